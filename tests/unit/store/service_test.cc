// D4, X5, cases 55 and 56 with whole controllers: disks that fail at every call, files that are gone,
// control records that nobody can read, and the journal.
#include <gtest/gtest.h>

#include <random>

#include "tests/unit/sanitized.h"
#include "tests/unit/store/lives.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {
namespace {

// --- disks that fail ----------------------------------------------------------------

// Whatever call fails: what is refused has not happened, and the old program runs on.
TEST(Service, case56_AChangeThatCannotBeStoredIsRefused) {
  for (const char* name : {"open", "write", "sync"}) {
    for (int number = 1, reached = 1; reached != 0; ++number) {
      sim::SimStorage disk;
      Plc plc(disk);
      ASSERT_TRUE(plc.boot(source(1)).ok());
      ASSERT_TRUE(set_and_save(plc, 3));
      int calls = 0;
      reached = 0;
      disk.fails = [&](std::string_view call) {
        if (call != name || ++calls != number) return sim::Failure::kNone;
        reached = 1;
        return sim::Failure::kError;
      };
      const base::Digest before = plc.status().running;
      const base::Status changed = plc.change(source(2));
      const vm::StatusReport now = plc.status();
      EXPECT_EQ(changed.ok(), now.running != before) << name << " " << number;
      EXPECT_EQ(now.boots_next, before);
      if (!changed.ok()) {
        EXPECT_EQ(changed.error().refusal, base::Refusal::kStorageFailed);
        EXPECT_EQ(now.change, "idle");
      }
      plc.run(1);
      EXPECT_EQ(plc.get("r"), "3");
      if (now.running != before) {
        EXPECT_TRUE(plc.undo().ok()) << "undo needs no disk";
        EXPECT_EQ(plc.status().running, before);
      }
      sim::SimStorage later = disk.after_cut(sim::SimStorage::Choice(disk.dirty().size(), 0));
      EXPECT_EQ(found(later, {nullptr, {1}, {3}}), "") << name << " " << number;
    }
  }
}

// The disk fails from some call on, for a while in which people go on trying, and is well again:
// then everything works as before, without a restart.
TEST(Service, X5_case56_BehindAFaultOfTheDiskChangesArePossibleAgain) {
  for (int first = 0; first < 60; ++first) {
    sim::SimStorage disk;
    Plc plc(disk);
    ASSERT_TRUE(plc.boot(source(1)).ok());
    ASSERT_TRUE(set_and_save(plc, 3));
    int calls = 0;
    disk.fails = [&](std::string_view call) {
      return call != "read" && calls++ >= first ? sim::Failure::kError : sim::Failure::kNone;
    };
    (void)plc.change(source(2)).ok();
    (void)plc.save().ok();
    (void)plc.accept().ok();
    (void)plc.change(source(3)).ok();
    (void)plc.undo().ok();
    (void)plc.change(source(3)).ok();
    disk.fails = nullptr;
    while (plc.status().edits != 0) ASSERT_TRUE(plc.undo().ok());
    const int next = version_of(plc) == 2 ? 3 : 2;
    const base::Status changed = plc.change(source(next));
    ASSERT_TRUE(changed.ok()) << first << ": " << base::to_string(changed.error());
    ASSERT_TRUE(plc.accept().ok()) << first;
    ASSERT_TRUE(set_and_save(plc, 8)) << first;
    EXPECT_TRUE(plc.store().renew().ok());
    EXPECT_TRUE(plc.status().alarms.empty()) << plc.status().alarms.front();
    sim::SimStorage later = disk.after_cut(sim::SimStorage::Choice(disk.dirty().size(), 0));
    EXPECT_EQ(found(later, {nullptr, {next}, {8}}), "") << first;
  }
}

TEST(Service, TheStateOfTheRetainedValuesIsAnAlarmOfStatus) {
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(source(1)).ok());
  disk.fails = [](std::string_view) { return sim::Failure::kError; };
  EXPECT_FALSE(plc.save().ok());
  const std::vector<std::string> alarms = plc.status().alarms;
  ASSERT_FALSE(alarms.empty());
  EXPECT_EQ(alarms.front().find("retained values are not being saved since 1970-01-01T"), 0u)
      << alarms.front();
  disk.fails = nullptr;
  EXPECT_TRUE(plc.save().ok());
  EXPECT_TRUE(plc.store().renew().ok());
  EXPECT_TRUE(plc.status().alarms.empty()) << plc.status().alarms.front();
}

// Whatever file is removed while a change is on trial: an accept is refused, or what it promises
// holds.
TEST(Service, AnAcceptWhoseFilesAreGoneIsRefusedOrHolds) {
  sim::SimStorage all;
  Plc first(all);
  ASSERT_TRUE(first.boot(source(1)).ok());
  const std::vector<std::string> names = all.names();
  for (size_t removed = 1; removed < size_t{1} << names.size(); removed += kOneOf) {
    sim::SimStorage disk;
    Plc plc(disk);
    ASSERT_TRUE(plc.boot(source(1)).ok());
    ASSERT_TRUE(set_and_save(plc, 3));
    ASSERT_TRUE(plc.change(source(2)).ok());
    ASSERT_TRUE(set_and_save(plc, 4));
    for (size_t i = 0; i < names.size(); ++i) {
      if ((removed >> i & 1) != 0) disk.remove(names[i]);
    }
    base::Status accepted = plc.accept();
    if (!accepted.ok()) accepted = plc.accept();
    ASSERT_TRUE(accepted.ok()) << removed << ": " << base::to_string(accepted.error());
    sim::SimStorage later = disk.after_cut(sim::SimStorage::Choice(disk.dirty().size(), 0));
    EXPECT_EQ(found(later, {nullptr, {2}, {4}}), "") << removed;
  }
}

// The folder itself is gone: no file comes back.
TEST(Service, AnAcceptWithoutAFolderIsRefused) {
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(source(1)).ok());
  ASSERT_TRUE(plc.change(source(2)).ok());
  for (const std::string& name : disk.names()) disk.remove(name);
  disk.fails = [](std::string_view) { return sim::Failure::kError; };
  for (int i = 0; i < 3; ++i) {
    const base::Status accepted = plc.accept();
    ASSERT_FALSE(accepted.ok());
    EXPECT_EQ(accepted.error().refusal, base::Refusal::kStorageFailed);
  }
  EXPECT_EQ(plc.status().change, "trial");
  EXPECT_FALSE(plc.status().alarms.empty());
  EXPECT_TRUE(plc.undo().ok());
}

TEST(Service, case56_AnAcceptThatCannotBeStoredLeavesTheTrial) {
  // Four calls keep the version before, without which the accept goes on (X8); then come payload,
  // header and sync.
  for (int number = 5; number <= 7; ++number) {
    sim::SimStorage disk;
    Plc plc(disk);
    ASSERT_TRUE(plc.boot(source(1)).ok());
    ASSERT_TRUE(plc.change(source(2)).ok());
    int calls = 0;
    disk.fails = [&](std::string_view call) {
      if (call == "open" || call == "read" || call == "check") return sim::Failure::kNone;
      return ++calls == number ? sim::Failure::kError : sim::Failure::kNone;
    };
    const base::Status accepted = plc.accept();
    ASSERT_FALSE(accepted.ok());
    EXPECT_NE(accepted.error().text.find("still on trial"), std::string::npos);
    EXPECT_EQ(plc.status().change, "trial");
    EXPECT_FALSE(plc.status().alarms.empty());
    EXPECT_TRUE(plc.undo().ok());
    EXPECT_EQ(plc.get("only1"), "0");
  }
}

// X8: what cannot be kept of the version before stands in nobody's way, and no other one comes back.
TEST(Service, X8_TheVersionBeforeIsKept) {
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(source(1)).ok());
  EXPECT_EQ(plc.store().before().error().refusal, base::Refusal::kNothingToUndo);
  const base::Digest first = plc.status().running;
  ASSERT_TRUE(plc.change(source(2)).ok());
  EXPECT_EQ(plc.store().before().error().refusal, base::Refusal::kNothingToUndo);
  ASSERT_TRUE(plc.accept().ok());
  ASSERT_TRUE(plc.store().before().ok());
  EXPECT_EQ(plc.store().before()->digest, first);

  ASSERT_TRUE(plc.change(source(3)).ok());
  disk.fails = [&](std::string_view call) {
    return call == "rename" ? sim::Failure::kError : sim::Failure::kNone;
  };
  EXPECT_TRUE(plc.accept().ok());
  disk.fails = nullptr;
  // The older one is not the version before this one.
  EXPECT_EQ(plc.store().before().error().refusal, base::Refusal::kNothingToUndo);
}

// --- nobody knows what boots ----------------------------------------------------------

void spoil(sim::SimStorage& disk, const std::string& which, std::mt19937& random) {
  const std::vector<std::string> names = disk.names();
  for (size_t file = 0; file < names.size(); ++file) {
    if (names[file].find(which) != 0) continue;
    for (uint8_t& byte : disk.content(file)) byte = static_cast<uint8_t>(random());
    disk.settle(file);
  }
}

// The program that was accepted last is held with its values, and runs when somebody says so.
TEST(Service, case56_WithoutAControlRecordTheProgramIsHeldInFault) {
  std::mt19937 random(1);
  for (const bool changed : {false, true}) {
    sim::SimStorage disk;
    {
      Plc plc(disk);
      ASSERT_TRUE(plc.boot(source(1)).ok());
      if (changed) {
        ASSERT_TRUE(plc.change(source(2), vm::kPermanent | vm::kAllowLoss).ok());
      }
      ASSERT_TRUE(set_and_save(plc, 5));
    }
    spoil(disk, "control_", random);
    Plc plc(disk);
    ASSERT_TRUE(plc.boot().ok());
    EXPECT_EQ(version_of(plc), changed ? 2 : 1);
    vm::StatusReport now = plc.status();
    EXPECT_TRUE(now.faulted);
    ASSERT_FALSE(now.alarms.empty());
    EXPECT_NE(now.alarms.front().find("both control records"), std::string::npos);
    plc.run(3);
    EXPECT_EQ(plc.get("P.n"), "0") << "it must not run";
    EXPECT_EQ(plc.change(source(3)).error().refusal, base::Refusal::kFault);
    for (const vm::Restart kind : {vm::Restart::kHot, vm::Restart::kWarm}) {
      vm::Request restart{.command = vm::Command::kRestart};
      restart.flags = static_cast<uint32_t>(kind);
      ASSERT_TRUE(plc.ask(restart).ok());
    }
    plc.run(3);
    EXPECT_EQ(plc.get("P.n"), "3");
    EXPECT_EQ(plc.get("r"), "5");
    EXPECT_FALSE(plc.status().faulted);
    EXPECT_TRUE(plc.status().alarms.empty()) << plc.status().alarms.front();
    sim::SimStorage later = disk.after_cut(sim::SimStorage::Choice(disk.dirty().size(), 0));
    EXPECT_EQ(found(later, {nullptr, {changed ? 2 : 1}, {5}}), "");
  }
}

// What was on trial is not what is held.
TEST(Service, case56_WithoutAControlRecordATrialIsNotHeld) {
  std::mt19937 random(2);
  sim::SimStorage disk;
  {
    Plc plc(disk);
    ASSERT_TRUE(plc.boot(source(1)).ok());
    ASSERT_TRUE(plc.change(source(2)).ok());
    ASSERT_TRUE(set_and_save(plc, 5));
  }
  spoil(disk, "control_", random);
  Plc plc(disk);
  ASSERT_TRUE(plc.boot().ok());
  EXPECT_EQ(version_of(plc), 1);
  EXPECT_TRUE(plc.status().faulted);
}

// --- journal ------------------------------------------------------------------------

TEST(Service, TheJournalSaysWhoChangedWhatWithWhichFates) {
  using online_change::Event;
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(source(1)).ok());
  const base::Digest first = plc.status().running;
  EXPECT_FALSE(plc.change(source(2), 0).ok()) << "losses are not allowed";
  ASSERT_TRUE(plc.ask(vm::Command::kCancel).ok());
  ASSERT_TRUE(plc.change(source(2)).ok());
  const base::Digest second = plc.status().running;
  ASSERT_TRUE(plc.undo().ok());
  ASSERT_TRUE(plc.change(source(2), vm::kPermanent | vm::kAllowLoss).ok());
  vm::Request restart{.command = vm::Command::kRestart};
  restart.flags = static_cast<uint32_t>(vm::Restart::kWarm);
  ASSERT_TRUE(plc.ask(restart).ok());
  auto entries = online_change::read_journal(disk, online_change::kJournalFile);
  ASSERT_TRUE(entries.ok());
  std::vector<Event> events;
  for (const auto& entry : *entries) {
    events.push_back(entry.event);
    if (entry.event == Event::kSwitched || entry.event == Event::kAccepted) {
      EXPECT_EQ(entry.from, first);
      EXPECT_EQ(entry.to, second);
    }
    if (entry.event == Event::kUndone) {
      EXPECT_EQ(entry.from, second);
      EXPECT_EQ(entry.to, first);
    }
    if (entry.event == Event::kSwitched) {
      EXPECT_GT(entry.counts.total(), 0u);
      EXPECT_GT(entry.predicted_ns, 0);
      EXPECT_GT(entry.measured_ns, 0);
    }
    if (entry.event == Event::kRefused) {
      EXPECT_NE(entry.text.find("R0303"), std::string::npos);
    }
    EXPECT_EQ(entry.who, entry.time_ns == 1 ? "test" : "tester");
  }
  const std::vector<Event> expected = {Event::kInstalled, Event::kStarted,   Event::kStaged,
                                       Event::kRefused,   Event::kCancelled, Event::kStaged,
                                       Event::kSwitched,  Event::kUndone,    Event::kStaged,
                                       Event::kSwitched,  Event::kAccepted,  Event::kRestarted};
  EXPECT_EQ(events, expected);
}

}  // namespace
}  // namespace plc
