// The two clocks: real time, and virtual time that runs the same code as fast as it can and
// always the same way.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vm/runtime/ports.h"

namespace vm {

// CLOCK_MONOTONIC, counted from construction; sleeps on absolute times, so nothing drifts.
class RealClock : public Clock {
 public:
  RealClock();
  int64_t now_ns() override;
  void wait_until(int64_t deadline_ns) override;
  void consumed(uint64_t) override {}
  void worked(int64_t) override {}
  // The same moment by CLOCK_MONOTONIC, which system calls wait for.
  int64_t as_monotonic(int64_t at_ns) const { return origin_ns_ + at_ns; }

 private:
  int64_t origin_ns_ = 0;
};

// Waiting jumps to the deadline. Execution takes `ns_per_safe_point` for each safe point, so a
// test decides how long a scan lasts by its loops; or the scans of a task last as long as is said
// here.
class VirtualClock : public Clock {
 public:
  explicit VirtualClock(int64_t ns_per_safe_point = 0) : ns_per_safe_point_(ns_per_safe_point) {}
  int64_t now_ns() override { return now_ns_; }
  void wait_until(int64_t deadline_ns) override {
    if (deadline_ns > now_ns_) now_ns_ = deadline_ns;
  }
  void consumed(uint64_t safe_points) override {
    now_ns_ += static_cast<int64_t>(safe_points) * ns_per_safe_point_;
  }
  void worked(int64_t expected_ns) override { now_ns_ += expected_ns; }
  void advance(int64_t ns) { now_ns_ += ns; }
  // From the start of a controller or its next change on.
  void let_scans_last(std::string task, int64_t ns) { scans_.emplace_back(std::move(task), ns); }
  int64_t scan_ns(std::string_view task) const override;

 private:
  int64_t now_ns_ = 0;
  int64_t ns_per_safe_point_;
  std::vector<std::pair<std::string, int64_t>> scans_;
};

}  // namespace vm
