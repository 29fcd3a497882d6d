#include "vm/runtime/state_sum.h"

#include <algorithm>

#include "base/crc32c.h"

namespace vm {

class StateSum::Walk {
 public:
  Walk(const ir::Image& image, std::vector<ir::Extent>& runs, std::vector<Text>& texts)
      : image_(image), runs_(runs), texts_(texts) {}

  void run() {
    for (uint32_t id = 0; id < image_.instances.size(); ++id) {
      const ir::Instance& row = image_.instances[id];
      if (id == 0 || row.live) members(row.type, row.data);
    }
  }

 private:
  void members(ir::TypeId id, uint32_t data) {
    const std::vector<ir::Member>& rows = image_.types[id].members;
    for (size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].section == ir::Section::kInOut) continue;
      value(rows[i].type, data + image_.layouts[id].member_offsets[i]);
    }
  }

  // No type contains itself. Of an instance only its ID lies here.
  void value(ir::TypeId id, uint32_t data) {
    const ir::Type& type = image_.types[id];
    if (type.kind == ir::Kind::kString || type.kind == ir::Kind::kWstring) {
      texts_.push_back({data, type.capacity, type.kind == ir::Kind::kWstring ? 2u : 1u});
    } else if (type.kind == ir::Kind::kArray) {
      array(type, data);
    } else if (type.kind == ir::Kind::kStruct && !image_.types.overlaps(id)) {
      members(id, data);
    } else if (image_.types.is_instance(id)) {
      add({data, sizeof(uint32_t)});
    } else {
      add({data, image_.layouts[id].size});
    }
  }

  void array(const ir::Type& type, uint32_t data) {
    uint64_t count = 1;
    for (const ir::Dimension& dim : type.dims) count *= dim.count();
    const uint32_t stride =
        image_.types.is_instance(type.base) ? sizeof(uint32_t) : image_.layouts[type.base].size;
    if (image_.types.is_scalar(type.base)) {
      return add({data, static_cast<uint32_t>(count * stride)});
    }
    for (uint64_t i = 0; i < count; ++i) {
      value(type.base, data + static_cast<uint32_t>(i) * stride);
    }
  }

  void add(ir::Extent run) {
    if (!runs_.empty() && runs_.back().offset + runs_.back().size == run.offset) {
      runs_.back().size += run.size;
    } else {
      runs_.push_back(run);
    }
  }

  const ir::Image& image_;
  std::vector<ir::Extent>& runs_;
  std::vector<Text>& texts_;
};

uint32_t StateSum::of(Controller& controller) {
  if (!known_ || version_ != controller.verified().digest()) {
    runs_.clear();
    texts_.clear();
    Walk(controller.image(), runs_, texts_).run();
    version_ = controller.verified().digest();
    known_ = true;
  }
  const uint8_t* memory = controller.memory().data();
  values_.clear();
  for (const ir::Extent& run : runs_) {
    values_.insert(values_.end(), memory + run.offset, memory + run.offset + run.size);
  }
  for (const Text& text : texts_) {
    const uint8_t* at = memory + text.data;
    uint32_t length = 0;
    const auto ends = [&] {
      return at[length * text.unit] == 0 && at[length * text.unit + text.unit - 1] == 0;
    };
    while (length < text.capacity && !ends()) ++length;
    values_.insert(values_.end(), at, at + size_t{length} * text.unit);
    values_.push_back(0);
  }
  return base::crc32c(values_);
}

}  // namespace vm
