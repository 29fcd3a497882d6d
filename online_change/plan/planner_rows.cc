// The fate rows of a plan: what people read, as few rows as say everything.
#include <algorithm>
#include <map>

#include "online_change/diff/diff_ops.h"
#include "online_change/plan/initial_note.h"
#include "online_change/plan/planner.h"

namespace online_change {
namespace {

// Of what is converted: its values are of two types.
constexpr const char* kInitialChanged = "; initial value changed, the live value stays";

std::string join_path(const std::string& instance, const std::string& relative) {
  return instance.empty() && !relative.empty() ? relative.substr(1) : instance + relative;
}

// Has the image a type with the name and kind of `like`?
bool has_type(const ir::Image& image, const ir::Type& like) {
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    const ir::Type& type = image.types[ir::TypeId{i}];
    if (type.kind == like.kind && ir::same_name(type.name, like.name)) return true;
  }
  return false;
}

}  // namespace

template <class MakeRow>
uint32_t Planner::share(const std::string& key, uint64_t leaves, MakeRow make) {
  const uint32_t number = repeated(key, leaves);
  return number == FateRows::kNoRow ? first_of(key, leaves, make()) : number;
}

uint32_t Planner::repeated(const std::string& key, uint64_t leaves) {
  const uint32_t number = fates_.find(key);
  if (number == FateRows::kNoRow) return number;
  if (used_here_.insert(number).second) {
    fates_.repeat(number, leaves);
  } else {
    fates_.add_count(number, leaves);
  }
  return number;
}

uint32_t Planner::first_of(const std::string& key, uint64_t leaves, FateRow row) {
  row.count = leaves;
  const uint32_t number = fates_.add(key, row);
  used_here_.insert(number);
  return number;
}

uint32_t Planner::row_of(const Carried& instance, uint32_t diff_row, uint64_t leaves,
                         bool other_initial) {
  const char* const kind = other_initial ? "v" : "r";
  return share(kind + instance.key + ":" + std::to_string(diff_row), leaves, [&] {
    FateRow row = instance.diff->rows[diff_row];
    row.path = join_path(row.fate == Fate::kDropped ? old_.instance_path(instance.old_id)
                                                    : new_.instance_path(instance.new_id),
                         row.path);
    name_old_place(instance, row);
    if (other_initial) row.reason += kInitialChanged;
    return row;
  });
}

// Names the old place of what was moved, from the path in its area.
void Planner::name_old_place(const Carried& instance, FateRow& row) const {
  if (row.old_path.empty()) return;
  row.old_path = join_path(old_.instance_path(instance.old_id), row.old_path);
}

uint32_t Planner::constant_row(const Carried& instance, const DiffOp& op) {
  return share("c" + instance.key + ":" + std::to_string(op.row), op.leaves, [&] {
    FateRow row = instance.diff->rows[op.row];
    row.fate = Fate::kInitialised;
    row.path = join_path(new_.instance_path(instance.new_id), row.path);
    row.reason = "constant changed";
    return row;
  });
}

// "renamed from `x`"; "" for what kept its name.
std::string Planner::rename_note(const Carried& instance, const DiffOp& op) const {
  if (op.row >= instance.diff->rows.size()) return {};
  const FateRow& row = instance.diff->rows[op.row];
  return row.fate == Fate::kMoved ? row.reason : std::string();
}

// An instance under another name. `whole`: what is in it has no rows of its own.
void Planner::rename_row(const Carried& instance, bool whole) {
  const ir::Instance& from = old_.instances[instance.old_id];
  const std::string key = "R" + std::to_string(old_.instances[from.parent].type.index) + "." +
                          std::string(base_name(from.name)) + ":" + std::to_string(from.type.index);
  share(key, whole ? instance.diff->leaves : 0, [&] {
    FateRow row;
    row.path = new_.instance_path(instance.new_id);
    row.old_type = row.new_type = new_.types.text(new_.instances[instance.new_id].type);
    row.reason = renamed_from(base_name(back_ ? from.name : old_.types.old_name(from.old_name)));
    return row;
  });
}

// Told beside what else becomes of a variable: the new one will show after a cold start only.
std::string Planner::initial_note(const Carried& instance, const DiffOp& op,
                                  std::string_view path) const {
  return online_change::initial_note(old_areas_, old_data_,
                                     {instance.from + op.from, op.from_stride}, new_data_,
                                     {instance.to + op.to, op.to_stride}, op.size, op.count, path);
}

// Another initial value, or another name.
uint32_t Planner::note_row(const Carried& instance, const DiffOp& op) {
  const std::string renamed = rename_note(instance, op);
  const bool stays = !initial_equal(instance, op);
  const std::string key = (stays ? "i" : "I") + instance.key + ":" + std::to_string(op.row);
  return share(key, op.leaves, [&] {
    FateRow row = instance.diff->rows[op.row];
    row.fate = Fate::kKept;
    row.path = join_path(new_.instance_path(instance.new_id), row.path);
    name_old_place(instance, row);
    row.reason = renamed;
    if (stays) row.reason += initial_note(instance, op, row.path).substr(renamed.empty() ? 2 : 0);
    return row;
  });
}

// An instance whose area moved has one row for all that moved with it and is else as it was.
uint32_t Planner::moved_row(const Carried& instance, const DiffOp& op) {
  const std::string renamed = rename_note(instance, op);
  const bool changed = !initial_equal(instance, op);
  const bool alone = !instance.moved() || !renamed.empty() || changed;
  std::string part = alone ? std::to_string(op.row) : "";
  return share((changed ? "M" : "m") + instance.key + ":" + part, op.leaves, [&] {
    FateRow row;
    row.fate = Fate::kMoved;
    row.path = new_.instance_path(instance.new_id);
    if (alone) {
      const FateRow& member = instance.diff->rows[op.row];
      row.path = join_path(row.path, member.path);
      row.old_path = member.old_path;
      name_old_place(instance, row);
      row.old_type = member.old_type;
      row.new_type = member.new_type;
      row.reason = renamed.empty() ? "" : renamed + ", ";
      row.reason += instance.moved() ? "area moved" : "moved inside its area";
      if (changed) row.reason += initial_note(instance, op, row.path);
      return row;
    }
    row.old_type = old_.types.text(old_.instances[instance.old_id].type);
    row.new_type = new_.types.text(new_.instances[instance.new_id].type);
    row.reason = "area moved";
    if (row.path.empty()) row.path = "global variables";
    return row;
  });
}

// What TypeDiff::hints says of a new instance in one that lives on.
std::string Planner::rename_hint(uint32_t new_id) {
  const ir::Instance& instance = new_.instances[new_id];
  const uint32_t twin = match_.old_of_new[instance.parent];
  if (twin == kNoInstance) return {};
  if (new_.types[instance.type].kind == ir::Kind::kProgram) return program_hint(instance.type);
  const TypeDiff& diff =
      differ_.area(old_.instances[twin].type, new_.instances[instance.parent].type);
  const auto hint = diff.hints.find(ir::fold_name(base_name(instance.name)));
  return hint == diff.hints.end() ? std::string() : hint->second;
}

// One program of a type goes, and one comes.
std::string Planner::program_hint(ir::TypeId type) const {
  uint32_t came = 0;
  for (const uint32_t id : new_.program_ids()) {
    came += new_.instances[id].type == type && match_.old_of_new[id] == kNoInstance ? 1 : 0;
  }
  uint32_t gone = 0;
  std::string name;
  for (const uint32_t id : old_.program_ids()) {
    const ir::Instance& row = old_.instances[id];
    if (match_.new_of_old[id] != kNoInstance) continue;
    if (!same_instance_type(old_, row.type, new_, type)) continue;
    ++gone;
    name = row.name;
  }
  return gone == 1 && came == 1 ? rename_proposal(name) : std::string();
}

// A type that is gone may be the new one under another name: that has what it had.
std::string Planner::type_rename_hint(ir::TypeId before, ir::TypeId after) const {
  const ir::Type& gone = old_.types[before];
  const ir::Type& came = new_.types[after];
  if (gone.kind != came.kind || has_type(new_, gone) || has_type(old_, came)) return {};
  const bool same = std::equal(
      gone.members.begin(), gone.members.end(), came.members.begin(), came.members.end(),
      [](const ir::Member& a, const ir::Member& b) { return ir::same_name(a.name, b.name); });
  const bool into =
      came.name.find('.') != std::string::npos && gone.name.find('.') == std::string::npos;
  return same ? "; if `" + gone.name + "` is called `" + came.name +
                    "` now, write {renamed from := '" + (into ? "." : "") + gone.name +
                    "'} before it"
              : std::string();
}

// Instances inside a new instance are counted with it; equal ones share a row.
uint32_t Planner::added_row(uint32_t new_id, uint64_t leaves) {
  const ir::Instance& instance = new_.instances[new_id];
  uint32_t parent_row = row_of_new_[instance.parent];
  if (instance.parent != 0 && parent_row != FateRows::kNoRow) {
    fates_.add_count(parent_row, leaves);
    return parent_row;
  }
  uint32_t replaced = match_.retyped_from[new_id];
  uint32_t parent_type = new_.instances[instance.parent].type.index;
  std::string key = (replaced == kNoInstance ? "n" : "t") + std::to_string(parent_type) + "." +
                    std::string(base_name(instance.name)) + ":" +
                    std::to_string(instance.type.index);
  return share(key, leaves, [&] {
    FateRow row;
    row.fate = Fate::kInitialised;
    row.path = new_.instance_path(new_id);
    row.new_type = new_.types.text(instance.type);
    row.reason = "new" + rename_hint(new_id);
    if (replaced != kNoInstance) {
      const ir::TypeId before = old_.instances[replaced].type;
      row.old_type = old_.types.text(before);
      row.may_lose = live_inside_[replaced];
      row.reason = "another type" + type_rename_hint(before, instance.type);
      if (row.may_lose && row.reason == "another type") {
        row.reason += migration_hint(old_.types[before], new_.types[instance.type]);
      }
    }
    return row;
  });
}

// What has nothing but constants, or nothing at all, has no value to lose.
void Planner::find_live() {
  const bool any_goes =
      std::any_of(match_.old_order.begin(), match_.old_order.end(),
                  [&](uint32_t id) { return match_.new_of_old[id] == kNoInstance; });
  if (!any_goes) return;
  live_inside_.resize(old_.instances.size());
  std::map<ir::TypeId, bool> by_type;
  for (size_t i = match_.old_order.size(); i-- > 0;) {  // children before parents
    const uint32_t id = match_.old_order[i];
    const ir::TypeId type = old_.instances[id].type;
    const auto [own, fresh] = by_type.try_emplace(type, false);
    for (const ir::Member& member : old_.types[type].members) {
      if (!fresh || own->second) break;
      own->second = ir::is_listed(member) && !member.constant &&
                    !old_.types.is_instance(member.type) && differ_.leaves(old_, member.type) != 0;
    }
    if (own->second) live_inside_[id] = true;
    if (live_inside_[id]) live_inside_[old_.instances[id].parent] = true;
  }
}

uint32_t Planner::dropped_row(uint32_t old_id, uint64_t leaves) {
  const ir::Instance& instance = old_.instances[old_id];
  std::string key = "d" + std::to_string(old_.instances[instance.parent].type.index) + "." +
                    std::string(base_name(instance.name)) + ":" +
                    std::to_string(instance.type.index);
  return share(key, leaves, [&] {
    FateRow row;
    row.fate = Fate::kDropped;
    row.path = old_.instance_path(old_id);
    row.old_type = old_.types.text(instance.type);
    row.may_lose = live_inside_[old_id];
    row.reason = "removed";
    return row;
  });
}

}  // namespace online_change
