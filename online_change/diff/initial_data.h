// The initial bytes of an image's data memory, by offset: Image::data, with the
// zeros that no run covers. Initial values, instance slots and constants all come
// from here, so a change initialises exactly as a cold start does (A15).
#pragma once

#include <cstdint>
#include <span>

#include "ir/bytecode/image.h"

namespace online_change {

class InitialData {
 public:
  explicit InitialData(const ir::Image& image) : runs_(image.data) {}

  void read(uint32_t offset, std::span<uint8_t> out) const;
  // Are `size` bytes here at `offset` the same as those there at `other_offset`?
  // Cost: the runs and bytes involved; constant where neither side has a run.
  bool equal(uint32_t offset, const InitialData& other, uint32_t other_offset, uint32_t size) const;
  // As far as they are the same; `size`: all. Cost as before.
  uint32_t equal_bytes(uint32_t offset, const InitialData& other, uint32_t other_offset,
                       uint32_t size) const;
  // False: zeros, known without a look at them.
  bool has_run(uint32_t offset, uint32_t size) const;
  bool is_zero(uint32_t offset, uint32_t size) const;
  uint32_t word(uint32_t offset) const;  // an instance slot

 private:
  // First run that ends after `offset`.
  size_t first_run(uint32_t offset) const;
  const std::vector<ir::DataRun>& runs_;
};

}  // namespace online_change
