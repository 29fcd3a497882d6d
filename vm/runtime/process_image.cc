#include "vm/runtime/process_image.h"

#include <algorithm>
#include <cstring>

namespace vm {
namespace {

// Elements of an array whose elements are BOOLs: each takes one bit at a bit address.
uint64_t bool_count(const ir::TypeTable& types, ir::TypeId type) {
  const ir::Type& t = types[type];
  if (t.kind == ir::Kind::kArray) {
    uint64_t count = bool_count(types, t.base);
    for (const ir::Dimension& dim : t.dims) count *= dim.count();
    return count;
  }
  bool is_bool = types.is_scalar(type) && types.scalar(type) == ir::Scalar::kBool;
  return is_bool ? 1 : 0;
}

}  // namespace

ProcessImage::ProcessImage(const ir::Image& image)
    : input_bytes_(image.input_bytes), output_bytes_(image.output_bytes) {
  for (const ir::IoBinding& binding : image.io) {
    switch (binding.address.area) {
      case ir::DirectArea::kInput:
        add(inputs_, image, binding, input_bytes_);
        break;
      case ir::DirectArea::kOutput:
        add(outputs_, image, binding, output_bytes_);
        break;
      default:
        break;  // markers are plain variables
    }
  }
}

void ProcessImage::add(Points& points, const ir::Image& image, const ir::IoBinding& binding,
                       uint32_t limit) {
  uint64_t first_bit = binding.address.bit_offset;
  uint64_t bools = bool_count(image.types, binding.type);
  // A single BOOL takes one bit whatever width its address names.
  bool bitwise = bools == 1 || (bools != 0 && binding.address.bit_size == 1);
  if (bitwise) {
    for (uint64_t i = 0; i < bools && (first_bit + i) / 8 < limit; ++i) {
      uint64_t bit = first_bit + i;
      points.push_back({binding.data + static_cast<uint32_t>(i), static_cast<uint32_t>(bit / 8), 0,
                        static_cast<uint8_t>(1u << (bit % 8))});
    }
    return;
  }
  uint64_t byte = first_bit / 8;
  uint64_t size = image.layouts[binding.type].size;
  if (byte >= limit) return;
  size = std::min<uint64_t>(size, limit - byte);
  points.push_back({binding.data, static_cast<uint32_t>(byte), static_cast<uint32_t>(size), 0});
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

void ProcessImage::variables_to_outputs(const uint8_t* memory, std::span<uint8_t> outputs) const {
  for (const Point& point : outputs_) {
    if (point.size != 0) {
      std::memcpy(outputs.data() + point.byte, memory + point.data, point.size);
    } else if (memory[point.data] != 0) {
      outputs[point.byte] |= point.mask;
    } else {
      outputs[point.byte] &= static_cast<uint8_t>(~point.mask);
    }
  }
}

}  // namespace vm
