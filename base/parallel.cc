#include "base/parallel.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace base {
namespace {

struct Crew {
  size_t count;
  size_t batch;
  parallel::Call call;
  const void* work;
  std::atomic<size_t> next = 0;

  void take_part() {
    for (;;) {
      const size_t begin = next.fetch_add(batch, std::memory_order_relaxed);
      if (begin >= count) return;
      const size_t end = std::min(count, begin + batch);
      for (size_t i = begin; i < end; ++i) call(work, i);
    }
  }
};

void* enter(void* crew) {
  static_cast<Crew*>(crew)->take_part();
  return nullptr;
}

}  // namespace

uint32_t usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return std::clamp<uint32_t>(static_cast<uint32_t>(CPU_COUNT(&set)), 1, kMaxJobs);
}

// POSIX threads: that none can be had is an answer there, not an exception.
void parallel::run(size_t count, uint32_t jobs, size_t batch, Call call, const void* work) {
  batch = std::max<size_t>(batch, 1);
  Crew crew{count, batch, call, work};
  const size_t batches = count / batch;  // of full size
  const size_t wanted = std::min<size_t>({jobs, batches, kMaxJobs});
  std::vector<pthread_t> threads;
  while (threads.size() + 1 < wanted) {
    pthread_t thread;
    if (pthread_create(&thread, nullptr, enter, &crew) != 0) break;
    threads.push_back(thread);
  }
  crew.take_part();
  for (const pthread_t thread : threads) pthread_join(thread, nullptr);
}

}  // namespace base
