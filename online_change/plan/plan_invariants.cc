#include "online_change/plan/plan_invariants.h"

namespace online_change {
namespace {

uint64_t end_of(uint32_t first, const UpdateStep& step, uint32_t stride, uint32_t size) {
  return first + uint64_t{step.count - 1} * stride + size;
}

const char* broken_form(const Plan& plan, const UpdateStep& step) {
  const bool makes_bytes = step.kind == StepKind::kInitialise || step.kind == StepKind::kMigrate ||
                           step.kind == StepKind::kGather;
  if (step.count == 0 || step.size == 0) return "a step writes something";
  if (step.early && step.kind != StepKind::kInitialise) return "only initial values come early";
  // A conversion holds those of an edit that is taken out, which are other ones (plan.h).
  const bool may_hold = makes_bytes || step.kind == StepKind::kConvert;
  if (!may_hold && !step.bytes.empty()) return "what is copied has no bytes";
  if (makes_bytes && !step.bytes.empty() && step.bytes.size() != step.total()) {
    return "a step has all its bytes";
  }
  if (step.fate != kNoFate && step.fate >= plan.fates.size()) return "a fate is a row";
  if (step.kind == StepKind::kMigrate && step.from >= plan.calls.size()) return "a call is there";
  if (step.kind == StepKind::kGather && step.from >= plan.gathers.size()) return "a row is there";
  return nullptr;
}

}  // namespace

const char* broken_promise(const Plan& plan, const ir::Image& from, const ir::Image& to) {
  for (const UpdateStep& step : plan.steps) {
    if (const char* broken = broken_form(plan, step)) return broken;
    if (end_of(step.to, step, step.to_stride, step.size) > to.data_capacity) {
      return "a step writes inside of data memory";
    }
    const bool copies = step.kind == StepKind::kCopy;
    if (copies && end_of(step.from, step, step.from_stride, step.size) > from.data_capacity) {
      return "a step reads inside of data memory";
    }
  }
  return nullptr;
}

}  // namespace online_change
