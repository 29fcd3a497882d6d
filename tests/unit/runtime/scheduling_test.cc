// B1, B2, D6 on virtual time: one back edge of a loop takes one microsecond where time matters.
#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

constexpr const char* kTwoPeriods = R"(
PROGRAM Count  VAR n : DINT; END_VAR  n := n + 1;  END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := T#10ms, PRIORITY := 0);
  TASK Slow (INTERVAL := T#40ms, PRIORITY := 5);
  PROGRAM A WITH Fast : Count;
  PROGRAM B WITH Slow : Count;
END_RESOURCE END_CONFIGURATION
)";

// Two tasks whose scans last as many microseconds as their loops have rounds.
std::string timed(const char* fast, const char* slow, int fast_rounds, int slow_rounds) {
  auto program = [](const char* name, int rounds) {
    return std::string("PROGRAM ") + name + " VAR n : DINT; i : DINT; END_VAR FOR i := 1 TO " +
           std::to_string(rounds) + " DO n := n + 1; END_FOR END_PROGRAM\n";
  };
  return program("FastWork", fast_rounds) + program("SlowWork", slow_rounds) +
         "CONFIGURATION c RESOURCE r ON cpu TASK Fast (INTERVAL := " + fast +
         ", PRIORITY := 0); TASK Slow (INTERVAL := " + slow +
         ", PRIORITY := 1); PROGRAM F WITH Fast : FastWork; PROGRAM S WITH Slow : SlowWork; "
         "END_RESOURCE END_CONFIGURATION\n";
}

vm::ControllerOptions small_slices() {
  vm::ControllerOptions options;
  options.fuel_slice = 100;
  return options;
}

TEST(Scheduling, B1_BaseCycleIsGcdAndTasksRunTheirMultiples) {
  Plant plant(kTwoPeriods);
  ASSERT_TRUE(plant.ok());
  EXPECT_EQ(plant->base_period_ns(), 10 * kMs);
  plant.cycles(9);
  EXPECT_EQ(plant.get("A.n"), "9");
  EXPECT_EQ(plant.get("B.n"), "3");
  EXPECT_EQ(plant.task("Fast").missed, 0u);
  EXPECT_EQ(plant->next_release_ns(), 90 * kMs);
  EXPECT_EQ(plant.clock.now_ns(), 80 * kMs);
}

// C5's load: fast 50 ms / 30 ms, slow 200 ms / 30 ms.
TEST(Scheduling, B1_SlowTaskIsSuspendedWhenTheFastOneIsDue) {
  Plant plant(timed("T#50ms", "T#200ms", 30'000, 30'000), small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  EXPECT_EQ(plant.task("Fast").scans, 1u);
  EXPECT_EQ(plant.task("Slow").scans, 0u);
  EXPECT_FALSE(plant->at_boundary());
  EXPECT_NEAR(static_cast<double>(plant.clock.now_ns()), 50e6, 0.3e6);
  plant.cycles(1);
  EXPECT_TRUE(plant->at_boundary());
  EXPECT_EQ(plant.task("Fast").scans, 2u);
  EXPECT_EQ(plant.task("Slow").scans, 1u);
  // Idle until the release at 100 ms, which is on time.
  EXPECT_NEAR(static_cast<double>(plant.clock.now_ns()), 90e6, 0.5e6);
  EXPECT_EQ(plant->next_release_ns(), 100 * kMs);
  plant.cycles(10);
  EXPECT_EQ(plant.task("Fast").missed, 0u);
  EXPECT_EQ(plant.task("Slow").missed, 0u);
  EXPECT_EQ(plant.task("Slow").scans, 3u);
  EXPECT_EQ(plant.get("S.n"), "90000");
}

TEST(Scheduling, B1_TasksOfOnePriorityDoNotInterruptEachOther) {
  Plant plant(R"(
PROGRAM Long VAR i : DINT; END_VAR FOR i := 1 TO 25000 DO ; END_FOR END_PROGRAM
PROGRAM Short VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK One (INTERVAL := T#100ms, PRIORITY := 1); TASK Two (INTERVAL := T#10ms, PRIORITY := 1);
  PROGRAM L WITH One : Long; PROGRAM S WITH Two : Short;
END_RESOURCE END_CONFIGURATION)",
              small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(2);
  EXPECT_FALSE(plant->at_boundary());
  EXPECT_EQ(plant.task("Two").scans, 0u) << "it waits for the end of the other one";
  plant.cycles(1);
  EXPECT_EQ(plant.task("One").scans, 1u);
  EXPECT_EQ(plant.task("Two").scans, 1u);
}

TEST(Scheduling, ReleasesThatFindTheTaskRunningAreMissed) {
  // 25 ms of work every 10 ms.
  Plant plant(timed("T#10ms", "T#100ms", 25'000, 1), small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(3);
  EXPECT_EQ(plant.task("Fast").scans, 1u);
  EXPECT_EQ(plant.task("Fast").missed, 2u);
  plant.cycles(3);
  EXPECT_EQ(plant.task("Fast").scans, 2u);
  EXPECT_EQ(plant.task("Fast").missed, 4u);
  EXPECT_NEAR(static_cast<double>(plant.task("Fast").run.max), 25e6, 0.2e6);
}

TEST(Scheduling, CyclesThatNobodyCouldStartAreSkippedAndCounted) {
  Plant plant(kTwoPeriods);
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  plant.clock.advance(35 * kMs);  // asleep over the releases at 10 and 20 ms
  plant.cycles(1);
  EXPECT_EQ(plant.task("Fast").scans, 2u);
  EXPECT_EQ(plant.task("Fast").missed, 2u);
  EXPECT_EQ(plant->next_release_ns(), 40 * kMs);
}

TEST(Scheduling, FuelOneComesOutTheSame) {
  std::string source = timed("T#10ms", "T#20ms", 20, 50);
  vm::ControllerOptions one;
  one.fuel_slice = 1;
  Plant whole(source);
  Plant sliced(source, one);
  ASSERT_TRUE(whole.ok() && sliced.ok());
  whole.cycles(10);
  sliced.cycles(10);
  EXPECT_EQ(ir::state_text(whole->image(), whole->memory().view()),
            ir::state_text(sliced->image(), sliced->memory().view()));
}

TEST(Scheduling, EndlessLoopIsAFuelTrap) {
  vm::ControllerOptions options;
  options.fuel_budget = 5000;
  Plant plant("PROGRAM P VAR n : DINT; END_VAR WHILE TRUE DO n := n + 1; END_WHILE END_PROGRAM",
              options);
  ASSERT_TRUE(plant.ok());
  plant.cycles(3);
  EXPECT_TRUE(plant->faulted());
  EXPECT_TRUE(plant->at_boundary());
  ASSERT_EQ(plant->traps().size(), 1u);
  EXPECT_EQ(plant->traps()[0]->trap.kind, ir::TrapKind::kFuel);
  EXPECT_EQ(plant->traps()[0]->text.pou, "P");
  EXPECT_EQ(plant->cycles(), 1u);
}

TEST(Scheduling, WatchdogIsTenPeriodsOfOwnRunTime) {
  Plant plant(timed("T#1ms", "T#1s", 1, 1), small_slices(), 1000);
  Plant late(timed("T#1ms", "T#1s", 20'000, 1), small_slices(), 1000);
  ASSERT_TRUE(plant.ok() && late.ok());
  plant.cycles(30);
  late.cycles(30);
  EXPECT_FALSE(plant->faulted());
  EXPECT_TRUE(late->faulted());
  ASSERT_FALSE(late->traps().empty());
  EXPECT_EQ(late->traps()[0]->trap.kind, ir::TrapKind::kWatchdog);
}

constexpr const char* kTrapsInThird = R"(
PROGRAM Bad   VAR n : DINT; d : DINT := 3; q AT %QB0 : BYTE; x : DINT; END_VAR
  n := n + 1; q := 16#55; d := d - 1; x := 10 / d;
END_PROGRAM
PROGRAM Good  VAR n : DINT; q AT %QB1 : BYTE; END_VAR  n := n + 1; q := 16#0F; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK T1 (INTERVAL := T#10ms, PRIORITY := 1);
  TASK T2 (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM B WITH T1 : Bad;
  PROGRAM G WITH T2 : Good;
END_RESOURCE END_CONFIGURATION
)";

TEST(Scheduling, TrapStopsAllAndOutputsGoToZeroInTheSameCycle) {
  Plant plant(kTrapsInThird);
  ASSERT_TRUE(plant.ok());
  plant.cycles(2);
  EXPECT_EQ(plant.io.output(0), 0x55);
  EXPECT_EQ(plant.io.output(1), 0x0f);
  plant.cycles(1);
  EXPECT_TRUE(plant->faulted());
  EXPECT_EQ(plant.io.output(0), 0);
  EXPECT_EQ(plant.io.output(1), 0);
  plant.cycles(5);
  EXPECT_EQ(plant.get("G.n"), "2");
}

TEST(Scheduling, TrapStopsOneTaskWhenThePolicySaysSo) {
  vm::ControllerOptions options;
  options.on_trap = ir::OnTrap::kStopTask;
  Plant plant(kTrapsInThird, options);
  ASSERT_TRUE(plant.ok());
  plant.cycles(8);
  EXPECT_FALSE(plant->faulted());
  EXPECT_TRUE(plant.task("T1").stopped);
  EXPECT_EQ(plant.task("T1").scans, 2u);
  EXPECT_EQ(plant.get("G.n"), "8");
  EXPECT_EQ(plant->traps()[0]->trap.kind, ir::TrapKind::kDivisionByZero);
  EXPECT_EQ(plant->traps()[0]->task, "T1");
}

// What the controller does with its devices, in order.
class Recorder : public vm::IoPort {
 public:
  void receive(std::span<uint8_t> inputs) override {
    inputs[0] = ++given;
    log += "in" + std::to_string(given) + " ";
  }
  void send(std::span<const uint8_t> outputs) override {
    log += "out" + std::to_string(outputs[0]) + " ";
  }
  void at_boundary(const vm::ProcessImage&, uint8_t*) override { log += "service "; }
  std::string log;
  uint8_t given = 0;
};

// Output refresh, input refresh, execution, service: an output is what the scan before made of its
// input, and between two cycles there is a boundary.
TEST(Scheduling, D6_PhasesOfAScan) {
  auto image =
      build("PROGRAM P VAR i AT %IB0 : BYTE; q AT %QB0 : BYTE; END_VAR q := i; END_PROGRAM");
  ASSERT_TRUE(image.has_value());
  vm::VirtualClock clock;
  Recorder devices;
  auto controller = vm::Controller::start(*image, {}, clock, devices);
  ASSERT_TRUE(controller.ok());
  devices.log.clear();
  const uint8_t first = devices.given;
  for (int i = 0; i < 3; ++i) {
    (*controller)->cycle();
    devices.log += "| ";
    EXPECT_TRUE((*controller)->at_boundary());
  }
  EXPECT_EQ(first, 0);
  EXPECT_EQ(devices.log, "out0 in1 service | out1 in2 service | out2 in3 service | ");
}

// However long a scan takes, and however late one begins: the next one begins where it would have.
TEST(Scheduling, D6_ThePeriodIsFixed) {
  constexpr int64_t kPeriodMs = 10;
  Plant plant(
      "PROGRAM P VAR n : DINT; END_VAR n := n + 1; END_PROGRAM CONFIGURATION c RESOURCE r "
      "ON cpu TASK T (INTERVAL := T#10ms); PROGRAM P WITH T : P; END_RESOURCE "
      "END_CONFIGURATION");
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  int64_t next_ms = kPeriodMs;
  for (const int64_t late_ms : {0, 3, 9, 0, 14, 27, 1}) {
    EXPECT_EQ(plant->next_release_ns(), next_ms * kMs);
    plant.clock.advance((next_ms + late_ms) * kMs - plant.clock.now_ns());
    plant.cycles(1);
    EXPECT_EQ(plant.clock.now_ns(), (next_ms + late_ms) * kMs) << "it has waited for nothing";
    next_ms += (late_ms / kPeriodMs + 1) * kPeriodMs;
  }
  plant.cycles(1);
  EXPECT_EQ(plant.clock.now_ns(), next_ms * kMs) << "and the rest of the period is others'";
}

}  // namespace
}  // namespace runtime_test
