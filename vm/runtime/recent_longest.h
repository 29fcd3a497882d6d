// The longest of the last times. A time that was long once is forgotten when enough others have
// followed. Adding costs two comparisons.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vm {

class RecentLongest {
 public:
  // Looks back on at least so many times, and on at most twice as many.
  static constexpr uint32_t kWindow = 500;

  void add(int64_t ns) {
    now_ = std::max(now_, ns);
    if (++count_ < kWindow) return;
    before_ = std::exchange(now_, 0);
    count_ = 0;
  }
  int64_t longest() const { return std::max(before_, now_); }

 private:
  int64_t before_ = 0;  // of the last kWindow that are complete
  int64_t now_ = 0;     // of those since
  uint32_t count_ = 0;
};

}  // namespace vm
