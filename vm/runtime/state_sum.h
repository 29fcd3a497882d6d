// A checksum of all values of a program, after every cycle of a recording: of variables, not of
// the room between them, where an earlier version may have left anything.
#pragma once

#include <cstdint>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"
#include "vm/runtime/controller.h"

namespace vm {

class StateSum {
 public:
  // For another version than last time, it finds out once where the values are: O(types, and
  // members of instances).
  uint32_t of(Controller& controller);

 private:
  class Walk;
  struct Text {
    uint32_t data = 0;
    uint32_t capacity = 0;  // characters
    uint32_t unit = 1;      // bytes of one
  };

  base::Digest version_{};
  bool known_ = false;
  std::vector<ir::Extent> runs_;
  std::vector<Text> texts_;
  base::Bytes values_;
};

}  // namespace vm
