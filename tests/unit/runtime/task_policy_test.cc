// B7, freewheeling tasks, and what traps do, on virtual time: a round of a loop takes a
// microsecond.
#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

vm::ControllerOptions small_slices() {
  vm::ControllerOptions options;
  options.fuel_slice = 100;
  return options;
}

// 25 ms of work every 10 ms, above a task without work.
std::string too_long(const std::string& attributes, const char* parameters = "INTERVAL := T#10ms") {
  return R"(
VAR_GLOBAL event : BOOL; END_VAR
PROGRAM Work VAR n, i : DINT; q AT %QB0 : BYTE; END_VAR
  n := n + 1; FOR i := 1 TO 25000 DO ; END_FOR q := 16#55;
END_PROGRAM
PROGRAM Count VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  )" + attributes +
         " TASK Long (" + parameters + R"(, PRIORITY := 2);
  TASK Other (INTERVAL := T#10ms, PRIORITY := 1);
  PROGRAM W WITH Long : Work; PROGRAM O WITH Other : Count;
END_RESOURCE END_CONFIGURATION
)";
}

TEST(TaskPolicy, B7_SkipLeavesReleasesOut) {
  Plant plant(too_long("{attribute 'overrun' := 'skip'}"), small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(9);
  EXPECT_EQ(plant.task("Long").scans, 3u);  // from 0, 30 and 60 ms on
  EXPECT_EQ(plant.task("Long").overruns, 6u);
  EXPECT_EQ(plant.task("Long").missed, 6u);
  EXPECT_EQ(plant.task("Other").scans, 9u);
  EXPECT_EQ(plant.task("Other").overruns, 0u);
}

// 0 to 25 ms, and at 30 ms again, on a cycle: a period of 30 ms. With a period of 20 ms, skipping
// would start at 0, 40 and 80 ms; stretching starts at 0, 30, 60 ms.
TEST(TaskPolicy, B7_StretchMakesThePeriodLonger) {
  Plant skip(too_long("", "INTERVAL := T#20ms"), small_slices(), 1000);
  Plant plant(too_long("{attribute 'overrun' := 'stretch'}", "INTERVAL := T#20ms"), small_slices(),
              1000);
  ASSERT_TRUE(plant.ok() && skip.ok());
  plant.cycles(9);
  skip.cycles(9);
  EXPECT_EQ(skip.task("Long").scans, 2u);
  EXPECT_EQ(skip.task("Long").missed, 2u);
  EXPECT_EQ(plant.task("Long").scans, 3u);
  EXPECT_EQ(plant.task("Long").missed, 0u);
  EXPECT_EQ(plant.task("Long").overruns, 3u);
  EXPECT_EQ(plant.task("Other").scans, 9u);
  EXPECT_EQ(plant.get("W.n"), "3");
}

TEST(TaskPolicy, B7_FaultEndsTheScan) {
  Plant plant(too_long("{attribute 'overrun' := 'fault'} {attribute 'on_trap' := 'stop_task'}"),
              small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(5);
  EXPECT_TRUE(plant.task("Long").stopped);
  EXPECT_EQ(plant.task("Long").scans, 0u);
  EXPECT_EQ(plant.task("Long").overruns, 1u);
  EXPECT_EQ(plant.task("Other").scans, 5u);
  ASSERT_EQ(plant->traps().size(), 1u);
  EXPECT_EQ(plant->traps()[0]->trap.kind, ir::TrapKind::kOverrun);
  EXPECT_EQ(plant->traps()[0]->cycle, 1u);
  EXPECT_EQ(plant->traps()[0]->text.pou, "Work");
  EXPECT_EQ(plant->traps()[0]->text.line, 4u);
}

TEST(TaskPolicy, B7_FaultOfATaskThatCouldNotEvenBegin) {
  Plant plant(R"(
PROGRAM Hog VAR i : DINT; END_VAR FOR i := 1 TO 15000 DO ; END_FOR END_PROGRAM
PROGRAM Work VAR i : DINT; END_VAR FOR i := 1 TO 10 DO ; END_FOR END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK High (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'overrun' := 'fault'} {attribute 'on_trap' := 'go_on'} TASK Low (INTERVAL := T#10ms, PRIORITY := 2);
  {attribute 'freewheeling'} TASK Lowest (PRIORITY := 9);
  PROGRAM H WITH High : Hog; PROGRAM L WITH Low : Work; PROGRAM M WITH Lowest : Work;
END_RESOURCE END_CONFIGURATION
)",
              small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(10);
  EXPECT_GT(plant.task("Low").overruns, 0u);
  EXPECT_GT(plant->trap_count(), 0u);
  EXPECT_FALSE(plant->faulted());
}

// An edge every 10 ms for a scan of 25 ms: the second and third one find it running, and one scan
// more makes up for them.
TEST(TaskPolicy, StretchedEventIsRunWhenTheScanIsDone) {
  for (const char* policy : {"skip", "stretch"}) {
    SCOPED_TRACE(policy);
    Plant plant(
        too_long("{attribute 'overrun' := '" + std::string(policy) + "'}", "SINGLE := %IX0.0"),
        small_slices(), 1000);
    ASSERT_TRUE(plant.ok());
    const uint8_t levels[] = {1, 0, 1, 0, 0, 0, 0, 0};
    for (uint8_t level : levels) {
      plant.io.set_input(0, level);
      plant.cycles(1);
    }
    const bool stretch = std::string(policy) == "stretch";
    EXPECT_EQ(plant.task("Long").overruns, 1u);
    EXPECT_EQ(plant.task("Long").scans, stretch ? 2u : 1u);
    EXPECT_EQ(plant.task("Long").missed, stretch ? 0u : 1u);
  }
}

// The trap stops it, though it was due once more.
TEST(TaskPolicy, StoppedTaskIsNotRunForAStretchedRelease) {
  Plant plant(R"(
PROGRAM Work VAR i, zero : DINT; q AT %QB0 : BYTE; END_VAR
  q := 16#55; FOR i := 1 TO 25000 DO ; END_FOR i := 1 / zero;
END_PROGRAM
PROGRAM Count VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  {attribute 'overrun' := 'stretch'} {attribute 'on_trap' := 'stop_task'}
  TASK Long (SINGLE := %IX0.0, PRIORITY := 2);
  TASK Other (INTERVAL := T#10ms, PRIORITY := 1);
  PROGRAM W WITH Long : Work; PROGRAM O WITH Other : Count;
END_RESOURCE END_CONFIGURATION
)",
              small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  for (uint8_t level : {1, 0, 1, 0, 0, 0, 0, 0}) {
    plant.io.set_input(0, level);
    plant.cycles(1);
    EXPECT_EQ(plant.io.output(0), 0);
  }
  EXPECT_EQ(plant->trap_count(), 1u);
  EXPECT_TRUE(plant.task("Long").stopped);
}

// Whenever nothing else runs; one scan may last over several cycles and is never an overrun.
TEST(TaskPolicy, B1_FreewheelingTaskRunsInWhatIsLeft) {
  Plant plant(R"(
PROGRAM Work VAR n, i : DINT; END_VAR n := n + 1; FOR i := 1 TO 25000 DO ; END_FOR END_PROGRAM
PROGRAM Count VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'freewheeling'} TASK Free (PRIORITY := 20);
  {attribute 'freewheeling'} TASK Short (PRIORITY := 10);
  PROGRAM F WITH Fast : Count; PROGRAM W WITH Free : Work; PROGRAM S WITH Short : Count;
END_RESOURCE END_CONFIGURATION
)",
              small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  EXPECT_EQ(plant->base_period_ns(), 10 * kMs);
  plant.cycles(9);
  EXPECT_EQ(plant.task("Fast").scans, 9u);
  EXPECT_EQ(plant.task("Short").scans, 9u);
  EXPECT_EQ(plant.task("Free").scans, 3u);
  EXPECT_EQ(plant.task("Free").overruns, 0u);
  EXPECT_EQ(plant.task("Fast").missed, 0u);
}

// --- fault class x policy -> safe outputs in the same cycle --------------------------------------

struct Fault {
  const char* name;
  const char* statements;  // from the third scan on
  ir::TrapKind kind;
};
constexpr Fault kFaults[] = {
    {"division", "n := 10 / zero;", ir::TrapKind::kDivisionByZero},
    {"modulo", "n := 10 MOD zero;", ir::TrapKind::kDivisionByZero},
    {"index", "a[9 + zero] := 1;", ir::TrapKind::kIndex},
    {"subrange", "small := zero + 50;", ir::TrapKind::kSubrange},
    {"conversion", "n := LREAL_TO_DINT(1E300 + n);", ir::TrapKind::kConversion},
    {"for step", "FOR n := 1 TO 3 BY zero DO ; END_FOR", ir::TrapKind::kForStep},
    {"reference", "n := nowhere^;", ir::TrapKind::kReference},
    {"fuel", "WHILE TRUE DO ; END_WHILE", ir::TrapKind::kFuel},
    {"watchdog", "FOR n := 1 TO 60000 DO ; END_FOR", ir::TrapKind::kWatchdog},
    {"overrun", "FOR n := 1 TO 12000 DO ; END_FOR", ir::TrapKind::kOverrun},
    {"io lost", "n := n + 1;", ir::TrapKind::kIoLost},  // a device of T1, before each of its scans
    {"NaN", "level := SQRT(INT_TO_REAL(-1 + zero));", ir::TrapKind::kNotANumber},
};

// %QX0.0 and %QB1 are of the task that traps; %QX0.0 becomes TRUE, %QB1 stays, %QB2 stays for 20 ms
// and becomes 7, %QB3 has no safe value. %QB8 is of the other task.
std::string matrix_source(const Fault& fault, const char* policy) {
  const bool overrun = fault.kind == ir::TrapKind::kOverrun;
  return R"(
PROGRAM Bad VAR n, scans, zero : DINT; small : DINT(0..9); a : ARRAY[0..3] OF INT;
  nowhere : REF_TO DINT; lamp AT %QX0.0 : BOOL; kept AT %QB1 : BYTE; timed AT %QB2 : BYTE;
  none AT %QB3 : BYTE; level AT %QD1 : REAL; END_VAR
  lamp := FALSE; kept := 16#11; timed := 16#22; none := 16#33; level := 1.5;
  scans := scans + 1;
  IF scans >= 3 THEN lamp := FALSE; kept := 16#AA; timed := 16#AA; none := 16#AA;
)" + std::string(fault.statements) +
         R"(
  END_IF
END_PROGRAM
PROGRAM Good VAR n : DINT; q AT %QB8 : BYTE; END_VAR n := n + 1; q := 16#0F; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK T2 (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'on_trap' := ')" +
         policy + "'} {attribute 'watchdog' := 'T#50ms'} {attribute 'overrun' := '" +
         (overrun ? "fault" : "skip") + R"('}
  TASK T1 (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM B WITH T1 : Bad; PROGRAM G WITH T2 : Good;
END_RESOURCE END_CONFIGURATION
)";
}

const std::vector<ir::SafeOutput>& safe_rows() {
  static const std::vector<ir::SafeOutput> rows = {
      {0, 1, ir::SafeKind::kValue, 1, 0},
      {8, 8, ir::SafeKind::kHold, 0, 0},
      {16, 8, ir::SafeKind::kHoldThenValue, 7, 20 * kMs},
      {64, 8, ir::SafeKind::kValue, 0x80, 0},
  };
  return rows;
}

class FaultMatrix : public testing::TestWithParam<Fault> {
 protected:
  // Until something has trapped, in the cycle in which it has.
  static void run_into(Plant& plant) {
    for (int i = 0; i < 20 && plant->trap_count() == 0; ++i) cycles(plant, 1);
    ASSERT_EQ(plant->trap_count(), 1u);
    EXPECT_EQ(plant->traps()[0]->trap.kind, GetParam().kind);
  }
  static void cycles(Plant& plant, int count) {
    const auto& tasks = plant->verified().image().tasks;
    for (; count > 0; --count) {
      for (uint32_t i = 0; i < tasks.size(); ++i) {
        const bool its = GetParam().kind == ir::TrapKind::kIoLost && tasks[i].name == "T1";
        if (its && plant.task("T1").scans >= 2) plant.io.lose(i);
      }
      plant.cycles(1);
    }
  }
  static vm::ControllerOptions options() {
    vm::ControllerOptions options = small_slices();
    options.fuel_budget = GetParam().kind == ir::TrapKind::kFuel ? 40'000 : 10'000'000;
    return options;
  }
};

TEST_P(FaultMatrix, StopAll) {
  Plant plant(matrix_source(GetParam(), "stop_all"), options(), 1000, safe_rows());
  ASSERT_TRUE(plant.ok());
  run_into(plant);
  EXPECT_TRUE(plant->faulted());
  EXPECT_EQ(plant.io.output(0), 0x01);
  EXPECT_EQ(plant.io.output(1), 0x11);
  EXPECT_EQ(plant.io.output(2), 0x22);
  EXPECT_EQ(plant.io.output(3), 0x00);
  EXPECT_EQ(plant.io.output(8), 0x80);
  plant.clock.advance(19 * kMs);
  cycles(plant, 1);
  EXPECT_EQ(plant.io.output(2), 0x22);
  plant.clock.advance(2 * kMs);
  cycles(plant, 1);
  EXPECT_EQ(plant.io.output(2), 0x07);
  EXPECT_EQ(plant.io.output(1), 0x11);
}

TEST_P(FaultMatrix, StopTask) {
  Plant plant(matrix_source(GetParam(), "stop_task"), options(), 1000, safe_rows());
  ASSERT_TRUE(plant.ok());
  run_into(plant);
  EXPECT_FALSE(plant->faulted());
  EXPECT_TRUE(plant.task("T1").stopped);
  EXPECT_EQ(plant.task("T1").scans, 2u);
  EXPECT_EQ(plant.io.output(0), 0x01);
  EXPECT_EQ(plant.io.output(1), 0x11);
  EXPECT_EQ(plant.io.output(2), 0x22);
  EXPECT_EQ(plant.io.output(3), 0x00);
  EXPECT_EQ(plant.io.output(8), 0x0f);
  EXPECT_EQ(plant.get("B.lamp"), "TRUE");
  EXPECT_EQ(plant.get("B.kept"), "16#11");
  cycles(plant, 4);
  EXPECT_EQ(plant.io.output(0), 0x01);
  EXPECT_EQ(plant.io.output(2), 0x07);
  EXPECT_EQ(plant.io.output(8), 0x0f);
  EXPECT_GT(plant.task("T2").scans, 6u);
  EXPECT_EQ(plant.task("T2").missed, 0u);
}

TEST_P(FaultMatrix, GoOn) {
  Plant plant(matrix_source(GetParam(), "go_on"), options(), 1000, safe_rows());
  ASSERT_TRUE(plant.ok());
  run_into(plant);
  const auto unchanged = [&] {
    EXPECT_EQ(plant.io.output(0), 0x00);
    EXPECT_EQ(plant.io.output(1), 0x11);
    EXPECT_EQ(plant.io.output(2), 0x22);
    EXPECT_EQ(plant.io.output(3), 0x33);
    EXPECT_EQ(plant.io.output(8), 0x0f);
  };
  unchanged();
  EXPECT_FALSE(plant->faulted());
  EXPECT_FALSE(plant.task("T1").stopped);
  cycles(plant, 20);
  unchanged();
  EXPECT_GT(plant->trap_count(), 1u);
  EXPECT_EQ(plant.task("T1").scans, 2u);
}

INSTANTIATE_TEST_SUITE_P(EveryClass, FaultMatrix, testing::ValuesIn(kFaults),
                         [](const testing::TestParamInfo<Fault>& row) {
                           std::string name = row.param.name;
                           std::erase(name, ' ');
                           return name;
                         });

// The scan that is under way is done with what it has; the next one begins with the trap, once.
TEST(TaskPolicy, ALossTrapsTheNextScanAndOnlyThatOne) {
  Plant plant(too_long("{attribute 'on_trap' := 'go_on'}"), small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(2);  // 20 ms of 25
  uint32_t number = 0;
  while (plant->verified().image().tasks[number].name != "Long") ++number;
  plant.io.lose(number);
  plant.cycles(1);
  EXPECT_EQ(plant.task("Long").scans, 1u);
  EXPECT_EQ(plant->trap_count(), 0u);
  plant.cycles(1);
  ASSERT_EQ(plant->trap_count(), 1u);
  EXPECT_EQ(plant->traps()[0]->trap.kind, ir::TrapKind::kIoLost);
  EXPECT_EQ(plant->traps()[0]->task, "Long");
  EXPECT_EQ(plant->traps()[0]->text.pou, "Work");
  EXPECT_EQ(plant.get("W.n"), "1");
  plant.cycles(9);
  EXPECT_EQ(plant->trap_count(), 1u);
  EXPECT_EQ(plant.get("W.n"), "4");
}

// What was to be trapped is not known any more after a restart; a change keeps it for the task of
// that name.
TEST(TaskPolicy, ALossIsKeptThroughAChangeAndForgottenByARestart) {
  const std::string source = R"(
PROGRAM Count VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'on_trap' := 'go_on'} TASK Slow (INTERVAL := T#30ms, PRIORITY := 2);
  PROGRAM F WITH Fast : Count; PROGRAM S WITH Slow : Count;
END_RESOURCE END_CONFIGURATION
)";
  for (const bool restart : {false, true}) {
    SCOPED_TRACE(restart);
    Plant plant(source, small_slices(), 1000);
    ASSERT_TRUE(plant.ok());
    plant.cycles(1);
    uint32_t number = 0;
    while (plant->verified().image().tasks[number].name != "Slow") ++number;
    plant.io.lose(number);
    plant.cycles(1);
    std::unique_ptr<vm::Generation> before;
    if (restart) {
      ASSERT_TRUE(plant->restart(vm::Restart::kHot, kMs).ok());
    } else {
      auto next = plant->prepare(plant->verified());
      ASSERT_TRUE(next.ok());
      before = plant->publish(std::move(*next));
    }
    plant.cycles(6);
    EXPECT_EQ(plant->trap_count(), restart ? 0u : 1u);
  }
}

// --- what is whose -------------------------------------------------------------------------------

constexpr const char* kTwoTasks = R"(
  TASK T1 (INTERVAL := T#10ms, PRIORITY := 2);
  TASK T2 (INTERVAL := T#10ms, PRIORITY := 1);
  PROGRAM B WITH T1 : Bad; PROGRAM G WITH T2 : Good;
END_RESOURCE END_CONFIGURATION
)";

// A word of the globals, written by name with the value that it always had: all of it is safe, and
// the hold of the row that it shares with another task's bit does not touch that one.
TEST(SafeOutputs, WholeValuesOfTheStoppedTaskOnly) {
  const std::vector<ir::SafeOutput> rows = {
      {0, 16, ir::SafeKind::kHoldThenValue, 0, 20 * kMs},
      {16, 16, ir::SafeKind::kValue, 0x0102, 0},
  };
  Plant plant(R"(
VAR_GLOBAL mine AT %QX0.0 : BOOL; others AT %QX1.0 : BOOL; speed AT %QW1 : WORD := 16#1234; far AT %QW2 : WORD; END_VAR
PROGRAM Bad VAR n, zero : DINT; r : REF_TO WORD; END_VAR
  n := n + 1; mine := TRUE; speed := 16#1234; r := REF(far); r^ := 16#4321; IF n = 3 THEN n := n / zero; END_IF
END_PROGRAM
PROGRAM Good VAR n : DINT; END_VAR n := n + 1; others := TRUE; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu {attribute 'on_trap' := 'stop_task'}
)" + std::string(kTwoTasks),
              small_slices(), 1000, rows);
  ASSERT_TRUE(plant.ok());
  plant.cycles(3);
  ASSERT_TRUE(plant.task("T1").stopped);
  EXPECT_EQ(plant.io.output(0), 0x01);
  EXPECT_EQ(plant.io.output(1), 0x01);
  EXPECT_EQ(plant.io.output(2), 0x02);
  EXPECT_EQ(plant.io.output(3), 0x01);
  EXPECT_EQ(plant.io.output(4), 0x00);  // through the reference: learned
  EXPECT_EQ(plant.io.output(5), 0x00);
  plant.cycles(5);
  EXPECT_EQ(plant.io.output(0), 0x00);
  EXPECT_EQ(plant.io.output(1), 0x01);
  EXPECT_EQ(plant.get("mine"), "FALSE");
  EXPECT_EQ(plant.get("others"), "TRUE");
}

constexpr const char* kHeld = R"(
PROGRAM Bad VAR n, zero : DINT; q AT %QB0 : BYTE; END_VAR
  n := n + 1; q := 16#11; IF n = 3 THEN q := 16#AA; n := n / zero; END_IF
END_PROGRAM
PROGRAM Good VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
)";

// A hold runs on through a change and its undo.
TEST(SafeOutputs, HoldsSurviveChanges) {
  const std::vector<ir::SafeOutput> rows = {{0, 8, ir::SafeKind::kHoldThenValue, 7, 100 * kMs}};
  Plant plant(std::string(kHeld) + "{attribute 'on_trap' := 'stop_task'}" + kTwoTasks,
              small_slices(), 1000, rows);
  ASSERT_TRUE(plant.ok());
  plant.cycles(5);
  auto next = plant->prepare(plant->verified());
  ASSERT_TRUE(next.ok());
  auto old = plant->publish(std::move(*next));
  plant.cycles(3);
  EXPECT_EQ(plant.io.output(0), 0x11);
  plant->publish(std::move(old));
  plant.cycles(3);
  EXPECT_EQ(plant.io.output(0), 0x11);
  plant.cycles(5);
  EXPECT_EQ(plant.io.output(0), 0x07);
}

// What the scan that trapped had written is not sent behind a hot restart either.
TEST(SafeOutputs, HotRestartSendsNothingOfTheScanThatTrapped) {
  Plant plant(std::string(kHeld) + kTwoTasks, small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(3);
  ASSERT_TRUE(plant->faulted());
  EXPECT_EQ(plant.io.output(0), 0);
  ASSERT_TRUE(plant->restart(vm::Restart::kHot, kMs).ok());
  const uint64_t sends = plant.io.sends();
  plant.cycles(1);
  EXPECT_GT(plant.io.sends(), sends);
  EXPECT_EQ(plant.io.output(0), 0);
}

// At the end nobody is there when a hold is over.
TEST(SafeOutputs, AtTheEndHoldsTakeTheirValue) {
  const std::vector<ir::SafeOutput> rows = {{0, 8, ir::SafeKind::kHoldThenValue, 7, 100 * kMs},
                                            {8, 8, ir::SafeKind::kHold, 0, 0}};
  Plant plant(
      "PROGRAM P VAR a AT %QB0 : BYTE; b AT %QB1 : BYTE; c AT %QB2 : BYTE; END_VAR a := 1; b "
      ":= 2; c := 3; END_PROGRAM",
      {}, 0, rows);
  ASSERT_TRUE(plant.ok());
  plant.cycles(2);
  plant->make_outputs_safe();
  EXPECT_EQ(plant.io.output(0), 7);
  EXPECT_EQ(plant.io.output(1), 2);
  EXPECT_EQ(plant.io.output(2), 0);
}

}  // namespace
}  // namespace runtime_test
