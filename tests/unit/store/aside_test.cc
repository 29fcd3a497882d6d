// An image that is written before it is verified: that promises nothing, and what goes on trial is
// never other bytes than those of begin_trial().
#include <gtest/gtest.h>

#include <memory>

#include "tests/unit/store/history.h"
#include "tools/stvm/aside_writer.h"

namespace history {
namespace {

using online_change::Store;
using online_change::StoredImage;

std::shared_ptr<const base::Bytes> shared(base::Bytes bytes) {
  return std::make_shared<const base::Bytes>(std::move(bytes));
}

class Aside : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(store_.install(program(1), 100).ok()); }

  uint64_t writes_of(const std::function<void()>& job) {
    uint64_t writes = 0;
    disk_.fails = [&](std::string_view call) {
      writes += call == "write" ? 1 : 0;
      return sim::Failure::kNone;
    };
    job();
    disk_.fails = nullptr;
    return writes;
  }
  // What boots behind the end of this process, when the trial was accepted.
  base::Bytes accepted() {
    EXPECT_TRUE(store_.accept().ok());
    const online_change::Recovered found = Store(disk_, small()).take_recovered();
    return found.boots ? found.boots->bytes : base::Bytes();
  }

  sim::SimStorage disk_;
  Store store_{disk_, small()};
};

TEST_F(Aside, TheSameBytesAreNotWrittenTwice) {
  const StoredImage next = program(2);
  const auto bytes = shared(next.bytes);
  const auto begin = [&] { EXPECT_TRUE(store_.begin_trial({next.digest, *bytes}, 100).ok()); };
  const uint64_t laid = writes_of([&] { store_.lay_aside(bytes); });
  EXPECT_GT(laid, 0u);
  const uint64_t control = writes_of(begin);
  EXPECT_TRUE(store_.end_trial().ok());
  store_.forget_aside();
  EXPECT_EQ(control, writes_of(begin)) << "it is what its digest says now";
  EXPECT_EQ(accepted(), next.bytes);
}

TEST_F(Aside, OtherBytesOfTheSameDigestAreNotTheTrial) {
  const StoredImage next = program(2);
  StoredImage forged = next;
  forged.bytes.back() ^= 1;
  const auto bytes = shared(forged.bytes);
  store_.lay_aside(bytes);
  EXPECT_TRUE(store_.begin_trial(next, 100).ok());
  EXPECT_EQ(accepted(), next.bytes);
}

TEST_F(Aside, WhatIsForgottenIsNotTheTrial) {
  const StoredImage next = program(2);
  StoredImage forged = next;
  forged.bytes.back() ^= 1;
  store_.lay_aside(shared(forged.bytes));
  store_.forget_aside();
  EXPECT_TRUE(store_.begin_trial(next, 100).ok());
  EXPECT_EQ(accepted(), next.bytes);
}

TEST_F(Aside, AFileThatIsGoneMeanwhileIsWrittenAgain) {
  const StoredImage next = program(2);
  const auto bytes = shared(next.bytes);
  store_.lay_aside(bytes);
  disk_.remove("slot_b");
  EXPECT_TRUE(store_.begin_trial({next.digest, *bytes}, 100).ok());
  EXPECT_EQ(accepted(), next.bytes);
}

// D3: the next edit goes beside what boots and what is on trial.
TEST_F(Aside, D3_DuringATrialTheThirdSlotIsWritten) {
  ASSERT_TRUE(store_.begin_trial(program(2), 100).ok());
  const StoredImage next = program(3);
  const auto bytes = shared(next.bytes);
  EXPECT_GT(writes_of([&] { store_.lay_aside(bytes); }), 0u);
  EXPECT_EQ(accepted(), program(2).bytes);
}

// What was laid aside is where it was free then: the slot that is free now holds something else.
TEST_F(Aside, D3_AnotherSlotIsFreeBehindTheEndOfATrial) {
  ASSERT_TRUE(store_.begin_trial(program(2), 100).ok());
  const StoredImage next = program(3);
  const auto bytes = shared(next.bytes);
  store_.lay_aside(bytes);
  ASSERT_TRUE(store_.end_trial().ok());
  EXPECT_TRUE(store_.begin_trial({next.digest, *bytes}, 100).ok());
  EXPECT_EQ(accepted(), next.bytes);
}

TEST_F(Aside, AFailureIsSaidAndTheTrialIsRefused) {
  disk_.fails = [](std::string_view call) {
    return call == "sync" ? sim::Failure::kError : sim::Failure::kNone;
  };
  const StoredImage next = program(2);
  const auto bytes = shared(next.bytes);
  store_.lay_aside(bytes);
  EXPECT_FALSE(store_.complaints().empty());
  EXPECT_FALSE(store_.begin_trial({next.digest, *bytes}, 100).ok());
  EXPECT_EQ(store_.boots(), program(1).digest);
  disk_.fails = nullptr;
  EXPECT_TRUE(store_.begin_trial({next.digest, *bytes}, 100).ok());
  EXPECT_EQ(accepted(), next.bytes);
  EXPECT_TRUE(store_.renew().ok());
  EXPECT_TRUE(store_.complaints().empty());
}

TEST_F(Aside, AThreadOfItsOwnWritesIt) {
  const StoredImage next = program(2);
  const auto bytes = shared(next.bytes);
  stvm::AsideWriter writer(store_);
  EXPECT_GT(writes_of([&] {
              writer.start(shared(program(3).bytes));
              writer.start(bytes);
              writer.wait();
            }),
            0u);
  const auto begin = [&] { EXPECT_TRUE(store_.begin_trial({next.digest, *bytes}, 100).ok()); };
  EXPECT_LE(writes_of(begin), 2u) << "the control record alone";
  EXPECT_EQ(accepted(), next.bytes);
}

}  // namespace
}  // namespace history
