// Paths of one version's forced variables in the other one, whichever of them renames (case 47).
#pragma once

#include <string>

#include "ir/bytecode/renames.h"
#include "vm/runtime/forces.h"

namespace vm {

// Borrows both images.
class RenamedPaths {
 public:
  RenamedPaths(const ir::Image& from, const ir::Image& to)
      : from_(from), to_(to), there_(from, to), back_(to, from) {}

  std::string find(const Force& force) const {
    if (!there_.renamed() && !back_.renamed()) return force.path;
    const std::string before = ir::path_of(from_, force.symbol);
    const std::string after = there_.renamed() ? ir::path_of(there_.image(), force.symbol)
                                               : ir::own_path(to_, back_.image(), before);
    return before == after ? force.path : after;
  }

 private:
  const ir::Image& from_;
  const ir::Image& to_;
  ir::OldUnderNewNames there_;
  ir::OldUnderNewNames back_;
};

}  // namespace vm
