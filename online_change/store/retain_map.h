// Where the bytes of data memory are among the retained ones, which are the ranges of Image::retain
// one after the other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

class RetainMap {
 public:
  struct Part {
    uint32_t data = 0;
    uint32_t size = 0;
    size_t at = 0;
  };

  explicit RetainMap(const ir::Image& image) {
    size_t at = 0;
    for (const ir::RetainRange& range : image.retain) {
      parts_.push_back({range.data, range.size, at});
      at += range.size;
    }
    std::sort(parts_.begin(), parts_.end(),
              [](const Part& a, const Part& b) { return a.data < b.data; });
  }

  // Calls visit(offset in data memory, bytes, place among the values) for what is retained of it.
  template <class Visit>
  void for_each(uint64_t data, uint64_t size, Visit visit) const {
    auto part = std::partition_point(parts_.begin(), parts_.end(), [&](const Part& each) {
      return uint64_t{each.data} + each.size <= data;
    });
    for (; part != parts_.end() && part->data < data + size; ++part) {
      const uint64_t begin = std::max<uint64_t>(part->data, data);
      const uint64_t end = std::min<uint64_t>(uint64_t{part->data} + part->size, data + size);
      if (begin < end) visit(begin, end - begin, part->at + (begin - part->data));
    }
  }

  // The place of something that is retained as a whole.
  std::optional<size_t> find(uint64_t data, uint64_t size) const {
    std::optional<size_t> found;
    for_each(data, size, [&](uint64_t begin, uint64_t bytes, size_t at) {
      if (begin == data && bytes == size) found = at;
    });
    return found;
  }

 private:
  std::vector<Part> parts_;
};

}  // namespace online_change
