// B5 without a controller: ends of scans and transmissions in every order.
#include "vm/runtime/output_sync.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace output_sync_test {
namespace {

using ir::IoBuffer;

constexpr IoBuffer kNewest[] = {IoBuffer::kCopied, IoBuffer::kLocked, IoBuffer::kSwapped,
                                IoBuffer::kSwappedWithFlag, IoBuffer::kThree};

// Two bytes of outputs, as the scheduler treats them: what a scan has changed is written when it
// ends, and taken by a transmission.
class Task {
 public:
  explicit Task(IoBuffer strategy) : sync_(strategy, 2) {}

  void end(std::array<uint8_t, 2> outputs) {
    std::array<uint8_t, 2> mask{};
    for (size_t i = 0; i < 2; ++i) mask[i] = outputs[i] ^ variables_[i];
    variables_ = outputs;
    sync_.write(variables_, mask);
  }
  std::string send() {
    std::array<uint8_t, 2> mask{};
    sync_.take(sent_, mask);
    return std::to_string(sent_[0]) + std::to_string(sent_[1]) + " ";
  }
  vm::OutputSync& sync() { return sync_; }

 private:
  vm::OutputSync sync_;
  std::array<uint8_t, 2> variables_{};
  std::array<uint8_t, 2> sent_{};
};

// A scan that ends as `event` says: it changes the first byte, the second, both or none.
std::array<uint8_t, 2> outputs_after(char event, uint8_t number, std::array<uint8_t, 2> before) {
  if (event == 'a' || event == 'c') before[0] = number;
  if (event == 'b' || event == 'c') before[1] = number;
  return before;
}

// What is sent in one order of events: 't'ransmissions and ends of scans.
std::string sent(IoBuffer strategy, const std::string& events) {
  Task task(strategy);
  std::array<uint8_t, 2> outputs{};
  uint8_t number = 0;
  std::string all;
  for (const char event : events) {
    if (event == 't') {
      all += task.send();
    } else {
      task.end(outputs = outputs_after(event, ++number, outputs));
    }
  }
  EXPECT_FALSE(task.sync().waits()) << events;  // all orders end with transmissions
  return all;
}

std::string text(const std::array<uint8_t, 2>& outputs) {
  return std::to_string(outputs[0]) + std::to_string(outputs[1]) + " ";
}

// Of the rule itself: the last that has ended.
std::string newest(const std::string& events) {
  std::array<uint8_t, 2> outputs{};
  uint8_t number = 0;
  std::string all;
  for (const char event : events) {
    if (event == 't') {
      all += text(outputs);
    } else {
      outputs = outputs_after(event, ++number, outputs);
    }
  }
  return all;
}

// The first that differs from what was sent, then, with the next transmission, the newest.
std::string first_unseen(const std::string& events) {
  std::array<uint8_t, 2> outputs{};
  std::array<uint8_t, 2> sent{};
  std::array<uint8_t, 2> first{};
  uint8_t number = 0;
  std::string all;
  for (const char event : events) {
    if (event == 't') {
      sent = first;
      first = outputs;
      all += text(sent);
    } else {
      outputs = outputs_after(event, ++number, outputs);
      if (first == sent) first = outputs;
    }
  }
  return all;
}

template <class Each>
void every_order(std::string& events, size_t count, const Each& each) {
  if (events.size() == count) return each(events);
  for (const char event : {'t', 'a', 'b', 'c', 'n'}) {
    events.push_back(event);
    every_order(events, count, each);
    events.pop_back();
  }
}

TEST(OutputSync, B5_EveryStrategySendsTheNewestThatIsComplete) {
  int orders = 0;
  std::string events;
  every_order(events, 6, [&](const std::string& order) {
    ++orders;
    for (const IoBuffer strategy : kNewest) {
      ASSERT_EQ(sent(strategy, order + "ttt"), newest(order + "ttt"))
          << order << static_cast<int>(strategy);
    }
  });
  EXPECT_EQ(orders, 15'625);
}

TEST(OutputSync, B5_FirstUnseenSendsTheFirstAndThenTheNewest) {
  std::string events;
  every_order(events, 6, [&](const std::string& order) {
    ASSERT_EQ(sent(IoBuffer::kFirstUnseen, order + "ttt"), first_unseen(order + "ttt")) << order;
  });
  EXPECT_EQ(first_unseen("aabtttatt"), "10 23 23 43 43 ");
}

// Which buffer is with whom (B11).
TEST(OutputSync, B5_B11_BuffersChangePlaces) {
  const auto numbers = [](Task& task) {
    const vm::BufferState state = task.sync().state(false, false);
    const auto text = [](uint8_t number) {
      return number == vm::BufferState::kNone ? std::string("-") : std::to_string(number);
    };
    return text(state.writer) + text(state.waiting) + text(state.reader) + " ";
  };
  const auto places = [&](IoBuffer strategy) {
    Task task(strategy);
    std::string all = numbers(task);
    task.end({1, 0});
    all += numbers(task);
    (void)task.send();
    all += numbers(task);
    (void)task.send();
    return all + numbers(task);
  };
  EXPECT_EQ(places(IoBuffer::kCopied), "0-1 0-1 0-1 0-1 ");
  EXPECT_EQ(places(IoBuffer::kLocked), "0-0 0-0 0-0 0-0 ");
  EXPECT_EQ(places(IoBuffer::kSwapped), "0-1 1-0 1-0 1-0 ");
  EXPECT_EQ(places(IoBuffer::kSwappedWithFlag), "0-1 0-1 1-0 1-0 ");
  EXPECT_EQ(places(IoBuffer::kThree), "021 201 210 210 ");
  EXPECT_EQ(places(IoBuffer::kFirstUnseen), "0-1 0-1 0-1 0-1 ");
}

// What waits goes over to the buffers of the next version, whichever kind they are.
TEST(OutputSync, B5_WhatWaitsIsKeptByAChange) {
  for (int from = 0; from < static_cast<int>(ir::kIoBufferCount); ++from) {
    for (int to = 0; to < static_cast<int>(ir::kIoBufferCount); ++to) {
      Task old(static_cast<IoBuffer>(from));
      old.end({1, 0});
      old.end({2, 3});
      Task next(static_cast<IoBuffer>(to));
      next.sync().keep(old.sync());
      const bool first = static_cast<IoBuffer>(from) == IoBuffer::kFirstUnseen &&
                         static_cast<IoBuffer>(to) == IoBuffer::kFirstUnseen;
      EXPECT_EQ(next.send(), first ? "10 " : "23 ") << from << to;
      EXPECT_EQ(next.send(), "23 ") << from << to;
      EXPECT_FALSE(next.sync().waits());
    }
  }
}

// What was set from outside is newer than what waits.
TEST(OutputSync, WhatIsWrittenFromOutsideDoesNotWait) {
  for (int kind = 0; kind < static_cast<int>(ir::kIoBufferCount); ++kind) {
    Task task(static_cast<IoBuffer>(kind));
    task.end({5, 6});
    task.sync().forget(0, 0xff);
    std::array<uint8_t, 2> mask{};
    task.sync().mark(mask);
    EXPECT_EQ(mask[0], 0) << kind;
    EXPECT_EQ(task.send(), "06 ") << kind;
    task.end({7, 7});
    task.sync().restart();
    EXPECT_EQ(task.send(), "06 ") << kind;
  }
}

}  // namespace
}  // namespace output_sync_test
