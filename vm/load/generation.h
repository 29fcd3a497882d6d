// A Generation: a verified image made ready to run. Code with operand bases
// resolved into handler numbers, POU table (D1), instance information table (A9),
// constant pool. Immutable once built; at most two exist, running and previous.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ir/bytecode/verify.h"

namespace vm {

struct PouEntry {
  const ir::Unit* code = nullptr;  // first unit, decoded
  uint32_t frame_size = 0;
};

struct InstanceEntry {
  uint32_t data = 0;  // 0: the ID is free
  uint32_t pou = 0;
};

// Of Image::bounds and Image::ranges, without their names.
struct BoundEntry {
  int64_t low = 0;
  uint64_t count = 0;
  uint32_t stride = 0;
};
struct RangeEntry {
  int64_t low = 0;
  int64_t high = 0;
};

class Generation {
 public:
  // `number` decides the constant pool (even A, odd B). Writes the pool into
  // `memory`, which no running code of the other generation reads.
  static std::unique_ptr<Generation> build(ir::VerifiedImage image, uint32_t number,
                                           uint8_t* memory);

  const ir::VerifiedImage& verified() const { return image_; }
  const ir::Image& image() const { return image_.image(); }
  uint32_t number() const { return number_; }
  uint32_t pool_offset() const;
  const std::vector<PouEntry>& pous() const { return pous_; }
  const std::vector<InstanceEntry>& instances() const { return instances_; }
  const std::vector<ir::Unit>& code() const { return code_; }
  const std::vector<BoundEntry>& bounds() const { return bounds_; }
  const std::vector<RangeEntry>& ranges() const { return ranges_; }

 private:
  explicit Generation(ir::VerifiedImage image) : image_(std::move(image)) {}
  ir::VerifiedImage image_;
  uint32_t number_ = 0;
  std::vector<ir::Unit> code_;
  std::vector<PouEntry> pous_;
  std::vector<InstanceEntry> instances_;
  std::vector<BoundEntry> bounds_;
  std::vector<RangeEntry> ranges_;
};

}  // namespace vm
