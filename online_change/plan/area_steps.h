// The steps for one area, on their way into a plan: made from the operations of a
// TypeDiff, then sorted and joined.
#pragma once

#include <cstdint>
#include <vector>

#include "online_change/diff/initial_data.h"
#include "online_change/diff/type_diff.h"
#include "online_change/plan/plan.h"

namespace online_change {

// An op of a TypeDiff for an area that was at `from` and is at `to`: absolute offsets.
UpdateStep step_for(const DiffOp& op, StepKind kind, uint32_t from, uint32_t to, uint32_t fate);
// The initial bytes of all values of a kInitialise step; none when all are zero.
base::Bytes initial_bytes(const InitialData& data, const UpdateStep& step);
// Sorts by target and joins copies that lie side by side and move by the same distance.
void join_steps(std::vector<UpdateStep>& steps);

}  // namespace online_change
