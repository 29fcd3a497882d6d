// X2, X5: migrations of retained values at a start: another program on the command line, and a
// trial that ended with the power.
#include <gtest/gtest.h>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {
namespace {

const char* const kEnd =
    " END_VAR ; END_FUNCTION_BLOCK PROGRAM P VAR a, b : Motor; END_VAR a(); b(); END_PROGRAM\n";

std::string motor(const std::string& variables, const std::string& migrations = {}) {
  return migrations + "FUNCTION_BLOCK Motor VAR RETAIN " + variables + kEnd;
}

// Seconds of turning from minutes and a divisor; and back.
const char* const kThere =
    "{migration of := 'Motor'} FUNCTION F VAR_INPUT {old := 'turns'} n : DINT; d : DINT; END_VAR "
    "VAR_OUTPUT {new := 'turns'} whole : DINT; END_VAR whole := n / d; END_FUNCTION ";
const char* const kBack =
    "{migration of := 'Motor', inverse} FUNCTION G VAR_INPUT {new := 'turns'} n : DINT; d : DINT; "
    "END_VAR VAR_OUTPUT {old := 'turns'} whole : DINT; END_VAR whole := n * d; END_FUNCTION ";
const char* const kOldVariables = "turns : DINT := 6; d : DINT := 3;";
const char* const kNewVariables = "more : INT; d : DINT := 3; turns : DINT := 5;";

class Start : public ::testing::Test {
 protected:
  void SetUp() override { begin(motor(kOldVariables)); }
  void begin(const std::string& source) {
    disk_ = sim::SimStorage();
    plc_ = std::make_unique<Plc>(disk_);
    ASSERT_TRUE(plc_->boot(source).ok());
    plc_->run(1);
  }
  void cut() {
    disk_ = disk_.after_cut(sim::SimStorage::Choice(disk_.dirty().size(), 0));
    plc_ = std::make_unique<Plc>(disk_);
  }
  // After a save, a cut, and with that on the command line.
  void start_with(const std::string& source) {
    ASSERT_TRUE(plc_->save().ok());
    const ir::VerifiedImage next = build(source, &plc_->controller().image());
    cut();
    const base::Status booted = plc_->boot(std::optional(next));
    ASSERT_TRUE(booted.ok()) << base::to_string(booted.error());
  }
  void lose_trial() {
    cut();
    ASSERT_TRUE(plc_->boot().ok());
    EXPECT_TRUE(plc_->found().trial_lost.has_value());
  }
  std::string alarms() const {
    std::string all;
    for (const std::string& alarm : plc_->found().alarms) all += alarm + "\n";
    return all;
  }

  sim::SimStorage disk_;
  std::unique_ptr<Plc> plc_;
};

// Case 62: what has become another type keeps its retained values as well, and by a lost trial it
// is again what it was.
TEST_F(Start, X2_case62_AnotherTypeTakesOverRetainedValues) {
  const auto line = [](const char* type, const std::string& migration) {
    return "FUNCTION_BLOCK A VAR RETAIN n : INT := 1; m : INT; END_VAR ; END_FUNCTION_BLOCK "
           "FUNCTION_BLOCK B VAR RETAIN m : DINT; n : INT; sum : DINT; END_VAR ; "
           "END_FUNCTION_BLOCK " +
           migration + "PROGRAM P VAR f : " + type + "; END_VAR f(); END_PROGRAM\n";
  };
  const std::string rule =
      "{migration of := 'B', from := 'A'} FUNCTION A_to_B VAR_INPUT n, m : INT; END_VAR VAR_OUTPUT "
      "sum : DINT; END_VAR sum := n + m; END_FUNCTION ";
  begin(line("A", ""));
  plc_->set("P.f.n", "20");
  plc_->set("P.f.m", "3");
  ASSERT_TRUE(plc_->save().ok());
  ASSERT_TRUE(plc_->change(line("B", rule)).ok());
  EXPECT_EQ(plc_->get("P.f.sum"), "23");
  plc_->set("P.f.n", "21");
  ASSERT_TRUE(plc_->save().ok());
  lose_trial();
  EXPECT_EQ(plc_->get("P.f.n"), "21");
  EXPECT_EQ(plc_->get("P.f.m"), "3");
  start_with(line("B", rule));
  EXPECT_EQ(alarms(), "");
  EXPECT_EQ(plc_->get("P.f.n"), "21");
  EXPECT_EQ(plc_->get("P.f.m"), "3");
  EXPECT_EQ(plc_->get("P.f.sum"), "24");
}

// Only values that are retained as a whole; each names itself when it cannot be.
TEST_F(Start, X2_EachRetainedValueOfAStructureIsMigrated) {
  const auto points = [](const char* members, const char* migration) {
    return "TYPE Point : STRUCT " + std::string(members) + " END_STRUCT END_TYPE " + migration +
           "VAR_GLOBAL RETAIN row : ARRAY[1..3] OF Point; END_VAR VAR_GLOBAL one : Point; END_VAR "
           "PROGRAM P END_PROGRAM\n";
  };
  begin(points("x : INT := 1;", ""));
  plc_->set("row[2].x", "20");
  plc_->set("one.x", "30");
  start_with(points("pad : INT; mm : DINT;",
                    "{migration of := 'Point'} FUNCTION F VAR_INPUT x : INT; END_VAR VAR_OUTPUT "
                    "mm : DINT; END_VAR mm := INT_TO_DINT(x) * 10; END_FUNCTION "));
  EXPECT_EQ(alarms(), "");
  EXPECT_EQ(plc_->get("row[1].mm"), "10");
  EXPECT_EQ(plc_->get("row[2].mm"), "200");
  EXPECT_EQ(plc_->get("one.mm"), "0") << "not retained";
}

TEST_F(Start, X2_AnotherProgramMigratesWhatIsRetained) {
  plc_->set("P.a.turns", "600");
  plc_->set("P.b.turns", "90");
  plc_->set("P.b.d", "9");
  start_with(motor(kNewVariables, kThere));
  EXPECT_EQ(alarms(), "");
  EXPECT_EQ(plc_->get("P.a.turns"), "200");
  EXPECT_EQ(plc_->get("P.b.turns"), "10");
  EXPECT_EQ(plc_->get("P.b.d"), "9");
  // It has been done, and is not done again.
  start_with(motor(kNewVariables, kThere));
  EXPECT_EQ(plc_->get("P.a.turns"), "200");
}

TEST_F(Start, X2_case60_OneThatTrapsIsInitialisedWithAnAlarmAndTheOthersAreMade) {
  plc_->set("P.a.turns", "600");
  plc_->set("P.a.d", "0");
  plc_->set("P.b.turns", "90");
  start_with(motor(kNewVariables, kThere));
  EXPECT_NE(alarms().find("`F` for `P.a`"), std::string::npos) << alarms();
  EXPECT_NE(alarms().find("initialised"), std::string::npos) << alarms();
  EXPECT_EQ(plc_->get("P.a.turns"), "5");
  EXPECT_EQ(plc_->get("P.a.d"), "0");
  EXPECT_EQ(plc_->get("P.b.turns"), "30");
}

TEST_F(Start, X2_case60_OneThatDoesNotEndIsInitialised) {
  const std::string endless =
      "{migration of := 'Motor'} FUNCTION F VAR_INPUT {old := 'turns'} n : DINT; END_VAR "
      "VAR_OUTPUT {new := 'turns'} whole : DINT; END_VAR WHILE TRUE DO whole := n; END_WHILE "
      "END_FUNCTION ";
  start_with(motor(kNewVariables, endless));
  EXPECT_NE(alarms().find("does not end"), std::string::npos) << alarms();
  EXPECT_NE(alarms().find("and 1 more"), std::string::npos) << alarms();
  EXPECT_EQ(plc_->get("P.a.turns"), "5");
}

// Only what is retained is there to be read.
TEST_F(Start, X2_OneThatReadsWhatIsNotRetainedIsInitialised) {
  begin(motor("turns : DINT := 6; END_VAR VAR d : DINT := 3;"));
  plc_->set("P.a.turns", "600");
  start_with(motor(kNewVariables, kThere));
  EXPECT_NE(alarms().find("not retained"), std::string::npos) << alarms();
  EXPECT_EQ(plc_->get("P.a.turns"), "5");
  // What it makes is not retained: nothing is lost, and nobody is alarmed.
  begin(motor(kOldVariables));
  start_with(motor("d : DINT; END_VAR VAR turns : DINT := 5;", kThere));
  EXPECT_EQ(alarms(), "");
  EXPECT_EQ(plc_->get("P.a.turns"), "5");
}

// A program that was made for another one than the one that ran.
TEST_F(Start, X2_OneThatFitsNoVariableIsAnAlarm) {
  begin(motor("turns : STRING; d : DINT;"));
  start_with(motor(kNewVariables, kThere));
  EXPECT_NE(alarms().find("migration `F`"), std::string::npos) << alarms();
  EXPECT_EQ(plc_->get("P.a.turns"), "5");
}

TEST_F(Start, X5_case55_ALostTrialGivesBackWhatWasBeforeIt) {
  plc_->set("P.a.turns", "601");
  ASSERT_TRUE(plc_->change(motor(kNewVariables, kThere)).ok());
  EXPECT_EQ(plc_->get("P.a.turns"), "200");
  lose_trial();
  EXPECT_EQ(plc_->get("P.a.turns"), "601");
  EXPECT_EQ(alarms(), "");
}

// What nobody wrote since is as it was; the rest comes from the inverse.
TEST_F(Start, X2_X5_case55_ALostTrialMigratesBack) {
  plc_->set("P.a.turns", "601");
  plc_->set("P.b.turns", "90");
  ASSERT_TRUE(plc_->change(motor(kNewVariables, std::string(kThere) + kBack)).ok());
  plc_->set("P.b.turns", "40");
  ASSERT_TRUE(plc_->save().ok());
  lose_trial();
  EXPECT_EQ(alarms(), "");
  EXPECT_EQ(plc_->get("P.a.turns"), "601");
  EXPECT_EQ(plc_->get("P.b.turns"), "120");
  // The same once more: nothing was saved since.
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("P.a.turns"), "601");
  EXPECT_EQ(plc_->get("P.b.turns"), "120");
}

TEST_F(Start, X2_X5_case60_AnInverseThatTrapsLeavesTheValueFromBefore) {
  const std::string traps =
      "{migration of := 'Motor', inverse} FUNCTION G VAR_INPUT {new := 'turns'} n : DINT; END_VAR "
      "VAR_OUTPUT {old := 'turns'} whole : DINT; END_VAR whole := 1 / (n - 7); END_FUNCTION ";
  plc_->set("P.a.turns", "601");
  ASSERT_TRUE(plc_->change(motor(kNewVariables, std::string(kThere) + traps)).ok());
  plc_->set("P.a.turns", "7");
  ASSERT_TRUE(plc_->save().ok());
  lose_trial();
  EXPECT_NE(alarms().find("before the trial"), std::string::npos) << alarms();
  EXPECT_EQ(plc_->get("P.a.turns"), "601");
}

}  // namespace
}  // namespace plc
