// B4 to B6 on virtual time: which inputs a scan sees, and when its outputs are sent. The devices
// give the number of the cycle as their input, counted from 1, so an output that copies its input
// says how old it is. A round of a loop takes a microsecond.
#include <map>
#include <set>

#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

class CountingDevices : public vm::IoPort {
 public:
  void receive(std::span<uint8_t> inputs) override { inputs[0] = ++cycle; }
  void send(std::span<const uint8_t> outputs) override {
    const bool changed = sent.empty() || sent.back().second != outputs[0];
    if (changed) sent.push_back({cycle + 1, outputs[0]});
  }
  uint8_t cycle = 0;
  std::vector<std::pair<int, int>> sent;  // cycle, and what %QB0 became
};

// Every millisecond a cycle. Fast takes 0.2, 1.7 and 0.8 ms in turn, so Slow, which is due every
// 6 ms and takes 1.5 ms, starts and ends earlier and later.
std::string plant(const std::string& attributes) {
  return R"(
PROGRAM FastWork VAR i, n, rounds : DINT; END_VAR
  n := n + 1;
  CASE n MOD 5 OF 0: rounds := 200; 1: rounds := 1700; ELSE rounds := 800; END_CASE
  FOR i := 1 TO rounds DO ; END_FOR
END_PROGRAM
PROGRAM SlowWork
  VAR inp AT %IB0 : BYTE; outp AT %QB0 : BYTE; first : BYTE; torn, i, n : DINT; END_VAR
  first := inp;
  outp := 16#FF;
  FOR i := 1 TO 1500 DO ; END_FOR
  outp := inp;
  IF first <> inp THEN torn := torn + 1; END_IF
  n := n + 1;
END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := T#2ms, PRIORITY := 0);
  TASK Beat (INTERVAL := T#1ms, PRIORITY := 3);
)" + attributes +
         R"(
  TASK Slow (INTERVAL := T#6ms, PRIORITY := 1);
  PROGRAM F WITH Fast : FastWork;
  PROGRAM S WITH Slow : SlowWork;
END_RESOURCE END_CONFIGURATION
)";
}

constexpr const char* kEveryBuffer[] = {
    "copied", "locked", "swapped", "swapped_with_flag", "three", "first_unseen"};

struct Seen {
  std::vector<std::pair<int, int>> sent;
  std::string torn;
  uint64_t missed = 0;
  // From the cycle of the input to the one in which its output is sent, with how often it was so.
  std::map<int, int> latencies() const {
    std::map<int, int> rows;
    for (const auto& [cycle, value] : sent) {
      if (value != 0) ++rows[cycle - value];
    }
    return rows;
  }
};

Seen run(const std::string& attributes, int cycles = 200) {
  Seen seen;
  auto image = build(plant(attributes));
  if (!image) return seen;
  vm::VirtualClock clock(1000);
  CountingDevices devices;
  vm::ControllerOptions options;
  options.fuel_slice = 50;
  auto controller = vm::Controller::start(*image, options, clock, devices);
  if (!controller.ok()) {
    ADD_FAILURE() << base::to_string(controller.error());
    return seen;
  }
  devices.sent.clear();
  for (int i = 0; i < cycles; ++i) (*controller)->cycle();
  seen.sent = devices.sent;
  seen.torn = *(*controller)->get("S.torn");
  seen.missed = (*controller)->tasks()[2].missed;
  return seen;
}

// The other mode: sent as soon as it is done, with what came in when it started.
TEST(IoTiming, B6_NewestModeVaries) {
  const Seen seen = run("");
  EXPECT_EQ(seen.torn, "0");
  EXPECT_EQ(seen.missed, 0u);
  EXPECT_GT(seen.sent.size(), 30u);
  EXPECT_GT(seen.latencies().size(), 1u);
  for (const auto& [latency, count] : seen.latencies()) EXPECT_LT(latency, 6);
}

// Inputs of the first cycle of the period, outputs in the first cycle of the next one, however late
// it starts and early it ends: six cycles, always.
TEST(IoTiming, B6_CycleSynchronousModeHasOneLatency) {
  const Seen seen = run("{attribute 'io' := 'synchronous'}");
  EXPECT_EQ(seen.torn, "0");
  EXPECT_EQ(seen.missed, 0u);
  EXPECT_GT(seen.sent.size(), 30u);
  const std::map<int, int> latencies = seen.latencies();
  ASSERT_EQ(latencies.size(), 1u);
  EXPECT_EQ(latencies.begin()->first, 6);
}

TEST(IoTiming, B6_SynchronousWithEveryBuffer) {
  for (const char* buffer : kEveryBuffer) {
    SCOPED_TRACE(buffer);
    const Seen seen = run("{attribute 'io' := 'synchronous'} {attribute 'input_buffer' := '" +
                          std::string(buffer) + "'}");
    EXPECT_EQ(seen.torn, "0");
    ASSERT_EQ(seen.latencies().size(), 1u);
    EXPECT_EQ(seen.latencies().begin()->first, 6);
  }
}

// All but first_unseen give the inputs of the cycle in which the scan starts.
TEST(IoTiming, B3_B4_EveryStrategyKeepsAScanApart) {
  const Seen copied = run("");
  for (const char* buffer : {"locked", "swapped", "swapped_with_flag", "three"}) {
    SCOPED_TRACE(buffer);
    const Seen seen = run("{attribute 'input_buffer' := '" + std::string(buffer) + "'}");
    EXPECT_EQ(seen.torn, "0");
    EXPECT_EQ(seen.sent, copied.sent);
  }
}

// With every kind for outputs: one latency, and what is half done is never sent, however often the
// scan is suspended. One scan ends between two exchanges, so all kinds send the same.
TEST(IoTiming, B5_B6_EveryOutputBuffer) {
  const Seen copied = run("");
  for (const char* buffer : kEveryBuffer) {
    SCOPED_TRACE(buffer);
    const std::string attribute = "{attribute 'output_buffer' := '" + std::string(buffer) + "'} ";
    const Seen newest = run(attribute);
    EXPECT_EQ(newest.sent, copied.sent);
    EXPECT_EQ(newest.torn, "0");
    const Seen synchronous = run(attribute + "{attribute 'io' := 'synchronous'}");
    ASSERT_EQ(synchronous.latencies().size(), 1u);
    EXPECT_EQ(synchronous.latencies().begin()->first, 6);
    for (const auto& [cycle, value] : synchronous.sent) EXPECT_NE(value, 0xff) << cycle;
  }
}

// A scan sees the first inputs that came after the start of the one before: a pulse of one cycle
// is not lost because others follow it.
TEST(IoTiming, B4_FirstUnseenKeepsTheFirst) {
  const Seen newest = run("");
  const Seen first = run("{attribute 'input_buffer' := 'first_unseen'}");
  EXPECT_EQ(first.torn, "0");
  ASSERT_GT(first.sent.size(), 5u);
  ASSERT_EQ(first.sent.size(), newest.sent.size());
  EXPECT_EQ(first.sent[0], newest.sent[0]);
  for (size_t i = 1; i < first.sent.size(); ++i) {
    EXPECT_EQ(first.sent[i].first, newest.sent[i].first);
    EXPECT_EQ(first.sent[i].second, newest.sent[i - 1].second + 1);
  }
}

// B5: what Slow writes half-way (16#FF) is never sent, though Beat ends meanwhile, and it reads
// back what it wrote.
TEST(IoTiming, B5_OutputsAreSentWhole) {
  for (const char* io : {"newest", "synchronous"}) {
    const Seen seen = run("{attribute 'io' := '" + std::string(io) + "'}", 100);
    EXPECT_GT(seen.sent.size(), 10u);
    for (const auto& [cycle, value] : seen.sent) EXPECT_NE(value, 0xff) << "cycle " << cycle;
  }
  Plant reads_back(
      "PROGRAM P VAR q AT %QW0 : UINT; seen : UINT; END_VAR q := q + 1; seen := q; "
      "END_PROGRAM CONFIGURATION c RESOURCE r ON cpu {attribute 'io' := 'synchronous'} "
      "TASK t (INTERVAL := T#10ms, PRIORITY := 1); PROGRAM p WITH t : P; END_RESOURCE "
      "END_CONFIGURATION");
  ASSERT_TRUE(reads_back.ok());
  reads_back.cycles(5);
  EXPECT_EQ(reads_back.get("p.seen"), "5");
  EXPECT_EQ(reads_back.io.output(0), 4);  // of the period before
}

// A change keeps what waits, and its latency with it.
TEST(IoTiming, B6_OutputsWaitThroughAChange) {
  auto image = build(plant("{attribute 'io' := 'synchronous'}"));
  ASSERT_TRUE(image);
  vm::VirtualClock clock(1000);
  CountingDevices devices;
  vm::ControllerOptions options;
  options.fuel_slice = 50;
  auto controller = vm::Controller::start(*image, options, clock, devices);
  ASSERT_TRUE(controller.ok());
  devices.sent.clear();
  uint64_t changes = 0;
  for (int i = 0; i < 200; ++i) {
    (*controller)->cycle();
    if (!(*controller)->at_boundary()) continue;
    auto next = (*controller)->prepare(*image);
    ASSERT_TRUE(next.ok());
    (*controller)->publish(std::move(*next));
    ++changes;
  }
  EXPECT_GT(changes, 50u);
  ASSERT_GT(devices.sent.size(), 30u);
  for (const auto& [cycle, value] : devices.sent) {
    if (value == 0) continue;
    EXPECT_EQ(cycle - value, 6) << "cycle " << cycle;
  }
}

constexpr const char* kSlowCopy = R"(
PROGRAM P VAR i AT %IB0 : BYTE; q AT %QB0 : BYTE; END_VAR q := i; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Beat (INTERVAL := T#10ms, PRIORITY := 1);
  ATTRIBUTES TASK Slow (INTERVAL := T#100ms, PRIORITY := 2);
  PROGRAM p WITH Slow : P;
END_RESOURCE END_CONFIGURATION
)";
std::string slow_copy(const std::string& attributes) {
  std::string source = kSlowCopy;
  return source.replace(source.find("ATTRIBUTES"), 10, attributes);
}

// A forced output is what it is forced to in the next cycle, whatever waits.
TEST(IoTiming, ForcedOutputsDoNotWait) {
  Plant plant(slow_copy("{attribute 'io' := 'synchronous'}"));
  ASSERT_TRUE(plant.ok());
  plant.io.set_input(0, 5);
  plant.cycles(3);
  EXPECT_EQ(plant.io.output(0), 0);
  ASSERT_TRUE(plant->force("p.q", "9").ok());
  for (int i = 0; i < 30; ++i) {
    plant.cycles(1);
    ASSERT_EQ(plant.io.output(0), 9) << i;
  }
}

// Tables that rested during a trial have seen old inputs; after undo and restart no scan does.
TEST(IoTiming, UndoAndRestartForgetOldInputs) {
  for (const char* buffer : kEveryBuffer) {
    SCOPED_TRACE(buffer);
    Plant plant(slow_copy("{attribute 'input_buffer' := '" + std::string(buffer) + "'}"));
    ASSERT_TRUE(plant.ok());
    plant.io.set_input(0, 1);
    plant.cycles(5);
    auto next = build(slow_copy("{attribute 'input_buffer' := 'copied'}"), &plant->image());
    ASSERT_TRUE(next);
    auto generation = plant->prepare(*next);
    ASSERT_TRUE(generation.ok());
    auto old = plant->publish(std::move(*generation));
    plant.io.set_input(0, 2);
    plant.cycles(30);
    EXPECT_EQ(plant.io.output(0), 2);
    plant->publish(std::move(old));
    plant.cycles(12);
    EXPECT_EQ(plant.io.output(0), 2);
    plant.io.set_input(0, 3);
    ASSERT_TRUE(plant->restart(vm::Restart::kHot, kMs).ok());
    plant.cycles(12);
    EXPECT_EQ(plant.io.output(0), 3);
  }
}

}  // namespace
}  // namespace runtime_test
