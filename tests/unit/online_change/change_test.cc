// Change as a state machine (C1, D1..D3): what each call does in each state, and
// that any failure before the switch leaves version 1 as it was.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using base::Refusal;
using plant::Plant;

// A conversion, a copy inside an area that moves, early and late initialisations, slots.
const char* const kFirst = R"(
FUNCTION_BLOCK Motor VAR hours : DINT; speed : INT := 5; END_VAR
  hours := hours + 1;
END_FUNCTION_BLOCK
PROGRAM Main VAR m : ARRAY[1..3] OF Motor; x : INT := 20; gone : INT := 4; name : STRING[20]; END_VAR
  m[1](); m[2](); m[3](); x := x + 1; name := 'abc';
END_PROGRAM)";
const char* const kSecond = R"(
FUNCTION_BLOCK Motor VAR hours : DINT; speed : LREAL := 5; log : ARRAY[0..99] OF LINT; END_VAR
  hours := hours + 1;
END_FUNCTION_BLOCK
PROGRAM Main VAR m : ARRAY[1..4] OF Motor; x : DINT; added : INT := 6; name : STRING[40]; END_VAR
  m[1](); m[2](); m[3](); m[4](); x := x + 10;
END_PROGRAM)";

TEST(Change, C1_states_in_order) {
  Plant plant(kFirst);
  plant.run(3);
  Change& change = plant.driver();
  EXPECT_EQ(change.state(), State::kIdle);
  EXPECT_FALSE(change.arm(true).ok());
  EXPECT_FALSE(change.switch_now().ok());
  ASSERT_TRUE(plant.stage(plant.package(kSecond)).ok());
  EXPECT_EQ(change.state(), State::kPrepared);
  EXPECT_FALSE(change.switch_now().ok());
  plant.run(2);  // version 1 runs on
  EXPECT_EQ(plant.get("Main.x"), "25");
  ASSERT_TRUE(change.arm(true).ok());
  EXPECT_EQ(change.state(), State::kArmed);
  plant.run(1);
  ASSERT_TRUE(change.switch_now().ok());
  EXPECT_EQ(change.state(), State::kTrial);
  EXPECT_EQ(plant.get("Main.x"), "26");
  plant.run(1);
  EXPECT_EQ(plant.get("Main.x"), "36");
  EXPECT_EQ(plant.get("Main.m[2].hours"), "7");
  EXPECT_EQ(plant.get("Main.m[4].hours"), "1");
  EXPECT_EQ(plant.get("Main.m[1].speed"), "5.0");
  EXPECT_EQ(plant.get("Main.name"), "'abc'");
  plant.accept();
  EXPECT_EQ(change.state(), State::kIdle);
  EXPECT_EQ(change.undo().error().refusal, Refusal::kNothingToUndo);
}

TEST(Change, D3_X4_undo_at_once_restores_every_bit) {
  Plant plant(kFirst);
  plant.run(3);
  base::Digest before = plant.hash();
  base::Digest version = plant.controller().verified().digest();
  plant.change(kSecond, true);
  plant.undo();
  EXPECT_EQ(plant.hash(), before);
  EXPECT_EQ(plant.controller().verified().digest(), version);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.x"), "24");
  EXPECT_EQ(plant.driver().undo().error().refusal, Refusal::kNothingToUndo);  // undo twice
}

TEST(Change, D3_case59_undo_after_1000_scans) {
  Plant plant(kFirst);
  plant.run(3);
  plant.change(kSecond, true);
  plant.run(1000);
  plant.undo();
  EXPECT_EQ(plant.get("Main.x"), "10023");
  EXPECT_EQ(plant.get("Main.m[1].hours"), "1003");
  EXPECT_EQ(plant.get("Main.gone"), "4");
  plant.run(1);
  EXPECT_EQ(plant.get("Main.x"), "10024");
}

// Whatever step of the change fails, version 1 is as it was and goes on as if nothing had been;
// then the next attempt succeeds. Returns how many steps there are.
int fail_at_every_step(const std::string& first, const std::string& second,
                       const linker::Slack& slack, const char* x_behind) {
  int points = 0;
  for (int fail_at = 0; fail_at < 10000; ++fail_at) {
    Plant plant(first, slack);
    plant.run(3);
    base::Digest before = plant.hash();
    int passed = 0;
    plant.driver().set_interruption([&] { return passed++ == fail_at; });
    Change& change = plant.driver();
    base::Bytes package = plant.package(second);
    bool done = plant.stage(package).ok() && change.configure().ok() && change.arm(true).ok() &&
                change.switch_now().ok();
    if (done) break;
    ++points;
    EXPECT_EQ(change.state(), State::kIdle) << fail_at;
    EXPECT_EQ(plant.hash(), before) << fail_at;
    plant.run(2);
    Plant reference(first, slack);
    reference.run(5);
    EXPECT_EQ(plant.hash(), reference.hash()) << fail_at;
    EXPECT_EQ(plant.clock().now_ns(), reference.clock().now_ns()) << fail_at;
    EXPECT_EQ(plant.controller().next_release_ns(), reference.controller().next_release_ns());
    plant.driver().set_interruption(nullptr);
    plant.change(second, true);
    plant.run(1);
    EXPECT_EQ(plant.get("Main.x"), x_behind) << fail_at;
  }
  return points;
}

TEST(Change, C1_every_step_can_fail) {
  EXPECT_GT(fail_at_every_step(kFirst, kSecond, {}, "35"), 15);
}

// Without slack there is no room but what version 1 uses: in place its bytes are written over, and
// a failure behind that must bring them back.
const char* const kFull = R"(
PROGRAM Main VAR x : DINT := 20; r : REAL := 2; a : ARRAY[0..3] OF INT := [1, 2, 3, 4]; END_VAR
  x := x + 1; a[1] := a[1] + 1;
END_PROGRAM)";
const char* const kFullToo = R"(
PROGRAM Main VAR x : REAL; r : DINT; a : ARRAY[0..1] OF DINT; END_VAR
  x := x + 10; a[1] := a[1] + 1;
END_PROGRAM)";

linker::Slack no_slack() { return {0, 0, 0, 0, 0, 0, 64 * 1024, 0}; }

TEST(Change, C1_A19_every_step_can_fail_where_version_1_is_written_over) {
  Plant plant(kFull, no_slack());
  plant.run(3);
  const ir::Image before = plant.controller().image();
  plant.change(kFullToo, true);
  EXPECT_EQ(plant.controller().image().instances[1].data, before.instances[1].data);
  EXPECT_TRUE(std::none_of(plant.plan().steps.begin(), plant.plan().steps.end(),
                           [](const UpdateStep& step) { return step.early(); }));
  EXPECT_EQ(plant.get("Main.x"), "23.0");
  EXPECT_EQ(plant.get("Main.a[1]"), "5");
  EXPECT_GT(fail_at_every_step(kFull, kFullToo, no_slack(), "35.0"), 10);
}

void fail_at_every_step_of_undo(const std::string& first, const std::string& second,
                                const linker::Slack& slack) {
  Plant plant(first, slack);
  plant.run(3);
  base::Digest before = plant.hash();
  plant.change(second, true);
  base::Digest trial = plant.hash();
  int points = 0;
  for (int fail_at = 0; fail_at < 10000; ++fail_at, ++points) {
    int passed = 0;
    plant.driver().set_interruption([&] { return passed++ == fail_at; });
    if (plant.driver().undo().ok()) break;
    EXPECT_EQ(plant.driver().state(), State::kTrial);
    EXPECT_EQ(plant.hash(), trial) << fail_at;
  }
  EXPECT_GT(points, 5);
  EXPECT_EQ(plant.hash(), before);
}

TEST(Change, C1_interrupted_undo_leaves_the_trial) {
  fail_at_every_step_of_undo(kFirst, kSecond, {});
  fail_at_every_step_of_undo(kFull, kFullToo, no_slack());
}

// Nobody but stc makes packages, but anybody can send one: the controller looks for itself.
TEST(Change, V17_the_controller_takes_no_plan_that_does_not_fit) {
  Plant plant(kFirst);
  plant.run(2);
  const base::Digest before = plant.hash();
  const base::Bytes sound = plant.package(kSecond);
  for (const bool back : {false, true}) {
    Package package = *decode(sound);
    Plan& plan = back ? package.inverse : package.forward;
    for (UpdateStep& step : plan.steps) {
      if (auto* copied = step.as<CopiedValues>()) copied->from += 2;
    }
    EXPECT_EQ(plant.stage(encode(package)).error().refusal, Refusal::kBadPackage);
    package = *decode(sound);
    (back ? package.inverse : package.forward) = {};
    EXPECT_EQ(plant.stage(encode(package)).error().refusal, Refusal::kBadPackage) << "no plan";
    EXPECT_EQ(plant.driver().state(), State::kIdle);
  }
  EXPECT_EQ(plant.hash(), before);
  EXPECT_TRUE(plant.stage(sound).ok());
}

TEST(Change, case58_wrong_base_same_change_two_tools) {
  Plant plant(kFirst);
  base::Bytes package = plant.package(kSecond);
  base::Bytes other =
      plant.package(std::string(kFirst) + "\nFUNCTION f : INT f := 1; END_FUNCTION");
  Change& change = plant.driver();
  ASSERT_TRUE(plant.stage(package).ok());
  EXPECT_EQ(plant.stage(other).error().refusal, Refusal::kChangePending);
  ASSERT_TRUE(change.arm(true).ok());
  ASSERT_TRUE(change.switch_now().ok());
  EXPECT_EQ(plant.stage(other).error().refusal, Refusal::kStaleBase);
  EXPECT_EQ(change.state(), State::kTrial);
  plant.accept();
  EXPECT_EQ(plant.stage(other).error().refusal, Refusal::kStaleBase);
  EXPECT_EQ(plant.stage(package).error().refusal, Refusal::kNoChange);
  EXPECT_EQ(change.state(), State::kIdle);
}

TEST(Change, C4_damaged_package_is_refused) {
  Plant plant(kFirst);
  base::Digest before = plant.hash();
  base::Bytes package = plant.package(kSecond);
  package[package.size() / 2] ^= 1;
  EXPECT_EQ(plant.stage(package).error().refusal, Refusal::kBadHash);
  EXPECT_EQ(plant.stage({}).error().refusal, Refusal::kBadFormat);
  EXPECT_EQ(plant.hash(), before);
  EXPECT_EQ(plant.driver().state(), State::kIdle);
}

TEST(Change, case53_same_program_is_no_change) {
  Plant plant(kFirst);
  EXPECT_EQ(plant.refused(kFirst), Refusal::kNoChange);
}

TEST(Change, cancel_before_the_switch) {
  Plant plant(kFirst);
  plant.run(2);
  base::Digest before = plant.hash();
  Change& change = plant.driver();
  ASSERT_TRUE(plant.stage(plant.package(kSecond)).ok());
  change.cancel();
  EXPECT_EQ(plant.hash(), before);
  ASSERT_TRUE(plant.stage(plant.package(kSecond)).ok());
  ASSERT_TRUE(change.arm(true).ok());
  change.cancel();
  EXPECT_EQ(plant.hash(), before);
  EXPECT_EQ(change.state(), State::kIdle);
  plant.change(kSecond, true);
  change.cancel();  // not in trial
  EXPECT_EQ(change.state(), State::kTrial);
}

const char* const kInt = "PROGRAM Main VAR x : INT := 100; END_VAR END_PROGRAM";
const char* const kSint = "PROGRAM Main VAR x : SINT; END_VAR END_PROGRAM";

TEST(Change, case1_exact_and_loss) {
  Plant plant(kInt);
  plant.change(kSint);
  EXPECT_EQ(plant.get("Main.x"), "100");
  plant.undo();
  plant.set("Main.x", "300");
  base::Digest before = plant.hash();
  EXPECT_EQ(plant.refused(kSint), Refusal::kWouldLose);
  EXPECT_EQ(plant.hash(), before);
  plant.change(kSint, true);
  EXPECT_EQ(plant.get("Main.x"), "127");
}

TEST(Change, A13_case2_loss_appears_between_preview_and_switch) {
  Plant plant(kInt);
  Change& change = plant.driver();
  ASSERT_TRUE(plant.stage(plant.package(kSint)).ok());
  EXPECT_TRUE(change.live_losses().empty());
  ASSERT_TRUE(change.arm(false).ok());
  plant.set("Main.x", "300");
  base::Digest before = plant.hash();
  auto report = change.switch_now();
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().refusal, Refusal::kWouldLose);
  EXPECT_NE(report.error().text.find("`Main.x` is 300"), std::string::npos) << report.error().text;
  EXPECT_EQ(plant.hash(), before);
  EXPECT_EQ(change.state(), State::kIdle);
}

TEST(Change, case45_too_long_a_pause_is_refused_before) {
  const std::string tasks =
      " CONFIGURATION Plant RESOURCE Cpu ON Pc TASK Fast (INTERVAL := T#1ms, PRIORITY := 0); "
      "PROGRAM Main WITH Fast : Main; END_RESOURCE END_CONFIGURATION";
  std::string big = tasks + " PROGRAM Main VAR a : ARRAY[0..1999999] OF INT; END_VAR END_PROGRAM";
  std::string converted =
      tasks + " PROGRAM Main VAR a : ARRAY[0..1999999] OF LREAL; END_VAR END_PROGRAM";
  linker::Slack slack;
  slack.free_bytes = 32u << 20;
  Plant plant(big, slack);
  plant.run(1);
  base::Digest before = plant.hash();
  EXPECT_EQ(plant.refused(converted), Refusal::kPauseTooLong);
  EXPECT_EQ(plant.hash(), before);
  ASSERT_TRUE(plant.stage(plant.package(converted)).ok());
  EXPECT_TRUE(plant.driver().arm(false, true).ok());
  EXPECT_TRUE(plant.driver().switch_now().ok());
}

// One scan was longer than its period once. Admission looks at the last 500 to 1,000 scans, and
// forgets it when it is told to.
TEST(Admission, case68_OneLongScanIsForgotten) {
  const auto source = [](const char* amount) {
    return std::string("PROGRAM Main VAR rounds, i, n : DINT; END_VAR FOR i := 1 TO rounds DO ; "
                       "END_FOR rounds := 0; n := n + ") +
           amount + "; END_PROGRAM";
  };
  const auto overrun = [&](Plant& plant) {
    plant.set("Main.rounds", "20000");
    plant.run(3);
    ASSERT_GT(plant.controller().tasks().front().run.max, int64_t{10'000'000});
  };
  Plant plant(source("1"), {}, 1000);
  plant.run(2);
  overrun(plant);
  EXPECT_EQ(plant.refused(source("2")), Refusal::kPauseTooLong);
  plant.run(1400);
  plant.change(source("2"));
  plant.accept();
  overrun(plant);
  EXPECT_EQ(plant.refused(source("3")), Refusal::kPauseTooLong);
  plant.controller().reset_times();
  plant.run(1);
  plant.change(source("3"));
}

}  // namespace
}  // namespace online_change
