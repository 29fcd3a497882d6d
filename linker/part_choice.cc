#include "linker/part_choice.h"

#include "base/name_case.h"

namespace linker {
namespace {

bool is_open(const ir::PartEdit* edit) {
  return edit != nullptr && edit->state == ir::PartState::kOk;
}

}  // namespace

PartChoice::PartChoice(const std::vector<ir::PartEdit>& edits) : edits_(edits) {
  for (const ir::PartEdit& edit : edits) {
    by_name_.emplace(std::pair(edit.kind, base::fold_name(edit.name)), &edit);
  }
}

const ir::PartEdit* PartChoice::edit(ir::PartKind kind, const std::string& name) const {
  const auto found = by_name_.find({kind, base::fold_name(name)});
  return found == by_name_.end() ? nullptr : found->second;
}

bool PartChoice::takes(ir::PartKind kind, const std::string& name) const {
  const ir::PartEdit* const row = edit(kind, name);
  return is_open(row) && row->edited != base::Digest{};
}

bool PartChoice::drops(ir::PartKind kind, const std::string& name) const {
  const ir::PartEdit* const row = edit(kind, name);
  return is_open(row) && row->edited == base::Digest{};
}

}  // namespace linker
