// One source on every tier: evaluator, interpreter and hard modes must agree on state and trap
// after every scan.
#pragma once

#include <cstdint>
#include <string>

#include "tests/differential/compiled.h"

namespace differential {

struct Finding {
  bool failed = false;
  std::string key;       // what kind of failure: shrinking keeps it
  std::string text;      // for people
  std::string trap;      // where the program ended, the same on every tier
  uint64_t scan = 0;     // of a difference, or of the trap
  std::string expected;  // line of state that the evaluator has there
};

// Optimised by the passes of `build`, apart from the evaluator's program.
Finding examine(const std::string& source, int scans, const Build& build);
// The passes for the program of a seed: all, none, or some.
std::string random_passes(uint64_t seed);
Finding failure(std::string key, std::string text);
Finding skipped();  // its key says so
// The first line in which two states differ.
Finding first_difference(const std::string& oracle, const std::string& other);

}  // namespace differential
