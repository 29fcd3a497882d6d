// Where the bytes lie that the text of a variable is made of: its own, and those of the instances
// inside it, which have areas of their own. For whoever copies values before making text of them.
#pragma once

#include <vector>

#include "ir/bytecode/symbols.h"

namespace ir {

struct DataRange {
  uint32_t data = 0;
  uint32_t size = 0;
};

// Memory is read in lines of so many bytes, whatever of them is wanted.
inline constexpr uint32_t kLineBytes = 64;

class ValueRanges {
 public:
  // `image` is borrowed. A range counts as one line at least.
  ValueRanges(const Image& image, uint64_t max_bytes) : image_(image), left_(max_bytes) {}
  // False: more than `max_bytes` with what was added before; the rest is not looked for.
  bool add(const Symbol& symbol);
  std::vector<DataRange> take() { return std::move(ranges_); }

 private:
  enum class Holds : uint8_t { kUnknown, kNo, kYes };
  bool add_range(uint32_t data, uint32_t size);
  bool instances(TypeId id, uint32_t data, uint32_t depth);
  bool part(TypeId id, uint32_t data, uint32_t depth);
  bool holds_instance(TypeId id, uint32_t depth);

  const Image& image_;
  uint64_t left_;
  std::vector<DataRange> ranges_;
  std::vector<Holds> holds_;  // by type, once it is asked for
};

// As in symbols.h; the text of an aggregate ends early, soon after `max_bytes`.
std::string format_value(const Image& image, const Symbol& symbol, std::span<const uint8_t> memory,
                         size_t max_bytes);

}  // namespace ir
