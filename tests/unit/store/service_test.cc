// X5, D4, cases 54 to 57 with whole controllers: boot, retained values, changes, undo, accept. The
// power fails, or the process is killed, at every call to storage; what boots then is one of the
// programs that may, with retained values that were durable.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"
#include "vm/runtime/file_storage.h"

namespace plc {
namespace {

// r and s are always set together. Every version has them, in other places and types.
std::string source(int version) {
  const char* const variables[] = {
      "r : DINT; s : DINT; only1 : INT;",
      "more : ARRAY[0..9] OF LINT; s : LINT; r : DINT;",
      "s : DINT; r : LINT; x : STRING;",
      "r : INT; s : INT;",
  };
  return std::string("VAR_GLOBAL RETAIN ") + variables[version - 1] +
         " END_VAR PROGRAM P VAR n : DINT; END_VAR n := n + 1; END_PROGRAM";
}

// One step of a controller's life, and what may be found after a cut in it.
struct Step {
  std::function<bool(std::unique_ptr<Plc>&, vm::Storage&)> run;
  std::vector<int> boots;   // versions; 0: nothing was stored yet
  std::vector<int> values;  // of r and s
};

bool set_and_save(Plc& plc, int value) {
  plc.set("r", std::to_string(value));
  plc.set("s", std::to_string(value));
  return plc.save().ok();
}

std::vector<Step> life() {
  auto set = [](int value) {
    return [value](std::unique_ptr<Plc>& plc, vm::Storage&) { return set_and_save(*plc, value); };
  };
  auto change = [](int version, uint32_t flags) {
    return [version, flags](std::unique_ptr<Plc>& plc, vm::Storage&) {
      return plc->change(source(version), flags | vm::kAllowLoss).ok();
    };
  };
  auto boot = [](int version) {
    return [version](std::unique_ptr<Plc>& plc, vm::Storage& storage) {
      std::optional<ir::VerifiedImage> given;
      if (version != 0) given = build(source(version), plc ? &plc->controller().image() : nullptr);
      plc = std::make_unique<Plc>(storage);
      return plc->boot(given).ok();
    };
  };
  auto undo = [](std::unique_ptr<Plc>& plc, vm::Storage&) { return plc->undo().ok(); };
  auto accept = [](std::unique_ptr<Plc>& plc, vm::Storage&) { return plc->accept().ok(); };
  auto accept_to = [](const char* edit) {
    return [edit](std::unique_ptr<Plc>& plc, vm::Storage&) {
      return plc->ask({.command = vm::Command::kAccept, .names = {edit}}).ok();
    };
  };
  return {
      {boot(1), {0, 1}, {0}},   {set(5), {1}, {0, 5}},
      {change(2, 0), {1}, {5}}, {set(6), {1}, {5, 6}},
      {undo, {1}, {6}},         {change(2, 0), {1}, {6}},
      {set(7), {1}, {6, 7}},    {accept, {1, 2}, {7}},
      {set(8), {2}, {7, 8}},    {change(3, vm::kPermanent), {2, 3}, {8}},
      {set(9), {3}, {8, 9}},    {change(2, 0), {3}, {9}},
      {boot(0), {3}, {9}},  // the trial is lost
      {boot(4), {3, 4}, {9}},   {set(10), {4}, {9, 10}},
      // D3, case 77: edits on top of each other.
      {change(1, 0), {4}, {10}},        {set(11), {4}, {10, 11}},
      {change(2, 0), {4}, {11}},        {set(12), {4}, {11, 12}},
      {change(3, 0), {4}, {12}},        {undo, {4}, {12}},
      {set(13), {4}, {12, 13}},         {change(4, 0), {4}, {13}},
      {undo, {4}, {13}},                {undo, {4}, {13}},
      {change(3, 0), {4}, {13}},        {set(14), {4}, {13, 14}},
      {accept_to("E1"), {4, 1}, {14}},  {set(15), {1}, {14, 15}},
      {accept, {1, 3}, {15}},
  };
}

template <class T>
bool holds(const std::vector<T>& list, const T& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

// What a version has that the others have not.
int version_of(const Plc& plc) {
  if (plc.get("only1") != "no only1") return 1;
  if (plc.get("more[0]") != "no more[0]") return 2;
  return plc.get("x") != "no x" ? 3 : 4;
}

// Boots from what was left; "" or what is wrong.
std::string found(vm::Storage& storage, const Step& step) {
  Plc plc(storage);
  const base::Status booted = plc.boot();
  if (!booted.ok()) {
    const bool nothing = booted.error().refusal == base::Refusal::kFileNotFound;
    return nothing && holds(step.boots, 0) ? "" : base::to_string(booted.error());
  }
  const int version = version_of(plc);
  if (!holds(step.boots, version)) return "version " + std::to_string(version) + " boots";
  if (plc.get("r") != plc.get("s")) return "a mixture: r " + plc.get("r") + ", s " + plc.get("s");
  if (!holds(step.values, std::stoi(plc.get("r")))) return "r is " + plc.get("r");
  // It is a controller: it takes a change.
  if (!plc.change(source(version == 2 ? 3 : 2)).ok()) return "no change is possible any more";
  return "";
}

TEST(Service, X5_case54_PowerFailsAtEveryCallToStorage) {
  const std::vector<Step> steps = life();
  sim::SimStorage disk;
  size_t at = 0;
  uint64_t tried = 0;
  uint64_t failed = 0;
  std::mt19937 random(1);
  auto look = [&](sim::SimStorage left) {
    ++tried;
    const std::string wrong = found(left, steps[at]);
    if (!wrong.empty() && ++failed < 5) ADD_FAILURE() << "in step " << at << ": " << wrong;
  };
  disk.before_call = [&] {
    sim::SimStorage::Choice choice(disk.dirty().size(), 0);
    look(disk.after_cut(choice));
    if (disk.dirty().empty()) return;
    look(disk.after_kill());
    for (int i = 0; i < 2; ++i) {
      for (uint8_t& one : choice) one = random() % 2;
      look(disk.after_cut(choice,
                          {random() % choice.size(), static_cast<uint32_t>(random() % 512)}));
    }
  };
  std::unique_ptr<Plc> plc;
  for (; at < steps.size(); ++at) ASSERT_TRUE(steps[at].run(plc, disk)) << "step " << at;
  std::printf("%llu tried, %llu failed\n", static_cast<unsigned long long>(tried),
              static_cast<unsigned long long>(failed));
  EXPECT_GT(tried, 450u);
}

// --- real files, a real process -----------------------------------------------------

// Ends the process at call `at`; a write may be done half before.
class Deadly : public vm::Storage {
 public:
  Deadly(const std::string& directory, uint64_t at) : files_(directory), at_(at) {}
  base::Status open(std::string_view name, uint64_t size) override {
    end_if_now();
    return files_.open(name, size);
  }
  base::Result<uint64_t> size(std::string_view name) override { return files_.size(name); }
  base::Result<base::Bytes> read(std::string_view name, uint64_t offset, uint64_t size) override {
    end_if_now();
    return files_.read(name, offset, size);
  }
  base::Status write(std::string_view name, uint64_t offset, base::ByteSpan bytes) override {
    end_if_now();
    if (calls_ + 1 == at_) (void)files_.write(name, offset, bytes.first(bytes.size() / 2)).ok();
    end_if_now();
    return files_.write(name, offset, bytes);
  }
  base::Status sync(std::string_view name) override {
    end_if_now();
    return files_.sync(name);
  }
  base::Status replace(std::string_view name, uint64_t size,
                       std::span<const Piece> pieces) override {
    end_if_now();
    return files_.replace(name, size, pieces);
  }
  base::Status check(std::string_view name) override { return files_.check(name); }

 private:
  void end_if_now() {
    if (++calls_ == at_) ::_exit(9);
  }
  vm::FileStorage files_;
  uint64_t at_;
  uint64_t calls_ = 0;
};

class Killed : public ::testing::Test {
 protected:
  void SetUp() override {
    // In memory where that is possible: nothing here depends on the disk.
    const bool memory = ::access("/dev/shm", W_OK) == 0;
    std::string path = (memory ? "/dev/shm/" : ::testing::TempDir()) + "killed-XXXXXX";
    ASSERT_NE(::mkdtemp(path.data()), nullptr);
    directory_ = path;
    void* shared =
        ::mmap(nullptr, sizeof *at_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(shared, MAP_FAILED);
    at_ = static_cast<volatile size_t*>(shared);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  // 9: killed at that call; 0: it lived to the end.
  int live_until(uint64_t call, const std::vector<Step>& steps) {
    *at_ = 0;
    const pid_t child = ::fork();
    if (child == 0) {
      Deadly storage(directory_, call);
      std::unique_ptr<Plc> plc;
      for (size_t i = 0; i < steps.size(); ++i) {
        *at_ = i;
        if (!steps[i].run(plc, storage)) ::_exit(1);
      }
      ::_exit(0);
    }
    int status = 0;
    if (child < 0 || ::waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
    return WEXITSTATUS(status);
  }

  std::string directory_;
  volatile size_t* at_ = nullptr;
};

TEST_F(Killed, X5_case54_AtEveryCallToStorage) {
  const std::vector<Step> steps = life();
  uint64_t call = 1;
  for (;; ++call) {
    const int end = live_until(call, steps);
    if (end == 0) break;
    ASSERT_EQ(end, 9) << "at call " << call << " in step " << *at_;
    vm::FileStorage storage(directory_);
    EXPECT_EQ(found(storage, steps[*at_]), "") << "at call " << call << " in step " << *at_;
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directory(directory_);
  }
  std::printf("%llu calls\n", static_cast<unsigned long long>(call));
  EXPECT_GT(call, 200u);
}

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
  for (size_t removed = 1; removed < size_t{1} << names.size(); ++removed) {
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
