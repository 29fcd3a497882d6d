// What an edit changed, and whether it can be made in another program (E-11, E-12; D3): a
// comparison of three images, part by part.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ir/bytecode/identities.h"

namespace ir {

enum class PartState : uint8_t {
  kOk,         // the target has what the edit was made on
  kHasIt,      // the target has what the edit made already
  kMissing,    // the target has no such part
  kDifferent,  // the target has another one
};

struct PartEdit {
  PartKind kind = PartKind::kUnit;
  std::string name;
  PartState state = PartState::kOk;
  base::Digest original{};  // 0: the edit adds it
  base::Digest edited{};    // 0: the edit removes it
  base::Digest here{};      // 0: the target has none
};

// The parts that differ between `original` and `edited`, in their order; all three are those of
// parts_of(). O(parts).
std::vector<PartEdit> part_edits(const std::vector<Part>& original, const std::vector<Part>& edited,
                                 const std::vector<Part>& target);

// Edits can come in steps (E-25): the table, which is all that is no unit, or one unit with its
// variables, by name.
inline constexpr std::string_view kTableStep = "";
inline constexpr std::string_view kTableName = "table";  // as people say it
inline std::string step_text(std::string_view step) {
  return std::string(step == kTableStep ? kTableName : step);
}
bool is_of_unit(PartKind kind);
// The step that a part is made in; `members`: those of the edited version.
std::string_view step_of(const PartEdit& edit, const UnitMembers& members);
std::vector<PartEdit> of_step(const std::vector<PartEdit>& edits, std::string_view step,
                              const UnitMembers& members);

}  // namespace ir
