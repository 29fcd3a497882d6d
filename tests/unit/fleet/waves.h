// Roll-outs by waves over controllers of this process (X6-01 to X6-10). Time is virtual: each pause
// of the roll-out is one cycle of every controller.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "online_change/package/package.h"
#include "tests/unit/fleet/fleet_of_plcs.h"
#include "tools/stvm/fleet_roll.h"

namespace fleet_test {

using stvm::RollPhase;
using stvm::RollState;

inline constexpr const char* kHealth = "Main.errors <= baseline(Main.errors) + 2";

// `faulty` is of the controller, and no edit changes it; the edited version makes errors where it
// is TRUE.
inline std::string line_program(bool edited, bool faulty, int own = 0) {
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
    fleet_.edit(source_(false, false, 0), source_(true, false, 0));
    plan_ = {};
    dead_ = false;
    saves_left_ = SIZE_MAX;
    std::string list;
    for (int i = 1; i <= count; ++i) {
      const bool bad = std::find(faulty.begin(), faulty.end(), i) != faulty.end();
      const std::string name = "line" + std::to_string(i);
      fleet_.add(name, source_(false, bad, i));
      if (!plc(i).get("Main.level").starts_with("no")) {
        plc(i).set("Main.f.was", std::to_string(1000 + i));
        plc(i).set("Main.level", std::to_string(100 + i));
      }
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
  // Whether edited, whether faulty, and the number of the controller.
  std::function<std::string(bool, bool, int)> source_ = line_program;
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
inline std::string four_waves(const std::string& roll = {}) {
  return std::string("[roll]\nhealth = [\"") + kHealth + "\"]\nsoak = \"10s\"\n" + roll +
         "[[wave]]\ncount = 1\n[[wave]]\ncontrollers = [\"line3\", \"line2\"]\n"
         "[[wave]]\npercent = 35\nparallel = 4\n[[wave]]\npercent = 100\nparallel = 4\n";
}

}  // namespace fleet_test
