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

// --- FB_Exit: whatever it wrote before one traps is as it was, there and back --------------------

// `exits` leave with a switch to the program without them, and with the undo of one that brings
// them; the last one traps as long as `zero` is 0.
std::string leaving_tank(const std::string& blocks, const std::string& more = "") {
  return "FUNCTION_BLOCK Leaves VAR n : INT; END_VAR\n"
         "METHOD FB_Exit : BOOL VAR_INPUT bInCopyCode : BOOL; END_VAR level[2] := 55; exits := "
         "exits + 1; n := 9; lamp := TRUE; link := NULL; END_METHOD END_FUNCTION_BLOCK\n"
         "FUNCTION_BLOCK Stays VAR n : INT; inits : INT; END_VAR\n"
         "METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR inits := "
         "inits + 1; END_METHOD\n"
         "METHOD FB_Exit : BOOL VAR_INPUT bInCopyCode : BOOL; END_VAR n := 100 / zero; END_METHOD "
         "END_FUNCTION_BLOCK\n"
         "VAR_GLOBAL zero, exits, shared : INT; link : REF_TO INT := REF(shared); lamp AT %QX0.1 : "
         "BOOL; level : ARRAY[1..10] OF INT; " +
         more +
         " END_VAR\n"
         "PROGRAM Main VAR x : INT; " +
         blocks + " END_VAR x := x + 1; level[3] := x; END_PROGRAM";
}
const std::string kLeaving = "a : Leaves; b : Stays;";

TEST_P(KeptDataBy, X1_case34_AnFbInitThatTakesLongerThanABasePeriodIsNoChange) {
  const auto source = [](const std::string& block) {
    return "FUNCTION_BLOCK Slow METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; "
           "END_VAR VAR i : DINT; END_VAR FOR i := 1 TO rounds DO inits := i; END_FOR END_METHOD "
           "END_FUNCTION_BLOCK\n"
           "VAR_GLOBAL rounds : DINT := 100_000; inits : DINT; END_VAR\n"
           "PROGRAM Main VAR x : INT; " +
           block +
           " END_VAR x := x + 1; END_PROGRAM\n"
           "CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#10ms, PRIORITY := 1); "
           "PROGRAM Main WITH T : Main; END_RESOURCE END_CONFIGURATION";
  };
  Plant plant(source(""), no_slack(), 1000);
  plant.use(GetParam());
  plant.run(4);
  EXPECT_EQ(switched(plant, source("s : Slow;")), Refusal::kInitFailed);
  EXPECT_EQ(plant.get("inits"), "0");
  EXPECT_FALSE(plant.controller().faulted());
  plant.controller().cycle();  // the trap is on record
  EXPECT_EQ(plant.get("Main.x"), "5");
  plant.set("rounds", "2_000");
  plant.change(source("s : Slow;"), true);
  EXPECT_EQ(plant.get("inits"), "2000");
}

TEST_P(KeptDataBy, X1_case34_WhatFbExitWroteBeforeOneTrapsInASwitchIsAsItWas) {
  Plant plant(leaving_tank(kLeaving), no_slack());
  plant.use(GetParam());
  plant.run(4);
  const base::Digest before = plant.hash();
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_EQ(switched(plant, leaving_tank("")), Refusal::kExitFailed);
    EXPECT_EQ(plant.hash(), before);
  }
  plant.controller().cycle();  // the traps are on record
  EXPECT_EQ(plant.get("exits"), "0");
  EXPECT_EQ(plant.get("Main.b.inits"), "1") << "nothing has left, so nothing is made anew";
  EXPECT_EQ(plant.devices().sent.back()[0], 0) << "lamp was never sent";
  plant.set("zero", "1");
  plant.change(leaving_tank(""), true);
  EXPECT_EQ(plant.get("exits"), "1");
  EXPECT_EQ(plant.get("level[2]"), "55");
}

TEST_P(KeptDataBy, X1_case34_WhatFbExitWroteBeforeOneTrapsInAnUndoIsAsItWas) {
  Plant plant(leaving_tank(""), no_slack());
  plant.use(GetParam());
  plant.run(2);
  plant.change(leaving_tank(kLeaving, "wide : LREAL;"));
  plant.run(3);
  const base::Digest before = plant.hash();
  for (int turn = 0; turn < 2; ++turn) {
    ASSERT_TRUE(plant.driver().prime().ok());
    EXPECT_EQ(plant.driver().undo().error().refusal, Refusal::kExitFailed);
    EXPECT_EQ(plant.driver().on_trial(), 1u);
    EXPECT_EQ(plant.hash(), before);
  }
  plant.controller().cycle();
  EXPECT_EQ(plant.get("Main.b.inits"), "1");
  EXPECT_EQ(plant.get("Main.x"), "6");
  EXPECT_EQ(plant.devices().sent.back()[0], 0);
  plant.set("zero", "1");
  plant.undo();
  EXPECT_EQ(plant.get("exits"), "1");
  EXPECT_EQ(plant.driver().on_trial(), 0u);
}

// The way out where one traps whatever happens: none of them runs, and all else is undone.
TEST_P(KeptDataBy, X4_case34_AnUndoWithoutFbExitGoesBackAllTheSame) {
  Plant plant(leaving_tank("", "narrow : INT := 5;"), no_slack());
  plant.use(GetParam());
  plant.run(2);
  plant.change(leaving_tank(kLeaving, "narrow : SINT;"), true);
  plant.run(3);
  ASSERT_TRUE(plant.driver().prime().ok());
  ASSERT_EQ(plant.driver().undo().error().refusal, Refusal::kExitFailed);
  ASSERT_EQ(plant.driver().leaving().size(), 2u);
  ASSERT_TRUE(plant.driver().undo(Exits::kSkip).ok());
  plant.driver().collect();
  EXPECT_EQ(plant.driver().on_trial(), 0u);
  EXPECT_TRUE(plant.driver().leaving().empty());
  EXPECT_EQ(plant.get("exits"), "0") << "that of the others has not run either";
  EXPECT_EQ(plant.get("level[2]"), "0");
  EXPECT_EQ(plant.get("narrow"), "5");
  EXPECT_EQ(plant.get("Main.x"), "5");
  plant.controller().cycle();
  EXPECT_EQ(plant.get("Main.x"), "6");
  EXPECT_EQ(plant.controller().trap_count(), 1u);
}

// What ends a switch or an undo behind FB_Exit.
TEST_P(KeptDataBy, X1_C1_WhatFbExitWroteIsAsItWasWhereverItEnds) {
  for (const bool back : {false, true}) {
    int points = 0;
    for (int fail_at = 0;; ++fail_at, ++points) {
      Plant plant(leaving_tank(back ? "" : kLeaving), no_slack());
      plant.use(GetParam());
      plant.run(2);
      plant.set("zero", "1");
      Change& change = plant.driver();
      if (back) {
        plant.change(leaving_tank(kLeaving));
        plant.run(1);
        ASSERT_TRUE(change.prime().ok());
      } else {
        ASSERT_TRUE(plant.stage(plant.package(leaving_tank(""))).ok());
        ASSERT_TRUE(change.arm(true).ok());
      }
      const base::Digest before = plant.hash();
      int passed = 0;
      change.set_interruption([&] { return passed++ == fail_at; });
      const auto report = back ? change.undo() : change.switch_now();
      if (report.ok()) break;
      EXPECT_EQ(report.error().refusal, Refusal::kDeadline);
      EXPECT_EQ(plant.hash(), before) << fail_at;
      plant.controller().cycle();
      EXPECT_EQ(plant.devices().sent.back()[0], 0) << "lamp was never sent, " << fail_at;
    }
    EXPECT_GE(points, 3) << back;
  }
}

// The copies that this needs are expected to take their time, by both strategies.
TEST_P(KeptDataBy, X1_C5_KeepingAllValuesForFbExitIsInThePrediction) {
  constexpr int kMany = 500'000;
  constexpr int64_t kCopied = 2 * kMany / kPauseCopiedBytesPerNs;
  int64_t there[2] = {};
  int64_t back[2] = {};
  for (const bool large : {false, true}) {
    const std::string more =
        large ? "much : ARRAY[1.." + std::to_string(kMany) + "] OF INT;" : std::string();
    Plant plant(leaving_tank(kLeaving, more));
    plant.use(GetParam());
    plant.run(1);
    ASSERT_TRUE(plant.stage(plant.package(leaving_tank("", more))).ok());
    there[large] = plant.driver().predicted_pause_ns();
    plant.driver().cancel();
    ASSERT_TRUE(plant.stage(plant.package(leaving_tank(kLeaving + "c : Leaves;", more))).ok());
    ASSERT_TRUE(plant.driver().arm(true, true).ok());
    ASSERT_TRUE(plant.driver().switch_now().ok());
    back[large] = plant.driver().predicted_pause_ns();
  }
  EXPECT_GE(there[1] - there[0], kCopied);
  EXPECT_GE(back[1] - back[0], kCopied);
}

// Behind a restart all FB_Init are due. Those of version 1 run before version 2 takes its place.
TEST_P(KeptDataBy, X1_case34_ASwitchWaitsForTheStartCodeOfARestart) {
  const auto before = [](const std::string& more) {
    return tank(more, "w : Writes; t : Traps;");
  };
  Plant plant(tank("", ""), no_slack());
  plant.use(GetParam());
  plant.set("zero", "1");
  plant.change(before(""));
  plant.accept();
  plant.run(2);
  ASSERT_TRUE(plant.stage(plant.package(before("more : INT;"))).ok());
  ASSERT_TRUE(plant.driver().arm(false).ok());
  (void)plant.controller().restart(vm::Restart::kCold, 0).ok();
  const base::Digest reset = plant.hash();
  const auto early = plant.driver().switch_now();
  ASSERT_FALSE(early.ok());
  EXPECT_EQ(early.error().refusal, Refusal::kBusy);
  EXPECT_EQ(plant.driver().state(), State::kArmed);
  EXPECT_EQ(plant.hash(), reset) << "no FB_Init has written anything";
  plant.set("zero", "1");
  plant.controller().cycle();
  EXPECT_EQ(plant.controller().trap_count(), 0u);
  ASSERT_TRUE(plant.driver().switch_now().ok());
  EXPECT_EQ(plant.get("level[3]"), "77");
  EXPECT_EQ(plant.get("Main.x"), "1");
}

}  // namespace
}  // namespace online_change
