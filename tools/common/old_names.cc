#include "tools/common/old_names.h"

namespace tools {

OldNames::OldNames(const ir::Image& original, const ir::Image& renamed) {
  if (&original == &renamed) return;
  original_.emplace(original);
  renamed_.emplace(renamed);
}

// Both have everything at the same places. Of what is in a union, the names around that are looked
// for, and its own stays.
void OldNames::tell(FateLine& line) const {
  if (!original_ || line.old_address == 0) return;
  const std::string path = line.row.old_path.empty() ? line.row.path : line.row.old_path;
  const std::string around = renamed_->path_at(line.old_address);
  if (around.empty() || !path.starts_with(around)) return;
  std::string before = original_->path_at(line.old_address) + path.substr(around.size());
  line.row.old_path = before == line.row.path ? std::string() : std::move(before);
}

}  // namespace tools
