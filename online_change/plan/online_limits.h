// What a controller takes online, by the version of its stvm (E-19 to E-22). stc asks it while
// somebody edits, and the controller asks it again before it stages a change.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "online_change/plan/pou_edits.h"
#include "online_change/plan/table_edits.h"

namespace online_change {

enum class EditKind : uint8_t {
#define ONLINE_EDIT(id, name, rule, what, remark) id,
#include "online_change/plan/online_edits.def"
#undef ONLINE_EDIT
};
enum class EditRule : uint8_t { kNone, kTable, kInterface };
// "table.removed"
const char* edit_kind_name(EditKind kind);
EditKind kind_of(TableChange change);

// One version, or what several have in common.
struct OnlineLimits {
  std::string_view version;
  uint32_t first_format = 0;  // of images
  uint32_t last_format = 0;
  uint32_t refused = 0;  // bits by EditKind
  bool takes(EditKind kind) const { return (refused >> static_cast<uint32_t>(kind) & 1) == 0; }
};
// Oldest first; the last row is of the version that is built.
std::span<const OnlineLimits> online_limits();
// Null: no row has that version.
const OnlineLimits* limits_of(std::span<const OnlineLimits> rows, std::string_view version);

// The limits that hold for all of these targets, and where they come from.
struct ChosenLimits {
  OnlineLimits limits;
  std::string text;  // "those of stvm 0.1.0", as people read it
};
// For no version, and for one without a row: the strictest of all rows. For several: the strictest
// of theirs (E-20).
ChosenLimits chosen_limits(std::span<const OnlineLimits> rows,
                           const std::vector<std::string>& versions);

// One edit, as far as limits go by it.
struct OnlineEdit {
  EditKind kind = EditKind::kUnitBody;
  std::string name;  // "Main.speed", "Motor"
  std::string what = {};
};
// All kinds of edits between two verified images. O(n log n).
std::vector<OnlineEdit> online_edits(const ir::Image& before, const ir::Image& after);

// E-22: kNotOnline names every edit that the limits refuse.
base::Status check_limits(const OnlineLimits& limits, const ir::Image& before,
                          const ir::Image& after);
// The same by the limits of the version that is built.
base::Status check_own_limits(const ir::Image& before, const ir::Image& after);

}  // namespace online_change
