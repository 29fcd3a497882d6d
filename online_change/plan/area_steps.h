// The steps for one area, on their way into a plan: made from the operations of a
// TypeDiff, then sorted and joined.
#pragma once

#include <cstdint>
#include <vector>

#include "online_change/diff/initial_data.h"
#include "online_change/diff/type_diff.h"
#include "online_change/plan/plan.h"

namespace online_change {

// The values that an op of a TypeDiff makes, for an area that is at `to`: absolute offsets. The
// caller says how they are made.
UpdateStep step_for(const DiffOp& op, uint32_t to, uint32_t fate);
// How they are copied or converted, from an area that was at `from`.
CopiedValues copied_by(const DiffOp& op, uint32_t from);
ConvertedValues converted_by(const DiffOp& op, uint32_t from);
// The initial bytes of all values of a step; none when all are zero.
base::Bytes initial_bytes(const InitialData& data, const UpdateStep& step);
// Sorts by target and joins copies that lie side by side and move by the same distance.
void join_steps(std::vector<UpdateStep>& steps);

}  // namespace online_change
