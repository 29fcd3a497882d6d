#include "tools/stc/memory_budget.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <new>

#include "tools/common/exit.h"

namespace stc {
namespace {

#define LIMIT(id, value, what) constexpr size_t id = value;
#include "base/tool_limits.def"
#undef LIMIT

constinit std::atomic<size_t> taken{0};
constinit std::atomic<size_t> budget{SIZE_MAX};  // until limit_memory()
constinit std::atomic<uint64_t> input{0};
// The last request of this thread: by the budget, not by the machine.
constinit thread_local bool refused = false;

// Nothing here may need memory, so the message is not made by tools::refuse.
[[noreturn]] void out_of_memory() {
  constexpr size_t kMega = 1 << 20;
  char text[600];
  const int length =
      refused
          ? std::snprintf(
                text, sizeof text,
                "stc: R0118: memory needed exceeds the limit: more than %zu MiB for %llu bytes of "
                "input (kMaxBuildBytes, kMaxBuildBytesPerByte)\n"
                "  help: Make large arrays of function blocks, long lists of initial values, or "
                "types that hold each other many times smaller, or split the program.\n",
                budget.load() / kMega, static_cast<unsigned long long>(input.load()))
          : std::snprintf(
                text, sizeof text,
                "stc: R0118: memory needed exceeds the limit: the machine gives no more than %zu "
                "MiB to this process\n"
                "  help: Raise the limit of the shell (ulimit -v), free memory, or "
                "build on a larger machine.\n",
                taken.load() / kMega);
  const ssize_t written = ::write(STDERR_FILENO, text, static_cast<size_t>(length));
  static_cast<void>(written);
  ::_exit(tools::kRefused);
}

}  // namespace

void limit_memory() {
  budget.store(kMaxBuildBytes);
  std::set_new_handler(out_of_memory);
}

void expect_input(uint64_t bytes) {
  if (bytes <= input.load()) return;
  input.store(bytes);
  budget.store(std::max<size_t>(kMaxBuildBytes, bytes * kMaxBuildBytesPerByte));
}

bool take_memory(size_t bytes) noexcept {
  const size_t now = taken.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  refused = now < bytes || now > budget.load(std::memory_order_relaxed);
  if (refused) taken.fetch_sub(bytes, std::memory_order_relaxed);
  return !refused;
}

void count_memory(size_t bytes) noexcept { taken.fetch_add(bytes, std::memory_order_relaxed); }
void give_memory(size_t bytes) noexcept { taken.fetch_sub(bytes, std::memory_order_relaxed); }
bool is_memory_scarce(size_t bytes) noexcept {
  return taken.load(std::memory_order_relaxed) + bytes > budget.load(std::memory_order_relaxed) / 2;
}

}  // namespace stc
