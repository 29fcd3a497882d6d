#include "online_change/plan/planner.h"

#include <algorithm>

#include "base/check.h"
#include "ir/bytecode/renames.h"
#include "ir/types/stamps.h"
#include "online_change/diff/stored_value.h"
#include "online_change/plan/area_steps.h"
#include "online_change/plan/by_address.h"
#include "online_change/plan/pause.h"
#include "online_change/plan/plan_invariants.h"

namespace online_change {
namespace {

// More steps than this are refused: a package must fit into a controller's memory.
constexpr size_t kMaxSteps = 8'000'000;

base::Bytes old_stamp() { return base::Bytes(4, static_cast<uint8_t>(ir::kOldStamp)); }

constexpr uint32_t kReplaced = FateRows::kNoRow - 1;  // row_of_old_: counted with its successor

}  // namespace

Planner::Planner(const ir::Image& old_image, const ir::Image& new_image,
                 TypeDiffer::Direction direction, bool renamed)
    : old_(old_image),
      new_(new_image),
      renamed_(renamed),
      back_(direction == TypeDiffer::Direction::kBack),
      old_data_(old_image),
      new_data_(new_image),
      old_areas_(old_image),
      match_(match_instances(old_image, new_image)),
      migrations_(direction == TypeDiffer::Direction::kForward
                      ? Migrations(old_image, new_image, Migrations::Way::kThere)
                      : Migrations(new_image, old_image, Migrations::Way::kBack)),
      differ_(old_image, new_image, direction, renamed, migrations_),
      calls_(plan_, migrations_, old_image,
             direction == TypeDiffer::Direction::kForward ? new_image : old_image),
      row_of_new_(new_image.instances.size(), FateRows::kNoRow),
      row_of_old_(old_image.instances.size(), FateRows::kNoRow) {}

base::Result<Plan> Planner::run() {
  if (migrations_.error()) return *migrations_.error();
  find_live();
  for (uint32_t id : match_.new_order) {
    uint32_t twin = match_.old_of_new[id];
    if (twin == kNoInstance) {
      add_instance(id);
    } else {
      carry(twin, id);
    }
    if (differ_.failed() || too_many_ || plan_.steps.size() > kMaxSteps) {
      return base::Error{base::Refusal::kTooMany,
                         "the change of `" + new_.instance_path(id) +
                             "` takes more single steps than a change may have (" +
                             std::to_string(kMaxSteps) + "); split it"};
    }
  }
  for (uint32_t id : match_.old_order) {
    if (match_.new_of_old[id] == kNoInstance) drop_instance(id);
  }
  base::dcheck(area_.empty(), "the steps of each area are in the plan");
  plan_.fates = fates_.take();
  if (differ_.forward()) propose_reading(new_, plan_.fates);
  ByAddress(old_, new_, plan_).run();
  for (const UpdateStep& step : plan_.steps) {
    if (!step.early()) plan_.boundary_bytes += step.total();
  }
  plan_.predicted_pause_ns = predicted_pause_ns(plan_, old_, new_);
  expect_promises(plan_, old_, new_);
  return std::move(plan_);
}

void Planner::carry(uint32_t old_id, uint32_t new_id) {
  const ir::Instance& from = old_.instances[old_id];
  const ir::Instance& to = new_.instances[new_id];
  base::dcheck(match_.new_of_old[old_id] == new_id, "who lives on is matched both ways");
  Carried instance{old_id, new_id, from.data, to.data, &differ_.area(from.type, to.type), ""};
  used_here_.clear();
  calls_.end_instance();
  const bool whole = stays_whole(instance);
  if (renamed_ && (back_ ? to : from).old_name.valid()) rename_row(instance, whole);
  if (whole) {
    plan_.counts.kept += instance.diff->leaves;
    return;
  }
  instance.key = std::to_string(from.type.index) + "," + std::to_string(to.type.index);
  if (moves_whole(instance)) return;
  for (const DiffOp& op : instance.diff->ops) apply(instance, op);
  add_dropped_rows(instance);
  finish_area();
}

bool Planner::nothing_differs(const Carried& instance) const {
  return instance.diff->same && !instance.diff->renamed &&
         old_data_.equal(instance.from, new_data_, instance.to, old_areas_.used(instance.old_id));
}

bool Planner::stays_whole(const Carried& instance) const {
  return !instance.moved() && nothing_differs(instance);
}

// One copy for the whole area.
bool Planner::moves_whole(const Carried& instance) {
  if (!instance.moved() || !nothing_differs(instance)) return false;
  DiffOp whole;
  whole.size = old_areas_.used(instance.old_id);
  whole.leaves = instance.diff->leaves;
  if (whole.size == 0) return true;
  plan_.counts.moved += whole.leaves;
  copy(instance, whole, moved_row(instance, whole));
  finish_area();
  return true;
}

void Planner::apply(const Carried& instance, const DiffOp& op) {
  switch (op.kind) {
    case DiffKind::kSame:
      return apply_same(instance, op);
    case DiffKind::kSlot:
      return apply_slots(instance, op);
    case DiffKind::kInOut:
      return apply_in_outs(instance, op);
    case DiffKind::kMigrate:
      return migrate(instance, op);
    case DiffKind::kEnter:
      return enter(instance, op);
    case DiffKind::kInitialise:
      plan_.counts.initialised += op.leaves;
      return initialise(instance, op,
                        op.leaves == 0 ? kNoFate : row_of(instance, op.row, op.leaves));
    case DiffKind::kConvert:
      return convert(instance, op);
  }
}

bool Planner::initial_equal(const Carried& instance, const DiffOp& op) const {
  const bool converts = op.kind == DiffKind::kConvert;
  const uint32_t old_size = converts ? old_.layouts[op.old_type].size : op.size;
  const uint32_t last = op.count - 1;
  // Zeros everywhere: one value says it for all.
  const bool alike =
      !old_data_.has_run(instance.from + op.from, last * op.from_stride + old_size) &&
      !new_data_.has_run(instance.to + op.to, last * op.to_stride + op.size);
  for (uint32_t i = 0; i < (alike ? 1 : op.count); ++i) {
    const uint32_t from = instance.from + op.from + i * op.from_stride;
    const uint32_t to = instance.to + op.to + i * op.to_stride;
    const bool equal =
        converts ? initial_converts(op, from, to) : old_data_.equal(from, new_data_, to, op.size);
    if (!equal) return false;
  }
  return true;
}

// Does a conversion make the new initial value of the old one?
bool Planner::initial_converts(const DiffOp& op, uint32_t from, uint32_t to) const {
  base::Bytes before(old_.layouts[op.old_type].size);
  base::Bytes made(op.size);
  base::Bytes after(op.size);
  old_data_.read(from, before);
  new_data_.read(to, after);
  const Converted value = convert_stored(old_, op.old_type, before.data(), new_, op.new_type, made);
  return value.initialise || made == after;
}

void Planner::apply_same(const Carried& instance, const DiffOp& op) {
  bool in_place = instance.from + op.from == instance.to + op.to &&
                  (op.count == 1 || op.from_stride == op.to_stride);
  if (op.constant && !initial_equal(instance, op)) {
    plan_.counts.initialised += op.leaves;
    return initialise(instance, op, constant_row(instance, op));
  }
  if (!in_place) {
    plan_.counts.moved += op.leaves;
    const bool counted = op.leaves != 0 || instance.moved();
    return copy(instance, op, counted ? moved_row(instance, op) : kNoFate);
  }
  plan_.counts.kept += op.leaves;
  if (!initial_equal(instance, op) || !rename_note(instance, op).empty()) note_row(instance, op);
}

void Planner::initialise(const Carried& instance, const DiffOp& op, uint32_t fate) {
  const UpdateStep step = step_for(op, instance.to, fate);
  const bool stamp = op.stamp && instance.new_id != 0;
  put_initial(step, stamp ? old_stamp() : initial_bytes(new_data_, step));
}

void Planner::copy(const Carried& instance, const DiffOp& op, uint32_t fate) {
  UpdateStep step = step_for(op, instance.to, fate);
  step.how = copied_by(op, instance.from);
  put(std::move(step));
}

void Planner::convert(const Carried& instance, const DiffOp& op) {
  plan_.counts.converted += op.leaves;
  UpdateStep step =
      step_for(op, instance.to, row_of(instance, op.row, op.leaves, !initial_equal(instance, op)));
  step.how = converted_by(op, instance.from);
  put(std::move(step));
}

void Planner::enter(const Carried& instance, const DiffOp& op) {
  plan_.counts.converted += op.leaves;
  UpdateStep step = step_for(op, instance.to, row_of(instance, op.row, op.leaves));
  step.how = EnteredStep{instance.from + op.from, instance.from + op.from_stride};
  put(std::move(step));
}

void Planner::migrate(const Carried& instance, const DiffOp& op) {
  plan_.counts.converted += op.leaves;
  const uint32_t row = row_of(instance, op.row, op.leaves);
  if (plan_.steps.size() + area_.size() + op.count > kMaxSteps) too_many_ = true;
  for (uint32_t i = 0; i < op.count && !too_many_; ++i) {
    put(calls_.step(op, i, instance.new_id, instance.from, instance.to, row));
  }
}

void Planner::apply_slots(const Carried& instance, const DiffOp& op) {
  for (uint32_t i = 0; i < op.count; ++i) {
    DiffOp slot = op;
    slot.count = 1;
    slot.from += i * op.from_stride;
    slot.to += i * op.to_stride;
    uint32_t from = instance.from + slot.from;
    uint32_t to = instance.to + slot.to;
    bool same_id = op.has_source && old_data_.word(from) == new_data_.word(to);
    if (same_id && from == to) continue;
    if (same_id) {
      copy(instance, slot, instance.moved() ? moved_row(instance, slot) : kNoFate);
    } else {
      initialise(instance, slot, kNoFate);
    }
  }
}

// Addresses are bound again by every call; one that would be of another place or type is cleared.
void Planner::apply_in_outs(const Carried& instance, const DiffOp& op) {
  bool in_place = op.has_source && instance.from + op.from == instance.to + op.to;
  if (in_place) return;
  put_initial(step_for(op, instance.to, kNoFate), {});
}

// Of what has no step.
void Planner::add_dropped_rows(const Carried& instance) {
  const std::vector<FateRow>& rows = instance.diff->rows;
  for (uint32_t i = 0; i < rows.size(); ++i) {
    if (rows[i].reason == kAnotherView) row_of(instance, i, rows[i].count);
    if (rows[i].fate != Fate::kDropped || rows[i].count == 0) continue;
    plan_.counts.dropped += rows[i].count;
    row_of(instance, i, rows[i].count);
  }
}

void Planner::add_instance(uint32_t new_id) {
  const ir::Instance& instance = new_.instances[new_id];
  base::dcheck(row_of_new_[new_id] == FateRows::kNoRow, "an instance is added once");
  uint64_t leaves = differ_.leaves(new_, instance.type);
  used_here_.clear();
  const bool hidden = instance.name == ir::kStartProgram;
  uint32_t row = hidden ? kNoFate : added_row(new_id, leaves);
  row_of_new_[new_id] = row;
  plan_.counts.initialised += leaves;
  if (match_.retyped_from[new_id] != kNoInstance) {
    row_of_old_[match_.retyped_from[new_id]] = kReplaced;
  }
  DiffOp whole;
  whole.size = new_.layouts[instance.type].used;
  if (whole.size == 0) return;
  const UpdateStep step = step_for(whole, instance.data, row);
  put_initial(step, initial_bytes(new_data_, step));
  finish_area();
}

void Planner::drop_instance(uint32_t old_id) {
  const ir::Instance& instance = old_.instances[old_id];
  base::dcheck(match_.new_of_old[old_id] == kNoInstance, "who is dropped lives on nowhere");
  if (row_of_old_[old_id] == kReplaced || instance.name == ir::kStartProgram) return;
  uint32_t parent_row = instance.parent == 0 ? FateRows::kNoRow : row_of_old_[instance.parent];
  if (parent_row == kReplaced) {
    row_of_old_[old_id] = kReplaced;
    return;
  }
  uint64_t leaves = differ_.leaves(old_, instance.type);
  used_here_.clear();
  plan_.counts.dropped += leaves;
  if (parent_row != FateRows::kNoRow) {
    fates_.add_count(parent_row, leaves);
    row_of_old_[old_id] = parent_row;
    return;
  }
  row_of_old_[old_id] = dropped_row(old_id, leaves);
}

void Planner::put(UpdateStep step) {
  base::dcheck(step.size != 0 && step.count != 0, "a step writes something");
  base::dcheck(step.to < new_.data_capacity, "a step writes inside of data memory");
  area_.push_back(std::move(step));
}

void Planner::put_initial(UpdateStep step, base::Bytes bytes) {
  const bool early = !old_areas_.owns(step.to, static_cast<uint32_t>(step.hull()));
  step.how = InitialValues{std::move(bytes), early};
  put(std::move(step));
}

void Planner::finish_area() {
  join_steps(area_);
  for (UpdateStep& step : area_) plan_.steps.push_back(std::move(step));
  area_.clear();
}

base::Result<Plan> plan(const ir::Image& old_image, const ir::Image& new_image) {
  const ir::OldUnderNewNames old(old_image, new_image);
  return Planner(old.image(), new_image, TypeDiffer::Direction::kForward, old.renamed()).run();
}

base::Result<Plan> inverse_plan(const ir::Image& old_image, const ir::Image& new_image) {
  const ir::OldUnderNewNames old(old_image, new_image);
  return Planner(new_image, old.image(), TypeDiffer::Direction::kBack, old.renamed()).run();
}

}  // namespace online_change
