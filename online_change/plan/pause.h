// The cost model of the pause: what the boundary work of a plan is expected to
// take. Constants from bench runs on a slow core, rounded up, so that the real
// pause stays below.
#pragma once

#include <cstdint>

#include "online_change/plan/plan.h"

namespace online_change {

inline constexpr int64_t kPauseFixedNs = 5'000;    // checks, publish
inline constexpr int64_t kPauseStepNs = 60;        // one step
inline constexpr int64_t kPauseValueNs = 15;       // one copied piece
inline constexpr int64_t kPauseConversionNs = 60;  // one converted value
inline constexpr int64_t kPauseBytesPerNs = 1;     // read, save, write

int64_t predicted_pause_ns(const Plan& plan);

}  // namespace online_change
