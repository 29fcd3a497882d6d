// B7: what starts at once when it was late, and control cycles that are lengthened, on virtual
// time: a round of a loop takes a microsecond.
#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

// The number of the exchange is the input, from 1 on; when each was.
class TimedDevices : public vm::IoPort {
 public:
  explicit TimedDevices(vm::Clock& clock) : clock_(clock) {}
  void receive(std::span<uint8_t> inputs) override {
    received_us.push_back(clock_.now_ns() / 1000);
    if (!inputs.empty()) inputs[0] = static_cast<uint8_t>(received_us.size());
  }
  void send(std::span<const uint8_t> outputs) override {
    sent.push_back(outputs.empty() ? 0 : outputs[0]);
  }
  std::vector<int64_t> received_us;
  std::vector<int> sent;

 private:
  vm::Clock& clock_;
};

class Timed {
 public:
  explicit Timed(const std::string& source, uint64_t fuel_slice = 20) {
    auto image = build(source);
    if (!image) return;
    vm::ControllerOptions options;
    options.fuel_slice = fuel_slice;
    auto started = vm::Controller::start(*image, options, clock, devices);
    EXPECT_TRUE(started.ok());
    if (started.ok()) controller = std::move(*started);
  }
  vm::Controller* operator->() { return controller.get(); }
  void run_until(int64_t ms) {
    while (clock.now_ns() < ms * kMs && !controller->faulted()) controller->cycle();
  }
  vm::TaskStatus task(const std::string& name) const {
    for (const vm::TaskStatus& row : controller->tasks()) {
      if (row.name == name) return row;
    }
    ADD_FAILURE() << "no task " << name;
    return {};
  }
  std::string get(const std::string& path) const { return *controller->get(path); }
  // What the other version is when a change has brought it.
  std::unique_ptr<vm::Generation> change(const std::string& source) {
    auto next = build(source, &controller->image());
    if (!next) return nullptr;
    auto generation = controller->prepare(*next);
    EXPECT_TRUE(generation.ok());
    return generation.ok() ? controller->publish(std::move(*generation)) : nullptr;
  }
  // When the exchanges were, to a tenth of a millisecond.
  std::vector<double> exchanges() const {
    std::vector<double> rows;
    for (const int64_t us : devices.received_us) {
      rows.push_back(static_cast<double>((us + 50) / 100) / 10);
    }
    return rows;
  }

  vm::VirtualClock clock{1000};
  TimedDevices devices{clock};
  std::unique_ptr<vm::Controller> controller;
};

// Long works for so many microseconds, in its later scans for others; it notes which input it has
// started with. Other is more urgent and has nothing to do, Free has always something.
std::string plant(const std::string& attributes, int first_us, int later_us,
                  const std::string& parameters = "INTERVAL := T#10ms") {
  return R"(
PROGRAM Work
  VAR inp AT %IB0 : BYTE; outp AT %QB0 : BYTE; n, i, rounds : DINT; torn : BOOL; first : BYTE;
    starts : STRING[80]; END_VAR
  n := n + 1;
  first := inp;
  starts := CONCAT(starts, CONCAT(UINT_TO_STRING(BYTE_TO_UINT(inp)), ' '));
  IF n = 1 THEN rounds := )" +
         std::to_string(first_us) + "; ELSE rounds := " + std::to_string(later_us) + R"(; END_IF
  outp := 16#FF;
  FOR i := 1 TO rounds DO ; END_FOR
  torn := torn OR first <> inp;
  outp := first;
END_PROGRAM
PROGRAM Count VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
PROGRAM Endless VAR i, n : DINT; END_VAR FOR i := 1 TO 70000 DO ; END_FOR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  )" + attributes +
         " TASK Long (" + parameters + R"(, PRIORITY := 2);
  TASK Other (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'freewheeling'} TASK Free (PRIORITY := 9);
  PROGRAM W WITH Long : Work; PROGRAM O WITH Other : Count; PROGRAM E WITH Free : Endless;
END_RESOURCE END_CONFIGURATION
)";
}
// That, and nothing to do when they have ended.
std::string without_free(std::string source) {
  for (const char* part : {"{attribute 'freewheeling'}", "PROGRAM E WITH"}) {
    const size_t begin = source.find(part);
    source.erase(begin, source.find(';', begin) + 1 - begin);
  }
  return source;
}
std::string overrun(const std::string& policy, const std::string& more = "") {
  return "{attribute 'overrun' := '" + policy + "'} " + more;
}

// Releases at 0, 10, 20 ms and so on. The scans are from 0 to 24.9, to 49.8, to 74.7, to 99.6 ms;
// skipped releases would leave them beginning at 0, 30, 60 and 90 ms.
TEST(Overrun, B7_AtOnceStartsWhenTheLateScanEnds) {
  Timed at_once(plant(overrun("at_once"), 24'900, 24'900));
  Timed skip(plant(overrun("skip"), 24'900, 24'900));
  ASSERT_TRUE(at_once.controller && skip.controller);
  at_once.run_until(100);
  skip.run_until(100);
  EXPECT_EQ(skip.task("Long").scans, 3u);
  EXPECT_EQ(at_once.task("Long").scans, 4u);
  EXPECT_EQ(at_once.get("W.n"), "5");
  // Ten releases: five have begun, the others came while one waited already.
  EXPECT_EQ(at_once.task("Long").missed, 5u);
  EXPECT_EQ(at_once.task("Long").overruns, 9u);
  EXPECT_EQ(at_once.task("Other").scans, 10u);
  EXPECT_EQ(at_once.task("Other").missed, 0u);
  EXPECT_EQ(at_once.get("W.torn"), "FALSE");
  // From the release at 50 ms to 74.7 ms.
  EXPECT_NEAR(static_cast<double>(at_once.task("Long").delay.max), 24.7e6, 0.2e6);
}

TEST(Overrun, B4_B7_AtOnceStartsWithTheNewestInputs) {
  for (const char* buffer : {"copied", "locked", "swapped", "swapped_with_flag", "three"}) {
    SCOPED_TRACE(buffer);
    Timed timed(plant(overrun("at_once", "{attribute 'input_buffer' := '" + std::string(buffer) +
                                             "'}"),
                      24'900, 24'900));
    ASSERT_TRUE(timed.controller);
    timed.run_until(100);
    EXPECT_EQ(timed.get("W.starts"), "'1 3 5 8 10 '");
    EXPECT_EQ(timed.get("W.torn"), "FALSE");
  }
  Timed first(plant(overrun("at_once", "{attribute 'input_buffer' := 'first_unseen'}"), 24'900,
                    24'900));
  ASSERT_TRUE(first.controller);
  first.run_until(100);
  EXPECT_EQ(first.get("W.starts"), "'1 2 4 6 9 '");
}

// The release at 10 ms finds that the scan of the one at 0 has not even begun: both scans are in
// the second cycle, and nothing has come between their starts.
TEST(Overrun, B4_B7_TwoStartsInOneCycleSeeTheSame) {
  for (const char* buffer : {"copied", "locked", "swapped", "swapped_with_flag", "three"}) {
    SCOPED_TRACE(buffer);
    Timed timed(R"(
PROGRAM Hog VAR n, i : DINT; END_VAR
  n := n + 1; IF n = 1 THEN FOR i := 1 TO 12000 DO ; END_FOR END_IF END_PROGRAM
PROGRAM Note VAR inp AT %IB0 : BYTE; starts : STRING[80]; END_VAR
  starts := CONCAT(starts, CONCAT(UINT_TO_STRING(BYTE_TO_UINT(inp)), ' ')); END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK High (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'overrun' := 'at_once'} {attribute 'input_buffer' := ')" +
                std::string(buffer) + R"('} TASK Low (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM H WITH High : Hog; PROGRAM N WITH Low : Note;
END_RESOURCE END_CONFIGURATION
)");
    ASSERT_TRUE(timed.controller);
    while (timed.get("N.starts") == "''") timed->cycle();
    EXPECT_EQ(timed.devices.received_us.size(), 2u);
    EXPECT_EQ(timed->next_cycle_ns(), timed.clock.now_ns());  // the second start comes at once
    timed->cycle();
    EXPECT_EQ(timed.devices.received_us.size(), 2u);
    EXPECT_EQ(timed.get("N.starts"), "'2 2 '");
    EXPECT_EQ(timed->next_cycle_ns(), 20 * kMs);
    timed->cycle();
    EXPECT_EQ(timed.get("N.starts"), "'2 2 3 '");
    EXPECT_EQ(timed.task("Low").missed, 0u);
    EXPECT_EQ(timed.task("Low").overruns, 1u);
  }
}

// A task that is late each time has the processor always; commands and changes come between two of
// its scans. No idle time is given away there.
TEST(Overrun, B7_AtOnceLeavesABoundaryBetweenTwoScans) {
  Timed timed(without_free(plant(overrun("at_once"), 24'900, 24'900)));
  ASSERT_TRUE(timed.controller);
  int boundaries = 0;
  uint64_t cycles = 0;
  for (int i = 0; i < 100; ++i) {
    timed->cycle();
    EXPECT_EQ(timed->cycles(), ++cycles);  // each time it can be told from the last one
    if (!timed->at_boundary()) continue;
    ++boundaries;
    EXPECT_LE(timed->next_cycle_ns(), timed.clock.now_ns());
    timed->run_idle([] {
      ADD_FAILURE() << "idle time while a start waits";
      return false;
    });
  }
  EXPECT_EQ(static_cast<uint64_t>(boundaries), timed.task("Long").scans);
  EXPECT_GT(boundaries, 25);
}

// The next version has the start that waits, and its policy from then on.
TEST(Overrun, B7_AStartAtOnceWaitsThroughAChange) {
  Timed timed(plant(overrun("at_once"), 24'900, 24'900));
  ASSERT_TRUE(timed.controller);
  while (timed.task("Long").scans == 0) timed->cycle();
  ASSERT_TRUE(timed->at_boundary());
  ASSERT_TRUE(timed.change(plant(overrun("skip"), 24'900, 24'900)));
  timed->cycle();
  EXPECT_EQ(timed.get("W.n"), "2");
  EXPECT_NEAR(static_cast<double>(timed.clock.now_ns()), 30e6, 0.1e6);
  timed.run_until(100);
  // To 49.8; 50 to 74.9; 80 to 104.9 ms.
  EXPECT_EQ(timed.get("W.n"), "4");
  EXPECT_EQ(timed.task("Other").missed, 0u);
}

// High lasts until its two first cycles are over, so Low is late before it has begun, and the
// boundary behind them can bring a change. The start at once that it is owed comes with the same
// policy; with another one it is a release without a scan. A restart forgets it.
TEST(Overrun, B7_ATaskThatIsLateBeforeItBeginsAtABoundary) {
  const auto source = [](const std::string& policy) {
    return R"(
PROGRAM Hog VAR n, i : DINT; END_VAR
  n := n + 1; IF n <= 2 THEN FOR i := 1 TO 10000 DO ; END_FOR END_IF END_PROGRAM
PROGRAM Count VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK High (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'overrun' := ')" +
           policy + R"('} TASK Low (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM H WITH High : Hog; PROGRAM N WITH Low : Count;
END_RESOURCE END_CONFIGURATION
)";
  };
  for (const char* next : {"at_once", "skip", ""}) {
    SCOPED_TRACE(next);
    Timed timed(source("at_once"), 30);
    ASSERT_TRUE(timed.controller);
    timed->cycle();
    timed->cycle();
    ASSERT_TRUE(timed->at_boundary());
    EXPECT_EQ(timed.task("Low").overruns, 1u);
    EXPECT_EQ(timed.get("N.n"), "0");
    const std::string policy = next;
    if (policy.empty()) {
      ASSERT_TRUE(timed->restart(vm::Restart::kHot, kMs).ok());
    } else {
      ASSERT_TRUE(timed.change(source(policy)));
    }
    timed.run_until(40);
    // Releases at 0, 10, 20, 30 and 40 ms; after the restart, the last three.
    const vm::TaskStatus low = timed.task("Low");
    EXPECT_EQ(low.missed, policy == "at_once" ? 1u : policy == "skip" ? 2u : 0u);
    EXPECT_EQ(low.scans, policy == "at_once" ? 4u : 3u);
  }
}

// From 30 ms on, with the next release.
TEST(Overrun, B7_AtOnceComesWithAChange) {
  Timed timed(without_free(plant(overrun("skip"), 24'900, 24'900)));
  ASSERT_TRUE(timed.controller);
  while (timed.task("Long").scans == 0) timed->cycle();
  ASSERT_TRUE(timed.change(without_free(plant(overrun("at_once"), 24'900, 24'900))));
  timed.run_until(100);
  EXPECT_EQ(timed.get("W.starts"), "'1 4 6 8 '");  // at 0, 30, 54.9, 79.8 ms
  EXPECT_EQ(timed.task("Other").missed, 0u);
}

// A restart forgets it: every task runs again in its phase.
TEST(Overrun, B7_ARestartForgetsTheStartThatWaits) {
  Timed timed(plant(overrun("at_once"), 24'900, 1'000));
  ASSERT_TRUE(timed.controller);
  while (timed.task("Long").scans == 0) timed->cycle();
  ASSERT_TRUE(timed->restart(vm::Restart::kHot, kMs).ok());
  EXPECT_EQ(timed->next_cycle_ns(), 30 * kMs);
  timed->cycle();
  EXPECT_EQ(timed.get("W.starts"), "'1 4 '");
}

// Above a scan that is suspended it starts at once too, in the cycle in which it ends.
TEST(Overrun, B7_AtOnceByEventsAboveASuspendedScan) {
  vm::ControllerOptions options;
  options.fuel_slice = 100;
  Plant plant(R"(
PROGRAM Work VAR n, i : DINT; END_VAR n := n + 1; FOR i := 1 TO 24900 DO ; END_FOR END_PROGRAM
PROGRAM Lower VAR n, i : DINT; END_VAR FOR i := 1 TO 29800 DO ; END_FOR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  {attribute 'overrun' := 'at_once'} TASK Edge (SINGLE := %IX0.0, PRIORITY := 1);
  TASK Low (INTERVAL := T#100ms, PRIORITY := 2);
  TASK Beat (INTERVAL := T#10ms, PRIORITY := 3);
  PROGRAM W WITH Edge : Work; PROGRAM L WITH Low : Lower;
END_RESOURCE END_CONFIGURATION
)",
              options, 1000);
  ASSERT_TRUE(plant.ok());
  const auto cycles = [&](std::initializer_list<uint8_t> levels) {
    for (const uint8_t level : levels) {
      plant.io.set_input(0, level);
      plant.cycles(1);
    }
  };
  cycles({0, 1, 0, 1});  // to 40 ms; it has begun at 10 ms, and an edge came at 30 ms
  EXPECT_EQ(plant.get("W.n"), "2");
  EXPECT_EQ(plant.task("Edge").scans, 1u);
  EXPECT_EQ(plant.get("L.n"), "0");
  EXPECT_FALSE(plant->at_boundary());
  cycles({0, 0, 0, 0});  // it ends at 60 ms, Low at 80 ms
  EXPECT_EQ(plant.task("Edge").scans, 2u);
  EXPECT_EQ(plant.task("Edge").overruns, 1u);
  EXPECT_EQ(plant.task("Edge").missed, 0u);
  EXPECT_EQ(plant.get("L.n"), "1");
}

// Twice in one cycle too: there is no boundary in between that would end the first of them.
TEST(Overrun, B7_TwoStartsInOneCycleAboveASuspendedScan) {
  Timed timed(R"(
PROGRAM Hog VAR n, i : DINT; END_VAR
  n := n + 1; IF n = 2 THEN FOR i := 1 TO 12000 DO ; END_FOR END_IF END_PROGRAM
PROGRAM Count VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
PROGRAM Endless VAR i, n : DINT; END_VAR FOR i := 1 TO 70000 DO ; END_FOR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK High (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'overrun' := 'at_once'} TASK Low (INTERVAL := T#10ms, PRIORITY := 2);
  {attribute 'freewheeling'} TASK Free (PRIORITY := 9);
  PROGRAM H WITH High : Hog; PROGRAM N WITH Low : Count; PROGRAM E WITH Free : Endless;
END_RESOURCE END_CONFIGURATION
)");
  ASSERT_TRUE(timed.controller);
  for (const char* n : {"1", "1", "3", "4"}) {
    timed->cycle();
    EXPECT_EQ(timed.get("N.n"), n);
    EXPECT_FALSE(timed->at_boundary());
  }
  EXPECT_EQ(timed.task("Low").missed, 0u);
}

// A scan that is given up has ended; a task that is stopped has no start more.
TEST(Overrun, B7_AtOnceBehindATrap) {
  for (const char* on_trap : {"go_on", "stop_task"}) {
    SCOPED_TRACE(on_trap);
    std::string source = plant(
        overrun("at_once", "{attribute 'on_trap' := '" + std::string(on_trap) + "'}"), 24'900, 10);
    source.insert(source.find("torn := torn"), "IF n = 1 THEN i := 1 / (n - 1); END_IF ");
    Timed timed(source);
    ASSERT_TRUE(timed.controller);
    timed.run_until(40);
    const bool goes_on = std::string(on_trap) == "go_on";
    EXPECT_EQ(timed->trap_count(), 1u);
    EXPECT_EQ(timed.task("Long").stopped, !goes_on);
    EXPECT_EQ(timed.get("W.starts"), goes_on ? "'1 3 4 '" : "'1 '");
  }
}

// Each scan of Long lasts for 24.9 ms, so each cycle does: exchanges wait, so does Other, and no
// task misses a release.
TEST(Overrun, B7_LengthenLetsTheCycleLastUntilTheScanHasEnded) {
  Timed timed(plant(overrun("lengthen"), 24'900, 24'900));
  ASSERT_TRUE(timed.controller);
  timed.run_until(99);
  EXPECT_EQ(timed.exchanges(), (std::vector<double>{0, 24.9, 49.8, 74.7}));
  EXPECT_EQ(timed.get("W.starts"), "'1 2 3 4 '");
  EXPECT_EQ(timed.get("W.torn"), "FALSE");
  EXPECT_EQ(timed.task("Long").scans, 4u);
  EXPECT_EQ(timed.task("Long").overruns, 4u);
  EXPECT_EQ(timed.task("Long").missed, 0u);
  EXPECT_EQ(timed.task("Other").scans, 4u);
  EXPECT_EQ(timed.task("Other").missed, 0u);
  EXPECT_EQ(timed.task("Other").overruns, 0u);
  EXPECT_NEAR(static_cast<double>(timed.task("Long").delay.max), 0, 0.1e6);
}

// The cycles behind it have their length again, and begin where it has ended.
TEST(Overrun, B7_CyclesBehindALengthenedOneAreAsBefore) {
  Timed timed(plant(overrun("lengthen"), 24'900, 1'000));
  ASSERT_TRUE(timed.controller);
  for (int i = 0; i < 5; ++i) timed->cycle();
  EXPECT_EQ(timed.exchanges(), (std::vector<double>{0, 24.9, 34.9, 44.9, 54.9}));
  EXPECT_EQ(timed.task("Long").overruns, 1u);
  EXPECT_EQ(timed.task("Long").missed, 0u);
}

// Only the cycle behind which it is due again waits for it; in those before it is suspended as
// always. A less urgent scan that is suspended is not waited for.
TEST(Overrun, B7_OnlyTheCycleBeforeTheNextReleaseIsLengthened) {
  Timed in_time(plant(overrun("lengthen"), 24'900, 24'900, "INTERVAL := T#30ms"));
  ASSERT_TRUE(in_time.controller);
  for (int i = 0; i < 7; ++i) in_time->cycle();
  EXPECT_EQ(in_time.exchanges(), (std::vector<double>{0, 10, 20, 30, 40, 50, 60}));
  EXPECT_EQ(in_time.task("Long").overruns, 0u);

  Timed late(plant(overrun("lengthen"), 34'900, 1'000, "INTERVAL := T#30ms"));
  ASSERT_TRUE(late.controller);
  for (int i = 0; i < 7; ++i) late->cycle();
  EXPECT_EQ(late.exchanges(), (std::vector<double>{0, 10, 20, 34.9, 44.9, 54.9, 64.9}));
  EXPECT_EQ(late.get("W.starts"), "'1 4 7 '");
  EXPECT_EQ(late.task("Long").overruns, 1u);
  EXPECT_EQ(late.task("Other").scans, 7u);
  EXPECT_FALSE(late->at_boundary());  // Free is suspended
}

// What keeps it from beginning is waited for as well.
TEST(Overrun, B7_LengthenForATaskThatCouldNotEvenBegin) {
  Timed timed(R"(
PROGRAM Hog VAR n, i : DINT; END_VAR
  n := n + 1; IF n = 1 THEN FOR i := 1 TO 12000 DO ; END_FOR END_IF END_PROGRAM
PROGRAM Work VAR n, i : DINT; END_VAR n := n + 1; FOR i := 1 TO 3000 DO ; END_FOR END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK High (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'overrun' := 'lengthen'} TASK Low (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM H WITH High : Hog; PROGRAM W WITH Low : Work;
END_RESOURCE END_CONFIGURATION
)");
  ASSERT_TRUE(timed.controller);
  for (int i = 0; i < 3; ++i) timed->cycle();
  EXPECT_EQ(timed.exchanges(), (std::vector<double>{0, 15, 25}));
  EXPECT_EQ(timed.get("W.n"), "3");
  EXPECT_EQ(timed.task("Low").missed, 0u);
  EXPECT_EQ(timed.task("High").missed, 0u);
}

// The watchdog of the scan ends the cycle with it.
TEST(Overrun, B7_AWatchdogEndsALengthenedCycle) {
  for (const char* on_trap : {"go_on", "stop_all"}) {
    SCOPED_TRACE(on_trap);
    Timed timed(plant(overrun("lengthen", "{attribute 'watchdog' := 'T#40ms'} {attribute 'on_trap' "
                                          ":= '" +
                                              std::string(on_trap) + "'}"),
                      90'000, 1'000));
    ASSERT_TRUE(timed.controller);
    timed->cycle();
    EXPECT_EQ(timed->trap_count(), 1u);
    EXPECT_EQ(timed->traps()[0]->trap.kind, ir::TrapKind::kWatchdog);
    EXPECT_EQ(timed.devices.sent.back(), 0);
    timed->cycle();
    const bool goes_on = std::string(on_trap) == "go_on";
    EXPECT_EQ(timed->faulted(), !goes_on);
    EXPECT_EQ(timed.exchanges().size(), goes_on ? 2u : 1u);
    if (goes_on) {
      EXPECT_NEAR(timed.exchanges()[1], 40, 0.2);
    }
  }
}

// Inputs of the first cycle of its period, outputs in the first cycle of the next: one latency in
// cycles, however long these are.
TEST(Overrun, B6_B7_LengthenKeepsTheLatencyInCycles) {
  Timed timed(plant(overrun("lengthen", "{attribute 'io' := 'synchronous'}"), 24'900, 24'900));
  ASSERT_TRUE(timed.controller);
  for (int i = 0; i < 6; ++i) timed->cycle();
  EXPECT_EQ(timed.devices.sent, (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

// Behind a lengthened cycle a change finds a plan of cycles like any other, and its policy holds
// from there on.
TEST(Overrun, B7_ChangesBehindLengthenedCycles) {
  const std::string source = without_free(plant(overrun("lengthen"), 24'900, 24'900));
  Timed timed(source);
  ASSERT_TRUE(timed.controller);
  for (int i = 0; i < 3; ++i) {
    timed->cycle();
    ASSERT_TRUE(timed->at_boundary());
    ASSERT_TRUE(timed.change(source));
  }
  EXPECT_EQ(timed.exchanges(), (std::vector<double>{0, 24.9, 49.8}));
  EXPECT_EQ(timed.task("Long").missed, 0u);
  EXPECT_EQ(timed.task("Other").missed, 0u);
  std::string skip = source;
  skip.replace(skip.find("'lengthen'"), 10, "'skip'");
  ASSERT_TRUE(timed.change(skip));
  for (int i = 0; i < 3; ++i) timed->cycle();
  EXPECT_EQ(timed.exchanges(), (std::vector<double>{0, 24.9, 49.8, 74.7, 84.7, 94.7}));
  EXPECT_EQ(timed.task("Long").missed, 2u);
}

// A task without a period that is declared first measures the cycles too: it moves with the others,
// or the first change would find another base period.
TEST(Overrun, B7_LengthenedCyclesMoveTasksWithoutAPeriod) {
  for (const char* first : {"{attribute 'freewheeling'} TASK First (PRIORITY := 9);",
                            "TASK First (SINGLE := go, PRIORITY := 9);"}) {
    const std::string source =
        "VAR_GLOBAL go : BOOL; END_VAR PROGRAM P VAR n : DINT; END_VAR n := n + 1; END_PROGRAM "
        "PROGRAM L VAR i : DINT; END_VAR FOR i := 1 TO 24900 DO ; END_FOR END_PROGRAM "
        "CONFIGURATION c RESOURCE r ON cpu " +
        std::string(first) +
        " {attribute 'overrun' := 'lengthen'} TASK Long (INTERVAL := T#10ms, PRIORITY := 1); "
        "PROGRAM p WITH First : P; PROGRAM l WITH Long : L; END_RESOURCE END_CONFIGURATION";
    Timed timed(source);
    ASSERT_TRUE(timed.controller);
    for (int i = 0; i < 3; ++i) {
      do {
        timed->cycle();
      } while (!timed->at_boundary());
      ASSERT_TRUE(timed.change(source));
      EXPECT_EQ(timed->base_period_ns(), 10 * kMs) << first;
    }
  }
}

}  // namespace
}  // namespace runtime_test
