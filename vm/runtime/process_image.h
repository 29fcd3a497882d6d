// Between the process image (%I and %Q as the devices see them: bits packed, little endian) and
// the located variables (a BOOL is one byte; ir/types/location.h). A table made once for each
// image; copying needs no allocation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "ir/bytecode/image.h"

namespace vm {

class ProcessImage {
 public:
  // Bindings that lie outside the image's own process image are left out.
  explicit ProcessImage(const ir::Image& image);

  uint32_t input_bytes() const { return input_bytes_; }
  uint32_t output_bytes() const { return output_bytes_; }
  uint32_t marker_bytes() const { return marker_bytes_; }  // 0: no device exchanges any

  // `inputs` has input_bytes(), `outputs` output_bytes(), `markers` marker_bytes().
  void inputs_to_variables(std::span<const uint8_t> inputs, uint8_t* memory) const;
  void variables_to_outputs(const uint8_t* memory, std::span<uint8_t> outputs) const;
  // %M as devices see it: the variables that lie inside `markers`, and can be exchanged.
  void markers_to_variables(std::span<const uint8_t> markers, uint8_t* memory) const;
  void variables_to_markers(const uint8_t* memory, std::span<uint8_t> markers) const;
  void outputs_to_variables(std::span<const uint8_t> outputs, uint8_t* memory) const;

  // Sets the bits that the variables at [begin, end) of data memory are sent as.
  void mark_outputs(uint32_t begin, uint32_t end, std::span<uint8_t> mask) const;
  // The bits that come in as the variable at [begin, begin + value.size()): set in `mask`, and in
  // `inputs` as they are when it has that value. Both have input_bytes().
  void mark_inputs(uint32_t begin, std::span<const uint8_t> value, std::span<uint8_t> inputs,
                   std::span<uint8_t> mask) const;
  // Whole values instead of some bits of them.
  void widen(std::span<uint8_t> mask) const;
  bool has_reals() const { return !reals_.empty(); }
  // Is an output among those of `mask` NaN in `outputs`?
  bool has_nan(std::span<const uint8_t> outputs, std::span<const uint8_t> mask) const;
  // Do the same bits stand for variables of the same sizes in the same order?
  bool same_outputs(const ProcessImage& other) const;

 private:
  struct Point {
    uint32_t data = 0;  // offset of the variable
    uint32_t byte = 0;  // in the process image
    uint32_t size = 0;  // 0: a BOOL
    uint8_t mask = 0;   // of a BOOL: its bit, or kWholeByte: TRUE is 1, read as any but 0
  };
  static constexpr uint8_t kWholeByte = 0xff;
  using Points = std::vector<Point>;
  class Collector;
  static void pack(const Points& points, const uint8_t* memory, std::span<uint8_t> to);
  static void unpack(const Points& points, std::span<const uint8_t> from, uint8_t* memory);

  Points inputs_;
  Points outputs_;
  Points markers_;
  Points values_;  // of outputs_: each REAL, and each other value of several bytes
  Points reals_;
  uint32_t input_bytes_;
  uint32_t output_bytes_;
  uint32_t marker_bytes_;
};

}  // namespace vm
