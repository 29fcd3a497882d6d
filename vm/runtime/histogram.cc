#include "vm/runtime/histogram.h"

#include <algorithm>
#include <bit>

namespace vm {

// Below 8 ns one class for each; then the three bits after the leading one.
uint32_t Histogram::class_of(uint64_t ns) {
  if (ns < 8) return static_cast<uint32_t>(ns);
  const auto exponent = static_cast<uint32_t>(std::bit_width(ns) - 1);
  return (exponent - 2) * 8 + static_cast<uint32_t>((ns >> (exponent - 3)) & 7);
}

int64_t Histogram::class_end(uint32_t number) {
  if (number < 8) return number + 1;
  const uint32_t exponent = number / 8 + 2;
  const uint64_t end = (uint64_t{8} + number % 8 + 1) << (exponent - 3);
  return static_cast<int64_t>(std::min<uint64_t>(end, INT64_MAX));
}

void Histogram::add(int64_t ns) {
  ns = std::max<int64_t>(ns, 0);
  ++classes_[class_of(static_cast<uint64_t>(ns))];
  min_ = count_ == 0 ? ns : std::min(min_, ns);
  max_ = std::max(max_, ns);
  sum_ = ns > INT64_MAX - sum_ ? INT64_MAX : sum_ + ns;
  ++count_;
}

int64_t Histogram::average() const { return count_ == 0 ? 0 : sum_ / static_cast<int64_t>(count_); }

int64_t Histogram::quantile(double share) const {
  const auto wanted = static_cast<uint64_t>(share * static_cast<double>(count_));
  uint64_t seen = 0;
  for (uint32_t i = 0; i < kClasses; ++i) {
    seen += classes_[i];
    if (seen > wanted || seen == count_) return std::min(class_end(i) - 1, max_);
  }
  return max_;
}

}  // namespace vm
