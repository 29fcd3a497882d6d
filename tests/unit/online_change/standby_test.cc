// The standby strategy (C2, C3, C5 to C7): a second data area made in idle time, brought up to date
// at the boundary, and exchanged for the one that runs. The other tests of this folder run by it
// too (STC_TEST_STRATEGY).
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "ir/bytecode/symbols.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using base::Refusal;
using plant::Plant;
using plant::Settings;

constexpr int64_t kMs = 1'000'000;

// Something of every kind of step, spread over many pages.
const char* const kFirst = R"(
VAR_GLOBAL total : DINT; last : ARRAY[0..9] OF INT; END_VAR
TYPE Part : STRUCT low, high : INT; END_STRUCT END_TYPE
FUNCTION_BLOCK Motor VAR hours : DINT; speed : INT := 5; part : Part; END_VAR hours := hours + 1; END_FUNCTION_BLOCK
PROGRAM Main
  VAR
    m : ARRAY[1..40] OF Motor; far : ARRAY[0..9999] OF INT; x : INT := 20; gone : INT := 4;
    name : STRING[20]; log : ARRAY[0..2999] OF INT; p : POINTER TO INT; r : REFERENCE TO Motor; i, k : INT;
  END_VAR
  FOR i := 1 TO 40 DO m[i](); END_FOR
  x := x + 1; name := 'abc'; k := (k + 7) MOD 3000; log[k] := x; far[9 * (k MOD 1000)] := k;
  p := ADR(log[17]); r REF= m[7]; total := total + x; last[k MOD 10] := k;
END_PROGRAM)";
const char* const kSecond = R"(
VAR_GLOBAL total : LREAL; last : ARRAY[0..9] OF INT; END_VAR
TYPE Part : STRUCT first : LREAL; low, high : DINT; END_STRUCT END_TYPE
FUNCTION_BLOCK Motor
  VAR hours : DINT; speed : LREAL := 5; part : Part; trace : ARRAY[0..99] OF LINT; END_VAR
  hours := hours + 1;
END_FUNCTION_BLOCK
PROGRAM Main
  VAR
    m : ARRAY[1..41] OF Motor; far : ARRAY[0..9999] OF INT; x : DINT; added : INT := 6;
    name : STRING[40]; log : ARRAY[0..2999] OF LREAL; p : POINTER TO LREAL; r : REFERENCE TO Motor; i, k : INT;
  END_VAR
  FOR i := 1 TO 41 DO m[i](); END_FOR
  x := x + 10; k := (k + 7) MOD 3000; log[k] := x;
END_PROGRAM)";

linker::Slack roomy() {
  linker::Slack slack;
  slack.free_bytes = 1u << 20;
  return slack;
}

std::string state(Plant& plant) {
  return ir::state_text(plant.controller().image(), plant.controller().memory().view());
}

// "" when there is none. Some thousand lines are too many for the differences that gtest looks for.
std::string first_difference(Plant& a, Plant& b) {
  std::istringstream first(state(a));
  std::istringstream second(state(b));
  for (std::string x, y; !first.eof() || !second.eof();) {
    std::getline(first, x);
    std::getline(second, y);
    if (x != y) return x + " and " + y;
  }
  return "";
}

TEST(Standby, C2_C6_the_areas_exchange_their_roles) {
  Plant plant(kFirst, roomy());
  plant.use(Strategy::kStandby);
  plant.run(3);
  const std::string before = state(plant);
  const ir::Image first = plant.controller().image();
  const uint8_t* const active = plant.controller().memory().data();
  plant.change(kSecond, true);
  EXPECT_NE(plant.controller().memory().data(), active);
  plant.run(5);
  // The old side holds version 1's data, untouched by version 2.
  EXPECT_EQ(ir::state_text(first, {active, size_t{1} << 32}), before);
  plant.accept();
  plant.change(kFirst, true);
  EXPECT_EQ(plant.get("Main.m[40].hours"), "8");
}

// The same with most of it in its place: what changed is copied there, and only the steps that it
// touches are done again.
const char* const kLittle = R"(
VAR_GLOBAL total : DINT; last : ARRAY[0..9] OF INT; END_VAR
TYPE Part : STRUCT low, high : INT; END_STRUCT END_TYPE
FUNCTION_BLOCK Motor VAR hours : DINT; speed : REAL := 5; part : Part; END_VAR hours := hours + 1; END_FUNCTION_BLOCK
PROGRAM Main
  VAR
    m : ARRAY[1..40] OF Motor; far : ARRAY[0..9999] OF INT; x : DINT; added : INT := 6;
    name : STRING[20]; log : ARRAY[0..2999] OF INT; p : POINTER TO INT; r : REFERENCE TO Motor; i, k : INT;
  END_VAR
  FOR i := 1 TO 40 DO m[i](); END_FOR
  x := x + 10; k := (k + 7) MOD 3000; far[k] := k;
END_PROGRAM)";

// Whatever version 1 and the user write between the copy and the switch arrives.
void compare_with_in_place(const char* second, const linker::Slack& slack, int scans) {
  Plant in_place(kFirst, slack);
  Plant standby(kFirst, slack);
  in_place.use(Strategy::kInPlace);
  standby.use(Strategy::kStandby);
  in_place.run(3 + scans);
  standby.run(3);
  ASSERT_TRUE(standby.stage(standby.package(second)).ok());
  ASSERT_TRUE(*standby.driver().configure());
  EXPECT_EQ(standby.driver().units_left(), 0u);
  standby.run(scans);
  ASSERT_TRUE(standby.driver().arm(true).ok());
  for (Plant* plant : {&in_place, &standby}) {
    plant->set("Main.m[3].speed", "77");
    plant->set("Main.log[2000]", "-5");
    plant->set("Main.name", "'later'");
  }
  in_place.change(second, true);
  auto report = standby.driver().switch_now();
  ASSERT_TRUE(report.ok()) << base::to_string(report.error());
  EXPECT_EQ(first_difference(standby, in_place), "") << scans;
  EXPECT_EQ(standby.get("Main.m[3].speed"), "77.0");
  EXPECT_EQ(standby.get("Main.r"), "Main.m[7]");
  in_place.run(4);
  standby.run(4);
  EXPECT_EQ(first_difference(standby, in_place), "") << scans;
  in_place.undo();
  standby.undo();
  EXPECT_EQ(first_difference(standby, in_place), "") << scans;
  in_place.run(2);
  standby.run(2);
  EXPECT_EQ(first_difference(standby, in_place), "") << scans;
}

TEST(Standby, C3_C7_what_changed_since_the_copy_is_brought_up_to_date) {
  for (int scans = 0; scans < 40; scans += 3) compare_with_in_place(kSecond, roomy(), scans);
}

// A step may reach over the end of a page: one value alone has changed, somewhere in what moves.
TEST(Standby, C3_C7_a_change_in_any_page_of_a_step_is_seen) {
  for (int index = 50; index < 10000; index += 500) {
    Plant plant(kFirst, roomy());
    plant.use(Strategy::kStandby);
    plant.run(3);
    ASSERT_TRUE(plant.stage(plant.package(kSecond)).ok());
    ASSERT_TRUE(*plant.driver().configure());
    const std::string path = "Main.far[" + std::to_string(index) + "]";
    plant.set(path, "-9");
    ASSERT_TRUE(plant.driver().arm(true).ok());
    ASSERT_TRUE(plant.driver().switch_now().ok());
    EXPECT_EQ(plant.get(path), "-9") << path;
  }
}

// With slack what is new lies in it; without, where something of version 1 lay.
TEST(Standby, C3_C7_what_changed_since_the_copy_is_up_to_date_in_its_place) {
  linker::Slack none = {0, 0, 0, 0, 0, 0, 1u << 20, 0};
  for (int scans = 0; scans < 40; scans += 13) {
    compare_with_in_place(kLittle, roomy(), scans);
    compare_with_in_place(kLittle, none, scans);
  }
}

const char* const kInt = "PROGRAM Main VAR x : INT := 300; y : INT; END_VAR END_PROGRAM";
const char* const kSint = "PROGRAM Main VAR x : SINT; y : INT; END_VAR END_PROGRAM";

// A value that would have been lost when it was copied, then not, then again.
TEST(Standby, C7_case2_losses_are_those_of_the_boundary) {
  for (const bool back : {false, true}) {
    Plant plant(kInt);
    plant.use(Strategy::kStandby);
    plant.run(1);
    Change& change = plant.driver();
    ASSERT_TRUE(plant.stage(plant.package(kSint)).ok());
    ASSERT_TRUE(*change.configure());
    plant.set("Main.x", "100");
    ASSERT_TRUE(change.arm(false).ok());
    if (back) plant.set("Main.x", "300");
    auto report = change.switch_now();
    ASSERT_EQ(report.ok(), !back);
    EXPECT_EQ(plant.get("Main.x"), back ? "300" : "100");
    EXPECT_TRUE(!back || report.error().refusal == Refusal::kWouldLose);
  }
}

// A loop of 1499 rounds and its call take 1500 safe points of 20 us: 30 ms.
const char* const kTasks = R"(
PROGRAM FastWork VAR n : DINT; i : INT; END_VAR FOR i := 1 TO 1500 DO n := n + 1; END_FOR END_PROGRAM
PROGRAM SlowWork VAR n : DINT; i : INT; END_VAR FOR i := 1 TO 1500 DO n := n + 1; END_FOR END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := T#50ms, PRIORITY := 0); TASK Slow (INTERVAL := T#200ms, PRIORITY := 1);
  PROGRAM F WITH Fast : FastWork; PROGRAM S WITH Slow : SlowWork;
END_RESOURCE END_CONFIGURATION
)";

// Fast task 50 ms period and 30 ms run time, slow task 200 ms and 30 ms; configuration needs 30 ms
// and starts at 90 ms.
TEST(Standby, B10_C5_case48_to_the_letter) {
  Settings settings;
  settings.ns_per_safe_point = vm::kIdleUnitNs;
  settings.slack.free_bytes = 1u << 20;
  const std::string data = "VAR_GLOBAL data : ARRAY[1..4909466] OF BYTE; x : INT; END_VAR";
  const std::string next = "VAR_GLOBAL data : ARRAY[1..4909466] OF BYTE; x : DINT; END_VAR";
  Plant plant(data + kTasks, settings);
  plant.use(Strategy::kStandby);
  Change& change = plant.driver();
  ASSERT_TRUE(plant.stage(plant.package(next + kTasks)).ok());
  ASSERT_EQ(static_cast<int64_t>(change.units_left()) * vm::kIdleUnitNs, 30 * kMs);
  plant.run(2);
  ASSERT_TRUE(plant.controller().at_boundary());
  ASSERT_EQ(plant.clock().now_ns(), 90 * kMs);
  ASSERT_FALSE(*change.configure());
  EXPECT_EQ(plant.clock().now_ns(), 100 * kMs);
  EXPECT_EQ(static_cast<int64_t>(change.units_left()) * vm::kIdleUnitNs, 20 * kMs);
  ASSERT_FALSE(*change.configure());  // no idle time is left
  EXPECT_EQ(plant.clock().now_ns(), 100 * kMs);
  plant.run(1);  // on time
  EXPECT_EQ(plant.clock().now_ns(), 130 * kMs);
  ASSERT_TRUE(*change.configure());  // in the next idle time
  EXPECT_EQ(plant.clock().now_ns(), 150 * kMs);
  plant.run(1);
  EXPECT_EQ(plant.clock().now_ns(), 180 * kMs);
  ASSERT_TRUE(change.arm(false).ok());
  ASSERT_TRUE(change.switch_now().ok());
  plant.run(4);
  for (const vm::TaskStatus& task : plant.controller().tasks()) EXPECT_EQ(task.missed, 0u);
}

// By any release, whatever the program does meanwhile; and nothing of it is seen before the switch.
TEST(Standby, C5_configuration_delays_no_release) {
  for (const Strategy strategy : {Strategy::kInPlace, Strategy::kStandby}) {
    Settings settings;
    settings.ns_per_safe_point = vm::kIdleUnitNs;
    settings.slack.free_bytes = 1u << 20;
    auto source = [](const char* more) {
      return "FUNCTION_BLOCK Box VAR a : ARRAY[1..300] OF LINT; " + std::string(more) +
             " END_VAR END_FUNCTION_BLOCK VAR_GLOBAL b : ARRAY[1..900] OF Box; END_VAR" + kTasks;
    };
    Plant plant(source(""), settings);
    Plant reference(source(""), settings);
    plant.use(strategy);
    ASSERT_TRUE(plant.stage(plant.package(source("n : INT := 3;"))).ok());
    int cycles = 0;
    for (; !*plant.driver().configure(); ++cycles) {
      plant.run(1);
      reference.run(1);
      while (!plant.controller().at_boundary()) plant.run(1), reference.run(1);
      ASSERT_EQ(plant.hash(), reference.hash());
      ASSERT_EQ(plant.clock().now_ns(), reference.clock().now_ns());
    }
    EXPECT_GT(cycles, 1) << "the test needs more idle time than one cycle has";
    ASSERT_TRUE(plant.driver().arm(false).ok());
    ASSERT_TRUE(plant.driver().switch_now().ok());
    EXPECT_EQ(plant.get("b[900].n"), "3");
    for (const vm::TaskStatus& task : plant.controller().tasks()) EXPECT_EQ(task.missed, 0u);
  }
}

TEST(Standby, C1_refused_with_the_amounts_when_it_does_not_fit) {
  const std::string source =
      "PROGRAM Main VAR data : ARRAY[1..100000] OF LINT; x : INT; END_VAR END_PROGRAM";
  const std::string next =
      "PROGRAM Main VAR data : ARRAY[1..100000] OF LINT; x : DINT; END_VAR END_PROGRAM";
  Settings settings;
  settings.options.data_limit = 2'000'000;
  Plant plant(source, settings);
  plant.use(Strategy::kStandby);
  plant.run(1);
  const base::Digest before = plant.hash();
  const base::Status staged = plant.stage(plant.package(next));
  ASSERT_FALSE(staged.ok());
  EXPECT_EQ(staged.error().refusal, Refusal::kTooLarge);
  EXPECT_NE(staged.error().text.find("limit is 2000000"), std::string::npos) << staged.error().text;
  EXPECT_EQ(plant.driver().state(), State::kIdle);
  EXPECT_EQ(plant.hash(), before);
  plant.use(Strategy::kInPlace);
  plant.change(next);
}

uint64_t address_space_bytes() {
  std::ifstream statm("/proc/self/statm");
  uint64_t pages = 0;
  statm >> pages;
  return pages * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

TEST(Standby, C1_nothing_is_left_of_a_change_that_was_cancelled) {
  Plant plant(kFirst, roomy());
  plant.use(Strategy::kStandby);
  plant.run(1);
  const base::Digest hash = plant.hash();
  const base::Bytes package = plant.package(kSecond);
  const uint64_t before = address_space_bytes();
  for (int round = 0; round < 20; ++round) {
    ASSERT_TRUE(plant.stage(package).ok());
    EXPECT_GT(address_space_bytes(), before + (uint64_t{8} << 30));
    EXPECT_TRUE(round % 2 == 0 || *plant.driver().configure());
    EXPECT_TRUE(round % 4 != 3 || plant.driver().arm(true).ok());
    plant.driver().cancel();
    EXPECT_EQ(plant.hash(), hash);
    EXPECT_LT(address_space_bytes(), before + (uint64_t{1} << 30)) << round;
  }
  plant.change(kSecond, true);
  plant.accept();
  plant.driver().collect();
  EXPECT_LT(address_space_bytes(), before + (uint64_t{1} << 30));
}

}  // namespace
}  // namespace online_change
