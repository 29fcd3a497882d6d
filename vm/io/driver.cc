#include "vm/io/driver.h"

#include <algorithm>

namespace vm {
namespace {

PointRange place(const ir::DeviceMapping& mapping, uint32_t& bytes) {
  PointRange range{mapping.table, mapping.first, mapping.count,
                   bytes,         mapping.at,    mapping.writable};
  bytes += (range.bits() + 7) / 8;
  return range;
}

// The parts of `range` that none of `others` covers, in whole values.
std::vector<PointRange> rest_of(const PointRange& range, const std::vector<PointRange>& others) {
  const uint32_t point_bits = range.bits() / range.count;
  const uint32_t step = std::max<uint32_t>(range.at.bit_size / point_bits, 1);
  auto covered = [&](uint32_t point) {
    return std::any_of(others.begin(), others.end(), [&](const PointRange& other) {
      return other.table == range.table && point >= other.first &&
             point - other.first < other.count;
    });
  };
  std::vector<PointRange> rest;
  bool open = false;
  for (uint32_t at = 0; at < range.count; at += step) {
    bool free = true;
    for (uint32_t i = 0; i < step; ++i) free = free && !covered(range.first + at + i);
    if (free && !open) {
      ir::DirectAddress address = range.at;
      address.bit_offset += at * point_bits;
      rest.push_back({range.table, range.first + at, 0, 0, address, range.writable});
    }
    if (free) rest.back().count += step;
    open = free;
  }
  return rest;
}

}  // namespace

uint32_t PointRange::bits() const {
  return count * ir::table_rows()[static_cast<size_t>(table)].point_bits;
}

DevicePoints points_of(const ir::Device& device) {
  DevicePoints out;
  for (const ir::DeviceMapping& mapping : device.map) {
    if (mapping.to_device) {
      out.outputs.push_back(place(mapping, out.output_bytes));
    } else {
      out.inputs.push_back(place(mapping, out.input_bytes));
    }
  }
  return out;
}

DevicePoints outputs_without(const DevicePoints& old, const DevicePoints* next) {
  DevicePoints out;
  for (const PointRange& range : old.outputs) {
    for (PointRange& part :
         rest_of(range, next != nullptr ? next->outputs : std::vector<PointRange>{})) {
      part.byte = out.output_bytes;
      out.output_bytes += (part.bits() + 7) / 8;
      out.outputs.push_back(part);
    }
  }
  return out;
}

base::Error exchange_failed(std::string text) {
  return {base::Refusal::kDeviceFailed, std::move(text)};
}

}  // namespace vm
