// What a new generation takes over from the old one.
#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

std::string tasks(const char* fast_period, const char* third) {
  return std::string(R"(
PROGRAM P VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := )") +
         fast_period + R"(, PRIORITY := 0);
  TASK Slow (INTERVAL := T#20ms, PRIORITY := 1);
  PROGRAM A WITH Fast : P;
  PROGRAM B WITH Slow : P;)" +
         third + R"(
END_RESOURCE END_CONFIGURATION)";
}

TEST(Publish, IdentityKeepsCountsPhaseAndForces) {
  Plant plant(tasks("T#10ms", ""));
  ASSERT_TRUE(plant.ok());
  plant.cycles(3);
  ASSERT_TRUE(plant->force("B.n", "100").ok());
  auto next = *plant->prepare(plant->verified());
  ASSERT_TRUE(plant->force("A.n", "200").ok());  // after prepare()
  auto old = plant->publish(std::move(next));
  ASSERT_NE(old, nullptr);
  EXPECT_EQ(plant->next_release_ns(), 30 * kMs);
  EXPECT_EQ(plant->next_cycle_ns(), 30 * kMs);
  EXPECT_EQ(plant.task("Fast").scans, 3u);
  EXPECT_EQ(plant->forces().size(), 2u);
  plant.cycles(2);
  EXPECT_EQ(plant.task("Fast").scans, 5u);
  EXPECT_EQ(plant.task("Slow").scans, 3u);
  EXPECT_EQ(plant.get("A.n"), "200");
  EXPECT_EQ(plant.get("B.n"), "100");
  // And back, as undo does.
  auto second = plant->publish(std::move(old));
  ASSERT_NE(second, nullptr);
  plant.cycles(2);
  EXPECT_EQ(plant.task("Fast").scans, 7u);
  EXPECT_EQ(plant.task("Fast").missed, 0u);
  EXPECT_EQ(plant.task("Slow").scans, 4u);
}

// Says in every scan which version it is, by constants that lie beside the code.
std::string version(const char* text, const char* step) {
  return std::string("PROGRAM P VAR said : STRING[20]; sum : LREAL; n : DINT; END_VAR said := '") +
         text + "'; sum := sum + " + step + "; n := n + 1; END_PROGRAM";
}

// A11: version 2 is built in the other area while version 1 runs; the switch only changes which one
// the record names, and can change it back.
TEST(Publish, A11TwoAreasAndOneRecordThatSaysWhichRuns) {
  Plant plant(version("one", "1.25"));
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  const vm::Generation* first = &plant->generation();
  const auto image = build(version("two", "1000.5"), &plant->image());
  ASSERT_TRUE(image.has_value());
  auto next = *plant->prepare(*image);
  const vm::Generation* second = next.get();
  EXPECT_NE(first->pous().data(), second->pous().data());
  EXPECT_NE(first->pool_offset(), second->pool_offset());
  plant.cycles(2);
  EXPECT_EQ(&plant->generation(), first) << "prepared, not yet running";
  EXPECT_EQ(plant.get("P.said"), "'one'");
  EXPECT_EQ(plant.get("P.sum"), "3.75");
  auto old = plant->publish(std::move(next));
  EXPECT_EQ(old.get(), first);
  EXPECT_EQ(&plant->generation(), second);
  EXPECT_EQ(plant.get("P.said"), "'one'") << "the switch runs nothing";
  plant.cycles(2);
  EXPECT_EQ(plant.get("P.said"), "'two'");
  EXPECT_EQ(plant.get("P.sum"), "2004.75");
  plant->publish(std::move(old));
  plant.cycles(1);
  EXPECT_EQ(plant.get("P.said"), "'one'");
  EXPECT_EQ(plant.get("P.sum"), "2006.0");
  EXPECT_EQ(plant.get("P.n"), "6") << "no scan is left out, and none runs twice";
}

// A task that a trap has stopped stays so, what it has missed stays counted, and an output that is
// held gets its value when it would have got it without the change.
TEST(Publish, WhatATaskHasMissedItsEndAndHeldOutputsGoOn) {
  const auto source = [](const char* step) {
    return std::string(R"(
PROGRAM Bad VAR n, zero : DINT; q AT %QB0 : BYTE; END_VAR
  n := n + 1; q := 16#11; IF n = 3 THEN n := n / zero; END_IF
END_PROGRAM
PROGRAM Good VAR n : DINT; END_VAR n := n + )") +
           step + R"(; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  {attribute 'on_trap' := 'stop_task'} TASK One (INTERVAL := T#10ms, PRIORITY := 1);
  TASK Two (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM B WITH One : Bad; PROGRAM G WITH Two : Good;
END_RESOURCE END_CONFIGURATION)";
  };
  const std::vector<ir::SafeOutput> safe = {{0, 8, ir::SafeKind::kHoldThenValue, 9, 30 * kMs}};
  Plant plant(source("1"), {}, 0, safe);
  ASSERT_TRUE(plant.ok());
  plant.cycles(1);
  plant.clock.advance(35 * kMs);
  plant.cycles(2);
  const uint64_t missed = plant.task("Two").missed;
  EXPECT_GE(missed, 2u);
  ASSERT_TRUE(plant.task("One").stopped);
  const auto next = build(source("2"), &plant->image(), safe);
  ASSERT_TRUE(next);
  auto old = plant->publish(*plant->prepare(*next));
  for (const int expected : {0x11, 0x11, 9, 9}) {
    plant.cycles(1);
    EXPECT_EQ(plant.io.output(0), expected);
  }
  EXPECT_TRUE(plant.task("One").stopped);
  EXPECT_EQ(plant.task("One").scans, 2u);
  EXPECT_EQ(plant.task("Two").missed, missed);
}

// `S` takes the inputs of the first cycle of its period. That cycle leaves no time for it: the
// switch comes before its scan, and its inputs stay those.
TEST(Publish, B6_InputsOfAScanThatIsStillToComeStay) {
  const auto source = [](const char* step) {
    return std::string(R"(
PROGRAM Long VAR i : DINT; END_VAR FOR i := 1 TO 12000 DO ; END_FOR END_PROGRAM
PROGRAM Beat VAR n : DINT; END_VAR n := n + )") +
           step + R"(; END_PROGRAM
PROGRAM Reads VAR i AT %IB0 : BYTE; seen : BYTE; END_VAR seen := i; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK One (INTERVAL := T#100ms, PRIORITY := 1);
  {attribute 'io' := 'synchronous'} TASK Two (INTERVAL := T#100ms, PRIORITY := 2);
  TASK Three (INTERVAL := T#10ms, PRIORITY := 0);
  PROGRAM L WITH One : Long; PROGRAM S WITH Two : Reads; PROGRAM B WITH Three : Beat;
END_RESOURCE END_CONFIGURATION)";
  };
  vm::ControllerOptions options;
  options.fuel_slice = 1'000'000;
  Plant plant(source("1"), options, 1000);
  ASSERT_TRUE(plant.ok());
  plant.io.set_input(0, 7);
  plant.cycles(1);
  ASSERT_TRUE(plant->at_boundary());
  ASSERT_EQ(plant.task("Two").scans, 0u);
  plant.io.set_input(0, 9);
  const auto next = build(source("2"), &plant->image());
  ASSERT_TRUE(next);
  auto old = plant->publish(*plant->prepare(*next));
  plant.cycles(1);
  EXPECT_EQ(plant.task("Two").scans, 1u);
  EXPECT_EQ(plant.get("S.seen"), "16#07");
}

// Change case 42: period changed, task added.
TEST(Publish, PeriodChangeAndNewTaskKeepTheOthersOnTime) {
  Plant plant(tasks("T#10ms", ""));
  ASSERT_TRUE(plant.ok());
  plant.cycles(3);  // last cycle began at 20 ms
  auto image = build(tasks("T#5ms",
                           " TASK Third (INTERVAL := T#15ms, PRIORITY := 2); "
                           "PROGRAM C WITH Third : P;"),
                     &plant->image());
  ASSERT_TRUE(image.has_value());
  auto old = plant->publish(*plant->prepare(*image));
  EXPECT_EQ(plant->base_period_ns(), 5 * kMs);
  EXPECT_EQ(plant->next_cycle_ns(), 25 * kMs);
  plant.cycles(4);  // 25, 30, 35, 40 ms
  EXPECT_EQ(plant.clock.now_ns(), 40 * kMs);
  EXPECT_EQ(plant.task("Fast").scans, 7u);
  EXPECT_EQ(plant.task("Slow").scans, 3u);
  EXPECT_GE(plant.task("Third").scans, 1u);
  for (const vm::TaskStatus& row : plant->tasks()) EXPECT_EQ(row.missed, 0u) << row.name;
}

// Change case 47: a forced variable that is retyped or removed.
TEST(Publish, ForcesFollowByNameAndValue) {
  Plant plant(
      "PROGRAM P VAR a : INT; b : INT; c : INT; END_VAR a := 1; b := 1; c := 1; END_PROGRAM");
  ASSERT_TRUE(plant.ok());
  for (const char* name : {"P.a", "P.b", "P.c"}) ASSERT_TRUE(plant->force(name, "300").ok());
  auto image = build("PROGRAM P VAR b : DINT; a : SINT; END_VAR a := 1; b := 1; END_PROGRAM",
                     &plant->image());
  ASSERT_TRUE(image.has_value());
  auto old = plant->publish(*plant->prepare(*image));
  ASSERT_EQ(plant->forces().size(), 1u);
  plant.cycles(1);
  EXPECT_EQ(plant.get("P.b"), "300");
  EXPECT_EQ(plant.get("P.a"), "1");
}

// An output that moves is at its new place, and what has no variable any more is safe, both in the
// first refresh after the switch; what is held stays, and later gets its value.
TEST(Publish, case46_removed_outputs_become_safe_without_a_glitch) {
  const std::vector<ir::SafeOutput> safe = {
      {1, 1, ir::SafeKind::kValue, 1, 0},
      {8, 8, ir::SafeKind::kHold, 0, 0},
      {16, 8, ir::SafeKind::kHoldThenValue, 9, 20 * kMs},
  };
  const auto source = [](const std::string& variables, const std::string& body) {
    return "PROGRAM P VAR " + variables + " last AT %QB4 : BYTE; END_VAR " + body +
           " last := 1; END_PROGRAM";
  };
  Plant plant(source("lamp AT %QX0.0 : BOOL; gone AT %QX0.1 : BOOL; kept AT %QB1 : BYTE; timed AT "
                     "%QB2 : BYTE; plain AT %QB3 : BYTE;",
                     "lamp := TRUE; gone := FALSE; kept := 5; timed := 6; plain := 7;"),
              {}, 0, safe);
  ASSERT_TRUE(plant.ok());
  plant.cycles(3);
  auto next = build(source("lamp AT %QX0.2 : BOOL;", "lamp := TRUE;"), &plant->image(), safe);
  ASSERT_TRUE(next);
  auto generation = plant->prepare(*next);
  ASSERT_TRUE(generation.ok());
  auto old = plant->publish(std::move(*generation));
  const auto outputs = [&] {
    plant.cycles(1);
    std::string text;
    for (size_t i = 0; i < 5; ++i) text += std::to_string(plant.io.output(i)) + " ";
    return text;
  };
  EXPECT_EQ(outputs(), "6 5 6 0 1 ");  // 10 ms after the switch
  EXPECT_EQ(outputs(), "6 5 9 0 1 ");  // 20 ms
  plant->publish(std::move(old));
  EXPECT_EQ(outputs(), "1 5 6 7 1 ");
}

}  // namespace
}  // namespace runtime_test
