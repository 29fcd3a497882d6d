#include "ir/bytecode/part_edits.h"

#include <map>
#include <utility>

#include "base/name_case.h"

namespace ir {
namespace {

struct BothSides {
  std::string name;
  base::Digest original{};
  base::Digest edited{};
};

PartState state_of(const PartEdit& edit) {
  constexpr base::Digest kNone{};
  if (edit.here == edit.edited) return PartState::kHasIt;
  if (edit.here == edit.original) return PartState::kOk;
  return edit.here == kNone ? PartState::kMissing : PartState::kDifferent;
}

}  // namespace

std::vector<PartEdit> part_edits(const std::vector<Part>& original, const std::vector<Part>& edited,
                                 const std::vector<Part>& target) {
  std::map<std::pair<PartKind, std::string>, BothSides> rows;
  for (const Part& part : original) {
    BothSides& row = rows[{part.kind, fold_name(part.name)}];
    row.name = part.name;
    row.original = part.identity;
  }
  for (const Part& part : edited) {
    BothSides& row = rows[{part.kind, fold_name(part.name)}];
    row.name = part.name;
    row.edited = part.identity;
  }
  std::vector<PartEdit> edits;
  for (const auto& [key, row] : rows) {
    if (row.original == row.edited) continue;
    PartEdit edit{key.first, row.name, PartState::kOk, row.original, row.edited, {}};
    const Part* const here = find_part(target, key.first, row.name);
    if (here != nullptr) edit.here = here->identity;
    edit.state = state_of(edit);
    edits.push_back(std::move(edit));
  }
  return edits;
}

bool is_of_unit(PartKind kind) { return kind == PartKind::kUnit || kind == PartKind::kBlock; }

std::string_view step_of(const PartEdit& edit, const UnitMembers& members) {
  if (!is_of_unit(edit.kind)) return kTableStep;
  return edit.kind == PartKind::kUnit ? edit.name : unit_of(members, edit.name);
}

std::vector<PartEdit> of_step(const std::vector<PartEdit>& edits, std::string_view step,
                              const UnitMembers& members) {
  std::vector<PartEdit> of;
  for (const PartEdit& edit : edits) {
    if (same_name(step_of(edit, members), step)) of.push_back(edit);
  }
  return of;
}

}  // namespace ir
