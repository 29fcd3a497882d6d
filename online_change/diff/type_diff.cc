#include "online_change/diff/type_diff.h"

#include <algorithm>

#include "base/limits.h"
#include "online_change/diff/areas.h"
#include "online_change/diff/diff_ops.h"
#include "online_change/diff/member_names.h"
#include "online_change/diff/union_bytes.h"

namespace online_change {
namespace {

using ir::Kind;
using ir::Member;
using ir::Section;
using ir::TypeId;

// Where a variable gets another value although A14 has a rule: what the source says, and what the
// plant says.
constexpr const char* kBecomesConstant = "constant";
constexpr const char* kBecomesInput = "an input now";

// The whole value is initialised: nothing of the old one can be used.
TypeDiff without_rule(std::string old_text, std::string new_text, uint32_t size, uint64_t leaves) {
  TypeDiff diff;
  diff.has_rule = false;
  diff.leaves = leaves;
  std::string reason = "no conversion from " + old_text + " to " + new_text;
  diff.rows.push_back(make_row(Fate::kInitialised, "", std::move(old_text), std::move(new_text),
                               std::move(reason), leaves));
  diff.rows.back().may_lose = true;
  diff.ops.push_back(make_op(DiffKind::kInitialise, 0, 0, size, leaves));
  diff.ops.back().row = 0;
  return diff;
}

// Does a migration say that `type` was one of that name?
bool was_another(const ir::Image& image, TypeId type, const std::string& name) {
  return std::any_of(image.migrations.begin(), image.migrations.end(),
                     [&](const ir::LinkedMigration& row) {
                       return row.from_other && row.type == type && ir::same_name(row.from, name);
                     });
}

bool is_input(const Member& member) { return member.address.area == ir::DirectArea::kInput; }

}  // namespace

bool same_instance_type(const ir::Image& old_image, TypeId old_type, const ir::Image& new_image,
                        TypeId new_type) {
  const ir::Type& from = old_image.types[old_type];
  const ir::Type& to = new_image.types[new_type];
  if (from.kind != to.kind) return false;
  return ir::same_name(from.name, to.name) || was_another(new_image, new_type, from.name) ||
         was_another(old_image, old_type, to.name);
}

const TypeDiff& TypeDiffer::area(TypeId old_type, TypeId new_type) {
  std::unique_ptr<TypeDiff>& diff = areas_[{old_type, new_type}];
  if (!diff) {
    diff = std::make_unique<TypeDiff>(compare_members(old_type, new_type, true));
  }
  return *diff;
}

const TypeDiff& TypeDiffer::value(TypeId old_type, TypeId new_type) {
  auto found = values_.find({old_type, new_type});
  if (found != values_.end()) return *found->second;
  if (depth_ >= base::kMaxTypeDepth) failed_ = true;
  ++depth_;
  auto diff = std::make_unique<TypeDiff>(failed_ ? TypeDiff{} : compare_values(old_type, new_type));
  --depth_;
  return *(values_[{old_type, new_type}] = std::move(diff));
}

uint64_t TypeDiffer::leaves(const ir::Image& image, TypeId type) {
  const bool has_parts = image.types.has_members(type) || image.types[type].kind == Kind::kArray;
  if (!has_parts) return 1;
  auto found = leaves_.find({&image, type});
  if (found != leaves_.end()) return found->second;
  if (depth_ >= base::kMaxTypeDepth) {
    failed_ = true;
    return 0;
  }
  ++depth_;
  uint64_t count = count_leaves(image, type);
  --depth_;
  return leaves_[{&image, type}] = count;
}

uint64_t TypeDiffer::count_leaves(const ir::Image& image, TypeId id) {
  const ir::Type& type = image.types[id];
  if (type.kind == Kind::kArray) {
    if (image.types.is_instance(type.base)) return 0;
    uint64_t count = leaves(image, type.base);
    for (const ir::Dimension& dim : type.dims) count *= dim.count();
    return count;
  }
  if (!image.types.has_members(id) || image.types.overlaps(id)) return 1;
  uint64_t count = 0;
  for (const Member& member : type.members) {
    if (!ir::is_listed(member) || image.types.is_instance(member.type)) continue;
    count += leaves(image, member.type);
  }
  return count;
}

TypeDiff TypeDiffer::compare_values(TypeId old_type, TypeId new_type) {
  const ir::Type& from = old_.types[old_type];
  const ir::Type& to = new_.types[new_type];
  if (old_.types.overlaps(old_type) || new_.types.overlaps(new_type)) {
    return compare_overlapping(old_type, new_type);
  }
  if (from.kind == Kind::kStruct && to.kind == Kind::kStruct) {
    return compare_members(old_type, new_type, false);
  }
  if (from.kind == Kind::kArray && to.kind == Kind::kArray && from.dims.size() == to.dims.size()) {
    return compare_arrays(old_type, new_type);
  }
  if (old_.types.is_instance(old_type) && new_.types.is_instance(new_type)) {
    TypeDiff slot;
    slot.ops.push_back(make_op(DiffKind::kSlot, 0, 0, 4, 0));
    slot.same = same_instance_type(old_, old_type, new_, new_type);
    slot.ops[0].has_source = slot.same;
    return slot;
  }
  return compare_leaves(old_type, new_type);
}

// What lies on top of each other has no members that could be carried over one by one, but its
// bytes stay while members that live on say what they are (case 74): whatever comes, goes or gets
// another type beside them is another view. A member with another type whose bytes no other tells
// of would read them as something that they are not.
TypeDiff TypeDiffer::compare_overlapping(TypeId old_type, TypeId new_type) {
  uint32_t size = new_.layouts[new_type].size;
  const bool alike =
      ir::same_value_type(old_.types, old_.layouts, old_type, new_.types, new_.layouts, new_type);
  if (!alike && !keeps_union_bytes(old_, old_type, new_, new_type)) {
    const uint64_t count = new_.types.is_instance(new_type) ? 0 : leaves(new_, new_type);
    return without_rule(old_.types.text(old_type), new_.types.text(new_type), size, count);
  }
  TypeDiff diff;
  diff.leaves = leaves(new_, new_type);
  diff.same = alike;
  if (!alike) add_views(diff, old_type, new_type);
  const uint32_t kept = std::min(size, old_.layouts[old_type].size);
  diff.ops.push_back(make_op(DiffKind::kSame, 0, 0, kept, diff.leaves));
  if (kept < size) diff.ops.push_back(make_op(DiffKind::kInitialise, 0, kept, size - kept, 0));
  return diff;
}

// Members that lie on bytes which stay, and read them as another type now.
void TypeDiffer::add_views(TypeDiff& diff, TypeId old_type, TypeId new_type) const {
  for (const UnionView& view : union_views(old_, old_type, new_, new_type)) {
    if (view.same) continue;
    const Member& from = old_.types[old_type].members[view.old_member];
    const Member& to = new_.types[new_type].members[view.new_member];
    diff.rows.push_back(make_row(Fate::kConverted, "." + to.name, old_.types.text(from.type),
                                 new_.types.text(to.type), std::string(kAnotherView), 1));
  }
}

// On the way back, what the way there converted must be a conversion too, even if every value
// fits: only so the value from before it can come back.
Conversion TypeDiffer::conversion_of(TypeId old_type, TypeId new_type) const {
  Conversion conversion = classify(old_.types, old_type, new_.types, new_type);
  if (!back_ || conversion != Conversion::kSame) return conversion;
  Conversion there = classify(new_.types, new_type, old_.types, old_type);
  return there == Conversion::kSame ? Conversion::kSame : Conversion::kExact;
}

// Instances have rows of their own, so an array of them is neither initialised here nor lost; what
// makes way for one is lost all the same (case 62).
TypeDiff TypeDiffer::without_conversion(TypeId old_type, TypeId new_type) {
  const std::string old_text = old_.types.text(old_type);
  const uint64_t gone = old_.types.is_instance(old_type) ? 0 : leaves(old_, old_type);
  const uint64_t count = new_.types.is_instance(new_type) ? 0 : leaves(new_, new_type);
  TypeDiff diff =
      without_rule(old_text, new_.types.text(new_type), new_.layouts[new_type].size, count);
  diff.rows[0].may_lose = gone != 0;
  if (count != 0 || gone == 0) return diff;
  diff.rows.push_back(make_row(Fate::kDropped, "", old_text, "", "removed", gone));
  diff.rows.back().may_lose = true;
  return diff;
}

TypeDiff TypeDiffer::compare_leaves(TypeId old_type, TypeId new_type) {
  Conversion conversion = conversion_of(old_type, new_type);
  uint32_t size = new_.layouts[new_type].size;
  std::string old_text = old_.types.text(old_type);
  std::string new_text = new_.types.text(new_type);
  if (conversion == Conversion::kNone) {
    return without_conversion(old_type, new_type);
  }
  TypeDiff diff;
  diff.leaves = 1;
  diff.same = conversion == Conversion::kSame;
  diff.ops.push_back(make_op(diff.same ? DiffKind::kSame : DiffKind::kConvert, 0, 0, size, 1));
  if (diff.same) return diff;
  diff.ops[0].old_type = old_type;
  diff.ops[0].new_type = new_type;
  diff.ops[0].row = 0;
  diff.rows.push_back(
      make_row(Fate::kConverted, "", std::move(old_text), std::move(new_text), "retyped", 1));
  diff.rows[0].may_lose = conversion == Conversion::kMayLose;
  return diff;
}

TypeDiff TypeDiffer::compare_members(TypeId old_type, TypeId new_type, bool is_area) {
  const ir::Type& from = old_.types[old_type];
  const ir::Type& to = new_.types[new_type];
  const ir::TypeLayout& old_layout = old_.layouts[old_type];
  const ir::TypeLayout& new_layout = new_.layouts[new_type];
  MemberNames old_names(from);
  MemberNames new_names(to);
  TypeDiff diff;
  for (uint32_t i = 0; i < to.members.size() && !failed_; ++i) {
    const Member& member = to.members[i];
    uint32_t twin = old_names.find(member);
    const Member* old_member = twin == MemberNames::kNone ? nullptr : &from.members[twin];
    uint32_t old_offset = old_member == nullptr ? 0 : old_layout.member_offsets[twin];
    if (add_migrated(diff, old_member, old_type, new_type, i)) continue;
    if (member.section == Section::kInOut) {
      add_in_out(diff, old_member, old_offset, member, new_layout.member_offsets[i]);
    } else if (old_member == nullptr || old_member->section == Section::kInOut) {
      add_new_member(diff, member, new_layout.member_offsets[i], "new");
    } else if (!is_area || !add_step(diff, old_type, *old_member, old_offset, new_type, member,
                                     new_layout.member_offsets[i])) {
      add_member(diff, *old_member, old_offset, member, new_layout.member_offsets[i], is_area);
    }
  }
  for (uint32_t i = 0; i < from.members.size(); ++i) {
    uint32_t twin = new_names.find(from.members[i]);
    bool gone = twin == MemberNames::kNone || to.members[twin].section == Section::kInOut;
    if (gone && from.members[i].section != Section::kInOut)
      add_dropped_member(diff, old_type, i, new_type);
  }
  if (is_area) {
    move_parts(diff, old_type, new_type);
    if (!back_) explain_rules(diff, old_type, new_type);
  }
  if (!back_ && ir::same_name(from.name, to.name)) propose_renames(diff, old_type, new_type);
  if (!back_) propose_migration(diff, old_type, new_type);
  join(diff.ops);
  uint32_t old_size = is_area ? old_layout.used : old_layout.size;
  uint32_t new_size = is_area ? new_layout.used : new_layout.size;
  // What is left of a structure may lie where it lay: no operation tells that the rest is gone.
  bool dropped = std::any_of(diff.rows.begin(), diff.rows.end(),
                             [](const FateRow& row) { return row.fate == Fate::kDropped; });
  bool all_kept = from.members.size() == to.members.size() && old_size == new_size && !dropped;
  diff.same = all_kept && is_identity(diff.ops);
  diff.leaves = leaves(new_, new_type);
  return diff;
}

void TypeDiffer::add_in_out(TypeDiff& diff, const Member* old_member, uint32_t from,
                            const Member& new_member, uint32_t to) {
  DiffOp op = make_op(DiffKind::kInOut, from, to, 4, 0);
  op.has_source = old_member != nullptr && old_member->section == Section::kInOut &&
                  value(old_member->type, new_member.type).same;
  diff.ops.push_back(op);
}

void TypeDiffer::add_new_member(TypeDiff& diff, const Member& member, uint32_t to,
                                const char* reason) {
  DiffOp op = make_op(DiffKind::kInitialise, 0, to, member_size(new_, member), 0);
  if (new_.types.is_instance(member.type)) {
    op.kind = DiffKind::kSlot;
    op.has_source = false;
    diff.ops.push_back(op);
    return;
  }
  op.stamp = member.section == Section::kStamp;
  if (op.stamp) {
    diff.ops.push_back(op);
    return;
  }
  op.leaves = leaves(new_, member.type);
  op.row = static_cast<uint32_t>(diff.rows.size());
  diff.ops.push_back(op);
  diff.rows.push_back(make_row(Fate::kInitialised, "." + member.name, "",
                               new_.types.text(member.type), reason, op.leaves));
}

void TypeDiffer::add_member(TypeDiff& diff, const Member& old_member, uint32_t from,
                            const Member& new_member, uint32_t to, bool is_area) {
  bool old_is_instance = old_.types.is_instance(old_member.type);
  bool new_is_instance = new_.types.is_instance(new_member.type);
  if (old_is_instance != new_is_instance) {
    add_new_member(diff, new_member, to, old_is_instance ? "was a function block" : "new");
    if (!new_is_instance) return;
    diff.rows.push_back(make_row(Fate::kDropped, "." + old_member.name,
                                 old_.types.text(old_member.type), "", "removed",
                                 leaves(old_, old_member.type)));
    diff.rows.back().may_lose = true;
    return;
  }
  const TypeDiff& inner = value(old_member.type, new_member.type);
  bool becomes_constant = new_member.constant && !(old_member.constant && inner.same);
  bool was_initialised = back_ && old_member.constant && !(new_member.constant && inner.same);
  // An instance is a slot there, and nobody asks about a stamp: these have no row.
  const bool has_row = !new_is_instance && new_member.section != Section::kStamp;
  const bool comes_or_goes = is_input(new_member) != is_input(old_member);
  const bool input = comes_or_goes && (back_ || is_input(new_member));
  if (has_row && (becomes_constant || was_initialised || input)) {
    add_new_member(diff, new_member, to, input ? kBecomesInput : kBecomesConstant);
    diff.rows.back().old_type = old_.types.text(old_member.type);
    diff.rows.back().may_lose = !back_ && !old_member.constant && !is_input(old_member);
    const std::string note = rename_note(old_member, new_member);
    if (!note.empty()) diff.rows.back().reason = note + ", " + diff.rows.back().reason;
    return;
  }
  append_value(diff, inner, old_member, from, new_member, to, is_area,
               rename_note(old_member, new_member));
}

// "renamed from `x`"; "" for a variable that kept its name.
std::string TypeDiffer::rename_note(const Member& old_member, const Member& new_member) const {
  const ir::OldNameId rule = (back_ ? new_member : old_member).old_name;
  if (!renamed_ || !rule.valid()) return {};
  return renamed_from(back_ ? new_member.name : old_.types.old_name(rule));
}

void TypeDiffer::append_value(TypeDiff& diff, const TypeDiff& inner, const Member& old_member,
                              uint32_t from, const Member& new_member, uint32_t to, bool is_area,
                              std::string note) {
  auto first_row = static_cast<uint32_t>(diff.rows.size());
  diff.renamed = diff.renamed || inner.renamed || !note.empty();
  for (const FateRow& row : inner.rows) {
    diff.rows.push_back(row);
    if (!note.empty() && row.path.empty()) diff.rows.back().reason = note + ", " + row.reason;
    if (old_member.constant) diff.rows.back().may_lose = false;  // the source said its value
    diff.rows.back().path =
        "." + (row.fate == Fate::kDropped ? old_member : new_member).name + row.path;
  }
  // One row for what may move with the variable; a row that stays empty is left out.
  uint32_t own_row = kWholeVariable;
  if (is_area || !note.empty()) {
    own_row = static_cast<uint32_t>(diff.rows.size());
    diff.rows.push_back(make_row(Fate::kMoved, "." + new_member.name,
                                 old_.types.text(old_member.type), new_.types.text(new_member.type),
                                 std::move(note), 0));
  }
  if (diff.ops.size() + inner.ops.size() > kMaxDiffOps) {
    failed_ = true;
    return;
  }
  for (DiffOp op : inner.ops) {
    op.from += from;
    op.to += to;
    op.row = op.row == kWholeVariable ? own_row : first_row + op.row;
    if (new_member.section == Section::kStamp) op.leaves = 0;
    op.constant = op.constant || (new_member.constant && op.kind == DiffKind::kSame);
    diff.ops.push_back(op);
  }
}

}  // namespace online_change
