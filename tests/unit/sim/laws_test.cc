// The laws of online change on random programs with everything that can happen to a plant, run as
// `sim` runs them (tests/sim/world.h), for a few seeds and by name.
#include <gtest/gtest.h>

#include "tests/sim/violation.h"
#include "tests/sim/world.h"

namespace sim {
namespace {

TEST(Simulation, law_random_programs_with_people_bad_connections_failing_disks_and_power_cuts) {
  Tally all;
  int plants = 0;
  for (uint64_t seed = 1001; plants < 12 && seed < 1040; ++seed) {
    World world(seed, false);
    try {
      if (!world.run(40)) continue;
    } catch (const Violation& violation) {
      ADD_FAILURE() << "seed " << seed << ": " << violation.what();
    }
    ++plants;
    all.switches += world.tally().switches;
    all.refusals += world.tally().refusals;
    all.faults += world.tally().faults;
    all.cuts += world.tally().cuts;
  }
  // They have met what the name says.
  EXPECT_EQ(plants, 12);
  EXPECT_GT(all.switches, 20u);
  EXPECT_GT(all.refusals, 20u);
  EXPECT_GT(all.faults, 10u);
  EXPECT_GT(all.cuts, 10u);
}

}  // namespace
}  // namespace sim
