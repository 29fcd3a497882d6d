// A trial over the end of a process (D4, cases 55 and 77): what boots, with which retained values,
// and whether each edit can still be taken back.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/tool_limits.h"
#include "online_change/store/edits_record.h"
#include "tests/unit/store/outage.h"

namespace stvm {
namespace {

using plc::Plc;

// Back to what was accepted, edit by edit.
void expect_all_ways_back(Plc& plc, const Outage& rig) {
  EXPECT_LT(std::stoi(plc.get("Main.n")), 18);  // is not retained, and began anew
  plc.run(2);
  EXPECT_EQ(plc.status().edits, 3u);
  EXPECT_EQ(plc.status().running, rig.digests[3]);
  EXPECT_EQ(plc.get("a"), "32767");
  EXPECT_EQ(plc.get("c"), "8");
  for (int left : {2, 1, 0}) {
    const base::Status undone = plc.undo();
    ASSERT_TRUE(undone.ok()) << base::to_string(undone.error());
    EXPECT_EQ(plc.status().running, rig.digests[static_cast<size_t>(left)]);
    plc.run(1);
  }
  EXPECT_EQ(plc.status().edits, 0u);
  EXPECT_EQ(plc.get("a"), "70000");  // nobody wrote it since it was narrowed
  EXPECT_EQ(plc.get("gone"), "44");
  EXPECT_EQ(plc.get("r"), "5");
}

TEST(Resume, D4_case77_ACleanStopKeepsTheTrialUnderBothPolicies) {
  for (const uint32_t policy : {0u, uint32_t{vm::kLastEditBoots}}) {
    Outage rig(policy);
    rig.three_edits();
    rig.plc.stop();
    sim::SimStorage disk = behind_cut(rig.disk);
    Plc plc(disk);
    ASSERT_TRUE(plc.boot().ok());
    EXPECT_TRUE(plc.found().alarms.empty());
    EXPECT_FALSE(plc.found().trial_lost.has_value());
    EXPECT_EQ(plc.status().last_edit_boots, policy != 0);
    expect_all_ways_back(plc, rig);
  }
}

TEST(Resume, D4_case55_UnderAcceptedAPowerLossLosesTheTrialAndSaysSo) {
  Outage rig(0);
  rig.three_edits();
  sim::SimStorage disk = behind_cut(rig.disk);
  Plc plc(disk);
  ASSERT_TRUE(plc.boot().ok());
  EXPECT_EQ(plc.status().running, rig.digests[0]);
  EXPECT_EQ(plc.status().trial_lost, rig.digests[3]);
  EXPECT_EQ(plc.status().edits, 0u);
  EXPECT_EQ(plc.get("a"), "70000");
  EXPECT_EQ(plc.get("gone"), "44");
  EXPECT_EQ(plc.store().history().back().event, online_change::Event::kStarted);
  EXPECT_EQ(std::prev(plc.store().history().end(), 2)->event, online_change::Event::kTrialLost);
}

// A clean stop counts once: the policy is that of the edit again as soon as it has started.
TEST(Resume, D4_BehindACleanStopAPowerLossLosesTheTrial) {
  Outage rig(0);
  rig.three_edits();
  rig.plc.stop();
  sim::SimStorage stopped = behind_cut(rig.disk);
  Plc plc(stopped);
  ASSERT_TRUE(plc.boot().ok());
  ASSERT_EQ(plc.status().edits, 3u);
  sim::SimStorage disk = behind_cut(stopped);
  Plc later(disk);
  ASSERT_TRUE(later.boot().ok());
  EXPECT_EQ(later.status().running, rig.digests[0]);
  EXPECT_EQ(later.status().trial_lost, rig.digests[3]);
}

TEST(Resume, D4_case55_UnderLastEditThePowerLossKeepsTheTrialAndItsWaysBack) {
  Outage rig(vm::kLastEditBoots);
  rig.three_edits();
  sim::SimStorage disk = behind_cut(rig.disk);
  for (int again = 0; again < 2; ++again) {  // and once more
    Plc plc(disk);
    ASSERT_TRUE(plc.boot().ok());
    EXPECT_TRUE(plc.found().alarms.empty());
    EXPECT_TRUE(plc.status().last_edit_boots);
    EXPECT_EQ(plc.status().boots_next, rig.digests[0]);
    if (again == 1) expect_all_ways_back(plc, rig);
  }
}

TEST(Resume, D4_ATrialThatGoesOnIsAcceptedAndGetsMoreEdits) {
  Outage rig(vm::kLastEditBoots);
  rig.change(1);
  rig.change(2);
  sim::SimStorage disk = behind_cut(rig.disk);
  Plc plc(disk);
  ASSERT_TRUE(plc.boot().ok());
  ASSERT_TRUE(plc.change(outage_source(3), rig.flags).ok());
  EXPECT_EQ(plc.status().edits, 3u);
  ASSERT_TRUE(plc.ask({.command = vm::Command::kAccept, .names = {"E1"}}).ok());
  sim::SimStorage later_disk = behind_cut(disk);
  Plc later(later_disk);
  ASSERT_TRUE(later.boot().ok());
  EXPECT_EQ(later.status().edits, 2u);
  ASSERT_TRUE(later.undo().ok());
  ASSERT_TRUE(later.undo().ok());
  EXPECT_EQ(later.status().running, rig.digests[1]);
  EXPECT_EQ(later.get("gone"), "44");
  EXPECT_EQ(later.get("a"), "32767");
  ASSERT_TRUE(later.change(outage_source(2), rig.flags).ok());
  ASSERT_TRUE(later.accept().ok());
  sim::SimStorage last_disk = behind_cut(later_disk);
  Plc last(last_disk);
  ASSERT_TRUE(last.boot().ok());
  EXPECT_EQ(last.status().edits, 0u);
  EXPECT_FALSE(last.found().trial_lost.has_value());
}

TEST(Resume, D4_AnEditThatComesAgainKeepsItsPolicy) {
  Outage rig(vm::kLastEditBoots);
  rig.three_edits();
  ASSERT_TRUE(rig.plc.undo().ok());
  ASSERT_TRUE(rig.plc.ask(vm::Command::kRedo).ok());
  vm::Request go{.command = vm::Command::kSwitch};
  go.flags = vm::kAllowLoss | vm::kAllowOverrun;
  ASSERT_TRUE(rig.plc.ask(std::move(go)).ok());
  EXPECT_TRUE(rig.plc.status().last_edit_boots);
  sim::SimStorage disk = behind_cut(rig.disk);
  Plc plc(disk);
  ASSERT_TRUE(plc.boot().ok());
  EXPECT_EQ(plc.status().edits, 3u);
}

// What cannot be resumed is lost, and that is said.
TEST(Resume, D4_WithoutTheListOfEditsTheAcceptedProgramBoots) {
  Outage rig(vm::kLastEditBoots);
  rig.three_edits();
  for (const bool gone : {true, false}) {
    sim::SimStorage left = behind_cut(rig.disk);
    if (gone) left.remove(online_change::kEditsFile);
    if (!gone) {
      ASSERT_TRUE(left.write(online_change::kEditsFile, 700, base::Bytes(40, 0xee)).ok());
      ASSERT_TRUE(left.sync(online_change::kEditsFile).ok());
    }
    sim::SimStorage disk = behind_cut(left);
    Plc plc(disk);
    ASSERT_TRUE(plc.boot().ok());
    EXPECT_EQ(plc.status().running, rig.digests[0]);
    EXPECT_EQ(plc.status().trial_lost, rig.digests[3]);
    ASSERT_FALSE(plc.found().alarms.empty());
    EXPECT_NE(plc.found().alarms.front().find("cannot be resumed"), std::string::npos);
    EXPECT_EQ(plc.get("a"), "70000");
    EXPECT_TRUE(plc.change(outage_source(1), rig.flags).ok());
  }
}

// What is read from the file of edits is what a controller writes, or nothing.
TEST(Resume, D4_AListOfEditsIsWhatAControllerWritesOrNothing) {
  using online_change::StoredEdit;
  const auto decoded = [](const std::vector<StoredEdit>& edits) {
    return online_change::decode_edits(online_change::encode(edits));
  };
  StoredEdit edit{"E7", "pat", 1, 2, 3, 4, {}, {}, {5, 6}, 7, {8}};
  edit.from[0] = 9;
  const auto back = decoded({edit, edit});
  ASSERT_TRUE(back && back->size() == 2);
  EXPECT_EQ(back->back().name, "E7");
  EXPECT_EQ(back->back().from, edit.from);
  EXPECT_EQ(back->back().package, edit.package);
  EXPECT_EQ(back->back().retained, edit.retained);

  EXPECT_TRUE(decoded(std::vector<StoredEdit>(base::kMostEditsOnTrial, edit)));
  EXPECT_FALSE(decoded(std::vector<StoredEdit>(base::kMostEditsOnTrial + 1, edit)));
  for (const char* name : {"", "E", "7", "E7\x1b[2J", "E-1", "E1234567890123456789", "F1"}) {
    edit.name = name;
    EXPECT_FALSE(decoded({edit})) << name;
  }
  edit.name = "E7";
  base::Bytes bytes = online_change::encode({edit, edit});
  while (!bytes.empty()) {
    bytes.pop_back();
    EXPECT_FALSE(online_change::decode_edits(bytes)) << bytes.size();
  }
}

// The migration holds with the values of a running program; with those of a start it divides by 0.
TEST(Resume, D4_WithoutAWayBackNothingIsUndoneAndTheNextStartRunsWhatWasAccepted) {
  const auto source = [](const std::string& migration, const std::string& member, int step) {
    return migration + "FUNCTION_BLOCK Tank VAR d : INT; " + member + " END_VAR d := 2; " +
           "END_FUNCTION_BLOCK PROGRAM Main VAR t : Tank; n : INT; END_VAR t(); n := n + " +
           std::to_string(step) + "; END_PROGRAM";
  };
  const std::string divides =
      "{migration of := 'Tank'} FUNCTION Divide VAR_INPUT d : INT; END_VAR VAR_OUTPUT q : INT; "
      "END_VAR q := 8 / d; END_FUNCTION ";
  sim::SimStorage disk;
  base::Digest accepted{};
  {
    Plc plc(disk);
    ASSERT_TRUE(plc.boot(source("", "", 1)).ok());
    plc.run(2);
    accepted = plc.status().running;
    ASSERT_TRUE(plc.change(source("", "", 2), vm::kLastEditBoots).ok());
    const base::Status migrated =
        plc.change(source(divides, "q : INT;", 3), vm::kLastEditBoots | vm::kAllowLoss);
    ASSERT_TRUE(migrated.ok()) << base::to_string(migrated.error());
    plc.run(2);
  }
  sim::SimStorage cut = behind_cut(disk);
  sim::SimStorage again = cut;
  {
    Plc plc(cut);
    ASSERT_TRUE(plc.boot().ok());
    plc.run(2);
    ASSERT_FALSE(plc.status().alarms.empty());
    EXPECT_NE(plc.status().alarms.front().find("no way back"), std::string::npos);
    EXPECT_EQ(plc.status().edits, 0u);
    const base::Status undone = plc.undo();
    ASSERT_FALSE(undone.ok());
    EXPECT_EQ(undone.error().refusal, base::Refusal::kNothingToUndo);
    plc.run(2);
    again = behind_cut(cut);
  }
  Plc plc(again);
  ASSERT_TRUE(plc.boot().ok());
  EXPECT_EQ(plc.status().running, accepted);
}

TEST(Resume, D4_AnotherProgramOnTheCommandLineEndsTheTrial) {
  Outage rig(vm::kLastEditBoots);
  rig.three_edits();
  sim::SimStorage disk = behind_cut(rig.disk);
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(outage_source(2)).ok());
  EXPECT_EQ(plc.status().edits, 0u);
  EXPECT_EQ(plc.get("r"), "5");
}

// X5: a power cut at every call to storage leaves what was before the step or what it makes, with
// all ways back.
TEST(Resume, D4_X5_case77_APowerCutAtEveryWriteLeavesTheTrialBeforeOrBehind) {
  Outage rig(vm::kLastEditBoots);
  const auto ask = [&](vm::Command command, const char* name) {
    return rig.plc.ask({.command = command, .names = {name}}).ok();
  };
  const std::vector<std::function<bool()>> steps = {
      [&] { return rig.plc.change(outage_source(1), rig.flags).ok(); },
      [&] { return rig.plc.change(outage_source(2), rig.flags).ok(); },
      [&] { return rig.plc.save().ok(); },
      [&] { return rig.plc.change(outage_source(3), rig.flags).ok(); },
      [&] { return rig.plc.undo().ok(); },
      [&] { return rig.plc.change(outage_source(3), rig.flags).ok(); },
      [&] { return ask(vm::Command::kAccept, "E1"); },
      [&] { return rig.plc.undo().ok(); },
      [&] { return rig.plc.undo().ok(); },
      [&] { return rig.plc.change(outage_source(2), rig.flags).ok(); },
      [&] { return rig.plc.accept().ok(); },
  };
  size_t tried = 0;
  for (size_t step = 0; step < steps.size(); ++step) {
    std::vector<sim::SimStorage> left;
    const vm::StatusReport before = rig.plc.status();
    rig.disk.before_call = [&] {
      left.push_back(behind_cut(rig.disk));
      if (!rig.disk.dirty().empty()) left.push_back(rig.disk.after_kill());
    };
    const bool done = steps[step]();
    rig.disk.before_call = nullptr;
    ASSERT_TRUE(done) << "step " << step;
    const vm::StatusReport now = rig.plc.status();
    for (sim::SimStorage& disk : left) {
      ++tried;
      Plc plc(disk);
      ASSERT_TRUE(plc.boot().ok()) << "step " << step;
      const vm::StatusReport found = plc.status();
      ASSERT_TRUE(found.running == before.running || found.running == now.running)
          << "step " << step << ", " << tried;
      EXPECT_TRUE(found.edits == before.edits || found.edits == now.edits) << "step " << step;
      EXPECT_EQ(plc.get("r"), "5") << "step " << step;
      while (plc.status().edits != 0) ASSERT_TRUE(plc.undo().ok()) << "step " << step;
      const base::Digest last = plc.status().running;
      EXPECT_TRUE(last == before.boots_next || last == now.boots_next) << "step " << step;
      if (last == rig.digests[0]) {
        EXPECT_EQ(plc.get("a"), "70000") << "step " << step;
        EXPECT_EQ(plc.get("gone"), "44") << "step " << step;
      }
    }
  }
  EXPECT_GT(tried, 100u);
}

// The newest edit does not boot, so the list of edits is without it; the one below it does. An undo
// is cut behind its record, before it has saved any values: those of the edit that went lead back.
TEST(Resume, D4_X5_case77_ACutInTheUndoOfAnEditThatDoesNotBootLosesNoRetainedValue) {
  Outage rig(vm::kLastEditBoots);
  rig.change(1);
  ASSERT_TRUE(rig.plc.change(outage_source(2), vm::kAllowLoss).ok());
  rig.plc.set("r", "6");
  rig.plc.set("a", "11");
  ASSERT_TRUE(rig.plc.save().ok());
  std::vector<sim::SimStorage> left;
  rig.disk.before_call = [&] { left.push_back(behind_cut(rig.disk)); };
  ASSERT_TRUE(rig.plc.undo().ok());
  rig.disk.before_call = nullptr;
  size_t resumed = 0;
  for (sim::SimStorage& disk : left) {
    Plc plc(disk);
    ASSERT_TRUE(plc.boot().ok());
    if (plc.status().running != rig.digests[1]) continue;
    ++resumed;
    EXPECT_TRUE(plc.found().alarms.empty());
    EXPECT_EQ(plc.get("r"), "6");
    EXPECT_EQ(plc.get("a"), "11");
  }
  EXPECT_GT(resumed, 1u);
}

// A cut comes before the newest edit has saved any values, so the newest ones are of the edit
// below, whose program another process has written. Undo leads back to it, and that is durable.
TEST(Resume, D4_X5_case77_AnUndoBehindACutIsDurable) {
  Outage rig(vm::kLastEditBoots);
  rig.change(1);
  ASSERT_TRUE(rig.plc.save().ok());
  std::vector<sim::SimStorage> left;
  rig.disk.before_call = [&] { left.push_back(behind_cut(rig.disk)); };
  rig.change(2);
  rig.disk.before_call = nullptr;
  size_t undone = 0;
  for (sim::SimStorage& disk : left) {
    Plc plc(disk);
    ASSERT_TRUE(plc.boot().ok());
    if (plc.status().running != rig.digests[2]) continue;
    ++undone;
    ASSERT_TRUE(plc.undo().ok());
    EXPECT_EQ(plc.get("r"), "5");
    sim::SimStorage cut = behind_cut(disk);
    Plc again(cut);
    ASSERT_TRUE(again.boot().ok());
    EXPECT_EQ(again.status().running, rig.digests[1]);
    EXPECT_EQ(again.get("r"), "5");
  }
  EXPECT_GT(undone, 0u);
}

// What the second edit dropped has the value that it had until then, and not the one of when the
// trial began; what the trial wrote and no edit dropped stays.
TEST(Resume, X5_case77_ValuesOfALostTrialComeBackEditByEdit) {
  Outage rig(0);
  rig.change(1);
  rig.plc.set("gone", "55");
  rig.change(2);
  rig.plc.set("r", "9");
  rig.change(3);
  ASSERT_TRUE(rig.plc.save().ok());
  sim::SimStorage disk = behind_cut(rig.disk);
  Plc plc(disk);
  ASSERT_TRUE(plc.boot().ok());
  EXPECT_EQ(plc.status().running, rig.digests[0]);
  EXPECT_TRUE(plc.found().alarms.empty());
  EXPECT_EQ(plc.get("gone"), "55");
  EXPECT_EQ(plc.get("r"), "9");
  EXPECT_EQ(plc.get("a"), "70000");  // nobody wrote it since it was narrowed
}

// Wherever the cut comes around the second edit.
TEST(Resume, X5_case77_ACutAroundTheSecondEditLosesNoValue) {
  Outage rig(0);
  rig.change(1);
  rig.plc.set("gone", "55");
  ASSERT_TRUE(rig.plc.save().ok());
  std::vector<sim::SimStorage> left;
  rig.disk.before_call = [&] { left.push_back(behind_cut(rig.disk)); };
  rig.change(2);
  ASSERT_TRUE(rig.plc.save().ok());
  rig.disk.before_call = nullptr;
  size_t lost = 0;
  for (sim::SimStorage& disk : left) {
    Plc plc(disk);
    ASSERT_TRUE(plc.boot().ok());
    if (plc.status().trial_lost == rig.digests[2]) ++lost;
    EXPECT_EQ(plc.get("gone"), "55");
  }
  EXPECT_GT(lost, 1u);
}

TEST(Resume, X5_case77_ValuesOfALostTrialComeBackThroughNewNames) {
  const auto with = [](const std::string& variable) {
    return "VAR_GLOBAL RETAIN " + variable +
           "; END_VAR PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM";
  };
  sim::SimStorage disk;
  {
    Plc plc(disk);
    ASSERT_TRUE(plc.boot(with("x : INT := 5")).ok());
    ASSERT_TRUE(plc.change(with("{renamed from := 'x'} y : DINT := 5"), 0).ok());
    ASSERT_TRUE(plc.change(with("{renamed from := 'y'} z : LINT := 5"), 0).ok());
    plc.set("z", "9");
    ASSERT_TRUE(plc.save().ok());
  }
  sim::SimStorage left = behind_cut(disk);
  Plc plc(left);
  ASSERT_TRUE(plc.boot().ok());
  EXPECT_EQ(plc.get("x"), "9");
}

// The program is made again from the list of edits; its values are there all the same.
TEST(Resume, X5_case56_WithoutItsSlotATrialKeepsItsValues) {
  for (const char* slot : {"slot_b", "slot_c"}) {  // slot_a has what was accepted
    for (const uint32_t policy : {0u, uint32_t{vm::kLastEditBoots}}) {
      Outage rig(policy);
      rig.change(1);
      rig.plc.set("r", "7");
      rig.change(2);
      rig.plc.set("r", "8");
      ASSERT_TRUE(rig.plc.save().ok());
      rig.plc.stop();
      sim::SimStorage disk = behind_cut(rig.disk);
      disk.remove(slot);
      Plc plc(disk);
      ASSERT_TRUE(plc.boot().ok());
      EXPECT_EQ(plc.get("r"), "8") << slot;
      EXPECT_EQ(plc.get("a"), "32767") << slot;
    }
  }
}

}  // namespace
}  // namespace stvm
