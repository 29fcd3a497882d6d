#include "vm/runtime/process_image.h"

#include <algorithm>
#include <cstring>

#include "ir/types/location.h"
#include "ir/types/natural_layout.h"

namespace vm {

// Walks located variables down to what is copied in one piece.
class ProcessImage::Collector {
 public:
  explicit Collector(const ir::Image& image)
      : image_(image), natural_(ir::natural_layouts(image.types)) {}

  void add(Points& points, const ir::IoBinding& binding, uint32_t limit) {
    uint64_t first_bit = binding.address.bit_offset;
    uint64_t bools = ir::located_bools(image_.types, binding.type, binding.address);
    uint64_t bits = ir::located_bits(image_.types, natural_, binding.type, binding.address);
    if ((first_bit + bits + 7) / 8 > limit) return;
    for (uint64_t i = 0; i < bools; ++i) {
      uint64_t bit = first_bit + i;
      points.push_back({binding.data + static_cast<uint32_t>(i), static_cast<uint32_t>(bit / 8), 0,
                        static_cast<uint8_t>(1u << (bit % 8))});
    }
    if (bools == 0) {
      add_bytes(points, binding.type, binding.data, static_cast<uint32_t>(first_bit / 8));
    }
  }

 private:
  // No type contains itself, and limits.def bounds how deep types nest.
  void add_bytes(Points& points, ir::TypeId id, uint32_t data, uint32_t byte) {
    const ir::Type& type = image_.types[id];
    const bool array = type.kind == ir::Kind::kArray;
    const ir::TypeId element = array ? type.base : id;
    if (image_.types.is_scalar(element) && image_.types.scalar(element) != ir::Scalar::kBool) {
      add_run(points, {data, byte, natural_[id].size, 0});
    } else if (array) {
      uint64_t count = 1;
      for (const ir::Dimension& dim : type.dims) count *= dim.count();
      for (uint32_t i = 0; i < count; ++i) {
        add_bytes(points, type.base, data + i * image_.layouts[type.base].size,
                  byte + i * natural_[type.base].size);
      }
    } else if (type.kind == ir::Kind::kStruct && !image_.types.overlaps(id)) {
      for (size_t i = 0; i < type.members.size(); ++i) {
        add_bytes(points, type.members[i].type, data + image_.layouts[id].member_offsets[i],
                  byte + natural_[id].member_offsets[i]);
      }
    } else if (image_.types.is_scalar(id)) {
      points.push_back({data, byte, 0, kWholeByte});
    } else {  // what overlaps is bytes
      add_run(points, {data, byte, std::min(image_.layouts[id].size, natural_[id].size), 0});
    }
  }

  static void add_run(Points& points, Point run) {
    Point* last = points.empty() ? nullptr : &points.back();
    bool next = last != nullptr && last->size != 0 && last->data + last->size == run.data &&
                last->byte + last->size == run.byte;
    if (next) {
      last->size += run.size;
    } else {
      points.push_back(run);
    }
  }

  const ir::Image& image_;
  ir::Layouts natural_;
};

ProcessImage::ProcessImage(const ir::Image& image)
    : input_bytes_(image.input_bytes),
      output_bytes_(image.output_bytes),
      marker_bytes_(ir::process_image_size(image.devices).marker_bytes) {
  if (image.io.empty()) return;
  Collector collector(image);
  for (const ir::IoBinding& binding : image.io) {
    switch (binding.address.area) {
      case ir::DirectArea::kInput:
        collector.add(inputs_, binding, input_bytes_);
        break;
      case ir::DirectArea::kOutput:
        collector.add(outputs_, binding, output_bytes_);
        break;
      case ir::DirectArea::kMarker:
        if (ir::is_locatable(image.types, binding.type)) {
          collector.add(markers_, binding, marker_bytes_);
        }
        break;
      case ir::DirectArea::kNone:
        break;
    }
  }
}

void ProcessImage::unpack(const Points& points, std::span<const uint8_t> from, uint8_t* memory) {
  for (const Point& point : points) {
    if (point.size == 0) {
      memory[point.data] = (from[point.byte] & point.mask) != 0;
    } else {
      std::memcpy(memory + point.data, from.data() + point.byte, point.size);
    }
  }
}

void ProcessImage::inputs_to_variables(std::span<const uint8_t> inputs, uint8_t* memory) const {
  unpack(inputs_, inputs, memory);
}

void ProcessImage::outputs_to_variables(std::span<const uint8_t> outputs, uint8_t* memory) const {
  unpack(outputs_, outputs, memory);
}

void ProcessImage::markers_to_variables(std::span<const uint8_t> markers, uint8_t* memory) const {
  unpack(markers_, markers, memory);
}

void ProcessImage::variables_to_outputs(const uint8_t* memory, std::span<uint8_t> outputs) const {
  pack(outputs_, memory, outputs);
}

void ProcessImage::variables_to_markers(const uint8_t* memory, std::span<uint8_t> markers) const {
  pack(markers_, memory, markers);
}

void ProcessImage::pack(const Points& points, const uint8_t* memory, std::span<uint8_t> to) {
  for (const Point& point : points) {
    if (point.size != 0) {
      std::memcpy(to.data() + point.byte, memory + point.data, point.size);
    } else if (point.mask == kWholeByte) {
      to[point.byte] = memory[point.data] != 0;
    } else if (memory[point.data] != 0) {
      to[point.byte] |= point.mask;
    } else {
      to[point.byte] &= static_cast<uint8_t>(~point.mask);
    }
  }
}

}  // namespace vm
