// A program that runs, an online change to another version of it, and undo: what must hold of
// every variable whatever the two programs are.
//
//   kept       same name and type: same value, and the same place unless the plan says moved
//   converted  as the rules of A14 say, computed here from the texts of the values
//   new        the initial value that the new version has at a cold start
//   afterwards the new version runs as the evaluator does from the same values
//   undo       what nobody wrote since is as it was; what lives in both goes on
#pragma once

#include <cstdint>
#include <string>

#include "tests/differential/tiers.h"

namespace differential {

struct ChangeScript {
  int scans_before = 3;
  int scans_after = 3;  // 0: undo at once, everything must be as it was
};
ChangeScript change_script(uint64_t seed);

// `Finding::key` is "skipped" when the second version does not compile or the first one traps.
Finding examine_change(const std::string& first, const std::string& second,
                       const ChangeScript& script, const Build& build);

}  // namespace differential
