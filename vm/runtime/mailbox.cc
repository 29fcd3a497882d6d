#include "vm/runtime/mailbox.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <thread>

#include "ir/types/time_units.h"

namespace vm {
namespace {

// Short enough that a command feels immediate, long enough to cost nothing.
constexpr auto kPoll = std::chrono::microseconds(100);
// Between two looks at whether anybody still wants it.
constexpr int kPollsPerLook = 200;

}  // namespace

Mailbox::Outcome Mailbox::run(const std::function<void()>& job, int64_t timeout_ns) {
  auto deadline = std::chrono::steady_clock::now() + std::chrono::nanoseconds(timeout_ns);
  job_ = &job;
  if (!post()) return Outcome::kClosed;
  for (int polls = 1;; ++polls) {
    uint32_t state = state_.load(std::memory_order_acquire);
    if (state == kDone) {
      uint32_t expected = kDone;
      state_.compare_exchange_strong(expected, kEmpty, std::memory_order_acq_rel);
      return Outcome::kDone;
    }
    if (state == kClosed) return Outcome::kClosed;
    const bool late = std::chrono::steady_clock::now() >= deadline;
    if (state == kPosted && (late || (give_up && polls % kPollsPerLook == 0))) {
      if (!take_back()) continue;  // it was taken just now
      if (late || give_up()) return Outcome::kTimeout;
      if (!post()) return Outcome::kClosed;
    }
    std::this_thread::sleep_for(kPoll);
  }
}

bool Mailbox::post() {
  uint32_t expected = kEmpty;
  if (!state_.compare_exchange_strong(expected, kPosted, std::memory_order_acq_rel)) return false;
  ::syscall(SYS_futex, &state_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
  return true;
}

bool Mailbox::take_back() {
  uint32_t expected = kPosted;
  return state_.compare_exchange_strong(expected, kEmpty, std::memory_order_acq_rel);
}

void Mailbox::pause(int64_t ns) { std::this_thread::sleep_for(std::chrono::nanoseconds(ns)); }

// Whatever ends it early is looked at by the caller, as the end of the time is.
void Mailbox::sleep_until(int64_t monotonic_ns) {
  const uint32_t seen = state_.load(std::memory_order_acquire);
  if (seen == kPosted) return;
  const timespec until{monotonic_ns / ir::kNsPerSecond, monotonic_ns % ir::kNsPerSecond};
  ::syscall(SYS_futex, &state_, FUTEX_WAIT_BITSET_PRIVATE, seen, &until, nullptr,
            FUTEX_BITSET_MATCH_ANY);
}

void Mailbox::wait_until(const RealClock& clock, int64_t at_ns) {
  sleep_until(clock.as_monotonic(at_ns));
}

void Mailbox::wait(int64_t ns) {
  RealClock clock;
  if (ns > 0) wait_until(clock, clock.now_ns() + ns);
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
