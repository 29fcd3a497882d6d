// A change that is refused because start code traps, whatever that wrote before (X1, case 34):
// values of version 1, the time that keeping them takes, and where nothing of it is needed.
#include "online_change/plan/pause.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using base::Refusal;
using plant::Plant;

// `blocks` are in Main: one writes what others own, one divides by `zero`.
std::string tank(const std::string& globals, const std::string& blocks, int size = 10) {
  return "FUNCTION_BLOCK Writes\n"
         "METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR VAR i : INT; "
         "END_VAR FOR i := 1 TO 10 DO level[i] := 77; END_FOR link^ := 5; link := NULL; "
         "name := 'another'; END_METHOD END_FUNCTION_BLOCK\n"
         "FUNCTION_BLOCK Traps VAR n : INT; END_VAR\n"
         "METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR "
         "n := 1 / zero; END_METHOD END_FUNCTION_BLOCK\n"
         "VAR_GLOBAL zero, shared : INT; link : REF_TO INT := REF(shared); name : STRING := "
         "'tank'; "
         "level : ARRAY[1.." +
         std::to_string(size) + "] OF INT; " + globals +
         " END_VAR\n"
         "PROGRAM Main VAR x : INT; " +
         blocks + " END_VAR x := x + 1; level[x] := x; END_PROGRAM";
}

// The new globals are where the old ones are, so that the switch writes over them.
linker::Slack no_slack() { return {0, 0, 0, 0, 0, 0, 64 * 1024, 0}; }
const std::string kBefore = tank("wide : DINT := 3;", "");
const std::string kAfter = tank("wide : REAL;", "w : Writes; t : Traps;");

// What the switch says, of a change that is armed with leave for losses.
Refusal switched(Plant& plant, const std::string& source) {
  EXPECT_TRUE(plant.stage(plant.package(source)).ok());
  EXPECT_TRUE(plant.driver().arm(true).ok());
  const auto report = plant.driver().switch_now();
  plant.driver().collect();
  return report.ok() ? Refusal::kInternal : report.error().refusal;
}

class KeptDataBy : public testing::TestWithParam<Strategy> {};
INSTANTIATE_TEST_SUITE_P(Strategies, KeptDataBy,
                         testing::Values(Strategy::kInPlace, Strategy::kStandby));

TEST_P(KeptDataBy, X1_case34_WhatFbInitWroteBeforeOneTrapsIsAsItWas) {
  Plant plant(kBefore, no_slack());
  plant.use(GetParam());
  plant.run(4);
  const base::Digest before = plant.hash();
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_EQ(switched(plant, kAfter), Refusal::kInitFailed);
    EXPECT_EQ(plant.hash(), before);
  }
  plant.controller().cycle();  // the traps are on record
  EXPECT_EQ(plant.get("level[3]"), "3");
  EXPECT_EQ(plant.get("link"), "shared");
  EXPECT_EQ(plant.get("name"), "'tank'");
  plant.set("zero", "1");
  plant.change(kAfter);
  EXPECT_EQ(plant.get("level[3]"), "77");
  plant.undo();
  EXPECT_EQ(plant.get("level[3]"), "77") << "undo of what was made is another matter";
}

TEST_P(KeptDataBy, X1_C1_EveryStepOfTheSwitchCanFail) {
  int points = 0;
  for (int fail_at = 0;; ++fail_at, ++points) {
    Plant plant(kBefore, no_slack());
    plant.run(3);
    const base::Digest before = plant.hash();
    Change& change = plant.driver();
    ASSERT_TRUE(change.stage(plant.package(kAfter), GetParam()).ok());
    ASSERT_TRUE(change.arm(true).ok());
    int passed = 0;
    change.set_interruption([&] { return passed++ == fail_at; });
    const auto report = change.switch_now();
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(plant.hash(), before) << fail_at;
    EXPECT_EQ(change.state(), State::kIdle);
    if (report.error().refusal == Refusal::kInitFailed) break;
    ASSERT_EQ(report.error().refusal, Refusal::kDeadline);
  }
  EXPECT_GE(points, 2);
}

// What is predicted for a program of so many variables and this change.
int64_t pause_of(Strategy strategy, int size, const char* globals, const char* blocks,
                 const char* blocks_before = "") {
  Plant plant(tank("", blocks_before, size));
  plant.run(1);
  EXPECT_TRUE(plant.driver().stage(plant.package(tank(globals, blocks, size)), strategy).ok());
  return plant.driver().predicted_pause_ns();
}

// In place all values are copied first, and the prediction says so.
TEST(KeptData, X1_C5_OnlyWhereStartCodeRunsThePauseFollowsTheData) {
  constexpr int kMany = 500'000;
  constexpr Strategy kHere = Strategy::kInPlace;
  constexpr int64_t kCopied = 2 * kMany / kPauseCopiedBytesPerNs;
  const auto difference = [](const char* globals, const char* blocks, const char* before) {
    return pause_of(kHere, kMany, globals, blocks, before) -
           pause_of(kHere, 10, globals, blocks, before);
  };
  EXPECT_GE(difference("", "w : Writes;", ""), kCopied);
  EXPECT_GE(difference("also : REF_TO INT := REF(zero);", "", ""), kCopied);
  EXPECT_EQ(difference("more : INT;", "", ""), 0);
  EXPECT_EQ(difference("more : INT;", "w : Writes;", "w : Writes;"), 0);
}

// A switch that takes too long so is refused, and the message names the way that needs no copy.
TEST(KeptData, X1_C5_TheRefusalSaysWhatTheTimeIsFor) {
  const std::string task =
      "CONFIGURATION C TASK Fast (INTERVAL := T#300us); PROGRAM Main WITH Fast : Main; "
      "END_CONFIGURATION\n";
  Plant plant(task + tank("", "", 5'000'000));
  plant.run(1);
  const base::Bytes package = plant.package(task + tank("", "w : Writes;", 5'000'000));
  ASSERT_TRUE(plant.driver().stage(package, Strategy::kInPlace).ok());
  const base::Status armed = plant.driver().arm(false);
  ASSERT_FALSE(armed.ok());
  EXPECT_EQ(armed.error().refusal, Refusal::kPauseTooLong);
  EXPECT_NE(armed.error().text.find("for keeping all values, as FB_Init runs in the switch"),
            std::string::npos)
      << armed.error().text;
}

}  // namespace
}  // namespace online_change
