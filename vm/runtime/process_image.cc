#include "vm/runtime/process_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ir/bytecode/located_layouts.h"
#include "ir/types/location.h"

namespace vm {

// Walks located variables down to what is copied in one piece.
class ProcessImage::Collector {
 public:
  // `values`: where single values of several bytes are noted too, and `reals` where REAL and LREAL
  // are; or nullptr.
  Collector(const ir::Image& image, Points* values, Points* reals)
      : image_(image), natural_(ir::located_layouts(image)), values_(values), reals_(reals) {}

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
      note_values(element, {data, byte, natural_[id].size, 0});
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

  void note_values(ir::TypeId type, Point run) {
    const ir::Scalar scalar = image_.types.scalar(type);
    const uint32_t size = ir::scalar_size(scalar);
    if (values_ == nullptr) return;
    for (uint32_t at = 0; at < run.size; at += size) {
      values_->push_back({run.data + at, run.byte + at, size, 0});
      if (ir::is_float(scalar)) reals_->push_back(values_->back());
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
  Points* values_;
  Points* reals_;
};

ProcessImage::ProcessImage(const ir::Image& image)
    : input_bytes_(image.input_bytes),
      output_bytes_(image.output_bytes),
      marker_bytes_(ir::process_image_size(image.devices).marker_bytes) {
  if (image.io.empty()) return;
  Collector inputs(image, nullptr, nullptr);
  Collector outputs(image, &values_, &reals_);
  Collector markers(image, nullptr, nullptr);
  for (const ir::IoBinding& binding : image.io) {
    switch (binding.address.area) {
      case ir::DirectArea::kInput:
        inputs.add(inputs_, binding, input_bytes_);
        break;
      case ir::DirectArea::kOutput:
        outputs.add(outputs_, binding, output_bytes_);
        break;
      case ir::DirectArea::kMarker:
        if (ir::is_locatable(image.types, binding.type)) {
          markers.add(markers_, binding, marker_bytes_);
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

void ProcessImage::mark_outputs(uint32_t begin, uint32_t end, std::span<uint8_t> mask) const {
  for (const Point& point : outputs_) {
    const uint32_t size = std::max(point.size, 1u);
    if (point.data >= end || point.data + size <= begin) continue;
    if (point.size == 0) {
      mask[point.byte] |= point.mask;
      continue;
    }
    const uint32_t first = std::max(begin, point.data) - point.data;
    const uint32_t last = std::min(end - point.data, size);
    std::fill(mask.begin() + point.byte + first, mask.begin() + point.byte + last, uint8_t{0xff});
  }
}

void ProcessImage::mark_inputs(uint32_t begin, std::span<const uint8_t> value,
                               std::span<uint8_t> inputs, std::span<uint8_t> mask) const {
  const auto end = static_cast<uint32_t>(begin + value.size());
  for (const Point& point : inputs_) {
    const uint32_t size = std::max(point.size, 1u);
    if (point.data >= end || point.data + size <= begin) continue;
    if (point.size == 0) {
      const bool on = value[point.data - begin] != 0;
      const uint8_t bits = point.mask == kWholeByte ? 1 : point.mask;
      mask[point.byte] |= point.mask;
      inputs[point.byte] = static_cast<uint8_t>((inputs[point.byte] & ~point.mask) |
                                                (on ? bits : 0));
      continue;
    }
    const uint32_t first = std::max(begin, point.data);
    const uint32_t last = std::min(end, point.data + size);
    const uint32_t byte = point.byte + (first - point.data);
    std::fill_n(mask.begin() + byte, last - first, uint8_t{0xff});
    std::copy_n(value.begin() + (first - begin), last - first, inputs.begin() + byte);
  }
}

void ProcessImage::widen(std::span<uint8_t> mask) const {
  for (const Point& value : values_) {
    const auto begin = mask.begin() + value.byte;
    const bool any = std::any_of(begin, begin + value.size, [](uint8_t bits) { return bits != 0; });
    if (any) std::fill_n(begin, value.size, uint8_t{0xff});
  }
}

bool ProcessImage::has_nan(std::span<const uint8_t> outputs, std::span<const uint8_t> mask) const {
  for (const Point& point : reals_) {
    const auto begin = mask.begin() + point.byte;
    if (std::all_of(begin, begin + point.size, [](uint8_t bits) { return bits == 0; })) continue;
    double value = 0;
    if (point.size == 4) {
      float single = 0;
      std::memcpy(&single, outputs.data() + point.byte, 4);
      value = single;
    } else {
      std::memcpy(&value, outputs.data() + point.byte, 8);
    }
    if (std::isnan(value)) return true;
  }
  return false;
}

bool ProcessImage::same_outputs(const ProcessImage& other) const {
  return std::equal(outputs_.begin(), outputs_.end(), other.outputs_.begin(), other.outputs_.end(),
                    [](const Point& a, const Point& b) {
                      return a.byte == b.byte && a.size == b.size && a.mask == b.mask;
                    });
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
