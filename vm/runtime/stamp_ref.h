// The stamp of an instance (ir/types/stamps.h) in data memory; of the globals (ID 0): the flag that
// tells start code that a change is what it runs for. Where there is none, it reads as kNewStamp
// and writing does nothing.
#pragma once

#include <cstdint>
#include <cstring>

#include "ir/types/stamps.h"
#include "vm/load/generation.h"

namespace vm {

class StampRef {
 public:
  StampRef(const Generation& generation, uint32_t id, uint8_t* memory) {
    if (generation.stamp(id) != 0) at_ = memory + generation.stamp(id);
  }
  bool valid() const { return at_ != nullptr; }
  uint32_t get() const {
    uint32_t value = ir::kNewStamp;
    if (at_ != nullptr) std::memcpy(&value, at_, sizeof value);
    return value;
  }
  void set(uint32_t value) const {
    if (at_ != nullptr) std::memcpy(at_, &value, sizeof value);
  }

 private:
  uint8_t* at_ = nullptr;
};

}  // namespace vm
