// What the running program calls a variable of a fate report, where the change renames it (X2):
// fates are told in the names of the new version.
#pragma once

#include <optional>

#include "online_change/diff/areas.h"
#include "tools/common/fate_report.h"

namespace tools {

class OldNames {
 public:
  // `renamed` is `original` under the names of the new version (ir/bytecode/renames.h), or the
  // same. Borrows both. Cost: their instances, when they are two.
  OldNames(const ir::Image& original, const ir::Image& renamed);

  // Fills in old_path where it differs from the path. Of a line for one variable.
  void tell(FateLine& line) const;

 private:
  std::optional<online_change::Areas> original_;
  std::optional<online_change::Areas> renamed_;
};

}  // namespace tools
