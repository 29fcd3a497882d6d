// C8: a download is verified and stored beside the control thread, never at a release's expense:
// at boundaries nothing of it happens. What boundaries do is counted, in virtual time, and the disk
// is asked whether anybody touches it there.
#include <gtest/gtest.h>

#include <utility>

#include "base/sha256.h"
#include "online_change/package/package.h"
#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {
namespace {

using Outcome = vm::Boundary::Outcome;

// A program of 300 POUs: much to send, to verify and to store.
std::string source(const char* type) {
  std::string out = "VAR_GLOBAL RETAIN kept : ARRAY[0..99] OF DINT; END_VAR ";
  std::string calls;
  for (int i = 0; i < 300; ++i) {
    const std::string name = "B" + std::to_string(i);
    out += "FUNCTION_BLOCK " + name + " VAR n, m : DINT; x : ARRAY[0..20] OF " + type +
           "; END_VAR n := n + 1; x[n MOD 21] := x[(n + 3) MOD 21] + " + std::to_string(i) +
           "; m := n * 3; END_FUNCTION_BLOCK ";
    calls += "b" + std::to_string(i) + "(); ";
  }
  out += "PROGRAM P VAR ";
  for (int i = 0; i < 300; ++i) {
    out += "b" + std::to_string(i) + " : B" + std::to_string(i) + "; ";
  }
  return out + "END_VAR " + calls + "END_PROGRAM CONFIGURATION c RESOURCE r ON cpu TASK T " +
         "(INTERVAL := T#1ms); PROGRAM P WITH T : P; END_RESOURCE END_CONFIGURATION";
}

class Download : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(plc_.boot(source("DINT")).ok());
    plc_.run(5);
    next_.emplace(build(source("LINT"), &plc_.controller().image()));
    package_ = online_change::encode(
        *online_change::make_package(plc_.controller().verified().encoded(), next_->encoded()));
    ASSERT_GT(package_.size(), size_t{100'000});
    plc_.at_boundary = [this] {
      ++jobs_;
      inside_ = true;
      before_ns_ = plc_.clock().now_ns();
      return Outcome::kDone;
    };
    plc_.behind_job = [this] {
      if (!std::exchange(inside_, false)) return;  // of status()
      most_ns_ = std::max(most_ns_, plc_.clock().now_ns() - before_ns_);
    };
    disk_.before_call = [this] { touch(); };
    disk_.fails = [this](std::string_view) {
      touch();
      return sim::Failure::kNone;
    };
  }
  void touch() {
    ++calls_;
    EXPECT_FALSE(inside_) << "the disk is touched at a boundary";
  }
  base::Status upload() {
    vm::Request part{.command = vm::Command::kUpload};
    constexpr size_t kPart = 4096;
    for (size_t at = 0; at < package_.size(); at += kPart) {
      const size_t size = std::min(kPart, package_.size() - at);
      part.offset = at;
      part.data.assign(package_.begin() + static_cast<std::ptrdiff_t>(at),
                       package_.begin() + static_cast<std::ptrdiff_t>(at + size));
      if (base::Status sent = ask(part); !sent.ok()) return sent;
    }
    return base::Ok{};
  }
  base::Status stage(uint32_t flags) {
    vm::Request stage{.command = vm::Command::kStage};
    stage.digest = base::sha256(package_);
    stage.flags = flags;
    return ask(stage);
  }
  // Without those of the look at what runs, which comes before each request.
  base::Status ask(vm::Request request) {
    const vm::StatusReport now = plc_.status();
    request.expected = now.running;
    request.edition = now.edition;
    jobs_ = 0;
    bool keep_open = true;
    auto answer = vm::decode_answer(plc_.service().answer(vm::encode(request), keep_open));
    return answer.ok() ? base::Status(base::Ok{}) : answer.error();
  }
  void expect_on_time() {
    plc_.run(3);
    EXPECT_EQ(plc_.controller().missed_releases(), 0u);
    for (const vm::TaskStatus& task : plc_.controller().tasks()) EXPECT_EQ(task.delay.max, 0);
  }

  sim::SimStorage disk_;
  Plc plc_{disk_};
  std::optional<ir::VerifiedImage> next_;
  base::Bytes package_;
  int jobs_ = 0;
  int calls_ = 0;
  bool inside_ = false;
  int64_t before_ns_ = 0;
  int64_t most_ns_ = 0;
};

TEST_F(Download, C8_ReceivingAndVerifyingTakeNothingOfABoundary) {
  for (const uint32_t strategy : {0u, uint32_t{vm::kByStandby}}) {
    ASSERT_TRUE(upload().ok());
    EXPECT_EQ(jobs_, 0) << "a part is only kept";
    ASSERT_TRUE(stage(strategy).ok());
    EXPECT_EQ(jobs_, 0) << "verified, planned and prepared without the control thread";
    ASSERT_TRUE(ask({.command = vm::Command::kCancel}).ok());
    EXPECT_EQ(jobs_, 0);
    expect_on_time();
  }
}

TEST_F(Download, C8_StoringTakesNothingOfABoundary) {
  for (const uint32_t strategy : {0u, uint32_t{vm::kByStandby}}) {
    ASSERT_TRUE(upload().ok());
    ASSERT_TRUE(stage(strategy).ok());
    calls_ = 0;
    vm::Request change{.command = vm::Command::kSwitch};
    change.flags = vm::kAllowLoss;
    base::Status switched = ask(change);
    ASSERT_TRUE(switched.ok()) << base::to_string(switched.error());
    EXPECT_GT(calls_, 5) << "both versions are stored";
    EXPECT_GT(jobs_, 2);
    calls_ = 0;
    ASSERT_TRUE(plc_.undo().ok());
    EXPECT_GT(calls_, 0);
    expect_on_time();
  }
  ASSERT_TRUE(upload().ok());
  ASSERT_TRUE(stage(0).ok());
  vm::Request change{.command = vm::Command::kSwitch};
  change.flags = vm::kAllowLoss;
  ASSERT_TRUE(ask(change).ok());
  calls_ = 0;
  ASSERT_TRUE(plc_.accept().ok());
  EXPECT_GT(calls_, 0);
  expect_on_time();
  // The work of one boundary fits into the period.
  EXPECT_LT(most_ns_, 1'000'000);
}

// A package that is no good costs the control thread nothing either.
TEST_F(Download, C8_WhatIsRefusedTakesNothingOfABoundary) {
  for (size_t at = 40; at < package_.size(); at += package_.size() / 7) {
    package_[at] ^= 0x40;
    ASSERT_TRUE(upload().ok());
    EXPECT_FALSE(stage(0).ok());
    EXPECT_EQ(jobs_, 0);
    package_[at] ^= 0x40;
  }
  expect_on_time();
}

}  // namespace
}  // namespace plc
