// Members whose values come by other ways than by name: by a migration, from a step that goes, or
// from another place in the area.
#include <algorithm>

#include "ir/bytecode/edge_names.h"
#include "online_change/diff/diff_ops.h"
#include "online_change/diff/moved_parts.h"
#include "online_change/diff/steps.h"
#include "online_change/diff/type_diff.h"

namespace online_change {

using ir::Member;
using ir::TypeId;

// What a migration reads is not lost.
void TypeDiffer::add_dropped_member(TypeDiff& diff, TypeId old_type, uint32_t number,
                                    TypeId new_type) {
  const Member& member = old_.types[old_type].members[number];
  if (old_.types.is_instance(member.type)) return;  // a row of its own, with its area
  std::string reason;
  const std::string reader = migrations_.reader_of(old_type, new_type, number);
  if (!reader.empty()) reason = "read by `" + reader + "`";
  const int32_t taker = back_ ? -1 : taker_of_step(old_, old_type, new_, new_type, number);
  if (taker >= 0) {
    reason = "goes on at `" + new_.types[new_type].members[static_cast<size_t>(taker)].name + "`";
  }
  diff.rows.push_back(make_row(Fate::kDropped, "." + member.name, old_.types.text(member.type), "",
                               reason.empty() ? "removed" : reason,
                               ir::is_listed(member) ? leaves(old_, member.type) : 0));
  // What an edge remembers is of no use without its contact.
  const std::string_view edge = ir::edge_of_name(member.name);
  const bool of_edge = !edge.empty() && edge.size() < member.name.size();
  diff.rows.back().may_lose =
      reason.empty() && !member.constant && !of_edge && ir::is_listed(member);
}

// A step that takes over another one. On the way back it is itself again.
bool TypeDiffer::add_step(TypeDiff& diff, TypeId old_type, const Member& old_member, uint32_t from,
                          TypeId new_type, const Member& new_member, uint32_t to) {
  const int32_t taken = back_ ? step_taken_over(new_, new_type, old_, old_type, old_member)
                              : step_taken_over(old_, old_type, new_, new_type, new_member);
  if (taken < 0 || !is_step(new_, new_member.type)) return false;
  DiffOp op = make_op(DiffKind::kEnter, from, to, new_.layouts[new_member.type].size,
                      leaves(new_, new_member.type));
  op.from_stride = back_ ? from : old_.layouts[old_type].member_offsets[static_cast<size_t>(taken)];
  op.row = static_cast<uint32_t>(diff.rows.size());
  diff.ops.push_back(op);
  const ir::Type& type = back_ ? new_.types[new_type] : old_.types[old_type];
  diff.rows.push_back(make_row(Fate::kConverted, "." + new_member.name,
                               old_.types.text(old_member.type), new_.types.text(new_member.type),
                               "takes over `" + type.members[static_cast<size_t>(taken)].name + "`",
                               op.leaves));
  return true;
}

// On the way back, what the way there has made anew gets the value from before, if no migration
// says better.
bool TypeDiffer::add_migrated(TypeDiff& diff, const Member* old_member, TypeId old_type,
                              TypeId new_type, uint32_t number) {
  const Member& member = new_.types[new_type].members[number];
  const uint32_t to = new_.layouts[new_type].member_offsets[number];
  const std::optional<Migrations::Source> source =
      migrations_.source_of(old_type, new_type, number);
  if (!source) {
    if (!migrations_.is_restored(old_type, new_type, number)) return false;
    add_new_member(diff, member, to, "restored");
    return true;
  }
  DiffOp op =
      make_op(DiffKind::kMigrate, 0, to, new_.layouts[member.type].size, leaves(new_, member.type));
  op.migration = *source;
  op.within = to;
  op.new_type = member.type;
  op.row = static_cast<uint32_t>(diff.rows.size());
  diff.ops.push_back(op);
  diff.rows.push_back(make_row(
      Fate::kConverted, "." + member.name,
      old_member == nullptr ? "" : old_.types.text(old_member->type), new_.types.text(member.type),
      "migrated by `" + migrations_.name_of(source->migration) + "`", op.leaves));
  return true;
}

// What was moved into a structure or out of one takes its value along, by A14. What is left of the
// row that drops it is what is really gone.
void TypeDiffer::move_parts(TypeDiff& diff, TypeId old_type, TypeId new_type) {
  const std::vector<MovedPart> moves = back_ ? moved_parts(new_, new_type, old_, old_type)
                                             : moved_parts(old_, old_type, new_, new_type);
  for (const MovedPart& move : moves) {
    if (back_ && !move.leaves) continue;  // the old place has a value of its own
    const PartPlace& from = back_ ? move.to : move.from;
    const PartPlace& to = back_ ? move.from : move.to;
    const TypeDiff& inner = value(from.type, to.type);
    if (!inner.has_rule) continue;
    const uint32_t size = new_.layouts[to.type].size;
    if (!carve(diff.ops, to.at, size, leaves(new_, to.type))) continue;
    uint64_t gone = leaves(old_, from.type);
    for (FateRow& row : diff.rows) {
      if (row.fate != Fate::kDropped || gone == 0 || !covers(row.path, from.path)) continue;
      row.count -= std::min(row.count, gone);
      row.may_lose = row.may_lose && row.count != 0;
      gone = 0;
    }
    diff.moved.insert(from.path);
    diff.moved.insert(to.path);
    Member source;
    source.name = from.path.substr(1);
    source.type = from.type;
    Member target;
    target.name = to.path.substr(1);
    target.type = to.type;
    const size_t first = diff.rows.size();
    append_value(diff, inner, source, from.at, target, to.at, true,
                 back_ ? "" : renamed_from(source.name));
    for (size_t i = first; i < diff.rows.size(); ++i) {
      FateRow& row = diff.rows[i];
      if (row.fate != Fate::kDropped) row.old_path = from.path + row.path.substr(to.path.size());
    }
  }
}

}  // namespace online_change
