#include "online_change/plan/area_steps.h"

#include <algorithm>

namespace online_change {
namespace {

// Side by side only: what stays in its place has no step, and may lie in a gap.
bool joins(const UpdateStep& a, const UpdateStep& b) {
  const auto* first = a.as<CopiedValues>();
  const auto* next = b.as<CopiedValues>();
  if (first == nullptr || next == nullptr) return false;
  if (a.count != 1 || b.count != 1 || a.fate != b.fate) return false;
  if (a.to - first->from != b.to - next->from) return false;
  return uint64_t{a.to} + a.size == b.to;
}

}  // namespace

UpdateStep step_for(const DiffOp& op, uint32_t to, uint32_t fate) {
  UpdateStep step;
  step.to = to + op.to;
  step.size = op.size;
  step.count = op.count;
  step.to_stride = op.to_stride;
  step.fate = fate;
  return step;
}

CopiedValues copied_by(const DiffOp& op, uint32_t from) { return {from + op.from, op.from_stride}; }

ConvertedValues converted_by(const DiffOp& op, uint32_t from) {
  return {from + op.from, op.from_stride, op.old_type, op.new_type, {}};
}

base::Bytes initial_bytes(const InitialData& data, const UpdateStep& step) {
  if (data.is_zero(step.to, static_cast<uint32_t>(step.hull()))) return {};
  base::Bytes bytes(step.total());
  for (uint32_t i = 0; i < step.count; ++i) {
    data.read(step.place(i), {bytes.data() + size_t{i} * step.size, step.size});
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
