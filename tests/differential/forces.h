// A program that runs with some of its variables forced, on several tiers, optimised and not: after
// every scan they agree with the evaluator, which puts the values back behind every instruction;
// and what is forced has its value at every safe point.
#pragma once

#include <cstdint>
#include <string>

#include "tests/differential/tiers.h"

namespace differential {

// `Finding::key` is "skipped" when the program has nothing that can be forced.
Finding examine_forces(const std::string& source, uint64_t seed, int scans,
                       const Build& build);

}  // namespace differential
