// A switch of 10,000 values asks for its deadline 40,000 times: looks at the clock must not be what
// it takes (case 69). Counted, in virtual time.
#include "online_change/apply/deadline.h"

#include <gtest/gtest.h>

#include "vm/runtime/clocks.h"

namespace online_change {
namespace {

class CountedClock : public vm::VirtualClock {
 public:
  int64_t now_ns() override {
    ++looks;
    return vm::VirtualClock::now_ns();
  }
  int looks = 0;
};

TEST(Deadline, case69_ShortStepsSeldomLookAtTheClock) {
  CountedClock clock;
  clock.advance(1000);
  Deadline over(clock, 1'000'000'000);
  for (int i = 0; i < 40'000; ++i) {
    ASSERT_FALSE(over());
    clock.advance(20);
  }
  EXPECT_LT(clock.looks, 40'000 / 15);
}

TEST(Deadline, LongStepsLookEachTime) {
  CountedClock clock;
  clock.advance(1000);
  Deadline over(clock, 1'000'000'000);
  for (int i = 0; i < 100; ++i) {
    ASSERT_FALSE(over());
    clock.advance(20'000);
  }
  EXPECT_GE(clock.looks, 99);
}

// Never more steps behind it than are skipped, whatever came before; and it stays over.
TEST(Deadline, IsSeenWithinTheStepsThatAreSkipped) {
  for (int at = 0; at < 100; ++at) {
    CountedClock clock;
    clock.advance(1000);
    Deadline over(clock, 5000);
    for (int i = 0; i < at; ++i) {
      ASSERT_FALSE(over()) << at;
      clock.advance(10);
    }
    clock.advance(10'000);
    uint32_t asked = 0;
    while (!over()) ASSERT_LT(++asked, Deadline::kMostSkipped) << at;
    EXPECT_TRUE(over());
  }
}

}  // namespace
}  // namespace online_change
