// Times of a task, counted in classes that are an eighth wide: adding is a few instructions and
// allocates nothing, quantiles are right to 12.5 %.
#pragma once

#include <array>
#include <cstdint>

namespace vm {

class Histogram {
 public:
  // Eight classes for each power of two, from 1 ns up.
  static constexpr uint32_t kClasses = 8 * 64;

  void add(int64_t ns);
  uint64_t count() const { return count_; }
  int64_t min() const { return count_ == 0 ? 0 : min_; }
  int64_t max() const { return max_; }
  int64_t average() const;
  int64_t total() const { return sum_; }  // stays at the largest number there is
  // The time that `share` (0..1) of all do not exceed: the end of its class, at most max().
  int64_t quantile(double share) const;
  // For class `number`: how many there are, and the first time that belongs to the next one.
  uint64_t in_class(uint32_t number) const { return classes_[number]; }
  static int64_t class_end(uint32_t number);

 private:
  static uint32_t class_of(uint64_t ns);

  std::array<uint64_t, kClasses> classes_{};
  uint64_t count_ = 0;
  int64_t min_ = 0;
  int64_t max_ = 0;
  int64_t sum_ = 0;
};

}  // namespace vm
