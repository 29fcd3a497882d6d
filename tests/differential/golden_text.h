// A finding as a golden file, ready to be put into tests/golden/.
#pragma once

#include <cstdint>
#include <string>

#include "tests/differential/changes.h"

namespace differential {

// Mode run: the tiers are compared there again.
std::string run_text(const std::string& source, uint64_t seed, const Finding& finding, int scans,
                     const Build& build);
// Mode change, with the script that showed it; `golden --update` fills in the report of the change.
std::string change_text(const std::string& first, const std::string& second, uint64_t seed,
                        const Finding& finding, const ChangeScript& script, const Build& build);

}  // namespace differential
