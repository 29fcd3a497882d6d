// Old names of declarations, from the rules in front of them (rename_rules.h), on their way into
// the program.
#pragma once

#include <string>

#include "frontend/sema/phase.h"

namespace frontend {

class OldNames : public Phase {
 public:
  using Phase::Phase;

  ir::OldNameId add(std::string name);  // invalid for ""
  ir::OldNameId of_rule(Range32 attributes);
  // Of what is made of a type and named after it, with `suffix` behind.
  ir::OldNameId add_made(ir::TypeId type, std::string_view suffix);
  // By the variable's own rule or that of the POU that it is part of.
  ir::OldNameId of(const Variable& variable);
  // The old names of the type `name(instance)`, by the rules of the program and of its instance.
  ir::OldNameId of_clone(std::string_view name, std::string_view rule, std::string_view instance,
                         std::string_view instance_rule);
  // After the resolution of all types. Only those with a name of their own can be renamed.
  void rename_types();

 private:
  std::string old_list(const PouInfo& info) const;
  std::string old_member(const Variable& variable) const;
  ir::OldNameId of_pool(const Variable& variable);
  bool has_part(ir::TypeId type, std::string_view part) const;
};

}  // namespace frontend
