// B2: a resource that runs first and exchanges then, on virtual time.
#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

// Gives the number of its receptions as the input and notes all that is exchanged.
class Log : public vm::IoPort {
 public:
  explicit Log(vm::Clock& clock) : clock_(clock) {}
  void receive(std::span<uint8_t> inputs) override {
    if (!inputs.empty()) inputs[0] = ++given;
    if (inputs.size() > 1) inputs[1] = second;
    text += "in" + std::to_string(given) + " ";
  }
  void send(std::span<const uint8_t> outputs) override {
    sent = outputs.empty() ? 0 : outputs[0];
    sent_ns = clock_.now_ns();
    text += "out" + std::to_string(sent) + " ";
  }
  void lost_tasks(std::span<uint8_t> tasks) override {
    if (lose) tasks[0] = 1;
    lose = false;
  }
  std::string text;
  uint8_t given = 0;
  uint8_t second = 0;
  int sent = 0;
  int64_t sent_ns = 0;
  bool lose = false;

 private:
  vm::Clock& clock_;
};

class Logged {
 public:
  explicit Logged(const std::string& source, const std::vector<ir::SafeOutput>& safe = {}) {
    auto image = build(source, nullptr, safe);
    if (!image) return;
    vm::ControllerOptions options;
    options.fuel_slice = 20;
    auto started = vm::Controller::start(*image, options, clock, devices);
    EXPECT_TRUE(started.ok());
    if (started.ok()) controller = std::move(*started);
    devices.text.clear();
  }
  vm::Controller* operator->() { return controller.get(); }
  // What is exchanged in so many cycles.
  std::string cycles(int count) {
    devices.text.clear();
    for (int i = 0; i < count; ++i) {
      controller->cycle();
      devices.text += "| ";
    }
    return devices.text;
  }
  std::string get(const std::string& path) const { return *controller->get(path); }
  void change(const std::string& source) {
    auto next = build(source, &controller->image());
    ASSERT_TRUE(next);
    auto generation = controller->prepare(*next);
    ASSERT_TRUE(generation.ok());
    controller->publish(std::move(*generation));
  }

  vm::VirtualClock clock{1000};
  Log devices{clock};
  std::unique_ptr<vm::Controller> controller;
};

constexpr const char* kRunFirst = "{attribute 'schedule' := 'run_first'}";

std::string copies(const std::string& schedule, const std::string& attributes = "",
                   const std::string& more = "") {
  return R"(
PROGRAM Copy VAR inp AT %IB0 : BYTE; outp AT %QB0 : BYTE; n : DINT; END_VAR
  outp := inp; n := n + 1; END_PROGRAM
PROGRAM Work VAR i, n : DINT; END_VAR FOR i := 1 TO 25000 DO ; END_FOR n := n + 1; END_PROGRAM
CONFIGURATION c )" +
         schedule + " RESOURCE r ON cpu\n" + attributes +
         " TASK t (INTERVAL := T#10ms, PRIORITY := 1); PROGRAM p WITH t : Copy;\n" + more +
         " END_RESOURCE END_CONFIGURATION\n";
}

// Sent in the cycle that has computed it, before anything is received. The first cycle has nothing
// of a cycle before, so it receives before it runs.
TEST(Schedule, B2_RunFirstSendsInTheSameCycle) {
  Logged first(copies(kRunFirst));
  Logged usual(copies(""));
  Logged said(copies("{attribute 'schedule' := 'send_first'}"));
  ASSERT_TRUE(first.controller && usual.controller && said.controller);
  const std::string sends = "out0 in1 | out1 in2 | out2 in3 | out3 in4 | ";
  EXPECT_EQ(usual.cycles(4), sends);
  EXPECT_EQ(said.cycles(4), sends);
  EXPECT_EQ(first.cycles(4), "out0 in1 out1 | out1 in2 | out2 in3 | out3 in4 | ");
  EXPECT_EQ(first.get("p.n"), "4");
}

// In front of the CONFIGURATION for all of its resources, if they say nothing else.
TEST(Schedule, B2_InFrontOfTheConfiguration) {
  auto plain = build(
      "PROGRAM P VAR n : INT; END_VAR n := 1; END_PROGRAM {attribute 'Schedule' := 'RUN_FIRST'} "
      "CONFIGURATION c TASK t (INTERVAL := T#10ms); PROGRAM p WITH t : P; END_CONFIGURATION");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->image().schedule, ir::Schedule::kRunFirst);
  auto other = build(
      "PROGRAM P VAR n : INT; END_VAR n := 1; END_PROGRAM {attribute 'schedule' := 'run_first'} "
      "CONFIGURATION c {attribute 'schedule' := 'send_first'} RESOURCE r ON cpu "
      "TASK t (INTERVAL := T#10ms); PROGRAM p WITH t : P; END_RESOURCE END_CONFIGURATION");
  ASSERT_TRUE(other);
  EXPECT_EQ(other->image().schedule, ir::Schedule::kSendFirst);
}

// What is due is waited for, also in the cycles over which it lasts; a scan that has begun before
// and a freewheeling one go on after the exchange.
TEST(Schedule, B2_TheExchangeWaitsForWhatIsDue) {
  Logged free(
      copies(kRunFirst, "",
             "{attribute 'freewheeling'} TASK f (PRIORITY := 9); PROGRAM w WITH f : Work;"));
  ASSERT_TRUE(free.controller);
  EXPECT_EQ(free.cycles(1), "out0 in1 out1 | ");  // Work begins
  EXPECT_NEAR(static_cast<double>(free.devices.sent_ns), 0, 0.1e6);
  EXPECT_EQ(free.cycles(1), "out1 in2 | ");
  EXPECT_FALSE(free->at_boundary());
  EXPECT_NEAR(static_cast<double>(free.devices.sent_ns), 10e6, 0.1e6);
  EXPECT_NEAR(static_cast<double>(free.clock.now_ns()), 20e6, 0.1e6);

  // Slow begins in the first cycle and in the fifth, in which its end is waited for as long as the
  // cycle lasts. In the others Copy alone is due.
  Logged slow(copies(kRunFirst, "",
                     "TASK s (INTERVAL := T#40ms, PRIORITY := 5); PROGRAM w WITH s : Work;"));
  ASSERT_TRUE(slow.controller);
  const double when_ms[] = {10, 10, 20, 30, 50};
  std::string exchanged;
  for (const double ms : when_ms) {
    exchanged += slow.cycles(1);
    EXPECT_NEAR(static_cast<double>(slow.devices.sent_ns), ms * 1e6, 0.1e6);
  }
  EXPECT_EQ(exchanged, "out0 in1 out1 | out1 in2 | out2 in3 | out3 in4 | out4 in5 | ");
  EXPECT_EQ(slow.get("w.n"), "1");
  EXPECT_EQ(slow->missed_releases(), 0u);
}

// The output of a scan of several cycles goes out with the exchange of the cycle behind its end, as
// a whole.
TEST(Schedule, B2_B5_ASuspendedScanSendsNothingHalf) {
  Logged slow(R"(
PROGRAM Slow VAR inp AT %IB0 : BYTE; outp AT %QB0 : BYTE; i : DINT; END_VAR
  outp := 16#FF; FOR i := 1 TO 15000 DO ; END_FOR outp := inp; END_PROGRAM
PROGRAM Beat VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c {attribute 'schedule' := 'run_first'} RESOURCE r ON cpu
  TASK b (INTERVAL := T#10ms, PRIORITY := 1); TASK s (INTERVAL := T#40ms, PRIORITY := 2);
  PROGRAM q WITH b : Beat; PROGRAM p WITH s : Slow;
END_RESOURCE END_CONFIGURATION
)");
  ASSERT_TRUE(slow.controller);
  EXPECT_EQ(slow.cycles(4), "out0 in1 out0 | out0 in2 | out1 in3 | out1 in4 | ");
  EXPECT_EQ(slow.cycles(4), "out1 in5 | out1 in6 | out4 in7 | out4 in8 | ");
}

// Inputs as they were when the period began, outputs with the first exchange of the next one.
TEST(Schedule, B2_B6_SynchronousHasOneLatency) {
  Logged logged(copies(kRunFirst, "{attribute 'io' := 'synchronous'}",
                       "TASK b (INTERVAL := T#5ms, PRIORITY := 0);"));
  ASSERT_TRUE(logged.controller);
  EXPECT_EQ(logged.cycles(8),
            "out0 in1 out0 | out0 in2 | out1 in3 | out1 in4 | out2 in5 | out2 in6 | out4 in7 | "
            "out4 in8 | ");
}

// What is forced is sent by the exchange of its cycle, and read by the scan.
TEST(Schedule, B2_ForcesHoldInTheirCycle) {
  Logged logged(copies(kRunFirst));
  ASSERT_TRUE(logged.controller);
  (void)logged.cycles(2);
  ASSERT_TRUE(logged->force("p.outp", "99").ok());
  EXPECT_EQ(logged.cycles(2), "out99 in3 | out99 in4 | ");
  ASSERT_TRUE(logged->unforce("p.outp").ok());
  ASSERT_TRUE(logged->force("p.inp", "77").ok());
  EXPECT_EQ(logged.cycles(2), "out77 in5 | out77 in6 | ");
  ASSERT_TRUE(logged->unforce("p.inp").ok());
  EXPECT_EQ(logged.cycles(1), "out6 in7 | ");
}

// Outputs are safe in the cycle of the trap, whether one task stops or all; after a restart
// nothing runs with inputs of before.
TEST(Schedule, B2_SafeOutputsInTheCycleOfTheTrap) {
  const std::vector<ir::SafeOutput> rows = {{0, 8, ir::SafeKind::kValue, 55, 0}};
  for (const char* on_trap : {"stop_task", "stop_all"}) {
    SCOPED_TRACE(on_trap);
    std::string source =
        copies(kRunFirst, "{attribute 'on_trap' := '" + std::string(on_trap) + "'}",
               "TASK b (INTERVAL := T#10ms, PRIORITY := 7);");
    source.insert(source.find("n := n + 1;"), "IF n = 3 THEN n := 4; n := 1 / (n - 4); END_IF ");
    Logged logged(source, rows);
    ASSERT_TRUE(logged.controller);
    EXPECT_EQ(logged.cycles(3), "out0 in1 out1 | out1 in2 | out2 in3 | ");
    (void)logged.cycles(1);
    EXPECT_EQ(logged->trap_count(), 1u);
    EXPECT_EQ(logged.devices.sent, 55);
    const bool all = std::string(on_trap) == "stop_all";
    EXPECT_EQ(logged->faulted(), all);
    EXPECT_EQ(logged.devices.given, all ? 3 : 4);
    (void)logged.cycles(2);
    EXPECT_EQ(logged.devices.sent, 55);
    logged.devices.given = 100;
    ASSERT_TRUE(logged->restart(vm::Restart::kHot, kMs).ok());
    EXPECT_EQ(logged.cycles(2), "out55 in101 out101 | out101 in102 | ");
  }
}

// A lost device traps the next scan.
TEST(Schedule, B2_ALossIsSeenByTheNextScan) {
  Logged logged(copies(kRunFirst, "{attribute 'on_trap' := 'go_on'}"));
  ASSERT_TRUE(logged.controller);
  (void)logged.cycles(2);
  logged.devices.lose = true;
  (void)logged.cycles(1);
  EXPECT_EQ(logged->trap_count(), 0u);
  EXPECT_EQ(logged.cycles(2), "out2 in4 | out4 in5 | ");
  EXPECT_EQ(logged->trap_count(), 1u);
}

// The edge that the exchange of a cycle has brought is seen when the next one begins.
TEST(Schedule, B2_EventsFromInputs) {
  Logged logged(R"(
PROGRAM Copy VAR inp AT %IB0 : BYTE; outp AT %QB0 : BYTE; END_VAR outp := inp; END_PROGRAM
CONFIGURATION c {attribute 'schedule' := 'run_first'} RESOURCE r ON cpu
  TASK b (INTERVAL := T#10ms, PRIORITY := 3);
  TASK e (SINGLE := %IX0.1, PRIORITY := 1); PROGRAM p WITH e : Copy;
END_RESOURCE END_CONFIGURATION
)");
  ASSERT_TRUE(logged.controller);
  EXPECT_EQ(logged.cycles(8),
            "out0 in1 out0 | out0 in2 | out2 in3 | out2 in4 | out2 in5 | out2 in6 | out6 in7 | "
            "out6 in8 | ");
}

// To and fro by online changes: nothing that was computed is left unsent, and what is new reads
// inputs that were received for it.
TEST(Schedule, B2_AChangeOfTheScheduleTakesEffectWithTheNextCycle) {
  Logged logged(copies(""));
  ASSERT_TRUE(logged.controller);
  EXPECT_EQ(logged.cycles(2), "out0 in1 | out1 in2 | ");
  logged.change(copies(kRunFirst));
  EXPECT_EQ(logged.cycles(3), "out2 in3 out3 | out3 in4 | out4 in5 | ");
  logged.change(copies(kRunFirst));
  EXPECT_EQ(logged.cycles(2), "out4 in6 out6 | out6 in7 | ");
  logged.change(copies(""));
  EXPECT_EQ(logged.cycles(2), "out6 in8 | out8 in9 | ");
  EXPECT_EQ(logged->missed_releases(), 0u);
}

// A change in the middle of a cycle, where a late task starts again at once: what the new version
// reads is received before any scan of it, by whichever schedule.
TEST(Schedule, B2_B7_AChangeInAPauseReceivesForTheNewVersion) {
  const auto source = [](const std::string& schedule, const std::string& input) {
    return R"(
PROGRAM Slow VAR inp AT %)" + input +
           R"( : BYTE; outp AT %QB0 : BYTE; i, n, rounds : DINT; END_VAR
  outp := inp; n := n + 1; IF n = 1 THEN rounds := 12000; ELSE rounds := 3000; END_IF
  FOR i := 1 TO rounds DO ; END_FOR END_PROGRAM
CONFIGURATION c )" +
           schedule + R"( RESOURCE r ON cpu
  {attribute 'overrun' := 'at_once'} TASK s (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM p WITH s : Slow;
END_RESOURCE END_CONFIGURATION
)";
  };
  for (const char* schedule : {"", kRunFirst}) {
    SCOPED_TRACE(schedule);
    Logged logged(source(schedule, "IB0"));
    ASSERT_TRUE(logged.controller);
    (void)logged.cycles(2);
    ASSERT_TRUE(logged->at_boundary());
    ASSERT_LT(logged.clock.now_ns(), 20 * kMs);
    const int before = logged.devices.given;
    logged.change(source(schedule, "IB1"));  // nothing was received there
    logged.devices.second = 77;
    EXPECT_EQ(logged.cycles(1).substr(0, 4), "in" + std::to_string(before + 1) + " ");
    EXPECT_EQ(logged.get("p.n"), "2");
    EXPECT_EQ(logged.get("p.outp"), "16#4D");
    (void)logged.cycles(1);
    EXPECT_EQ(logged.devices.sent, 77);
  }
}

// A start at once in the middle of a cycle is due like any other; a lengthened cycle exchanges when
// it is over.
TEST(Schedule, B2_B7_OverrunsWhenTheTasksRunFirst) {
  const auto source = [](const char* overrun) {
    return R"(
PROGRAM Slow VAR inp AT %IB0 : BYTE; outp AT %QB0 : BYTE; i, n, rounds : DINT; END_VAR
  outp := inp; n := n + 1; IF n = 1 THEN rounds := 12000; ELSE rounds := 3000; END_IF
  FOR i := 1 TO rounds DO ; END_FOR END_PROGRAM
CONFIGURATION c {attribute 'schedule' := 'run_first'} RESOURCE r ON cpu
  {attribute 'overrun' := ')" +
           std::string(overrun) + R"('} TASK s (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM p WITH s : Slow;
END_RESOURCE END_CONFIGURATION
)";
  };
  Logged at_once(source("at_once"));
  ASSERT_TRUE(at_once.controller);
  // The first scan goes on after the exchange of its second cycle, and the next one starts at
  // 12 ms with what that has brought.
  EXPECT_EQ(at_once.cycles(2), "out0 in1 out0 | out0 in2 | ");
  EXPECT_TRUE(at_once->at_boundary());
  EXPECT_EQ(at_once.cycles(1), "| ");
  EXPECT_EQ(at_once.get("p.n"), "2");
  EXPECT_EQ(at_once.get("p.outp"), "16#02");
  EXPECT_EQ(at_once.cycles(2), "out2 in3 | out3 in4 | ");

  Logged lengthen(source("lengthen"));
  ASSERT_TRUE(lengthen.controller);
  EXPECT_EQ(lengthen.cycles(3), "out0 in1 out1 | out1 in2 | out2 in3 | ");
  EXPECT_NEAR(static_cast<double>(lengthen.devices.sent_ns), 25e6, 0.1e6);
}

}  // namespace
}  // namespace runtime_test
