// Variables that the compiler makes of others, and names after them: what an edge in a drawing
// remembers (`operand#rising#target`, parse/diagram.h), the record of a chart's action that is a
// variable (`lamp#action`, sfc/declare.h). Where a rule gives the others old names, these had
// others, too (X2); and what an edge of a block remembers is named otherwise where the block got a
// base or lost it. Reads declarations that are resolved.
#pragma once

#include <string>
#include <vector>

#include "frontend/sema/phase.h"

namespace frontend {

class MadeNames : public Phase {
 public:
  explicit MadeNames(Sema& sema, const Variable& variable);

  // The names that it may have had, the latest first; without the present one.
  std::vector<std::string> before() const;

 private:
  using Names = std::vector<std::string>;

  Names of_operand(std::string_view text) const;
  Names prefixes(std::string_view& front) const;
  VarId global_in_list(std::string_view list, std::string_view name) const;

  const Variable& variable_;
};

}  // namespace frontend
