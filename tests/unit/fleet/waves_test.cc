// X6-01 to X6-10: an edit goes out by waves to twenty controllers of this process.
#include "tests/unit/fleet/waves.h"

namespace fleet_test {
namespace {

TEST_F(Waves, X601_X602_X610_AHealthyEditGoesThroughFourWaves) {
  make(20, {}, four_waves());
  at_pause_ = [&] {
    // Nobody of a later wave has it before the one at work is accepted.
    for (size_t i = 0; i < plan_.members.size(); ++i) {
      if (plan_.wave_of(i) > plan_.wave) {
        EXPECT_EQ(switches(static_cast<int>(i) + 1), 0);
      }
      if (plan_.wave_of(i) < plan_.wave) {
        EXPECT_EQ(plan_.members[i].state, RollState::kAccepted);
      }
    }
  };
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(plan_.phase, RollPhase::kDone);
  EXPECT_EQ(begun_, "1234");
  EXPECT_EQ(stvm::plan_exit_code(plan_), 0);
  for (int line = 1; line <= 20; ++line) {
    EXPECT_EQ(state(line), RollState::kAccepted) << line;
    EXPECT_EQ(switches(line), 1);
    EXPECT_EQ(plc(line).status().edits, 0u);
    EXPECT_TRUE(runs_edit(line));
    expect_values_kept(line, Was::kEdited);
    const std::string wave = line == 1 ? "1" : line <= 3 ? "2" : line <= 10 ? "3" : "4";
    const std::string noted = "plan 0badcafe wave " + wave + " by ann";
    EXPECT_NE(journal(line).find("switched ann: edit E1, fleet file " +
                                 base::short_hex(plan_.digest) + ", " + noted),
              std::string::npos)
        << journal(line);
    EXPECT_NE(journal(line).find("accepted ann: edit E1, " + noted), std::string::npos)
        << journal(line);
  }
}

// FALSE at the boundary behind cycle k, and the version before runs from cycle k + 1 on.
TEST_F(Waves, X604_X605_X607_ACanaryThatFailsIsUndoneAndNobodyElseIsTouched) {
  make(20, {1}, four_waves());
  ASSERT_TRUE(roll().ok());
  const std::string noted = journal(1);
  const size_t at = noted.find("is FALSE in cycle ");
  ASSERT_NE(at, std::string::npos) << noted;
  const uint64_t failed_at = std::stoull(noted.substr(at + 18));
  for (const auto& entry : plc(1).store().history()) {
    if (entry.event == online_change::Event::kUndone) {
      EXPECT_EQ(entry.cycle, failed_at + 1) << "the first of the version before";
    }
  }
  EXPECT_NE(noted.find("plan 0badcafe wave 1 by ann: `" + std::string(kHealth) + "`"),
            std::string::npos)
      << noted;
  EXPECT_NE(noted.find("Main.errors = 6, baseline(Main.errors) = 1"), std::string::npos) << noted;
  EXPECT_EQ(plan_.phase, RollPhase::kFailed);
  EXPECT_EQ(stvm::plan_exit_code(plan_), 7);
  EXPECT_EQ(state(1), RollState::kFailed);
  EXPECT_FALSE(runs_edit(1));
  expect_values_kept(1);
  for (int line = 2; line <= 20; ++line) {
    EXPECT_EQ(switches(line), 0);
    EXPECT_EQ(state(line), RollState::kSkipped);
  }
}

// What somebody has brought before is no canary: nobody has watched it, and nobody accepts it.
TEST_F(Waves, X602_NoRollOutBeginsWhereTheEditIsOnTrial) {
  make(2, {}, "[roll]\nsoak = \"3s\"\n[[wave]]\ncount = 1\n[[wave]]\npercent = 100\n");
  const stvm::FleetMember first = fleet_.members()[0];
  stvm::SwitchOptions how = quietly();
  how.switch_flags |= vm::kAllowLoss;
  stvm::FleetChange change(fleet_.edit(), how, fleet_.access());
  stvm::FleetRow row = change.visit(first);
  EXPECT_EQ(row.outcome, stvm::FleetOutcome::kDone) << base::to_string(*row.why);
  {
    stvm::FleetRoll roll(plan_, fleet_.edit(), access(), ports());
    const std::vector<stvm::FleetRow> rows = roll.check_all();
    EXPECT_EQ(rows[0].outcome, stvm::FleetOutcome::kRefused);
    EXPECT_EQ(rows[0].why->refusal, base::Refusal::kChangePending);
    EXPECT_EQ(rows[1].outcome, stvm::FleetOutcome::kPossible);
  }
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(states(), "refused skipped");
  EXPECT_EQ(plan_.phase, RollPhase::kFailed);
  EXPECT_EQ(plc(1).status().edits, 1u) << "it stays as it was";
  // Accepted, it is what the edit makes.
  EXPECT_EQ(stvm::FleetAccept(fleet_.edit(), quietly(), fleet_.access()).visit(first).outcome,
            stvm::FleetOutcome::kAccepted);
  stvm::FleetRoll again(plan_, fleet_.edit(), access(), ports());
  EXPECT_EQ(again.check_all()[0].outcome, stvm::FleetOutcome::kHadIt);
}

TEST_F(Waves, X607_TheThirdWaveFailsAndAllAreTakenBack) {
  make(20, {5, 7}, four_waves("on_failure = \"undo-all\"\nmax_failed = 1\n"));
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(plan_.phase, RollPhase::kFailed);
  for (int line = 1; line <= 20; ++line) {
    const bool faulty = line == 5 || line == 7;
    EXPECT_EQ(state(line), faulty       ? RollState::kFailed
                           : line <= 10 ? RollState::kUndone
                                        : RollState::kSkipped)
        << line << " " << plan_.members[static_cast<size_t>(line) - 1].text;
    EXPECT_FALSE(runs_edit(line)) << line;
    expect_values_kept(line, line <= 3 ? Was::kReverted : Was::kUndone);
    EXPECT_EQ(plc(line).status().edits, 0u);
  }
}

// By default accepted waves stay, and one failure that max_failed permits stops nothing.
TEST_F(Waves, X607_AWaveMayHaveAsManyFailuresAsItSays) {
  make(20, {5}, four_waves("max_failed = 1\n"));
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(plan_.phase, RollPhase::kDone);
  EXPECT_EQ(stvm::plan_exit_code(plan_), 1);
  for (int line = 1; line <= 20; ++line) {
    EXPECT_EQ(state(line), line == 5 ? RollState::kFailed : RollState::kAccepted);
  }
}

TEST_F(Waves, X607_OtherwiseEarlierWavesKeepIt) {
  make(20, {5}, four_waves());
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(plan_.phase, RollPhase::kFailed);
  for (int line = 1; line <= 3; ++line) EXPECT_EQ(state(line), RollState::kAccepted);
  EXPECT_TRUE(runs_edit(2));
  EXPECT_FALSE(runs_edit(9));
}

TEST_F(Waves, X601_AllWavesCanBeAcceptedAtTheEnd) {
  make(6, {},
       std::string("[roll]\nsoak = \"5s\"\naccept = \"at-end\"\n") +
           "[[wave]]\ncount = 2\n[[wave]]\ncount = 4\n");
  at_pause_ = [&] { EXPECT_EQ(plc(1).status().edits, 1u); };
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(states(), "accepted accepted accepted accepted accepted accepted");
}

}  // namespace
}  // namespace fleet_test
