// The keeper beside a running program, in virtual time: values at most a second old, nothing
// written that did not change; and what it does while the disk fails.
#include "online_change/store/retain_keeper.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr const char* kCounting =
    "VAR_GLOBAL RETAIN r : LINT; END_VAR PROGRAM P r := r + 1; END_PROGRAM";

// The program, its keeper, and the control thread that this test is.
class KeeperTest : public ::testing::Test {
 protected:
  void begin(const std::string& source) {
    store_ = std::make_unique<online_change::Store>(disk_);
    auto found = online_change::boot(*store_, build(source), "test", 1);
    ASSERT_TRUE(found.ok());
    controller_ = std::move(*vm::Controller::start(found->image, vm::ControllerOptions(), clock_,
                                                   io_, found->retained));
    keeper_ = std::make_unique<online_change::RetainKeeper>(*controller_, *store_,
                                                            [this] { return now_ns_; });
    store_->tell([this](const online_change::JournalEntry& entry) {
      said_.push_back(std::string(event_name(entry.event)) + ": " + entry.text);
      return true;
    });
  }
  // A cycle in each millisecond, with next to no time left, as in a busy controller.
  void run_for(int64_t ms) {
    for (const int64_t end = now_ns_ + ms * kMs; now_ns_ < end; now_ns_ += kMs) {
      controller_->cycle();
      keeper_->serve(0);
      if (now_ns_ >= step_ns_) step_ns_ = now_ns_ + keeper_->step(now_ns_);
    }
  }
  int64_t value() const { return std::stoll(*controller_->get("r")); }
  // What boots after a power cut now.
  int64_t durable() const {
    sim::SimStorage left = disk_.after_cut(sim::SimStorage::Choice(disk_.dirty().size(), 0));
    Plc plc(left);
    EXPECT_TRUE(plc.boot().ok());
    return std::stoll(plc.get("r"));
  }
  void break_disk() {
    disk_.fails = [this](std::string_view call) {
      if (call == "read" || call == "check") return sim::Failure::kNone;
      ++failed_calls_;
      return sim::Failure::kError;
    };
  }
  size_t times_said(const std::string& text) const {
    return static_cast<size_t>(std::count_if(said_.begin(), said_.end(), [&](const auto& line) {
      return line.find(text) != std::string::npos;
    }));
  }

  int64_t now_ns_ = 0;
  int64_t step_ns_ = 0;  // the keeper's next
  uint64_t failed_calls_ = 0;
  std::vector<std::string> said_;
  sim::SimStorage disk_;
  vm::VirtualClock clock_;
  vm::NullIo io_;
  std::unique_ptr<online_change::Store> store_;
  std::unique_ptr<vm::Controller> controller_;
  std::unique_ptr<online_change::RetainKeeper> keeper_;
};

TEST_F(KeeperTest, ValuesAreDurableWithinASecond) {
  begin(kCounting);
  for (int i = 0; i < 20; ++i) {
    const int64_t before = value();
    run_for(700 + 13 * i);
    EXPECT_GE(durable(), before);
  }
  EXPECT_TRUE(said_.empty()) << said_.front();
}

TEST_F(KeeperTest, WhatDoesNotChangeIsWrittenOnce) {
  uint64_t writes = 0;
  begin(
      "VAR_GLOBAL RETAIN r : INT := 5; END_VAR PROGRAM P VAR n : INT; END_VAR n := n + 1; "
      "END_PROGRAM");
  run_for(1000);
  disk_.before_call = [&] { ++writes; };
  run_for(10'000);
  EXPECT_EQ(writes, 0u);
  EXPECT_TRUE(store_->retained_fits());
}

// With the thread that a controller has: it asks, and what it was given is saved when it ends.
TEST_F(KeeperTest, TheThreadSavesWithoutBeingTold) {
  begin(kCounting);
  keeper_->start();
  while (!store_->keeps_retained()) {
    controller_->cycle();
    keeper_->serve(0);
  }
  keeper_.reset();
  EXPECT_GT(durable(), 0);
}

// The one that is older never becomes the newest.
TEST_F(KeeperTest, AnOlderSnapshotIsLeftOut) {
  begin("VAR_GLOBAL RETAIN r : INT; END_VAR PROGRAM P r := r + 1; END_PROGRAM");
  online_change::Snapshot first;
  online_change::Snapshot second;
  keeper_->take(first);
  controller_->cycle();
  keeper_->take(second);
  ASSERT_TRUE(keeper_->save(second).ok());
  ASSERT_TRUE(keeper_->save(first).ok());
  keeper_.reset();
  online_change::Recovered found = online_change::Store(disk_).take_recovered();
  ASSERT_TRUE(found.newest);
  EXPECT_EQ(found.newest->values, second.values);
}

// --- the disk fails -----------------------------------------------------------------

// However long it lasts: values from before it stay, and new ones are saved when it is over.
TEST_F(KeeperTest, X5_case56_ADiskFaultEndsWithoutARestart) {
  for (const int64_t fault_ms : {100, 500, 1500, 3000, 60'000}) {
    disk_ = {};
    begin(kCounting);
    run_for(1000);
    const int64_t before = durable();
    break_disk();
    run_for(fault_ms);
    EXPECT_GE(durable(), before) << fault_ms;
    EXPECT_EQ(keeper_->unsaved().has_value(), fault_ms >= 500) << fault_ms;
    disk_.fails = nullptr;
    run_for(4000);
    EXPECT_FALSE(keeper_->unsaved()) << fault_ms;
    EXPECT_TRUE(store_->complaints().empty()) << fault_ms << ": " << store_->complaints().front();
    const int64_t then = value();
    run_for(1000);
    EXPECT_GE(durable(), then) << fault_ms;
  }
}

// Every save kills a copy when it fails; the newest is never one of them, however often.
TEST_F(KeeperTest, X5_case56_FaultsThatComeAgainCostNoValues) {
  begin(kCounting);
  run_for(1000);
  for (int i = 0; i < 50; ++i) {
    const int64_t before = durable();
    break_disk();
    run_for(300 + 97 * i);
    EXPECT_GE(durable(), before) << i;
    disk_.fails = nullptr;
    run_for(4500);
    EXPECT_GT(durable(), before) << i;
  }
}

TEST_F(KeeperTest, TheFaultIsAnAlarmAndAnEventOnceAndItsEndToo) {
  begin(kCounting);
  run_for(1000);
  const int64_t begun = now_ns_;
  break_disk();
  run_for(30'000);
  ASSERT_TRUE(keeper_->unsaved());
  EXPECT_GE(keeper_->unsaved()->since_ns, begun);
  EXPECT_LE(keeper_->unsaved()->since_ns, begun + 1000 * kMs);
  EXPECT_NE(keeper_->unsaved()->why.find("retain_"), std::string::npos) << keeper_->unsaved()->why;
  disk_.fails = nullptr;
  run_for(5000);
  EXPECT_EQ(times_said("alarm: retained values are not being saved"), 1u);
  EXPECT_EQ(times_said("alarm over: retained values are saved again"), 1u);
  EXPECT_EQ(times_said("alarm over: storage is well again"), 1u);
  EXPECT_LE(said_.size(), 10u);
  auto entries = online_change::read_journal(disk_, online_change::kJournalFile);
  ASSERT_TRUE(entries.ok());
  for (const std::string& line : said_) {
    EXPECT_TRUE(std::any_of(entries->begin(), entries->end(), [&](const auto& entry) {
      return line == std::string(event_name(entry.event)) + ": " + entry.text;
    })) << line << " is not in the journal";
  }
}

// A disk that stays broken is left in peace: a call now and then.
TEST_F(KeeperTest, WhatFailsIsTriedLessAndLessOften) {
  begin(kCounting);
  run_for(1000);
  break_disk();
  run_for(60'000);
  failed_calls_ = 0;
  run_for(60'000);
  EXPECT_GT(failed_calls_, 15u) << "it must be tried again";
  EXPECT_LT(failed_calls_, 200u);
}

TEST_F(KeeperTest, FilesThatAreRemovedComeBackAndItIsSaid) {
  begin(kCounting);
  run_for(1000);
  for (const char* name : {"retain_0", "retain_1", "retain_2", "control_0", "control_1", "journal",
                           "traps", "slot_b"}) {
    disk_.remove(name);
  }
  run_for(3000);
  EXPECT_GE(times_said("removed"), 1u);
  EXPECT_TRUE(store_->complaints().empty()) << store_->complaints().front();
  const int64_t then = value();
  run_for(1000);
  EXPECT_GE(durable(), then);
}

// Its image is not the keeper's to write; status says it until somebody does.
TEST_F(KeeperTest, ARemovedProgramIsSaidUntilItIsStoredAgain) {
  begin(kCounting);
  run_for(1000);
  disk_.remove("slot_a");
  run_for(3000);
  ASSERT_FALSE(store_->complaints().empty());
  EXPECT_NE(store_->complaints().front().find("nothing to boot"), std::string::npos);
  EXPECT_TRUE(keeper_->unsaved());
  const ir::VerifiedImage& image = controller_->verified();
  ASSERT_TRUE(store_->restore({image.digest(), image.encoded()}).ok());
  run_for(3000);
  EXPECT_TRUE(store_->complaints().empty()) << store_->complaints().front();
  EXPECT_FALSE(keeper_->unsaved());
  EXPECT_GT(durable(), 0);
}

// Removed, and nothing has changed since: what is gone is written again.
TEST_F(KeeperTest, ValuesThatDoNotChangeAreSavedAgainWhenTheirFileIsGone) {
  begin("VAR_GLOBAL RETAIN r : LINT; END_VAR PROGRAM P END_PROGRAM");
  ASSERT_TRUE(controller_->set("r", "77").ok());
  run_for(1000);
  ASSERT_EQ(durable(), 77);
  for (const char* name : {"retain_0", "retain_1", "retain_2"}) disk_.remove(name);
  EXPECT_EQ(durable(), 0);
  run_for(2000);
  EXPECT_EQ(durable(), 77);
}

}  // namespace
}  // namespace plc
