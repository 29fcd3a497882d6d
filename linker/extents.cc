#include "linker/extents.h"

#include <algorithm>

namespace linker {

void Extents::add(uint64_t begin, uint64_t size) {
  if (size == 0) return;
  const uint64_t end = begin + size;
  auto next = ranges_.upper_bound(begin);
  const bool touches = next != ranges_.begin() && std::prev(next)->second >= begin;
  uint64_t& own_end = (touches ? std::prev(next) : ranges_.emplace_hint(next, begin, end))->second;
  own_end = std::max(own_end, end);
  while (next != ranges_.end() && next->first <= own_end) {
    own_end = std::max(own_end, next->second);
    next = ranges_.erase(next);
  }
}

void Extents::remove(uint64_t begin, uint64_t size) {
  const uint64_t end = begin + size;
  auto next = ranges_.upper_bound(begin);
  if (next != ranges_.begin()) --next;
  while (next != ranges_.end() && next->first < end) {
    const auto [first, last] = *next;
    if (last <= begin) {
      ++next;
      continue;
    }
    next = ranges_.erase(next);
    if (first < begin) ranges_.emplace(first, begin);
    if (last > end) ranges_.emplace(end, last);
  }
}

std::optional<uint64_t> Extents::first_gap(uint64_t low, uint64_t high, uint64_t size,
                                           uint64_t align) const {
  const auto aligned = [align](uint64_t at) { return (at + align - 1) / align * align; };
  uint64_t at = aligned(low);
  auto next = ranges_.upper_bound(low);
  if (next != ranges_.begin() && std::prev(next)->second > low) --next;
  for (; next != ranges_.end() && next->first < at + size && at + size <= high; ++next) {
    at = std::max(at, aligned(next->second));
  }
  if (at + size > high) return std::nullopt;
  return at;
}

std::optional<uint64_t> Extents::first_fit(uint64_t size) const {
  for (const auto& [begin, end] : ranges_) {
    if (end - begin >= size) return begin;
  }
  return std::nullopt;
}

uint64_t Extents::largest() const {
  uint64_t largest = 0;
  for (const auto& [begin, end] : ranges_) largest = std::max(largest, end - begin);
  return largest;
}

}  // namespace linker
