// Where the constants of two versions differ. The linker gives a place that nobody names any more
// to another constant, so one in the middle may change.
#pragma once

#include <cstddef>

#include "base/bytes.h"

namespace ir {

// Bytes of a pool; empty: begin == end.
struct ConstantRange {
  size_t begin = 0;
  size_t end = 0;
  bool meets(size_t offset, size_t size) const { return offset < end && begin < offset + size; }
};

// Of the bytes that both pools have: from the first that is another one to behind the last.
ConstantRange changed_constants(base::ByteSpan before, base::ByteSpan after);

}  // namespace ir
