#include "linker/frame.h"

#include <algorithm>

#include "base/limits.h"

namespace linker {
namespace {

struct Extent {
  uint64_t size;
  uint64_t align;
};

Extent extent_of(const ir::Slot& slot, const ir::Layouts& layouts) {
  if (!slot.aggregate) return {ir::class_size(slot.cls), ir::class_size(slot.cls)};
  const ir::TypeLayout& layout = layouts[slot.region.type];
  return {layout.size, layout.align};
}

ir::FrameSlot frame_slot(const ir::Slot& slot, uint64_t offset) {
  return {static_cast<uint32_t>(offset),
          slot.kind,
          slot.local,
          slot.aggregate,
          slot.cls,
          slot.region,
          slot.name};
}

class FrameBuilder {
 public:
  FrameBuilder(const ir::Object& object, const ir::Layouts& layouts)
      : object_(object), layouts_(layouts) {
    frame_.offsets.resize(object.slots.size());
    frame_.slot_numbers.resize(object.slots.size(), kNoSlot);
  }

  void place_if(bool (*wanted)(const ir::Slot&)) {
    for (uint32_t i = 0; i < object_.slots.size(); ++i) {
      if (wanted(object_.slots[i])) place(i);
    }
  }

  void place_scratch(const Scratch& scratch) {
    const uint64_t size = ir::class_size(scratch.cls);
    const uint64_t offset = take({size, size});
    frame_.scratch_offsets.push_back(static_cast<uint32_t>(offset));
    ir::Slot slot;
    slot.cls = scratch.cls;
    slot.region = scratch.region;
    frame_.slots.push_back(frame_slot(slot, offset));
  }

  uint64_t end() const { return end_; }
  FrameLayout take_frame() {
    frame_.size = static_cast<uint32_t>((end_ + 7) / 8 * 8);
    return std::move(frame_);
  }

 private:
  uint64_t take(Extent extent) {
    const uint64_t offset = (end_ + extent.align - 1) / extent.align * extent.align;
    end_ = offset + extent.size;
    return offset;
  }

  void place(uint32_t number) {
    const ir::Slot& slot = object_.slots[number];
    frame_.offsets[number] = take(extent_of(slot, layouts_));
    frame_.slot_numbers[number] = static_cast<uint32_t>(frame_.slots.size());
    frame_.slots.push_back(frame_slot(slot, frame_.offsets[number]));
  }

  const ir::Object& object_;
  const ir::Layouts& layouts_;
  FrameLayout frame_;
  uint64_t end_ = 0;
};

bool is_own(const ir::Slot& slot) {
  return slot.kind == ir::SlotKind::kLocal || slot.kind == ir::SlotKind::kTemp;
}

}  // namespace

base::Result<FrameLayout> lay_out_frame(const ir::Object& object, const ir::Layouts& layouts,
                                        const std::vector<Scratch>& scratch) {
  FrameBuilder frame(object, layouts);
  frame.place_if([](const ir::Slot& slot) { return slot.kind == ir::SlotKind::kParam; });
  frame.place_if([](const ir::Slot& slot) { return is_own(slot) && !slot.aggregate; });
  for (const Scratch& slot : scratch) frame.place_scratch(slot);
  frame.place_if([](const ir::Slot& slot) { return is_own(slot) && slot.aggregate; });
  const uint64_t limit = std::min<uint64_t>(base::kMaxFrameBytes, 0xffff * 8);
  if (frame.end() > limit) {
    return base::Error{base::Refusal::kTooMany,
                       "the local variables of `" + object.name + "` need " +
                           std::to_string(frame.end()) + " bytes; the limit is " +
                           std::to_string(limit) + ". Make large ones variables of the instance."};
  }
  return frame.take_frame();
}

}  // namespace linker
