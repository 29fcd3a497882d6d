// B4 without a controller: arrivals, starts and ends of scans in every order.
#include "vm/runtime/input_sync.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace {

using ir::IoBuffer;

constexpr IoBuffer kNewest[] = {IoBuffer::kCopied, IoBuffer::kLocked,
                                   IoBuffer::kSwapped, IoBuffer::kSwappedWithFlag,
                                   IoBuffer::kThree};

// One byte is received. A task as the scheduler treats it: all that arrives is offered, and what
// was received last once more where the buffer wants it when a scan starts.
class Task {
 public:
  explicit Task(IoBuffer strategy) : sync_(strategy, 1) {}

  void arrive(uint8_t value) {
    received_ = {value};
    if (!sync_.reads_last_written()) sync_.write(received_);
  }
  uint8_t start() {
    if (sync_.wants_last()) sync_.write(received_);
    sync_.begin();
    return seen();
  }
  void end() { sync_.end(); }
  uint8_t seen() const { return sync_.inputs()[0]; }

 private:
  vm::InputSync sync_;
  std::array<uint8_t, 1> received_{};
};

// What each scan sees of one order of events, 'a'rrival, 's'tart and 'e'nd; arrivals are counted.
// Empty: a scan has seen two things.
std::string seen(IoBuffer strategy, const std::string& events) {
  Task task(strategy);
  uint8_t arrived = 0;
  bool running = false;
  std::string all;
  for (const char event : events) {
    if (event == 'a') task.arrive(++arrived);
    if (event == 's') all += static_cast<char>('0' + task.start());
    if (event == 'e') task.end();
    running = event == 's' || (running && event != 'e');
    if (running && '0' + task.seen() != all.back()) return {};
  }
  return all;
}

// Of the rule itself: the newest when it starts.
std::string newest(const std::string& events) {
  char arrived = '0';
  std::string all;
  for (const char event : events) {
    if (event == 'a') ++arrived;
    if (event == 's') all += arrived;
  }
  return all;
}

// The first since the start before; when there is none, what was seen before.
std::string first_unseen(const std::string& events) {
  char arrived = '0';
  char first = '0';
  bool unseen = false;
  std::string all;
  for (const char event : events) {
    if (event == 'a' && ++arrived && !unseen) first = arrived;
    unseen = event == 'a' || (unseen && event != 's');
    if (event == 's') all += first;
  }
  return all;
}

// All orders of so many events in which scans start and end in turn.
template <class Each>
void every_order(std::string& events, size_t count, bool running, const Each& each) {
  if (events.size() == count) return each(events);
  for (const char event : {'a', running ? 'e' : 's'}) {
    events.push_back(event);
    every_order(events, count, event == 'a' ? running : !running, each);
    events.pop_back();
  }
}

TEST(InputSync, B4_EveryStrategyShowsTheNewestThatHadArrived) {
  int orders = 0;
  std::string events;
  every_order(events, 10, false, [&](const std::string& order) {
    ++orders;
    for (const IoBuffer strategy : kNewest) {
      ASSERT_EQ(seen(strategy, order), newest(order)) << order << static_cast<int>(strategy);
    }
  });
  EXPECT_EQ(orders, 1024);
}

TEST(InputSync, B4_FirstUnseenShowsTheFirstSinceTheStartBefore) {
  std::string events;
  every_order(events, 10, false, [&](const std::string& order) {
    ASSERT_EQ(seen(IoBuffer::kFirstUnseen, order), first_unseen(order)) << order;
  });
  EXPECT_EQ(first_unseen("asaaeseseas"), "1224");
}

// Where nothing has come since the last start there is older data in the other buffer.
TEST(InputSync, B4_NothingNewBringsNothingOlderBack) {
  for (const IoBuffer strategy : kNewest) {
    EXPECT_EQ(seen(strategy, "aseaseses"), "1222") << static_cast<int>(strategy);
  }
  EXPECT_EQ(seen(IoBuffer::kFirstUnseen, "aseaseses"), "1222");
}

// What came before a restart is older than what comes behind it.
TEST(InputSync, ARestartForgetsWhatNoScanHasSeen) {
  vm::InputSync sync(IoBuffer::kFirstUnseen, 1);
  const std::array<uint8_t, 1> old = {1};
  const std::array<uint8_t, 1> now = {2};
  sync.write(old);
  sync.restart();
  sync.write(now);
  sync.begin();
  EXPECT_EQ(sync.inputs()[0], 2);
}

}  // namespace
