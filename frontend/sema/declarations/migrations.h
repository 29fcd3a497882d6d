// Functions that migrate values in an online change: {migration of := 'Motor'} in front of a
// FUNCTION, {old := 'x'} and {new := 'x'} in front of its parameters (X2,
// docs/adr/0014-migrations.md).
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class Migrations : public Phase {
 public:
  using Phase::Phase;

  // After all interfaces: fills Program::migrations.
  void collect();
  // After all bodies: nothing but parameters and locals is read and written.
  void check_code();

 private:
  void add(PouInfo& info, const Attribute& rule);
  ir::TypeId type_of(const Attribute& rule);
  bool read_other(ir::Migration& row, const Attribute& rule);
  bool add_value(ir::Migration& row, const Variable& variable);
  bool is_new_member(const ir::Migration& row, const Variable& variable, const std::string& name);
  bool is_plain(ir::TypeId type) const;
  void check_function(const ir::Migration& row);
  void refuse(base::SourceSpan span, std::string text, std::string fix);
};

}  // namespace frontend
