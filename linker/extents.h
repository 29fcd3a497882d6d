// Ranges of bytes that are taken, and the gaps between them: the one allocator
// behind member offsets and areas. First fit.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace linker {

class Extents {
 public:
  // Adds a range; may touch or overlap others, with which it becomes one.
  void add(uint64_t begin, uint64_t size);
  // Takes a range away; it need not have been added as one.
  void remove(uint64_t begin, uint64_t size);
  // The lowest aligned begin of `size` bytes inside [low, high) that no range covers.
  std::optional<uint64_t> first_gap(uint64_t low, uint64_t high, uint64_t size,
                                    uint64_t align) const;
  // The lowest begin of `size` bytes inside one range (ranges as free space).
  std::optional<uint64_t> first_fit(uint64_t size) const;
  uint64_t largest() const;
  bool empty() const { return ranges_.empty(); }
  // begin -> end, disjoint, never adjacent.
  const std::map<uint64_t, uint64_t>& ranges() const { return ranges_; }

 private:
  std::map<uint64_t, uint64_t> ranges_;
};

}  // namespace linker
