// B5 in a controller: `output_buffer` of tasks, on virtual time.
#include "tests/unit/runtime/exchange_log.h"

namespace runtime_test {
namespace {

constexpr const char* kEveryOutputBuffer[] = {
    "copied", "locked", "swapped", "swapped_with_flag", "three", "first_unseen"};

// Hog takes 12 ms in its first scan, so Pulse, which is due every 10 ms and starts at once, has two
// scans between the exchanges at 10 and at 20 ms. `body` computes %QB0 of `n`, the number of the
// scan; half-way through it is 255.
std::string pulses(const std::string& attributes, const std::string& body = "q := INT_TO_BYTE(n);",
                   const std::string& schedule = "") {
  return R"(
PROGRAM Hog VAR n, i : DINT; END_VAR
  n := n + 1; IF n = 1 THEN FOR i := 1 TO 12000 DO ; END_FOR END_IF END_PROGRAM
PROGRAM Pulse VAR q AT %QB0 : BYTE; n, zero : INT; i : DINT; back : BYTE; torn : BOOL; END_VAR
  n := n + 1; torn := torn OR q <> back;
  q := 255; FOR i := 1 TO 100 DO ; END_FOR
  )" + body + R"( back := q; END_PROGRAM
CONFIGURATION c )" +
         schedule + R"( RESOURCE r ON cpu
  TASK High (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'overrun' := 'at_once'} )" +
         attributes + R"( TASK Low (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM H WITH High : Hog; PROGRAM P WITH Low : Pulse;
END_RESOURCE END_CONFIGURATION
)";
}
std::string buffer(const std::string& kind) {
  return "{attribute 'output_buffer' := '" + kind + "'} ";
}

constexpr const char* kPulseOfOneScan = "IF n = 1 THEN q := 1; ELSE q := 0; END_IF";

// The transmissions at 0, 10, 20 ms and so on; the scans end at 12 ms twice, then in each cycle.
TEST(OutputBuffer, B5_AllKindsButFirstUnseenSendTheNewest) {
  for (const char* kind : kEveryOutputBuffer) {
    SCOPED_TRACE(kind);
    ExchangePlant plant(pulses(buffer(kind)));
    ASSERT_TRUE(plant.ok());
    const bool first = std::string(kind) == "first_unseen";
    EXPECT_EQ(plant.cycles(6), first ? "0 out0  0 in1  10 out0  10 in2  20 out1  20 in3  30 out2  "
                                       "30 in4  40 out3  40 in5  "
                                     : "0 out0  0 in1  10 out0  10 in2  20 out2  20 in3  30 out3  "
                                       "30 in4  40 out4  40 in5  ");
    EXPECT_EQ(plant.get("P.torn"), "FALSE");
  }
}

// What the first of two scans has set and the second has taken back is sent, once.
TEST(OutputBuffer, B5_FirstUnseenSendsThePulseOfOneScan) {
  for (const char* kind : {"copied", "first_unseen"}) {
    ExchangePlant plant(pulses(buffer(kind), kPulseOfOneScan));
    ASSERT_TRUE(plant.ok());
    std::string pulse = plant.cycles(6);
    std::erase(pulse, ' ');
    const bool seen = pulse.find("20out1") != std::string::npos;
    EXPECT_EQ(seen, std::string(kind) == "first_unseen") << pulse;
    EXPECT_NE(pulse.find("30out0"), std::string::npos) << pulse;
  }
}

// Of a task that has no further scan, the newest outputs come behind the first ones by themselves:
// two edges in the first cycle, then none.
TEST(OutputBuffer, B5_FirstUnseenIsFollowedByTheNewest) {
  ExchangePlant plant(R"(
VAR_GLOBAL go : BOOL; END_VAR
PROGRAM Up VAR n : INT; END_VAR n := n + 1; IF n = 1 THEN go := TRUE; END_IF END_PROGRAM
PROGRAM Down VAR n : INT; END_VAR n := n + 1; IF n = 1 THEN go := FALSE; END_IF END_PROGRAM
PROGRAM Pulse VAR q AT %QB0 : BYTE; n : INT; END_VAR
  n := n + 1; IF n = 1 THEN q := 1; ELSE q := 0; END_IF END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK a (INTERVAL := T#10ms, PRIORITY := 1); TASK b (INTERVAL := T#10ms, PRIORITY := 2);
  TASK d (INTERVAL := T#10ms, PRIORITY := 3);
  {attribute 'overrun' := 'at_once'} {attribute 'output_buffer' := 'first_unseen'}
  TASK e (SINGLE := go, PRIORITY := 4);
  PROGRAM w WITH a : Up; PROGRAM x WITH b : Down; PROGRAM y WITH d : Up; PROGRAM z WITH e : Pulse;
END_RESOURCE END_CONFIGURATION
)");
  ASSERT_TRUE(plant.ok());
  EXPECT_EQ(plant.cycles(5),
            "0 out0  0 in1  10 out1  10 in2  20 out0  20 in3  30 out0  30 in4  ");
  EXPECT_EQ(plant.get("z.n"), "2");
}

// Sent in the cycle that has computed it, whichever buffer it is in.
TEST(OutputBuffer, B2_B5_WithAScheduleThatRunsFirst) {
  for (const char* kind : kEveryOutputBuffer) {
    SCOPED_TRACE(kind);
    std::string source =
        pulses(buffer(kind), "q := INT_TO_BYTE(n);", "{attribute 'schedule' := 'run_first'}");
    source.replace(source.find("12000"), 5, "5");
    ExchangePlant plant(source);
    ASSERT_TRUE(plant.ok());
    EXPECT_EQ(plant.cycles(3), "0 out0  0 in1  0 out1  10 out2  10 in2  20 out3  20 in3  ");
  }
}

// What is forced or set does not wait behind what a buffer has.
TEST(OutputBuffer, B5_ForcedAndSetOutputsDoNotWait) {
  for (const char* kind : kEveryOutputBuffer) {
    SCOPED_TRACE(kind);
    ExchangePlant forced(pulses(buffer(kind)));
    ASSERT_TRUE(forced.ok());
    (void)forced.cycles(3);
    ASSERT_TRUE(forced->force("P.q", "99").ok());
    EXPECT_EQ(forced.cycles(3), "20 out99  20 in3  30 out99  30 in4  40 out99  40 in5  ");
    ASSERT_TRUE(forced->unforce("P.q").ok());
    EXPECT_EQ(forced.cycles(3).substr(0, 8), "50 out99");
    EXPECT_EQ(forced.devices.sent[0], 7);

    ExchangePlant set(pulses(buffer(kind)));
    ASSERT_TRUE(set.ok());
    (void)set.cycles(3);
    ASSERT_TRUE(set->set("P.q", "77").ok());
    EXPECT_EQ(set.cycles(1), "20 out77  20 in3  ");
  }
}

// A scan that is given up leaves what the one before it has completed.
TEST(OutputBuffer, B5_AGivenUpScanSendsNothing) {
  for (const char* kind : kEveryOutputBuffer) {
    SCOPED_TRACE(kind);
    ExchangePlant plant(pulses(buffer(kind) + "{attribute 'on_trap' := 'go_on'}",
                               "q := INT_TO_BYTE(n); IF n = 2 THEN n := n / zero; END_IF"));
    ASSERT_TRUE(plant.ok());
    EXPECT_EQ(plant.cycles(6).substr(32), "20 out1  20 in3  30 out3  30 in4  40 out4  40 in5  ");
    EXPECT_EQ(plant->trap_count(), 1u);
  }
}

// What waits is gone when the task stops, and its outputs are safe at once.
TEST(OutputBuffer, B5_SafeOutputsDoNotWait) {
  const std::vector<ir::SafeOutput> rows = {{0, 8, ir::SafeKind::kValue, 55, 0}};
  for (const char* on_trap : {"stop_task", "stop_all"}) {
    for (const char* kind : kEveryOutputBuffer) {
      SCOPED_TRACE(std::string(kind) + on_trap);
      ExchangePlant plant(
          pulses(buffer(kind) + "{attribute 'on_trap' := '" + std::string(on_trap) + "'}",
                 "q := INT_TO_BYTE(n); IF n = 2 THEN n := n / zero; END_IF"),
          rows);
      ASSERT_TRUE(plant.ok());
      EXPECT_EQ(plant.cycles(3).substr(32), "12 out55  ");
      (void)plant.cycles(3);
      EXPECT_EQ(plant.devices.sent[0], 55);
      ASSERT_TRUE(plant->restart(vm::Restart::kHot, kMs).ok());
      (void)plant.cycles(2);
      EXPECT_EQ(plant.devices.sent[0], 3);
    }
  }
}

// A change between the end of the scans and their transmission, to itself and to every other kind.
TEST(OutputBuffer, B5_WhatWaitsIsSentThroughAChange) {
  for (const char* from : kEveryOutputBuffer) {
    for (const char* to : kEveryOutputBuffer) {
      SCOPED_TRACE(std::string(from) + " " + to);
      ExchangePlant plant(pulses(buffer(from)));
      ASSERT_TRUE(plant.ok());
      (void)plant.cycles(3);
      auto old = plant.change(pulses(buffer(to)));
      ASSERT_TRUE(old);
      const bool first = std::string(from) == "first_unseen" && std::string(to) == from;
      EXPECT_EQ(plant.cycles(1), first ? "20 out1  20 in3  " : "20 out2  20 in3  ");
      plant->publish(std::move(old));  // undo
      EXPECT_EQ(plant.cycles(1), first ? "30 out2  30 in4  " : "30 out3  30 in4  ");
      EXPECT_EQ(plant.cycles(1), first ? "40 out3  40 in5  " : "40 out4  40 in5  ");
    }
  }
}

// Which buffer is with whom, and from when until when there is something new.
TEST(OutputBuffer, B5_B11_StatesOfTheBuffers) {
  for (const char* kind : kEveryOutputBuffer) {
    SCOPED_TRACE(kind);
    ExchangePlant plant(pulses(buffer(kind)));
    ASSERT_TRUE(plant.ok());
    const vm::BufferState before = plant.activity(1).outputs;
    const std::string name = kind;
    const auto number = static_cast<size_t>(before.kind);
    EXPECT_EQ(kEveryOutputBuffer[number], name);
    EXPECT_FALSE(before.fresh);
    (void)plant.cycles(3);
    const vm::BufferState complete = plant.activity(1).outputs;
    EXPECT_TRUE(complete.fresh);
    EXPECT_FALSE(complete.locked);
    (void)plant.cycles(1);  // one transmission and one scan
    const vm::BufferState next = plant.activity(1).outputs;
    EXPECT_EQ(before.waiting != vm::BufferState::kNone, name == "three");
    EXPECT_EQ(before.writer == before.reader, name == "locked");
    const bool moves = name != "copied" && name != "locked";
    EXPECT_EQ(next.writer != complete.writer, moves);
    EXPECT_EQ(next.reader != complete.reader, moves);
  }
}

}  // namespace
}  // namespace runtime_test
