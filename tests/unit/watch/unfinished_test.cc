// what `--watch` holds back, in times that the test says: a loaded machine changes nothing.
#include "tools/stc/unfinished.h"

#include <gtest/gtest.h>

namespace stc {
namespace {

using std::chrono::milliseconds, std::chrono::seconds;
using Time = Unfinished::Time;

constexpr Time kBegin{std::chrono::hours(1)};
constexpr seconds kPause{10};

FileStamp stamp(int64_t bytes, int64_t at = 1) { return {at, 0, bytes, 7}; }

struct Look {
  Stamps before{{"a.st", stamp(10)}, {"b.st", stamp(20)}};
  Stamps now = before;
  std::map<std::string, Time> begun;
  Time lost = Time::min();
  Unfinished unfinished{kPause};
  std::string told;

  // After so long.
  std::optional<Time> at(milliseconds time) {
    testing::internal::CaptureStderr();
    const auto until = unfinished.until(before, now, {begun, lost}, kBegin + time);
    told += testing::internal::GetCapturedStderr();
    return until;
  }
};

TEST(Unfinished, WhatIsSavedAndClosedIsComplete) {
  Look look;
  look.now["a.st"] = stamp(11, 2);
  EXPECT_EQ(look.at(milliseconds(0)), std::nullopt);
}

TEST(Unfinished, AFileThatIsAwayIsGoneAfterAFifthOfThePause) {
  Look look;
  look.now.erase("a.st");
  EXPECT_EQ(look.at(milliseconds(0)), kBegin + seconds(2));
  look.now["b.st"] = stamp(21, 2);  // another one is saved meanwhile
  EXPECT_EQ(look.at(milliseconds(1999)), kBegin + seconds(2));
  EXPECT_EQ(look.at(milliseconds(2000)), std::nullopt);
}

TEST(Unfinished, AFileThatCameBackHasNotBeenAway) {
  Look look;
  look.now.erase("a.st");
  look.at(milliseconds(0));
  look.now["a.st"] = stamp(12, 3);
  EXPECT_EQ(look.at(milliseconds(100)), std::nullopt);
  look.now["a.st"] = stamp(0, 4);  // empty is away, and since now
  EXPECT_EQ(look.at(milliseconds(1500)), kBegin + milliseconds(3500));
}

TEST(Unfinished, AWriterIsWaitedForUntilItPausesTooLong) {
  Look look;
  look.now["a.st"] = stamp(5, 2);
  look.begun["a.st"] = kBegin;
  EXPECT_EQ(look.at(milliseconds(0)), kBegin + kPause);
  look.begun["a.st"] = kBegin + seconds(9);
  EXPECT_EQ(look.at(seconds(9)), kBegin + seconds(19));
  EXPECT_EQ(look.at(seconds(19)), std::nullopt);
  look.begun.clear();
  EXPECT_EQ(look.at(seconds(9)), std::nullopt) << "closed";
}

TEST(Unfinished, AWriterOfAFileOfNoProjectHoldsNothingBack) {
  Look look;
  look.now["a.st"] = stamp(5, 2);
  look.begun["noise.log"] = kBegin;
  EXPECT_EQ(look.at(milliseconds(0)), std::nullopt);
}

TEST(Unfinished, WhatTheSystemCouldNotTellMayBeHalfWritten) {
  Look look;
  look.lost = kBegin;
  EXPECT_EQ(look.at(milliseconds(0)), std::nullopt) << "nothing was saved";
  look.now["a.st"] = stamp(5, 2);
  EXPECT_EQ(look.at(milliseconds(1)), kBegin + kPause);
  EXPECT_EQ(look.at(kPause), std::nullopt);
}

TEST(Unfinished, WhoIsHeldBackIsToldOnceByWhichFile) {
  Look look;
  look.now["a.st"] = stamp(5, 2);
  for (int second = 0; second < 30; ++second) {
    look.begun["b.st"] = kBegin + seconds(second);  // goes on and on
    look.at(seconds(second));
    EXPECT_EQ(look.told.empty(), second < 5) << second;
  }
  EXPECT_EQ(look.told,
            "waiting with what was saved: b.st is being written; until it is closed, or for 10 s "
            "after its last write\n");
}

}  // namespace
}  // namespace stc
