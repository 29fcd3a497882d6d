// Cold, warm and hot start, after a fault of the whole controller.
#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

constexpr const char* kTwoTasks = R"(
VAR_GLOBAL RETAIN total : INT; END_VAR
VAR_GLOBAL divisor : INT := 1; END_VAR
PROGRAM Fast VAR n : INT; lamp AT %QB0 : BYTE := 3; END_VAR
  n := n + 1; total := total + 1; lamp := INT_TO_BYTE(10 / divisor);
END_PROGRAM
PROGRAM Slow VAR n : INT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK quick (INTERVAL := T#10ms, PRIORITY := 0); TASK idle (INTERVAL := T#30ms, PRIORITY := 1);
  PROGRAM f WITH quick : Fast; PROGRAM s WITH idle : Slow;
END_RESOURCE END_CONFIGURATION
)";

// Five cycles, a fault in the sixth, and 95 ms in which nothing runs.
void let_it_fail(Plant& plant) {
  plant.cycles(5);
  ASSERT_TRUE(plant->set("divisor", "0").ok());
  plant.cycles(1);
  ASSERT_TRUE(plant->faulted());
  EXPECT_EQ(plant.io.output(0), 0);
  plant.clock.wait_until(plant.clock.now_ns() + 95 * kMs);
}

TEST(Restart, WarmKeepsWhatIsRetainedAndForces) {
  Plant plant(kTwoTasks);
  ASSERT_TRUE(plant.ok());
  ASSERT_TRUE(plant->force("s.n", "40").ok());
  let_it_fail(plant);
  ASSERT_TRUE(plant->restart(vm::Restart::kWarm, kMs).ok());
  EXPECT_FALSE(plant->faulted());
  EXPECT_EQ(plant.get("total"), "6");
  EXPECT_EQ(plant.get("f.n"), "0");
  plant.cycles(1);
  EXPECT_EQ(plant.io.output(0), 3);  // as it begins
  plant.cycles(1);
  EXPECT_EQ(plant.io.output(0), 10);
  EXPECT_EQ(plant.get("total"), "8");
  EXPECT_EQ(plant.get("f.n"), "2");
  plant.cycles(3);
  EXPECT_EQ(plant.get("s.n"), "40");
}

// The time in which nothing ran is not made up for, and nobody has missed a scan.
TEST(Restart, HotGoesOnInPhase) {
  Plant plant(kTwoTasks);
  ASSERT_TRUE(plant.ok());
  let_it_fail(plant);
  ASSERT_TRUE(plant->set("divisor", "2").ok());
  ASSERT_TRUE(plant->restart(vm::Restart::kHot, kMs).ok());
  const uint64_t slow = plant.task("idle").scans;
  plant.cycles(6);
  EXPECT_EQ(plant.get("f.n"), "12");
  EXPECT_EQ(plant.task("idle").scans, slow + 2);
  EXPECT_EQ(plant.task("quick").missed, 0u);
  EXPECT_EQ(plant.task("idle").missed, 0u);
  EXPECT_EQ(plant->next_cycle_ns() % (10 * kMs), 0);
}

TEST(Restart, ColdKeepsNothing) {
  Plant plant(kTwoTasks);
  ASSERT_TRUE(plant.ok());
  let_it_fail(plant);
  ASSERT_TRUE(plant->restart(vm::Restart::kCold, kMs).ok());
  EXPECT_EQ(plant.get("total"), "0");
  EXPECT_EQ(plant.get("divisor"), "1");
  EXPECT_EQ(plant->traps().size(), 1u);  // stays on record
}

}  // namespace
}  // namespace runtime_test
