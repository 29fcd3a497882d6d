#include "online_change/plan/area_steps.h"

#include <algorithm>

namespace online_change {
namespace {

// Side by side only: what stays in its place has no step, and may lie in a gap.
bool joins(const UpdateStep& a, const UpdateStep& b) {
  if (a.kind != StepKind::kCopy || b.kind != StepKind::kCopy) return false;
  if (a.count != 1 || b.count != 1 || a.fate != b.fate) return false;
  if (a.to - a.from != b.to - b.from) return false;
  return uint64_t{a.to} + a.size == b.to;
}

}  // namespace

UpdateStep step_for(const DiffOp& op, StepKind kind, uint32_t from, uint32_t to, uint32_t fate) {
  UpdateStep step;
  step.kind = kind;
  step.from = kind == StepKind::kInitialise ? 0 : from + op.from;
  step.to = to + op.to;
  step.size = op.size;
  step.count = op.count;
  step.from_stride = kind == StepKind::kInitialise ? 0 : op.from_stride;
  step.to_stride = op.to_stride;
  if (kind == StepKind::kConvert) {
    step.old_type = op.old_type;
    step.new_type = op.new_type;
  }
  step.fate = fate;
  return step;
}

base::Bytes initial_bytes(const InitialData& data, const UpdateStep& step) {
  uint32_t hull = step.to_stride * (step.count - 1) + step.size;
  if (data.is_zero(step.to, hull)) return {};
  base::Bytes bytes(step.total());
  for (uint32_t i = 0; i < step.count; ++i) {
    data.read(step.to + i * step.to_stride, {bytes.data() + size_t{i} * step.size, step.size});
  }
  return bytes;
}

void join_steps(std::vector<UpdateStep>& steps) {
  std::stable_sort(steps.begin(), steps.end(),
                   [](const UpdateStep& a, const UpdateStep& b) { return a.to < b.to; });
  size_t kept = 0;
  for (size_t i = 0; i < steps.size(); ++i) {
    if (kept != 0 && joins(steps[kept - 1], steps[i])) {
      steps[kept - 1].size = steps[i].to + steps[i].size - steps[kept - 1].to;
    } else {
      if (kept != i) steps[kept] = std::move(steps[i]);
      ++kept;
    }
  }
  steps.resize(kept);
}

}  // namespace online_change
