// B8: what one thread publishes, the other takes whole, the newest first, and nobody waits.
#include "vm/io/triple_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

namespace vm {
namespace {

TEST(TripleBuffer, GivesTheNewestOnce) {
  TripleBuffer buffer(1);
  EXPECT_FALSE(buffer.take());
  for (uint8_t value : {1, 2}) {
    buffer.work()[0] = value;
    buffer.publish();
  }
  EXPECT_TRUE(buffer.take());
  EXPECT_EQ(buffer.newest()[0], 2);
  EXPECT_FALSE(buffer.take());
  EXPECT_EQ(buffer.newest()[0], 2);
}

// Both sides in one thread, in every order of their steps: half a value is written, the other half
// and published; the newest is taken. What the reader has is whole, and stays until it takes again.
TEST(TripleBuffer, B8_NothingIsTornInAnyOrderOfSteps) {
  constexpr uint32_t kSteps = 14;
  for (uint32_t order = 0; order < 1u << kSteps; ++order) {
    TripleBuffer buffer(2);
    uint8_t written = 0;
    uint8_t published = 0;
    uint8_t taken = 0;
    bool begun = false;
    for (uint32_t step = 0; step < kSteps; ++step) {
      if (((order >> step) & 1) == 0) {
        const bool is_new = buffer.take();
        ASSERT_EQ(is_new, published != taken) << order;
        taken = published;
      } else if (!begun) {
        buffer.work()[0] = ++written;
        begun = true;
      } else {
        buffer.work()[1] = written;
        buffer.publish();
        published = written;
        begun = false;
      }
      ASSERT_EQ(buffer.newest()[0], taken) << order << " " << step;
      ASSERT_EQ(buffer.newest()[1], taken) << order << " " << step;
    }
  }
}

TEST(TripleBuffer, B8_NothingIsTornBetweenThreads) {
  constexpr size_t kBytes = 256;
  constexpr int kRounds = 200'000;
  TripleBuffer buffer(kBytes);
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (int round = 1; round <= kRounds; ++round) {
      std::ranges::fill(buffer.work(), static_cast<uint8_t>(round));
      buffer.publish();
    }
    done = true;
  });
  int torn = 0;
  int taken = 0;
  for (bool last = false; !last;) {
    last = done;
    if (!buffer.take()) continue;
    ++taken;
    const auto now = buffer.newest();
    torn += std::any_of(now.begin(), now.end(), [&](uint8_t v) { return v != now[0]; });
  }
  writer.join();
  EXPECT_GT(taken, 0);
  EXPECT_EQ(buffer.newest()[0], static_cast<uint8_t>(kRounds));
  EXPECT_EQ(torn, 0);
  EXPECT_FALSE(buffer.take());
}

}  // namespace
}  // namespace vm
