// One value that a step converts, read from data memory and carried over by A14.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "ir/bytecode/image.h"
#include "online_change/diff/fast_conversion.h"
#include "online_change/diff/initial_data.h"
#include "online_change/plan/plan.h"

namespace online_change {

class Conversions {
 public:
  Conversions(const ir::Image& from, const ir::Image& to) : from_(from), to_(to), to_initial_(to) {}

  // For a step of that conversion; null: value by value.
  FastConverter fast(const ConvertedValues& how) const {
    if (!how.known.empty()) return nullptr;
    return fast_converter(from_.types, how.old_type, to_.types, how.new_type);
  }
  uint32_t source_size(const ConvertedValues& how) const {
    return from_.layouts[how.old_type].size;
  }
  // Does the other direction leave the bytes of such values as they are? Compares names, once for
  // each pair of types: not at the boundary.
  bool left_by_inverse(const ConvertedValues& how);
  // Converts the value at `source`, number `index` of its step, for the place `to` of the new
  // version; fills `out`, which is one value long. Returns what is lost, or null.
  const char* convert(const ConvertedValues& how, uint32_t index, const uint8_t* source,
                      uint32_t to, std::span<uint8_t> out) const;
  std::string old_text(const ConvertedValues& how, const uint8_t* value) const;
  std::string new_text(const ConvertedValues& how, const uint8_t* value) const;

 private:
  const ir::Image& from_;
  const ir::Image& to_;
  InitialData to_initial_;
  std::map<std::pair<ir::TypeId, ir::TypeId>, bool> left_;  // by old and new type
};

// In a converting step of a change that takes out an edit (values_back.h): value number `index`,
// while it is what was `made` of it, becomes the bytes at `value`, of the step's size, no loss.
void know(UpdateStep& step, uint32_t index, std::span<const uint8_t> made, const uint8_t* value);

}  // namespace online_change
