#include "vm/runtime/clocks.h"

#include <cerrno>
#include <ctime>

#include "base/name_case.h"
#include "ir/types/time_units.h"

namespace vm {
namespace {


int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<int64_t>(now.tv_sec) * ir::kNsPerSecond + now.tv_nsec;
}

}  // namespace

RealClock::RealClock() : origin_ns_(monotonic_ns()) {}

int64_t RealClock::now_ns() { return monotonic_ns() - origin_ns_; }

void RealClock::wait_until(int64_t deadline_ns) {
  int64_t absolute = deadline_ns + origin_ns_;
  timespec until{absolute / ir::kNsPerSecond, absolute % ir::kNsPerSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

int64_t VirtualClock::scan_ns(std::string_view task) const {
  int64_t ns = 0;
  for (const auto& [name, duration] : scans_) {
    if (base::same_name(name, task)) ns = duration;
  }
  return ns;
}

}  // namespace vm
