#include "online_change/diff/stored_value.h"

#include "ir/types/value_text.h"

#include <cstring>

namespace online_change {

using ir::Kind;

uint64_t load(const ir::Image& image, ir::TypeId type, const uint8_t* at) {
  ir::Scalar scalar = image.types.scalar(type);
  uint32_t size = ir::scalar_size(scalar);
  uint64_t bits = 0;
  std::memcpy(&bits, at, size);
  if (!ir::is_signed(scalar) || size == 8) return bits;
  uint32_t unused = 64 - size * 8;
  return static_cast<uint64_t>(static_cast<int64_t>(bits << unused) >> unused);
}

bool is_string(const ir::Image& image, ir::TypeId type) {
  Kind kind = image.types[type].kind;
  return kind == Kind::kString || kind == Kind::kWstring;
}

uint32_t unit_of(const ir::Image& image, ir::TypeId type) {
  return image.types[type].kind == Kind::kWstring ? 2 : 1;
}

std::string stored_text(const ir::Image& image, ir::TypeId type, const uint8_t* at) {
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

Converted convert_stored(const ir::Image& old_image, ir::TypeId old_type, const uint8_t* source,
                         const ir::Image& new_image, ir::TypeId new_type, std::span<uint8_t> out) {
  if (is_string(old_image, old_type)) {
    return {0, convert_string({source, old_image.layouts[old_type].size},
                              unit_of(old_image, old_type), out, unit_of(new_image, new_type))};
  }
  const Converted value = convert_scalar(old_image.types, old_type, new_image.types, new_type,
                                         load(old_image, old_type, source));
  if (!value.initialise) std::memcpy(out.data(), &value.bits, out.size());
  return value;
}

}  // namespace online_change
