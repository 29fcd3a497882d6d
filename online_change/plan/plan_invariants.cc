#include "online_change/plan/plan_invariants.h"

namespace online_change {
namespace {

const char* broken_form(const Plan& plan, const UpdateStep& step) {
  if (step.count == 0 || step.size == 0) return "a step writes something";
  const base::Bytes* const bytes = step.bytes();
  if (bytes != nullptr && !bytes->empty() && bytes->size() != step.total()) {
    return "a step has all its bytes";
  }
  if (step.fate != kNoFate && step.fate >= plan.fates.size()) return "a fate is a row";
  const auto* given = step.as<GivenValue>();
  if (given != nullptr && given->call >= plan.calls.size()) return "a call is there";
  const auto* gathered = step.as<GatheredBits>();
  if (gathered != nullptr && gathered->row >= plan.gathers.size()) return "a row is there";
  return nullptr;
}

}  // namespace

const char* broken_promise(const Plan& plan, const ir::Image& from, const ir::Image& to) {
  for (const UpdateStep& step : plan.steps) {
    if (const char* broken = broken_form(plan, step)) return broken;
    if (step.to + step.hull() > to.data_capacity) return "a step writes inside of data memory";
    const auto* copied = step.as<CopiedValues>();
    if (copied == nullptr) continue;
    const uint64_t hull = uint64_t{copied->from_stride} * (step.count - 1) + step.size;
    if (copied->from + hull > from.data_capacity) return "a step reads inside of data memory";
  }
  return nullptr;
}

}  // namespace online_change
