// A program that runs with some of its variables forced, on several tiers: they agree after every
// scan, and a variable whose force holds everywhere has its value at every safe point.
#pragma once

#include <cstdint>
#include <string>

#include "tests/differential/tiers.h"

namespace differential {

// `Finding::key` is "skipped" when the program has nothing that can be forced.
Finding examine_forces(const std::string& source, uint64_t seed, int scans,
                       const std::string& passes);

}  // namespace differential
