// The stamp of an instance (ir/types/stamps.h) in data memory; of the globals (ID 0): the flag that
// tells start code that a change is what it runs for. Where there is none, it reads as kNewStamp
// and writing does nothing.
#pragma once

#include <cstdint>
#include <cstring>

#include "ir/bytecode/image.h"
#include "ir/types/stamps.h"

namespace vm {

class StampRef {
 public:
  StampRef(const ir::Image& image, uint32_t id, uint8_t* memory) {
    const ir::Instance& instance = image.instances[id];
    const std::vector<ir::Member>& members = image.types[instance.type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      if (members[i].section != ir::Section::kStamp) continue;
      at_ = memory + instance.data + image.layouts[instance.type].member_offsets[i];
    }
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
