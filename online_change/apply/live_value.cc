#include "online_change/apply/live_value.h"

#include <cstring>

#include "ir/types/value_text.h"
#include "online_change/diff/value_conversion.h"

namespace online_change {
namespace {

using ir::Kind;
using ir::TypeId;

// As in ConstValue: sign-extended, REAL as its 32 bits.
uint64_t load(const ir::Image& image, TypeId type, const uint8_t* at) {
  ir::Scalar scalar = image.types.scalar(type);
  uint32_t size = ir::scalar_size(scalar);
  uint64_t bits = 0;
  std::memcpy(&bits, at, size);
  if (!ir::is_signed(scalar) || size == 8) return bits;
  uint32_t unused = 64 - size * 8;
  return static_cast<uint64_t>(static_cast<int64_t>(bits << unused) >> unused);
}

bool is_string(const ir::Image& image, TypeId type) {
  Kind kind = image.types[type].kind;
  return kind == Kind::kString || kind == Kind::kWstring;
}

uint32_t unit_of(const ir::Image& image, TypeId type) {
  return image.types[type].kind == Kind::kWstring ? 2 : 1;
}

std::string value_text(const ir::Image& image, TypeId type, const uint8_t* at) {
  if (!is_string(image, type)) {
    return ir::scalar_text(image.types, type, load(image, type, at));
  }
  uint32_t unit = unit_of(image, type);
  uint32_t size = image.layouts[type].size;
  uint32_t length = 0;
  for (; length + unit <= size; length += unit) {
    if (at[length] == 0 && (unit == 1 || at[length + 1] == 0)) break;
  }
  std::string_view units(reinterpret_cast<const char*>(at), length);
  return unit == 2 ? ir::wstring_text(units) : ir::string_text(units);
}

}  // namespace

void know(UpdateStep& step, uint32_t index, std::span<const uint8_t> made, const uint8_t* value) {
  const size_t row = 1 + made.size() + step.size;
  base::Bytes& known = step.as<ConvertedValues>()->known;
  known.resize(row * step.count);
  uint8_t* const out = known.data() + index * row;
  *out = 1;
  std::memcpy(out + 1, made.data(), made.size());
  std::memcpy(out + 1 + made.size(), value, step.size);
}

const char* Conversions::convert(const ConvertedValues& how, uint32_t index, const uint8_t* source,
                                 uint32_t to, std::span<uint8_t> out) const {
  if (!how.known.empty()) {
    const size_t made = source_size(how);
    const uint8_t* const known = how.known.data() + index * (1 + made + out.size());
    if (*known != 0 && std::memcmp(known + 1, source, made) == 0) {
      std::memcpy(out.data(), known + 1 + made, out.size());
      return nullptr;
    }
  }
  if (is_string(from_, how.old_type)) {
    return convert_string({source, source_size(how)}, unit_of(from_, how.old_type), out,
                          unit_of(to_, how.new_type));
  }
  Converted value = convert_scalar(from_.types, how.old_type, to_.types, how.new_type,
                                   load(from_, how.old_type, source));
  if (value.initialise) {
    to_initial_.read(to, out);
  } else {
    std::memcpy(out.data(), &value.bits, out.size());
  }
  return value.loss;
}

bool Conversions::left_by_inverse(const ConvertedValues& how) {
  const auto [row, is_new] = left_.try_emplace({how.old_type, how.new_type});
  if (is_new) {
    row->second = classify(to_.types, how.new_type, from_.types, how.old_type) == Conversion::kSame;
  }
  return row->second;
}

std::string Conversions::old_text(const ConvertedValues& how, const uint8_t* value) const {
  return value_text(from_, how.old_type, value);
}

std::string Conversions::new_text(const ConvertedValues& how, const uint8_t* value) const {
  return value_text(to_, how.new_type, value);
}

}  // namespace online_change
