// A deadline that is asked before every step of a switch. Most steps take less than a look at the
// clock, so it looks at every 16th ask while steps are short, and at each when they are not.
#pragma once

#include <algorithm>
#include <cstdint>

#include "vm/runtime/ports.h"

namespace online_change {

class Deadline {
 public:
  static constexpr uint32_t kMostSkipped = 16;
  static constexpr int64_t kLongNs = 10'000;  // between two looks

  Deadline(vm::Clock& clock, int64_t at_ns) : clock_(clock), at_ns_(at_ns) {}

  // Once it is over it stays over.
  bool operator()() {
    if (over_ || skip_-- > 1) return over_;
    const int64_t now_ns = clock_.now_ns();
    const bool brief = looked_ns_ != 0 && now_ns - looked_ns_ < kLongNs;
    stride_ = brief ? std::min(stride_ * 2, kMostSkipped) : 1;
    looked_ns_ = now_ns;
    skip_ = stride_;
    over_ = now_ns > at_ns_;
    return over_;
  }

 private:
  vm::Clock& clock_;
  int64_t at_ns_;
  int64_t looked_ns_ = 0;
  uint32_t stride_ = 1;
  uint32_t skip_ = 1;
  bool over_ = false;
};

}  // namespace online_change
