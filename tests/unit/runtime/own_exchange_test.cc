// B12: tasks that exchange by themselves inside a control cycle, on virtual time.
#include "tests/unit/runtime/exchange_log.h"

namespace runtime_test {
namespace {

constexpr const char* kOwn = "{attribute 'exchange' := 'own'} ";

// In each cycle of 10 ms Work takes 2 ms first; then Twice copies %IB0 to %QB0, which takes 3 ms;
// then Last copies it to %QB1. Over, the least urgent, lasts over several cycles.
std::string three_tasks(const std::string& of_twice, const std::string& schedule = "",
                        const std::string& body = "") {
  return R"(
PROGRAM Work VAR i : DINT; END_VAR FOR i := 1 TO 2000 DO ; END_FOR END_PROGRAM
PROGRAM Copy
  VAR a AT %IB0 : BYTE; q AT %QB0 : BYTE; i, n, zero : DINT; torn : BOOL; first : BYTE; END_VAR
  first := a; n := n + 1; q := 255; FOR i := 1 TO 3000 DO ; END_FOR
  torn := torn OR first <> a; q := a; )" +
         body + R"( END_PROGRAM
PROGRAM Copy2 VAR a AT %IB0 : BYTE; q AT %QB1 : BYTE; END_VAR q := a; END_PROGRAM
PROGRAM Long VAR a AT %IB0 : BYTE; q AT %QB2 : BYTE; i : DINT; torn : BOOL; first : BYTE; END_VAR
  first := a; q := 255; FOR i := 1 TO 12000 DO torn := torn OR first <> a; END_FOR q := a;
END_PROGRAM
CONFIGURATION c )" +
         schedule + R"( RESOURCE r ON cpu
  TASK High (INTERVAL := T#10ms, PRIORITY := 1);
  )" + of_twice +
         R"( TASK Twice (INTERVAL := T#10ms, PRIORITY := 2);
  TASK Last (INTERVAL := T#10ms, PRIORITY := 3);
  TASK Over (INTERVAL := T#40ms, PRIORITY := 4);
  PROGRAM W WITH High : Work; PROGRAM T WITH Twice : Copy; PROGRAM L WITH Last : Copy2;
  PROGRAM O WITH Over : Long;
END_RESOURCE END_CONFIGURATION
)";
}

// Received when the scan starts, at 2 ms, and sent when it ends, at 5 ms. The outputs of others are
// sent with the next cycle as before, and their inputs are those of the cycle.
TEST(OwnExchange, B12_AReceptionAndATransmissionWithEachScan) {
  ExchangePlant usual(three_tasks(""));
  ExchangePlant own(three_tasks(kOwn));
  ASSERT_TRUE(usual.ok() && own.ok());
  EXPECT_EQ(usual.cycles(3),
            "0 out0.0.0  0 in1  10 out1.1.0  10 in2  20 out2.2.0  20 in3  ");
  EXPECT_EQ(own.cycles(1), "0 out0.0.0  0 in1  2 in2  5 out2.0.0  ");
  EXPECT_EQ(own.cycles(1), "10 out2.1.0  10 in3  12 in4  15 out4.1.0  ");
  EXPECT_EQ(own.cycles(1), "20 out4.3.0  20 in5  22 in6  25 out6.3.0  ");
  EXPECT_EQ(own.cycles(2), "30 out6.5.1  30 in7  32 in8  35 out8.5.1  "
                           "40 out8.7.1  40 in9  42 in10  45 out10.7.1  ");
  EXPECT_EQ(own.get("T.torn"), "FALSE");
  EXPECT_EQ(own.get("O.torn"), "FALSE");  // it was suspended while Twice received
}

// What a more urgent task has completed in the same cycle is not sent with it.
TEST(OwnExchange, B12_OutputsOfOthersWaitForTheCycle) {
  ExchangePlant own(R"(
PROGRAM Count VAR q AT %QB1 : BYTE; END_VAR q := q + 1; END_PROGRAM
PROGRAM Copy VAR a AT %IB0 : BYTE; q AT %QB0 : BYTE; END_VAR q := a; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK High (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'exchange' := 'own'} TASK Twice (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM h WITH High : Count; PROGRAM t WITH Twice : Copy;
END_RESOURCE END_CONFIGURATION
)");
  ASSERT_TRUE(own.ok());
  EXPECT_EQ(own.cycles(2),
            "0 out0.0  0 in1  0 in2  0 out2.0  10 out2.1  10 in3  10 in4  10 out4.1  ");
}

TEST(OwnExchange, B4_B5_B12_WithEveryBuffer) {
  for (const char* kind : {"copied", "locked", "swapped", "swapped_with_flag", "three"}) {
    SCOPED_TRACE(kind);
    const std::string buffers = "{attribute 'input_buffer' := '" + std::string(kind) +
                                "'} {attribute 'output_buffer' := '" + kind + "'} ";
    ExchangePlant own(three_tasks(kOwn + buffers));
    ASSERT_TRUE(own.ok());
    EXPECT_EQ(own.cycles(2), "0 out0.0.0  0 in1  2 in2  5 out2.0.0  "
                             "10 out2.1.0  10 in3  12 in4  15 out4.1.0  ");
    EXPECT_EQ(own.get("T.torn"), "FALSE");
    EXPECT_FALSE(own.activity(1).outputs.fresh);  // it has gone out
  }
}

TEST(OwnExchange, B2_B12_WithAScheduleThatRunsFirst) {
  ExchangePlant own(three_tasks(kOwn, "{attribute 'schedule' := 'run_first'}"));
  ASSERT_TRUE(own.ok());
  // Over is due in the first cycle, and its exchange waits for that.
  EXPECT_EQ(own.cycles(2), "0 out0.0.0  0 in1  2 in2  5 out2.0.0  10 out2.1.0  "
                           "12 in3  15 out3.1.0  15 out3.1.0  15 in4  ");
}

TEST(OwnExchange, B12_ForcesHoldInBoth) {
  ExchangePlant own(three_tasks(kOwn));
  ASSERT_TRUE(own.ok());
  (void)own.cycles(3);
  ASSERT_TRUE(own->force("T.a", "77").ok());
  EXPECT_EQ(own.cycles(1), "30 out6.5.1  30 in7  32 in8  35 out77.5.1  ");
  ASSERT_TRUE(own->unforce("T.a").ok());
  ASSERT_TRUE(own->force("T.q", "99").ok());
  ASSERT_TRUE(own->force("O.q", "44").ok());
  // L has the same input, and saw the force (case 75).
  EXPECT_EQ(own.cycles(1), "40 out99.77.44  40 in9  42 in10  45 out99.77.44  ");
}

// A loss that its own reception finds ends the scan that it was for.
TEST(OwnExchange, B12_ALostDeviceTrapsTheScan) {
  ExchangePlant own(three_tasks(std::string(kOwn) + "{attribute 'on_trap' := 'go_on'}"));
  ASSERT_TRUE(own.ok());
  own.devices.lost_in = 4;
  own.devices.lost_task = 1;
  (void)own.cycles(1);
  EXPECT_EQ(own.cycles(1), "10 out2.1.0  10 in3  12 in4  ");
  EXPECT_EQ(own->trap_count(), 1u);
  EXPECT_EQ(own->traps()[0]->trap.kind, ir::TrapKind::kIoLost);
  EXPECT_EQ(own.cycles(1), "20 out2.3.1  20 in5  22 in6  25 out6.3.1  ");
}

// Nothing of a scan that traps is sent; where the task stops, its outputs are safe in that instant.
TEST(OwnExchange, B12_Traps) {
  const std::vector<ir::SafeOutput> rows = {{0, 8, ir::SafeKind::kValue, 55, 0}};
  const std::string trap = "IF n = 2 THEN n := n / zero; END_IF";
  const auto policy = [](const char* on_trap) {
    return kOwn + ("{attribute 'on_trap' := '" + std::string(on_trap) + "'}");
  };
  ExchangePlant go_on(three_tasks(policy("go_on"), "", trap), rows);
  ExchangePlant stops(three_tasks(policy("stop_task"), "", trap), rows);
  ExchangePlant all(three_tasks(policy("stop_all"), "", trap), rows);
  ASSERT_TRUE(go_on.ok() && stops.ok() && all.ok());
  EXPECT_EQ(go_on.cycles(3), "0 out0.0.0  0 in1  2 in2  5 out2.0.0  10 out2.1.0  10 in3  12 in4  "
                             "20 out2.3.0  20 in5  22 in6  25 out6.3.0  ");
  EXPECT_EQ(stops.cycles(3), "0 out0.0.0  0 in1  2 in2  5 out2.0.0  10 out2.1.0  10 in3  12 in4  "
                             "15 out55.1.0  20 out55.3.0  20 in5  ");
  EXPECT_EQ(all.cycles(3),
            "0 out0.0.0  0 in1  2 in2  5 out2.0.0  10 out2.1.0  10 in3  12 in4  15 out55.0.0  ");
  ASSERT_TRUE(stops->restart(vm::Restart::kHot, kMs).ok());
  EXPECT_EQ(stops.cycles(1).substr(0, 11), "30 out55.5.");
}

// To and fro by online changes, with the next scan; nobody misses a release.
TEST(OwnExchange, B12_ChangesOfTheAttribute) {
  ExchangePlant plant(three_tasks(""));
  ASSERT_TRUE(plant.ok());
  EXPECT_EQ(plant.cycles(2), "0 out0.0.0  0 in1  10 out1.1.0  10 in2  ");
  while (!plant->at_boundary()) (void)plant.cycles(1);
  (void)plant.cycles(1);
  const int before = plant.devices.received;
  const int64_t at_ms = plant->next_cycle_ns() / kMs;
  const auto at = [](int64_t ms) { return std::to_string(ms) + " "; };
  ASSERT_TRUE(plant->at_boundary());
  auto old = plant.change(three_tasks(kOwn));
  ASSERT_TRUE(old);
  std::string text = plant.cycles(1);
  EXPECT_EQ(plant.devices.received, before + 2) << text;
  EXPECT_NE(text.find(at(at_ms + 2) + "in" + std::to_string(before + 2)), std::string::npos)
      << text;
  EXPECT_NE(text.find(at(at_ms + 5) + "out" + std::to_string(before + 2)), std::string::npos)
      << text;
  while (!plant->at_boundary()) (void)plant.cycles(1);
  plant->publish(std::move(old));  // undo
  const int then = plant.devices.received;
  (void)plant.cycles(1);
  EXPECT_EQ(plant.devices.received, then + 1);
  EXPECT_EQ(plant->missed_releases(), 0u);
}

// An event task exchanges whenever it is released.
TEST(OwnExchange, B12_OfAnEventTask) {
  ExchangePlant plant(R"(
VAR_GLOBAL go : BOOL; END_VAR
PROGRAM Beat VAR i : DINT; END_VAR FOR i := 1 TO 1000 DO ; END_FOR go := NOT go; END_PROGRAM
PROGRAM Copy VAR a AT %IB0 : BYTE; q AT %QB0 : BYTE; END_VAR q := a; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK b (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'exchange' := 'own'} TASK e (SINGLE := go, PRIORITY := 2);
  PROGRAM p WITH b : Beat; PROGRAM q WITH e : Copy;
END_RESOURCE END_CONFIGURATION
)");
  ASSERT_TRUE(plant.ok());
  EXPECT_EQ(plant.cycles(3), "0 out0  0 in1  1 in2  1 out2  10 out2  10 in3  20 out2  20 in4  "
                             "21 in5  21 out5  ");
}

}  // namespace
}  // namespace runtime_test
