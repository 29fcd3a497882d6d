// V17 for migrations: what a function is given has the type that it takes, and what it gives goes
// to a variable of that type.
#include "ir/types/layout.h"
#include "online_change/diff/steps.h"
#include "online_change/diff/value_conversion.h"
#include "online_change/package/plan_check.h"

namespace online_change {
namespace {

const ir::FrameSlot* find_slot(const ir::LinkedPou& pou, uint32_t offset, ir::LocalKind kind) {
  for (const ir::FrameSlot& slot : pou.slots) {
    const bool parameter = slot.kind == ir::SlotKind::kParam && slot.local == kind;
    if (parameter && slot.offset == offset) return &slot;
  }
  return nullptr;
}

}  // namespace

bool PlanCheck::check_calls() {
  TypeFit fit(old_areas_, code_);
  for (const MigrationCall& call : plan_.calls) {
    why_ = "calls a migration that is nowhere";
    const bool known = call.row < code_.migrations.size() && call.instance < new_.instances.size();
    if (!known || (call.place != 0 && !new_.types.contains(call.type))) return false;
    const ir::LinkedPou& pou = code_.pous[code_.migrations[call.row].pou];
    size_t wanted = 0;
    for (const ir::FrameSlot& slot : pou.slots) {
      const bool input = slot.kind == ir::SlotKind::kParam && slot.local == ir::LocalKind::kInput;
      wanted += input ? 1 : 0;
    }
    why_ = "gives a migration other values than it takes";
    if (call.inputs.size() != wanted) return false;
    for (size_t i = 0; i < call.inputs.size(); ++i) {
      for (size_t other = 0; other < i; ++other) {
        if (call.inputs[other].slot == call.inputs[i].slot) return false;
      }
      if (!check_input(call.inputs[i], pou, fit)) return false;
    }
  }
  why_.clear();
  return true;
}

bool PlanCheck::check_input(const MigrationInput& input, const ir::LinkedPou& pou, TypeFit& fit) {
  const ir::FrameSlot* slot = find_slot(pou, input.slot, ir::LocalKind::kInput);
  if (slot == nullptr || !old_.types.contains(input.type)) return false;
  const std::optional<Node> leaf = old_areas_.leaf_at(input.from);
  if (leaf && !leaf->in_out && leaf->begin == input.from && leaf->type == input.type) {
    const Conversion way = classify(old_.types, input.type, code_.types, slot->region.type);
    if (way == Conversion::kSame || way == Conversion::kExact) return true;
  }
  const uint32_t size = code_.layouts[slot->region.type].size;
  return old_.layouts[input.type].size == size &&
         fit.value_at(input.from, {slot->region.type, 0, false}) == Fit::kYes;
}

const ir::FrameSlot* PlanCheck::slot_of(const GivenValue& value) const {
  const ir::LinkedMigration& row = code_.migrations[plan_.calls[value.call].row];
  return find_slot(code_.pous[row.pou], value.slot, ir::LocalKind::kOutput);
}

// Both sources are steps, so whichever is taken.
bool PlanCheck::check_entered(Node node, const Target& target) {
  const auto& how = *step_of(target).as<EnteredStep>();
  const bool right = !node.in_out && node.begin == target.to && size_of(node) == target.size &&
                     is_step(new_, node.type) && fit_.value_at(how.from, node) == Fit::kYes &&
                     fit_.value_at(how.active, node) == Fit::kYes;
  if (right) reach(target);
  return right || fail(node.begin, "goes on from what is no step");
}

bool PlanCheck::check_migrated(Node node, const Target& target) {
  const ir::FrameSlot* slot = slot_of(*step_of(target).as<GivenValue>());
  const bool right = slot != nullptr && !node.in_out && node.begin == target.to &&
                     size_of(node) == target.size &&
                     code_.layouts[slot->region.type].size == target.size &&
                     ir::same_value_type(new_.types, new_.layouts, node.type, code_.types,
                                         code_.layouts, slot->region.type);
  if (right) reach(target);
  return right || fail(node.begin, "is made by a migration of another type");
}

}  // namespace online_change
