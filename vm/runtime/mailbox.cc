#include "vm/runtime/mailbox.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <thread>

namespace vm {
namespace {

// Short enough that a command feels immediate, long enough to cost nothing.
constexpr auto kPoll = std::chrono::microseconds(100);
constexpr int64_t kNsPerSecond = 1'000'000'000;

}  // namespace

Mailbox::Outcome Mailbox::run(const std::function<void()>& job, int64_t timeout_ns) {
  auto deadline = std::chrono::steady_clock::now() + std::chrono::nanoseconds(timeout_ns);
  job_ = &job;
  uint32_t expected = kEmpty;
  if (!state_.compare_exchange_strong(expected, kPosted, std::memory_order_acq_rel)) {
    return Outcome::kClosed;
  }
  ::syscall(SYS_futex, &state_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
  for (;;) {
    uint32_t state = state_.load(std::memory_order_acquire);
    if (state == kDone) {
      expected = kDone;
      state_.compare_exchange_strong(expected, kEmpty, std::memory_order_acq_rel);
      return Outcome::kDone;
    }
    if (state == kClosed) return Outcome::kClosed;
    if (state == kPosted && std::chrono::steady_clock::now() >= deadline) {
      expected = kPosted;
      if (state_.compare_exchange_strong(expected, kEmpty, std::memory_order_acq_rel)) {
        return Outcome::kTimeout;
      }
      continue;  // it was taken just now
    }
    std::this_thread::sleep_for(kPoll);
  }
}

void Mailbox::pause(int64_t ns) { std::this_thread::sleep_for(std::chrono::nanoseconds(ns)); }

// Whatever ends it early is looked at by the caller, as the end of the time is.
void Mailbox::wait(int64_t ns) {
  const uint32_t seen = state_.load(std::memory_order_acquire);
  if (seen == kPosted || ns <= 0) return;
  const timespec time{ns / kNsPerSecond, ns % kNsPerSecond};
  ::syscall(SYS_futex, &state_, FUTEX_WAIT_PRIVATE, seen, &time, nullptr, 0);
}

void Mailbox::serve() {
  uint32_t expected = kPosted;
  if (!state_.compare_exchange_strong(expected, kRunning, std::memory_order_acq_rel)) return;
  (*job_)();
  state_.store(kDone, std::memory_order_release);
}

void Mailbox::close() {
  uint32_t state = state_.load(std::memory_order_acquire);
  // The answer of the last job must still be seen; the channel thread empties the box first.
  while (state == kDone || !state_.compare_exchange_weak(state, kClosed)) {
    if (state == kDone) {
      std::this_thread::sleep_for(kPoll);
      state = state_.load(std::memory_order_acquire);
    }
  }
}

}  // namespace vm
