// Safe values of outputs (Image::safe): what they become when their task stops, or everything does
// (docs/TASKS.md). Allocates nothing after construction.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "ir/bytecode/image.h"

namespace vm {

class SafeOutputs {
 public:
  explicit SafeOutputs(const ir::Image& image);

  // The bits of `mask` in `outputs` become safe; holds for a time begin at `now_ns`. All spans have
  // Image::output_bytes.
  void apply(std::span<const uint8_t> mask, int64_t now_ns, std::span<uint8_t> outputs);
  // Bits whose hold is over take their value, and are set in `mask`; false: there are none.
  bool expire(int64_t now_ns, std::span<uint8_t> outputs, std::span<uint8_t> mask);
  // When the next hold is over; INT64_MAX: none runs.
  int64_t next_ns() const;
  void forget_holds();
  // What outputs become when nobody is there any more: holds for a time are over.
  struct AtTheEnd {
    base::Bytes value;
    base::Bytes held;  // mask of what stays as it is
  };
  static AtTheEnd at_the_end(const ir::Image& image);
  // Holds that run there go on here, where the rows are the same.
  void adopt_holds(const SafeOutputs& previous);

 private:
  struct Hold {
    ir::SafeOutput row;
    int64_t until_ns = 0;  // 0: does not run
    uint64_t bits = 0;     // of the row, for which it runs
  };
  // The bits of the row in `bytes`, and new ones where `mask` is set.
  static uint64_t take(const ir::SafeOutput& row, std::span<const uint8_t> bytes);
  static void put(const ir::SafeOutput& row, uint64_t value, uint64_t mask,
                  std::span<uint8_t> bytes);

  base::Bytes value_;
  base::Bytes held_;  // mask of what stays as it is
  std::vector<Hold> holds_;
};

}  // namespace vm
