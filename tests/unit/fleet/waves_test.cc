// X6-01 to X6-10: an edit goes out by waves to twenty controllers of this process. Time is virtual:
// each pause of the roll-out is one cycle of every controller.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "online_change/package/package.h"
#include "tests/unit/fleet/fleet_of_plcs.h"
#include "tools/stvm/condition_parse.h"
#include "tools/stvm/fleet_roll.h"

namespace fleet_test {
namespace {

using stvm::RollPhase;
using stvm::RollState;

constexpr const char* kHealth = "Main.errors <= baseline(Main.errors) + 2";

// `faulty` is of the controller, and no edit changes it; the edited version makes errors where it
// is TRUE.
std::string line_program(bool edited, bool faulty, int own = 0) {
  const std::string is_faulty = faulty ? "TRUE" : "FALSE";
  return std::string("FUNCTION_BLOCK Filler VAR_OUTPUT n, m : INT; ") +
         (edited ? "" : "was : INT; ") + "END_VAR n := n + " + (edited ? "10; m := m + 1" : "1") +
         "; END_FUNCTION_BLOCK\n"
         "FUNCTION Mine : INT Mine := " +
         std::to_string(own) + "; END_FUNCTION\n" +
         "FUNCTION Faulty : BOOL Faulty := " + is_faulty +
         "; END_FUNCTION\n"
         "PROGRAM Main VAR f : Filler; errors : INT := 1; zero : INT; level : INT; c : INT; "
         "END_VAR f(); c := Mine(); IF f.m >= 3 AND Faulty() THEN errors := errors + 5; END_IF "
         "END_PROGRAM\n"
         "CONFIGURATION x RESOURCE r ON cpu TASK t (INTERVAL := T#1ms, PRIORITY := 1);"
         " PROGRAM Main WITH t : Main; END_RESOURCE END_CONFIGURATION";
}

class Waves : public ::testing::Test {
 protected:
  // line1 to line`count`; those of `faulty` have the edit make errors.
  void make(int count, const std::vector<int>& faulty, const std::string& roll_table) {
    fleet_.edit(line_program(false, false), line_program(true, false));
    plan_ = {};
    dead_ = false;
    saves_left_ = SIZE_MAX;
    std::string list;
    for (int i = 1; i <= count; ++i) {
      const bool bad = std::find(faulty.begin(), faulty.end(), i) != faulty.end();
      const std::string name = "line" + std::to_string(i);
      fleet_.add(name, line_program(false, bad, i));
      plc(i).set("Main.f.was", std::to_string(1000 + i));
      plc(i).set("Main.level", std::to_string(100 + i));
      list += "[controllers." + name + "]\nhost = \"" + name + "\"\n";
    }
    plan_.list = list + roll_table;
    plan_.id = "0badcafe";
    plan_.who = "ann";
    plan_.file = "x.fleet";
    plan_.digest = fleet_.edit().digest;
    plan_.switch_flags = vm::kAllowOverrun | vm::kAllowLoss;
    base::Result<stvm::RollPlan> read = stvm::parse_plan("x.plan", with_members(plan_, count));
    ASSERT_TRUE(read.ok()) << base::to_string(read.error());
    plan_ = *read;
    stored_ = stvm::plan_text(plan_);
  }
  static std::string with_members(stvm::RollPlan plan, int count) {
    plan.members.resize(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i) {
      plan.members[static_cast<size_t>(i)].member.place = "line" + std::to_string(i + 1);
    }
    return stvm::plan_text(plan);
  }
  plc::Plc& plc(int line) { return fleet_.plc("line" + std::to_string(line)); }

  // A cycle of all controllers, and a look of each server's thread.
  void cycle() {
    for (size_t i = 1; i <= fleet_.members().size(); ++i) {
      if (cut_.count(static_cast<int>(i)) != 0 && stands_) continue;
      plc(static_cast<int>(i)).run(1);
      plc(static_cast<int>(i)).service().keep_up();
    }
  }
  stvm::RollPorts ports() {
    stvm::RollPorts ports;
    ports.now_ms = [this] { return now_ms_; };
    ports.pause_ms = [this](int64_t ms) {
      now_ms_ += ms;
      cycle();
      if (at_pause_) at_pause_();
    };
    ports.save = [this](const stvm::RollPlan& plan) -> base::Status {
      if (dead_ || saves_left_ == 0) {
        dead_ = true;
        return base::Error{base::Refusal::kFileUnwritable, "killed"};
      }
      --saves_left_;
      stored_ = stvm::plan_text(plan);
      return base::Ok{};
    };
    ports.may_begin = [this](const stvm::RollPlan& plan) -> base::Status {
      begun_ += std::to_string(plan.wave + 1);
      return base::Ok{};
    };
    ports.say = [](const std::string&) {};
    ports.package_back = [](const base::Bytes& running, const base::Bytes& before) {
      auto made = online_change::make_package(running, before);
      return made.ok() ? base::Result<base::Bytes>(online_change::encode(*made)) : made.error();
    };
    return ports;
  }
  stvm::FleetAccess access() {
    stvm::FleetAccess access = fleet_.access();
    access.connect = [this](const stvm::FleetMember& member) {
      const int line = std::stoi(member.name.substr(4));
      if (dead_ || cut_.count(line) != 0) {
        return base::Result<stvm::ControllerClient>(
            base::Error{base::Refusal::kNotRunning, "cut off"});
      }
      return fleet_.connect(member.name, "ann");
    };
    return access;
  }
  base::Status roll() {
    stvm::FleetRoll roll(plan_, fleet_.edit(), access(), ports());
    return roll.run();
  }
  // Another tool, from the plan on the disk.
  base::Status resume() {
    dead_ = false;
    saves_left_ = SIZE_MAX;
    plan_ = *stvm::parse_plan("x.plan", stored_);
    return roll();
  }

  RollState state(int line) const { return plan_.members[static_cast<size_t>(line - 1)].state; }
  std::string states() const {
    std::string out;
    for (const stvm::RollMember& row : plan_.members) {
      out += (out.empty() ? "" : " ") + std::string(stvm::roll_state_name(row.state));
    }
    return out;
  }
  bool runs_edit(int line) {
    plc::Plc& one = plc(line);
    const int n = std::stoi(one.get("Main.f.n"));
    one.run(1);
    return std::stoi(one.get("Main.f.n")) == n + 10;
  }
  int switches(int line) {
    int count = 0;
    for (const auto& entry : plc(line).store().history()) {
      count += entry.event == online_change::Event::kSwitched;
    }
    return count;
  }
  std::string journal(int line) {
    std::string text;
    for (const auto& entry : plc(line).store().history()) {
      text += std::string(online_change::event_name(entry.event)) + " " + entry.who + ": " +
              entry.text + "\n";
    }
    return text;
  }
  // `was` goes with the edit, and comes back with an undo; after a revert it begins anew.
  enum class Was { kUndone, kEdited, kReverted };
  void expect_values_kept(int line, Was what = Was::kUndone) {
    const std::string was = what == Was::kUndone   ? std::to_string(1000 + line)
                            : what == Was::kEdited ? "no Main.f.was"
                                                   : "0";
    EXPECT_EQ(plc(line).get("Main.f.was"), was);
    EXPECT_EQ(plc(line).get("Main.level"), std::to_string(100 + line));
    EXPECT_EQ(plc(line).get("Main.c"), std::to_string(line));
  }

  Fleet fleet_;
  stvm::RollPlan plan_;
  std::string stored_;
  std::string begun_;
  int64_t now_ms_ = 1'000'000;
  size_t saves_left_ = SIZE_MAX;
  bool dead_ = false;
  bool stands_ = false;
  std::set<int> cut_;
  std::function<void()> at_pause_;
};

// Four waves of 1, 2, 7 and 10.
std::string four_waves(const std::string& roll = {}) {
  return std::string("[roll]\nhealth = [\"") + kHealth + "\"]\nsoak = \"10s\"\n" + roll +
         "[[wave]]\ncount = 1\n[[wave]]\ncontrollers = [\"line3\", \"line2\"]\n"
         "[[wave]]\npercent = 35\nparallel = 4\n[[wave]]\npercent = 100\nparallel = 4\n";
}

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
