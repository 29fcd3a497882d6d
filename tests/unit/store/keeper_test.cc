// The keeper's thread beside a running program: values at most a second old, nothing written that
// did not change, traps in the journal.
#include "online_change/store/retain_keeper.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {
namespace {

using Time = std::chrono::steady_clock;

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
                                                            [] { return int64_t{7}; });
    keeper_->start();
  }
  // Cycles with next to no time left, as in a busy controller.
  void run_for(std::chrono::milliseconds time) {
    for (const auto end = Time::now() + time; Time::now() < end;) {
      controller_->cycle();
      keeper_->serve(0);
    }
  }
  uint64_t writes() {
    std::lock_guard lock(counting_);
    return writes_;
  }

  std::mutex counting_;
  uint64_t writes_ = 0;
  sim::SimStorage disk_;
  vm::VirtualClock clock_;
  vm::NullIo io_;
  std::unique_ptr<online_change::Store> store_;
  std::unique_ptr<vm::Controller> controller_;
  std::unique_ptr<online_change::RetainKeeper> keeper_;
};

TEST_F(KeeperTest, ValuesAreDurableWithinASecond) {
  begin("VAR_GLOBAL RETAIN r : LINT; END_VAR PROGRAM P r := r + 1; END_PROGRAM");
  run_for(std::chrono::milliseconds(300));
  ASSERT_TRUE(controller_->set("r", "1000000000").ok());
  run_for(std::chrono::milliseconds(2000));  // a loaded machine may take another second
  keeper_.reset();
  sim::SimStorage left = disk_.after_cut(sim::SimStorage::Choice(disk_.dirty().size(), 0));
  Plc plc(left);
  ASSERT_TRUE(plc.boot().ok());
  EXPECT_GE(std::stoll(plc.get("r")), 1'000'000'000);
}

TEST_F(KeeperTest, WhatDoesNotChangeIsWrittenOnce) {
  disk_.before_call = [this] {
    std::lock_guard lock(counting_);
    ++writes_;
  };
  begin(
      "VAR_GLOBAL RETAIN r : INT := 5; END_VAR PROGRAM P VAR n : INT; END_VAR n := n + 1; "
      "END_PROGRAM");
  run_for(std::chrono::milliseconds(2000));
  const uint64_t before = writes();
  run_for(std::chrono::milliseconds(1000));
  EXPECT_EQ(writes(), before);
  EXPECT_TRUE(store_->retained_fits());
}

TEST_F(KeeperTest, TrapsAreInTheJournal) {
  begin("PROGRAM P VAR z : INT; q : INT; END_VAR q := 1 / z; END_PROGRAM");
  run_for(std::chrono::milliseconds(2000));
  keeper_.reset();
  auto traps = online_change::read_journal(disk_, online_change::kTrapsFile);
  ASSERT_TRUE(traps.ok());
  ASSERT_EQ(traps->size(), 1u);
  EXPECT_EQ(traps->front().event, online_change::Event::kTrap);
  EXPECT_EQ(traps->front().time_ns, 7);
  EXPECT_NE(traps->front().text.find("test.st:1 (P)"), std::string::npos) << traps->front().text;
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

}  // namespace
}  // namespace plc
