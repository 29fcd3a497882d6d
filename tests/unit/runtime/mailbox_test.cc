// The hand-over between channel thread and control thread; meant to be run under TSan too.
#include "vm/runtime/mailbox.h"

#include <gtest/gtest.h>

#include <thread>

namespace vm {
namespace {

// Of who waits for what comes, however loaded the machine is.
constexpr int64_t kPatience = 600'000'000'000;

TEST(Mailbox, JobsRunOneByOneOnTheControlThread) {
  Mailbox mailbox;
  std::atomic<bool> end{false};
  uint64_t state = 0;  // only jobs touch it
  uint64_t rounds = 0;
  std::thread control([&] {
    while (!end.load()) {
      mailbox.serve();
      ++rounds;
    }
    mailbox.close();
  });
  for (uint64_t i = 0; i < 2000; ++i) {
    uint64_t seen = 0;
    ASSERT_EQ(mailbox.run([&] { seen = ++state; }, kPatience), Mailbox::Outcome::kDone);
    ASSERT_EQ(seen, i + 1);
  }
  end.store(true);
  control.join();
  EXPECT_EQ(state, 2000u);
  EXPECT_GE(rounds, 2000u);
}

TEST(Mailbox, JobThatTimesOutNeverRuns) {
  Mailbox mailbox;
  bool ran = false;
  EXPECT_EQ(mailbox.run([&] { ran = true; }, 1'000'000), Mailbox::Outcome::kTimeout);
  mailbox.serve();
  EXPECT_FALSE(ran);
}

TEST(Mailbox, TimeoutsAndDeliveryRace) {
  Mailbox mailbox;
  std::atomic<bool> end{false};
  uint64_t ran = 0;
  std::thread control([&] {
    while (!end.load()) {
      mailbox.serve();
      std::this_thread::sleep_for(std::chrono::microseconds(150));
    }
    mailbox.close();
  });
  uint64_t done = 0;
  for (int i = 0; i < 500; ++i) {
    done += mailbox.run([&] { ++ran; }, i % 7 * 50'000) == Mailbox::Outcome::kDone;
  }
  end.store(true);
  control.join();
  EXPECT_EQ(ran, done);
}

TEST(Mailbox, AJobEndsTheWaitOfTheControlThread) {
  Mailbox mailbox;
  std::atomic<bool> end{false};
  std::thread control([&] {
    while (!end.load()) {
      mailbox.wait(kPatience);
      mailbox.serve();
    }
    mailbox.close();
  });
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(mailbox.run([&] { end.store(i == 199); }, kPatience), Mailbox::Outcome::kDone);
  }
  control.join();
}

TEST(Mailbox, TheControlThreadWaitsNoLongerThanItSays) {
  Mailbox mailbox;
  const auto begin = std::chrono::steady_clock::now();
  mailbox.wait(0);
  mailbox.wait(-1);
  mailbox.wait(5'000'000);
  mailbox.serve();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::nanoseconds(kPatience));
}

TEST(Mailbox, ClosedTakesNothing) {
  Mailbox mailbox;
  mailbox.close();
  bool ran = false;
  EXPECT_EQ(mailbox.run([&] { ran = true; }, kPatience), Mailbox::Outcome::kClosed);
  EXPECT_FALSE(ran);
}

TEST(Mailbox, CloseReleasesAWaitingJob) {
  Mailbox mailbox;
  std::thread closer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    mailbox.close();
  });
  EXPECT_EQ(mailbox.run([] {}, kPatience), Mailbox::Outcome::kClosed);
  closer.join();
}

}  // namespace
}  // namespace vm
