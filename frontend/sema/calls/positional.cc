#include "frontend/sema/calls/positional.h"

#include <algorithm>

namespace frontend {

std::vector<VarId> positional_parameters(const Declarations& declared,
                                         std::span<const VarId> variables, VarId result,
                                         uint32_t count) {
  std::vector<VarId> out;
  for (const VarId id : variables) {
    if (id != result && is_parameter(declared.variables[id.index].section)) out.push_back(id);
  }
  if (count == out.size()) return out;
  std::stable_partition(out.begin(), out.end(), [&](VarId id) {
    return declared.variables[id.index].section != VarSection::kOutput;
  });
  return out;
}

}  // namespace frontend
