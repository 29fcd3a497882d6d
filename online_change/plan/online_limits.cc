#include "online_change/plan/online_limits.h"

#include <algorithm>
#include <iterator>

#include "base/joined.h"
#include "ir/bytecode/image_versions.h"
#include "ir/bytecode/part_edits.h"
#include "online_change/plan/system_edits.h"

namespace online_change {
namespace {

using ir::kFirstImageVersion;
using ir::kLastImageVersion;

constexpr OnlineLimits kLimits[] = {
#define ONLINE_LIMITS(version, first_format, last_format, refused) \
  {version, first_format, last_format, refused},
#include "online_change/plan/online_limits.def"
#undef ONLINE_LIMITS
};

constexpr const char* kEditKindNames[] = {
#define ONLINE_EDIT(id, name, rule, what, remark) name,
#include "online_change/plan/online_edits.def"
#undef ONLINE_EDIT
};

// A version takes what all take that are joined.
void join(OnlineLimits& limits, const OnlineLimits& other) {
  limits.first_format = std::max(limits.first_format, other.first_format);
  limits.last_format = std::min(limits.last_format, other.last_format);
  limits.refused |= other.refused;
}

OnlineLimits strictest(std::span<const OnlineLimits> rows) {
  OnlineLimits out = rows.front();
  for (const OnlineLimits& row : rows) join(out, row);
  return out;
}

EditKind kind_of(const PouEdit& edit) {
  switch (edit.change) {
    case PouChange::kAdded:
      return EditKind::kUnitAdded;
    case PouChange::kRemoved:
      return EditKind::kUnitRemoved;
    case PouChange::kInterface:
      return EditKind::kUnitInterface;
    default:
      return EditKind::kUnitBody;
  }
}

bool is_program(const ir::Image& image, const std::string& type) {
  for (const uint32_t id : image.program_ids()) {
    if (ir::same_name(image.types->text(image.instances[id].type), type)) return true;
  }
  return false;
}

// By PartKind. kUnitBody: units and the table say it.
constexpr EditKind kOfParts[ir::kPartKindCount] = {
    EditKind::kUnitBody, EditKind::kType,    EditKind::kBlockVariables, EditKind::kUnitBody,
    EditKind::kTask,     EditKind::kProgram, EditKind::kAccess,         EditKind::kUnitBody,
    EditKind::kDevice,   EditKind::kSafe,    EditKind::kSchedule};

void add_parts(const ir::Image& before, const ir::Image& after, std::vector<OnlineEdit>& out) {
  const std::vector<ir::Part> was = ir::parts_of(before);
  for (const ir::PartEdit& edit : ir::part_edits(was, ir::parts_of(after), was)) {
    const EditKind kind = kOfParts[static_cast<size_t>(edit.kind)];
    if (kind == EditKind::kUnitBody) continue;
    const bool stays = edit.original != base::Digest{} && edit.edited != base::Digest{};
    const bool of_block = kind == EditKind::kBlockVariables;
    if (of_block && (!stays || is_program(after, edit.name))) continue;
    out.push_back({kind, edit.name, {}});
  }
}

}  // namespace

const char* edit_kind_name(EditKind kind) { return kEditKindNames[static_cast<size_t>(kind)]; }

EditKind kind_of(TableChange change) {
  return static_cast<EditKind>(static_cast<uint8_t>(EditKind::kVariableRemoved) +
                               static_cast<uint8_t>(change));
}

std::span<const OnlineLimits> online_limits() { return kLimits; }

const OnlineLimits* limits_of(std::span<const OnlineLimits> rows, std::string_view version) {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const OnlineLimits& row) { return row.version == version; });
  return found == rows.end() ? nullptr : &*found;
}

ChosenLimits chosen_limits(std::span<const OnlineLimits> rows,
                           const std::vector<std::string>& versions) {
  const std::string all = "the strictest of all versions";
  if (versions.empty()) return {strictest(rows), all + "; no --target says which"};
  std::vector<OnlineLimits> chosen;
  std::string names;
  for (const std::string& version : versions) {
    const OnlineLimits* const row = limits_of(rows, version);
    if (row == nullptr) {
      return {
          strictest(rows),
          all + ": stvm " + (version.empty() ? "of an unknown version" : version) + " has no row"};
    }
    chosen.push_back(*row);
    if (names.find(version) == std::string::npos) names += (names.empty() ? "" : ", ") + version;
  }
  const bool several = names.find(',') != std::string::npos;
  return {strictest(chosen), several ? "the strictest of stvm " + names : "those of stvm " + names};
}

std::vector<OnlineEdit> online_edits(const ir::Image& before, const ir::Image& after) {
  std::vector<OnlineEdit> out;
  for (const PouEdit& edit : pou_edits(before, after)) {
    if (edit.change != PouChange::kFollows) out.push_back({kind_of(edit), edit.pou, edit.what});
  }
  for (const TableEdit& edit : table_edits(before, after, TableSide::kBefore)) {
    out.push_back({kind_of(edit.change), edit.path, edit.what});
  }
  // What the new table has and the old one has not, is what goes on the way back.
  for (const TableEdit& edit : table_edits(after, before, TableSide::kBefore)) {
    const bool added = edit.change == TableChange::kRemoved && edit.path != edit.program;
    if (added) out.push_back({EditKind::kVariableAdded, edit.path, {}});
  }
  add_parts(before, after, out);
  for (const SystemEdit& edit : chart_edits(before, after)) {
    out.push_back({EditKind::kChart, edit.name, edit.what});
  }
  return out;
}

base::Status check_limits(const OnlineLimits& limits, const ir::Image& before,
                          const ir::Image& after) {
  std::string text;
  for (const OnlineEdit& edit : online_edits(before, after)) {
    if (limits.takes(edit.kind)) continue;
    text += base::joined({text.empty() ? "`" : "; `", edit.name, "`: ", edit_kind_name(edit.kind)});
    if (!edit.what.empty()) text += base::joined({" (", edit.what, ")"});
  }
  if (text.empty()) return base::Ok{};
  return base::Error{base::Refusal::kNotOnline,
                     base::joined({"stvm ", limits.version, " takes no such edit: ", text})};
}

base::Status check_own_limits(const ir::Image& before, const ir::Image& after) {
  // Where they refuse nothing there is no code for that.
  constexpr const OnlineLimits& kOwn = kLimits[std::size(kLimits) - 1];
  if constexpr (kOwn.refused == 0) return base::Ok{};
  return check_limits(kOwn, before, after);
}

}  // namespace online_change
