// Changes on a controller whose cycles do not go on, as in a replay, or that has to wait for one.
#include <gtest/gtest.h>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace stvm {
namespace {

using plc::Plc;

// A recorded request that had come late left no idle time, and nothing makes more of it.
TEST(Standing, D4_AChangeThatNoIdleTimeIsLeftForIsReplayed) {
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot("PROGRAM Main VAR n : DINT; END_VAR n := n + 1; END_PROGRAM").ok());
  plc.run(3);
  plc.stand();
  plc.clock().worked(1'000'000'000);
  const std::string next =
      "PROGRAM Main VAR n : DINT; more : LREAL := 2.5; END_VAR n := n + 1; END_PROGRAM";
  for (const int turn : {1, 2}) {
    ASSERT_TRUE(plc.change(next, vm::kAllowOverrun).ok()) << turn;
    EXPECT_EQ(plc.get("Main.more"), "2.5");
    ASSERT_TRUE(plc.undo().ok());
  }
}

// Behind a restart FB_Init runs for version 1, as at a start, before the switch.
TEST(Standing, case34_ASwitchWaitsForTheStartCodeOfARestart) {
  const auto tank = [](const char* more) {
    return std::string("VAR_GLOBAL colds, copies : INT; END_VAR\n") +
           "FUNCTION_BLOCK Tank VAR n : INT; END_VAR\n"
           "METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR "
           "IF bInCopyCode THEN copies := copies + 1; ELSE colds := colds + 1; END_IF END_METHOD\n"
           "END_FUNCTION_BLOCK\n"
           "PROGRAM Main VAR t : Tank; n : DINT; " +
           more + " END_VAR t(); n := n + 1; END_PROGRAM";
  };
  for (int at = 0; at < 8; ++at) {  // behind each job of the change
    sim::SimStorage disk;
    Plc plc(disk);
    ASSERT_TRUE(plc.boot(tank("")).ok());
    plc.run(3);
    int jobs = 0;
    plc.behind_job = [&] {
      if (jobs++ == at) (void)plc.controller().restart(vm::Restart::kCold, 0).ok();
    };
    ASSERT_TRUE(plc.change(tank("more : INT;"), vm::kAllowOverrun | vm::kAllowLoss).ok()) << at;
    plc.run(1);
    EXPECT_EQ(plc.get("colds"), "1") << at;
    EXPECT_EQ(plc.get("copies"), "0") << at;
  }
}

// FB_Reinit is due in the next cycle after an undo, as the version says that came back: a switch
// that is asked for before that waits for it.
TEST(Standing, D3_case34_ASwitchWaitsForTheStartCodeOfAnUndo) {
  const auto tank = [](int version, const char* in_tank, const char* in_main) {
    return std::string("FUNCTION_BLOCK Tank VAR seen : DINT; ") + in_tank +
           " END_VAR\nMETHOD FB_Reinit : BOOL seen := seen * 10 + " + std::to_string(version) +
           "; END_METHOD END_FUNCTION_BLOCK\n"
           "PROGRAM Main VAR t : Tank; n : DINT; " +
           in_main + " END_VAR t(); n := n + 1; END_PROGRAM";
  };
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(tank(1, "", "")).ok());
  plc.run(3);
  ASSERT_TRUE(plc.change(tank(2, "extra : INT;", "")).ok());
  plc.run(3);
  ASSERT_EQ(plc.get("Main.t.seen"), "2");
  plc.behind_job = [&] {  // after that of the undo no boundary comes, so no cycle is waited for
    if (plc.controller().start_pending()) {
      plc.at_boundary = [] { return vm::Boundary::Outcome::kTimeout; };
    }
  };
  ASSERT_TRUE(plc.undo().ok());
  plc.behind_job = {};
  plc.at_boundary = {};
  ASSERT_TRUE(plc.controller().start_pending());
  ASSERT_EQ(plc.get("Main.t.seen"), "2");
  const uint64_t cycles = plc.controller().cycles();
  ASSERT_TRUE(plc.change(tank(3, "", "more : INT;")).ok());
  EXPECT_EQ(plc.get("Main.t.seen"), "21") << "by the version that came back";
  EXPECT_GT(plc.controller().cycles(), cycles);
}

}  // namespace
}  // namespace stvm
