// A check in a process of its own may wait as long as the machine lets it, and compute no longer
// than it is said.
#include "tests/differential/isolated.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace differential {
namespace {

TEST(Isolated, AMachineThatIsBusyIsNoFinding) {
  const Finding found = isolated(
      [] {
        std::this_thread::sleep_for(std::chrono::milliseconds(1500));
        return Finding{};
      },
      1);
  EXPECT_FALSE(found.failed) << found.text;
}

TEST(Isolated, AnEndlessLoopIsOne) {
  const Finding found = isolated(
      [] {
        std::atomic<bool> turns = true;
        while (turns.load()) continue;
        return Finding{};
      },
      1);
  EXPECT_TRUE(found.failed);
  EXPECT_NE(found.text.find("CPU time"), std::string::npos) << found.text;
}

}  // namespace
}  // namespace differential
