#include "base/parallel.h"

#include <gtest/gtest.h>

#include <pthread.h>

#include <atomic>
#include <vector>

namespace base {
namespace {

TEST(Parallel, EveryIndexIsWorkedOnOnce) {
  for (const size_t count : {0, 1, 7, 8, 9, 64, 1000}) {
    for (const uint32_t jobs : {0u, 1u, 2u, 5u, 1000u}) {
      for (const size_t batch : {0, 1, 8, 2000}) {
        std::vector<uint32_t> times(count, 0);
        for_each_index(count, jobs, batch, [&](size_t i) { ++times[i]; });
        EXPECT_EQ(times, std::vector<uint32_t>(count, 1)) << count << ' ' << jobs << ' ' << batch;
      }
    }
  }
}

// Two elements that wait for each other can only end on two threads.
TEST(Parallel, ElementsAreWorkedOnAtTheSameTime) {
  std::atomic<int> arrived = 0;
  for_each_index(2, 2, 1, [&](size_t) {
    ++arrived;
    while (arrived < 2) {
    }
  });
  EXPECT_EQ(arrived, 2);
}

TEST(Parallel, LittleWorkStaysWithTheCaller) {
  const pthread_t caller = pthread_self();
  for_each_index(15, 8, 8, [&](size_t) { EXPECT_TRUE(pthread_equal(caller, pthread_self())); });
  for_each_index(100, 1, 1, [&](size_t) { EXPECT_TRUE(pthread_equal(caller, pthread_self())); });
}

TEST(Parallel, CoresAreCounted) {
  EXPECT_GE(usable_cores(), 1u);
  EXPECT_LE(usable_cores(), kMaxJobs);
}

}  // namespace
}  // namespace base
