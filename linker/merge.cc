#include "linker/merge.h"

#include <map>
#include <optional>
#include <utility>

#include "base/name_case.h"
#include "ir/types/member_finder.h"
#include "linker/link.h"
#include "linker/merge_pous.h"
#include "linker/merge_rows.h"
#include "linker/translate.h"
#include "linker/unlink.h"

namespace linker {
namespace {

using ir::PartEdit;
using ir::PartKind;
using ir::PartState;

constexpr base::Digest kNobody{};

std::string part_text(const PartEdit& edit) {
  const std::string name = std::string(ir::part_kind_name(edit.kind)) + " `" + edit.name + "`";
  if (edit.state == PartState::kMissing) return name + " is missing";
  const std::string made_for =
      edit.original == kNobody ? "added by the edit" : "was " + base::short_hex(edit.original);
  return name + " is another one here (" + base::short_hex(edit.here) + ", " + made_for + ")";
}

// Names all parts in the way. With `matching`, a unit may stay what it is, with its variables.
base::Status check_parts(const std::vector<PartEdit>& parts, bool matching) {
  std::string text;
  bool any = false;
  for (const PartEdit& edit : parts) {
    any = any || edit.state == PartState::kOk;
    const bool fits = edit.state == PartState::kOk || edit.state == PartState::kHasIt;
    const bool unit = edit.kind == PartKind::kUnit || edit.kind == PartKind::kBlock;
    if (fits || (matching && unit)) continue;
    text += (text.empty() ? "" : "; ") + part_text(edit);
  }
  if (!text.empty()) return base::Error{base::Refusal::kOtherPart, text};
  if (any) return base::Ok{};
  return base::Error{base::Refusal::kNoChange, "the program has every part of the edit already" +
                                                   std::string(matching ? " that fits" : "")};
}

uint32_t size_of(const ir::Image& image, ir::TypeId id) {
  const ir::TypeLayout& layout = image.layouts[id];
  return image.types.is_instance(id) ? layout.used : layout.size;
}

// A type that both have and that lies otherwise in the second one; with `sizes`, or that is larger
// or smaller there. Those that `ignored` says are left out.
template <class Ignored>
std::optional<std::string> moved_type(const ir::Image& from, const ir::Image& to, bool sizes,
                                      const Ignored& ignored) {
  std::map<std::string, ir::TypeId> known;
  for (uint32_t i = 0; i < to.types.size(); ++i) {
    known.emplace(ir::fold_name(to.types.text(ir::TypeId(i))), ir::TypeId(i));
  }
  for (uint32_t i = ir::kElementaryCount; i < from.types.size(); ++i) {
    const ir::TypeId id(i);
    const ir::Type& type = from.types[id];
    const auto found = known.find(ir::fold_name(from.types.text(id)));
    if (type.kind == ir::Kind::kGlobals || found == known.end() || ignored(id)) continue;
    const ir::TypeId there = found->second;
    const bool other_size = from.layouts[id].size != to.layouts[there].size;
    if (other_size || (sizes && size_of(from, id) != size_of(to, there))) {
      return from.types.text(id);
    }
    ir::MemberFinder members(to.types, there);
    for (size_t m = 0; m < type.members.size(); ++m) {
      const std::optional<size_t> number = members.find(type.members[m].name);
      const uint32_t before = from.layouts[id].member_offsets[m];
      if (number && before != to.layouts[there].member_offsets[*number]) return from.types.text(id);
    }
  }
  return std::nullopt;
}

// Types of the edited version that are others in the merged program. Its code names none of them,
// or it would have been refused.
class OtherTypes {
 public:
  OtherTypes(const ir::Image& from, const ir::Image& to)
      : types_(*from.types), from_(ir::parts_of(from)), to_(ir::parts_of(to)) {}

  bool operator()(ir::TypeId id) const {
    for (uint32_t depth = 0; types_[id].name.empty() && types_[id].base.valid(); ++depth) {
      if (depth > kMostNested) return false;
      id = types_[id].base;
    }
    for (const PartKind kind : {PartKind::kType, PartKind::kBlock}) {
      const ir::Part* const before = ir::find_part(from_, kind, types_[id].name);
      const ir::Part* const now = ir::find_part(to_, kind, types_[id].name);
      if (before != nullptr && now != nullptr && before->identity != now->identity) return true;
    }
    return false;
  }

 private:
  static constexpr uint32_t kMostNested = 1000;
  const ir::TypeTable& types_;
  std::vector<ir::Part> from_;
  std::vector<ir::Part> to_;
};

base::Error cannot(const std::string& text) { return {base::Refusal::kCannotRelink, text}; }

template <class Ignored>
base::Status check_fixed(const FixedPous& pous, const ir::Image& from, const ir::Image& to,
                         const Ignored& ignored) {
  if (pous.offsets.empty()) return base::Ok{};
  const bool sizes = !pous.sizes.empty();
  const std::optional<std::string> type = moved_type(from, to, sizes, ignored);
  if (!type) return base::Ok{};
  return cannot("`" + (sizes ? pous.sizes : pous.offsets) +
                "` goes through references or takes the SIZEOF of something, and `" + *type +
                "` would lie otherwise, or be of another size");
}

// Those of the edit, and what the target has besides.
ir::UnitMembers units_of_both(const ir::UnitMembers& edited, const ir::UnitMembers& target) {
  ir::UnitMembers units = edited;
  for (const ir::UnitMember& row : target) {
    if (ir::find_unit_member(edited, row.name) == nullptr) units.push_back(row);
  }
  ir::sort_by_name(units);
  return units;
}

base::Result<ir::Image> link_merged(const MergeInput& input, const MergedPous& pous,
                                    const MergedRows& rows, const Slack& slack) {
  Options options;
  options.base = &input.target;
  options.slack = slack;
  options.devices = rows.devices;
  options.safe = rows.safe;
  options.unit_members = units_of_both(input.edited.unit_members, input.target.unit_members);
  base::Result<ir::Image> image = link(*rows.merged, pous.objects, options);
  if (!image.ok()) return image;
  const OtherTypes others(input.edited, *image);
  const auto none = [](ir::TypeId) { return false; };
  if (base::Status lies = check_fixed(pous.from_edited, input.edited, *image, others); !lies.ok()) {
    return lies.error();
  }
  if (base::Status lies = check_fixed(pous.from_target, input.target, *image, none); !lies.ok()) {
    return lies.error();
  }
  return image;
}

}  // namespace

std::vector<PartEdit> merge_parts(const MergeInput& input) {
  const ir::UnitMembers& units = input.edited.unit_members;
  return ir::part_edits(ir::parts_of(input.original, units), ir::parts_of(input.edited),
                        ir::parts_of(input.target, units));
}

base::Result<ir::Image> merge(const MergeInput& input, const MergeOptions& options) {
  std::vector<PartEdit> parts = merge_parts(input);
  if (options.step) parts = ir::of_step(parts, *options.step, input.edited.unit_members);
  if (base::Status good = check_parts(parts, options.matching); !good.ok()) return good.error();
  base::Result<Unlinked> edited = unlink(input.edited);
  if (!edited.ok()) return edited.error();
  base::Result<Unlinked> target = unlink(input.target);
  if (!target.ok()) return target.error();
  const PartChoice choice(parts);
  base::Result<MergedRows> rows = merge_rows(input, choice, *edited, *target);
  if (!rows.ok()) return rows.error();
  base::Result<MergedPous> pous = merge_pous(input, choice, *edited, *target, *rows);
  if (!pous.ok()) return pous.error();
  return link_merged(input, *pous, *rows, options.slack);
}

}  // namespace linker
