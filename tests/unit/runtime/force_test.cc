// Forces while a controller runs: what they hold, and when.
#include <functional>

#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

// Asks at every safe point.
class AskingClock : public vm::VirtualClock {
 public:
  AskingClock() : VirtualClock(0) {}
  void consumed(uint64_t safe_points) override {
    VirtualClock::consumed(safe_points);
    if (ask) ask();
  }
  std::function<void()> ask;
};

constexpr const char* kSource = R"(
VAR_GLOBAL g : DINT; seen : ARRAY[0..3] OF DINT; END_VAR
FUNCTION Next : DINT Next := g + 1; END_FUNCTION
FUNCTION_BLOCK Ramp VAR_INPUT up : BOOL; END_VAR VAR_OUTPUT value : DINT; END_VAR VAR i : INT; END_VAR
  IF up THEN value := value + 1; END_IF
  FOR i := 1 TO 4 DO value := value + i; END_FOR;
END_FUNCTION_BLOCK
PROGRAM Main VAR r : Ramp; i : INT; END_VAR
  FOR i := 0 TO 3 DO g := Next(); seen[i] := g; END_FOR;
  r(up := TRUE);
  seen[3] := r.value;
END_PROGRAM)";

class Forces : public testing::TestWithParam<vm::Tier> {};

// A scan that is interrupted at every call and back edge never has another value there.
TEST_P(Forces, HoldAtEverySafePoint) {
  const auto image = build(kSource);
  ASSERT_TRUE(image);
  AskingClock clock;
  vm::SimulatedIo io;
  vm::ControllerOptions options;
  options.fuel_slice = 1;
  options.tier.tier = GetParam();
  auto plant = vm::Controller::start(*image, options, clock, io);
  ASSERT_TRUE(plant.ok());
  (*plant)->cycle();
  EXPECT_EQ(*(*plant)->get("g"), "4");
  for (const char* path : {"g", "Main.r.value", "Main.r.up"}) {
    ASSERT_TRUE((*plant)
                    ->force(path, path[0] == 'g'   ? "70"
                                  : path[7] == 'u' ? "FALSE"
                                                   : "80")
                    .ok());
  }
  for (const vm::Force& force : (*plant)->forces()) EXPECT_EQ(force.reason, "") << force.path;
  uint64_t asked = 0;
  clock.ask = [&] {
    ++asked;
    for (const vm::Force& force : (*plant)->forces()) {
      const uint8_t* const at = (*plant)->memory().data() + force.symbol.data;
      EXPECT_TRUE(std::equal(force.value.begin(), force.value.end(), at)) << force.path;
    }
  };
  (*plant)->cycle();
  clock.ask = nullptr;
  EXPECT_GE(asked, 10u);
  EXPECT_EQ(*(*plant)->get("seen[2]"), "70");
  EXPECT_EQ(*(*plant)->get("seen[3]"), "80");
}
INSTANTIATE_TEST_SUITE_P(Tiers, Forces, testing::Values(vm::Tier::kInterpreter, vm::Tier::kNative));

// Side by side in memory.
TEST(Force, NeighboursAreForcedEach) {
  Plant plant("PROGRAM P VAR a, b, c : INT; END_VAR a := 1; b := 1; c := 1; END_PROGRAM");
  ASSERT_TRUE(plant.ok());
  for (const char* name : {"P.b", "P.c", "P.a"}) ASSERT_TRUE(plant->force(name, "9").ok());
  EXPECT_EQ(plant->forces().size(), 3u);
  ASSERT_TRUE(plant->force("P.b", "8").ok());
  EXPECT_EQ(plant->forces().size(), 3u) << "the same one anew";
  plant.cycles(1);
  EXPECT_EQ(plant.get("P.a") + plant.get("P.b") + plant.get("P.c"), "989");
}

// Also where a task that is stopped by a trap leaves its outputs, in the middle of the scan of
// another one, and for the devices.
TEST(Force, HoldsWhenATaskIsStopped) {
  vm::ControllerOptions options;
  options.fuel_slice = 1;
  Plant plant(R"(
VAR_GLOBAL q AT %QX0.0 : BOOL; free AT %QX0.1 : BOOL; END_VAR
PROGRAM Fast VAR n, x : INT; END_VAR q := FALSE; free := TRUE; n := n + 1; x := 10 / (5 - n); END_PROGRAM
PROGRAM Slow VAR i, lost, safe : INT; END_VAR
  FOR i := 1 TO 100 DO
    IF NOT q THEN lost := lost + 1; END_IF;
    IF NOT free THEN safe := safe + 1; END_IF;
  END_FOR;
END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC
  {attribute 'on_trap' := 'stop_task'} TASK High (INTERVAL := T#1ms, PRIORITY := 0);
  TASK Low (INTERVAL := T#50ms, PRIORITY := 1);
  PROGRAM F WITH High : Fast;
  PROGRAM S WITH Low : Slow;
END_RESOURCE END_CONFIGURATION)",
              options, 100'000);
  ASSERT_TRUE(plant.ok());
  ASSERT_TRUE(plant->force("q", "TRUE").ok());
  for (int i = 0; i < 40; ++i) {
    plant.cycles(1);
    EXPECT_EQ(plant.io.output(0) & 1, 1) << i;
  }
  EXPECT_TRUE(plant.task("High").stopped);
  EXPECT_EQ(plant.get("S.lost"), "0");
  EXPECT_NE(plant.get("S.safe"), "0") << "what is not forced is safe at once";
}

// Nobody writes it any more: without the force it has to become what the stop made of others.
TEST(Force, B3_AnOutputOfAStoppedTaskIsSafeBehindItsForce) {
  Plant plant(R"(
VAR_GLOBAL q AT %QX0.0 : BOOL; w AT %QB1 : BYTE; other AT %QB2 : BYTE; END_VAR
PROGRAM Stops VAR n, x : INT; END_VAR q := TRUE; w := 3; n := n + 1; x := 10 / (5 - n); END_PROGRAM
PROGRAM Goes VAR n : INT; END_VAR n := n + 1; other := 9; END_PROGRAM
PROGRAM Idle VAR n, x : INT; third AT %QB3 : BYTE; END_VAR third := 1; n := n + 1; x := 10 / (4 - n); END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC
  {attribute 'on_trap' := 'stop_task'} TASK High (INTERVAL := T#1ms, PRIORITY := 0);
  {attribute 'on_trap' := 'stop_task'} TASK Last (INTERVAL := T#1ms, PRIORITY := 2);
  PROGRAM I WITH Last : Idle;
  TASK Low (INTERVAL := T#1ms, PRIORITY := 1);
  PROGRAM S WITH High : Stops;
  PROGRAM G WITH Low : Goes;
END_RESOURCE END_CONFIGURATION)");
  ASSERT_TRUE(plant.ok());
  ASSERT_TRUE(plant->force("w", "55").ok());
  ASSERT_TRUE(plant->force("q", "TRUE").ok());
  ASSERT_TRUE(plant->force("other", "66").ok());
  plant.cycles(20);
  EXPECT_TRUE(plant.task("High").stopped);
  EXPECT_EQ(plant.io.output(1), 55);
  ASSERT_TRUE(plant->unforce("w").ok());
  plant.cycles(2);
  EXPECT_EQ(plant.io.output(1), 0);
  EXPECT_EQ(plant.get("w"), "16#00");
  EXPECT_EQ(plant.io.output(0) & 1, 1) << "is forced still";
  ASSERT_TRUE(plant->unforce("q").ok());
  ASSERT_TRUE(plant->unforce("other").ok());
  plant.cycles(2);
  EXPECT_EQ(plant.io.output(0) & 1, 0);
  EXPECT_EQ(plant.io.output(2), 9) << "its task goes on";
  ASSERT_TRUE(plant->force("w", "88").ok());  // after the stop
  plant.cycles(2);
  EXPECT_EQ(plant.io.output(1), 88);
  ASSERT_TRUE(plant->unforce("w").ok());
  plant.cycles(2);
  EXPECT_EQ(plant.io.output(1), 0);
}

// What is prepared beside the running program changes nothing before it is exchanged.
TEST(Force, ComesWithItsExchange) {
  Plant plant(kSource);
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  const vm::NamedValue values[] = {{"g", "70"}, {"Main.r.value", "80"}};
  auto change = plant->prepare_force(values);
  ASSERT_TRUE(change.ok());
  EXPECT_TRUE(plant->forces().empty());
  plant.cycles(1);
  EXPECT_EQ(plant.get("g"), "8");
  plant->use(**change);
  EXPECT_EQ(plant->forces().size(), 2u);
  plant.cycles(1);
  EXPECT_EQ(plant.get("seen[2]"), "70");
  const std::string both[] = {"g", "Main.r.value"};
  auto back = plant->prepare_unforce(both);
  ASSERT_TRUE(back.ok());
  plant.cycles(1);
  EXPECT_EQ(plant.get("seen[2]"), "70");
  plant->use(**back);
  EXPECT_TRUE(plant->forces().empty());
  plant.cycles(1);
  EXPECT_EQ(plant.get("seen[2]"), "73");
}

// Whether a cycle comes between two commands makes no difference to what the second one finds.
TEST(Force, HoldsFromItsAnswerOn) {
  Plant plant(R"(
VAR_GLOBAL start : BOOL; q AT %QB0 : BYTE; i AT %IB0 : BYTE; END_VAR
PROGRAM Main VAR seen : BYTE; n : DINT; END_VAR n := n + 1; seen := i; END_PROGRAM)");
  ASSERT_TRUE(plant.ok());
  plant.io.set_input(0, 3);
  plant.cycles(2);
  ASSERT_TRUE(plant->force("start", "TRUE").ok());
  ASSERT_TRUE(plant->force("q", "55").ok());
  ASSERT_TRUE(plant->force("i", "9").ok());
  EXPECT_EQ(plant.get("start"), "TRUE");
  EXPECT_EQ(plant.get("q"), "16#37");
  EXPECT_EQ(plant.get("i"), "16#09");
  ASSERT_TRUE(plant->set("start", "FALSE").ok());
  EXPECT_EQ(plant.get("start"), "TRUE") << "what is forced is not written";
  for (const char* name : {"start", "q", "i"}) ASSERT_TRUE(plant->unforce(name).ok());
  plant.cycles(1);
  EXPECT_EQ(plant.get("start"), "TRUE") << "nobody has written it since";
  EXPECT_EQ(plant.io.output(0), 55);
  EXPECT_EQ(plant.get("Main.seen"), "16#03");
  ASSERT_TRUE(plant->force("start", "FALSE").ok());
  EXPECT_EQ(plant.get("start"), "FALSE");
}

// All or none.
TEST(Force, OneMistakeForcesNothing) {
  Plant plant(kSource);
  ASSERT_TRUE(plant.ok());
  const vm::NamedValue values[] = {{"g", "70"}, {"Main.r.up", "7"}};
  EXPECT_EQ(plant->prepare_force(values).error().refusal, base::Refusal::kBadValue);
  const std::string paths[] = {"g"};
  EXPECT_EQ(plant->prepare_unforce(paths).error().refusal, base::Refusal::kNoSuchVariable);
}

// The version before the last one is gone, and what is known of it stays until the next change.
TEST(Force, OutlivesAVersionThatNobodyWantsBack) {
  Plant plant(kSource);
  ASSERT_TRUE(plant.ok());
  ASSERT_TRUE(plant->force("g", "70").ok());
  auto next = *plant->prepare(plant->verified());
  plant->publish(std::move(next)).reset();  // accepted
  ASSERT_TRUE(plant->force("Main.r.value", "80").ok());
  plant.cycles(1);
  EXPECT_EQ(plant.get("seen[2]"), "70");
  EXPECT_EQ(plant.get("seen[3]"), "80");
  ASSERT_TRUE(plant->unforce("g").ok());
  plant.cycles(1);
  EXPECT_EQ(plant.get("seen[2]"), "73");
}

}  // namespace
}  // namespace runtime_test
