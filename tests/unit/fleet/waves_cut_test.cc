// X6-02, X6-05, X6-08, X6-09: tools that are killed, networks that are cut, two tools at once.
#include "tests/unit/fleet/waves.h"
#include "tools/stvm/condition_parse.h"

namespace fleet_test {
namespace {

// Killed before each write of the plan, and behind each: the next tool goes on, and nothing is done
// twice.
TEST_F(Waves, X602_AToolThatIsKilledAtAnyWriteIsResumed) {
  size_t writes = 0;
  for (size_t k = 0; k < 60; ++k) {
    for (const bool faulty : {false, true}) {
      SCOPED_TRACE("write " + std::to_string(k) + (faulty ? ", faulty" : ""));
      fleet_.clear();
      make(4, faulty ? std::vector<int>{3} : std::vector<int>{},
           std::string("[roll]\nhealth = [\"") + kHealth +
               "\"]\nsoak = \"5s\"\non_failure = \"undo-all\"\n" +
               "[[wave]]\ncount = 1\n[[wave]]\ncount = 3\n");
      saves_left_ = k;
      const base::Status first = roll();
      if (!first.ok()) {
        ++writes;
        cycle();
        ASSERT_TRUE(resume().ok());
      }
      EXPECT_EQ(plan_.phase, faulty ? RollPhase::kFailed : RollPhase::kDone);
      for (int line = 1; line <= 4; ++line) {
        EXPECT_EQ(runs_edit(line), !faulty) << line << ": " << states();
        EXPECT_LE(switches(line), faulty ? 2 : 1) << journal(line);
        if (!faulty) {
          EXPECT_EQ(switches(line), 1);
        }
        EXPECT_EQ(plc(line).status().edits, 0u);
        expect_values_kept(line, !faulty     ? Was::kEdited
                                 : line == 1 ? Was::kReverted
                                             : Was::kUndone);
      }
    }
  }
  EXPECT_GT(writes, 30u) << "so many were cut";
}

// The disk of the tool is full, and the network is well.
TEST_F(Waves, X602_NothingIsDoneThatCouldNotBeWritten) {
  make(2, {}, "[roll]\nsoak = \"2s\"\n[[wave]]\ncount = 1\n[[wave]]\ncount = 1\n");
  stvm::RollPorts full = ports();
  full.save = [](const stvm::RollPlan&) {
    return base::Status(base::Error{base::Refusal::kFileUnwritable, "full"});
  };
  stvm::FleetRoll roll(plan_, fleet_.edit(), access(), full);
  const base::Status ended = roll.run();
  ASSERT_FALSE(ended.ok());
  EXPECT_EQ(ended.error().text, "full");
  EXPECT_EQ(switches(1), 0);
}

// Killed between any two messages.
TEST_F(Waves, X602_AToolThatIsKilledAtAnyMessageIsResumed) {
  for (const bool faulty : {false, true}) {
    bool cut = true;
    size_t messages = 0;
    for (; cut; messages += 3) {
      SCOPED_TRACE(messages);
      fleet_.clear();
      make(2, faulty ? std::vector<int>{2} : std::vector<int>{},
           std::string("[roll]\nsoak = \"4s\"\non_failure = \"undo-all\"\nhealth = [\"") + kHealth +
               "\"]\n[[wave]]\ncount = 1\n[[wave]]\ncount = 1\n");
      size_t left = messages;
      fleet_.before_message = [&] {
        dead_ = dead_ || left == 0;
        if (dead_) saves_left_ = 0;
        if (!dead_) --left;
        return !dead_;
      };
      cut = !roll().ok();
      fleet_.before_message = {};
      if (cut) {
        cycle();
        ASSERT_TRUE(resume().ok());
      }
      EXPECT_EQ(plan_.phase, faulty ? RollPhase::kFailed : RollPhase::kDone) << states();
      EXPECT_EQ(switches(1), faulty ? 2 : 1) << journal(1);
      EXPECT_EQ(switches(2), 1) << journal(2);
      for (int line = 1; line <= 2; ++line) {
        EXPECT_EQ(plc(line).status().edits, 0u);
        EXPECT_EQ(runs_edit(line), !faulty);
      }
    }
    EXPECT_GT(messages, 30u);
  }
}

// The tool is gone for good, or the network: nobody accepts, so each goes back by itself.
TEST_F(Waves, X605_X608_WithoutANetworkEachControllerDecidesAlone) {
  make(4, {},
       "[roll]\nsoak = \"20s\"\nlost_after = \"5s\"\ndeadline = \"21s\"\n"
       "[[wave]]\ncount = 2\n[[wave]]\ncount = 2\n");
  int pauses = 0;
  at_pause_ = [&] {
    if (++pauses == 3) cut_ = {1, 2};
  };
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(plan_.phase, RollPhase::kFailed);
  EXPECT_EQ(states(), "lost lost skipped skipped");
  EXPECT_LT(pauses, 15) << "after lost_after, and not after the soak";
  EXPECT_EQ(plc(1).status().edits, 1u) << "its deadline is later";
  plc(1).run(21'100);
  plc(1).service().keep_up();
  EXPECT_EQ(plc(1).status().edits, 0u);
  EXPECT_NE(journal(1).find("undone controller: edit E1: plan 0badcafe wave 1 by ann: nobody has "
                            "accepted it by its deadline"),
            std::string::npos)
      << journal(1);
  expect_values_kept(1);
}

// One that comes back in time has lost nothing.
TEST_F(Waves, X608_AShortSilenceIsNoFailure) {
  make(2, {}, "[roll]\nsoak = \"20s\"\nlost_after = \"10s\"\n[[wave]]\ncount = 2\n");
  int pauses = 0;
  at_pause_ = [&] {
    ++pauses;
    cut_ = pauses > 3 && pauses < 9 ? std::set<int>{1} : std::set<int>{};
  };
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(states(), "accepted accepted");
}

TEST_F(Waves, X608_APowerCutOnTrialCountsAsAFailure) {
  make(2, {}, "[roll]\nsoak = \"20s\"\n[[wave]]\ncount = 2\n");
  int pauses = 0;
  at_pause_ = [&] {
    if (++pauses == 3) {
      ASSERT_TRUE(plc(2).boot().ok());
    }
  };
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(states(), "undone failed");
  EXPECT_EQ(plan_.members[1].text, "the trial ended with its controller");
}

TEST_F(Waves, X609_AnAbortTakesBackAllOpenTrials) {
  make(6, {},
       "[roll]\nsoak = \"20s\"\n[[wave]]\ncount = 1\n[[wave]]\ncount = 3\n"
       "[[wave]]\ncount = 2\n");
  at_pause_ = [&] {
    if (plan_.wave == 1) saves_left_ = 0;  // Ctrl-C
    if (plan_.wave == 1) dead_ = true;
  };
  now_ms_ += 5;
  EXPECT_FALSE(roll().ok());
  at_pause_ = {};
  dead_ = false;
  saves_left_ = SIZE_MAX;
  plan_ = *stvm::parse_plan("x.plan", stored_);
  for (int line = 2; line <= 4; ++line) EXPECT_EQ(plc(line).status().edits, 1u);
  stvm::FleetRoll roll(plan_, fleet_.edit(), access(), ports());
  ASSERT_TRUE(roll.abort().ok());
  EXPECT_EQ(states(), "accepted undone undone undone skipped skipped");
  EXPECT_EQ(plan_.phase, RollPhase::kAborted);
  for (int line = 2; line <= 4; ++line) {
    EXPECT_FALSE(runs_edit(line));
    expect_values_kept(line);
  }
  EXPECT_FALSE(roll.abort().ok()) << "it is over";
}

// It is sick, and a step is active that only the edit has: nobody accepts that.
TEST_F(Waves, X606_WhoCannotGoBackIsNotAccepted) {
  source_ = [](bool edited, bool, int) {
    return std::string(
               "PROGRAM Main VAR go : BOOL := TRUE; back : BOOL; ok : BOOL := TRUE; "
               "END_VAR INITIAL_STEP First: END_STEP STEP Second: END_STEP ") +
           (edited ? "STEP Third: Deny(N); END_STEP ACTION Deny: ok := FALSE; END_ACTION "
                     "TRANSITION FROM First TO Third := go; END_TRANSITION "
                     "TRANSITION FROM Third TO Second := back; END_TRANSITION "
                   : "TRANSITION FROM First TO Second := back; END_TRANSITION ") +
           "TRANSITION FROM Second TO First := back; END_TRANSITION END_PROGRAM";
  };
  make(3, {},
       "[roll]\nhealth = [\"Main.ok\"]\nsoak = \"20s\"\n[[wave]]\ncount = 1\n"
       "[[wave]]\ncount = 2\n");
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(states(), "stays skipped skipped");
  EXPECT_NE(plan_.members[0].text.find("R0313"), std::string::npos) << plan_.members[0].text;
  EXPECT_EQ(plan_.phase, RollPhase::kFailed);
  EXPECT_EQ(plc(1).status().edits, 1u);
}

// A second roll-out on the same controllers is refused by them, and by their check before.
TEST_F(Waves, X602_ASecondRollOutIsRefused) {
  make(2, {}, "[roll]\nsoak = \"20s\"\n[[wave]]\ncount = 2\n");
  int pauses = 0;
  at_pause_ = [&] {
    if (++pauses != 3) return;
    stvm::RollPlan other = *stvm::parse_plan("x.plan", with_members(plan_, 2));
    for (stvm::RollMember& row : other.members) {
      row.state = RollState::kWaiting;
      row.edit.clear();
    }
    other.id = "00000002";
    other.soak_from_ms = 0;
    Fleet edit;
    edit.edit(line_program(true, false), line_program(false, false));
    stvm::FleetAccess both = edit.access();
    both.connect = access().connect;
    stvm::FleetRoll second(other, edit.edit(), both, ports());
    for (const stvm::FleetRow& row : second.check_all()) {
      EXPECT_EQ(row.outcome, stvm::FleetOutcome::kRefused);
      ASSERT_TRUE(row.why.has_value());
      EXPECT_EQ(row.why->refusal, base::Refusal::kChangePending) << row.why->text;
    }
  };
  ASSERT_TRUE(roll().ok());
  EXPECT_EQ(states(), "accepted accepted");
  EXPECT_EQ(switches(1), 1);
}

// Nothing is changed by the check, and it says who cannot take the edit.
TEST_F(Waves, X602_TheCheckOfAllChangesNothing) {
  make(3, {}, "[roll]\nsoak = \"20s\"\nhealth = [\"Main.f.m >= 0\"]\n[[wave]]\ncount = 3\n");
  cut_ = {2};
  stvm::FleetRoll roll(plan_, fleet_.edit(), access(), ports());
  const std::vector<stvm::FleetRow> rows = roll.check_all();
  EXPECT_EQ(rows[0].outcome, stvm::FleetOutcome::kPossible);
  EXPECT_EQ(rows[1].outcome, stvm::FleetOutcome::kUnreachable);
  EXPECT_EQ(plc(1).status().edits + plc(3).status().edits, 0u);
  cut_.clear();
  plan_.settings.guard = {};
  size_t at = 0;
  ASSERT_TRUE(stvm::add_condition("Main.none > 1", plan_.settings.guard, at).ok());
  for (const stvm::FleetRow& row : roll.check_all()) {
    EXPECT_EQ(row.outcome, stvm::FleetOutcome::kRefused);
    EXPECT_EQ(row.why->refusal, base::Refusal::kNoSuchVariable);
  }
}

}  // namespace
}  // namespace fleet_test
