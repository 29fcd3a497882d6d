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
