// When something that has failed is tried again: soon at first, then after twice as long each time,
// up to a longest time. When it fails again soon after it was well, the waiting time goes on from
// where it was, so that a disk that comes and goes does not fill the journal.
#pragma once

#include <algorithm>
#include <cstdint>

namespace online_change {

class BackOff {
 public:
  BackOff(int64_t first_ns, int64_t longest_ns) : first_ns_(first_ns), longest_ns_(longest_ns) {}

  bool due(int64_t now_ns) const { return now_ns >= next_ns_; }
  void failed(int64_t now_ns) {
    const bool soon = delay_ns_ != 0 && now_ns - next_ns_ < kForget * longest_ns_;
    delay_ns_ = soon ? std::min(2 * delay_ns_, longest_ns_) : first_ns_;
    next_ns_ = now_ns + delay_ns_;
  }

 private:
  static constexpr int64_t kForget = 4;

  int64_t first_ns_;
  int64_t longest_ns_;
  int64_t delay_ns_ = 0;
  int64_t next_ns_ = 0;
};

}  // namespace online_change
