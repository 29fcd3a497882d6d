#include "online_change/diff/value_conversion.h"

#include <bit>
#include <cmath>
#include <limits>

#include "ir/types/time_units.h"

namespace online_change {
namespace {

using ir::Group;
using ir::Kind;
using ir::TypeId;
using ir::TypeTable;
using Wide = __int128;

// BOOL and bit strings count as unsigned integers.
bool is_integral(Kind kind) {
  Group group = ir::elementary_group(kind);
  return group == Group::kBit || group == Group::kSigned || group == Group::kUnsigned;
}
bool is_real(Kind kind) { return ir::elementary_group(kind) == Group::kReal; }
bool is_date_or_dt(Kind kind) {
  return kind == Kind::kDate || kind == Kind::kLdate || kind == Kind::kDt || kind == Kind::kLdt;
}
bool is_day(Kind kind) { return kind == Kind::kDate || kind == Kind::kLdate; }
bool is_tod(Kind kind) { return kind == Kind::kTod || kind == Kind::kLtod; }

struct Interval {
  Wide low = 0;
  Wide high = 0;
  bool contains(Interval other) const { return low <= other.low && other.high <= high; }
};

uint32_t integral_bytes(Kind kind) {
  switch (kind) {
    case Kind::kBool:
    case Kind::kSint:
    case Kind::kUsint:
    case Kind::kByte:
      return 1;
    case Kind::kInt:
    case Kind::kUint:
    case Kind::kWord:
      return 2;
    case Kind::kDint:
    case Kind::kUdint:
    case Kind::kDword:
      return 4;
    default:
      return 8;
  }
}

Interval interval_of(Kind kind) {
  if (kind == Kind::kBool) return {0, 1};
  uint32_t bits = integral_bytes(kind) * 8;
  Wide one = 1;
  if (ir::elementary_group(kind) == Group::kSigned) {
    return {-(one << (bits - 1)), (one << (bits - 1)) - 1};
  }
  return {0, (one << bits) - 1};
}

Wide wide_value(Kind kind, uint64_t bits) {
  if (ir::elementary_group(kind) == Group::kSigned) return static_cast<int64_t>(bits);
  uint32_t width = integral_bytes(kind) * 8;
  return width == 64 ? bits : bits & ((uint64_t{1} << width) - 1);
}

double real_value(Kind kind, uint64_t bits) {
  if (kind == Kind::kReal) return std::bit_cast<float>(static_cast<uint32_t>(bits));
  return std::bit_cast<double>(bits);
}

Converted clamp_to(Interval range, Wide value) {
  if (value < range.low) return {static_cast<uint64_t>(range.low), "saturates", false};
  if (value > range.high) return {static_cast<uint64_t>(range.high), "saturates", false};
  return {static_cast<uint64_t>(value), nullptr, false};
}

Converted integral_to_real(Kind to, Wide value) {
  if (to == Kind::kReal) {
    auto real = static_cast<float>(value);
    return {std::bit_cast<uint32_t>(real), static_cast<Wide>(real) == value ? nullptr : "inexact",
            false};
  }
  auto real = static_cast<double>(value);
  return {std::bit_cast<uint64_t>(real), static_cast<Wide>(real) == value ? nullptr : "inexact",
          false};
}

// Round half to even, as every REAL to integer conversion of the language.
double round_half_even(double value) {
  double floor = std::floor(value);
  double rest = value - floor;
  if (rest < 0.5) return floor;
  if (rest > 0.5) return floor + 1;
  return std::fmod(floor, 2.0) == 0.0 ? floor : floor + 1;
}

Converted real_to_integral(Kind to, double value) {
  if (std::isnan(value)) return {0, "is not a number, initialised", true};
  Interval range = interval_of(to);
  double rounded = round_half_even(value);
  // 2^64 is far outside of every range and inside of Wide.
  if (rounded > 0x1p64) rounded = 0x1p64;
  if (rounded < -0x1p64) rounded = -0x1p64;
  Converted out = clamp_to(range, static_cast<Wide>(rounded));
  if (out.loss == nullptr && rounded != value) out.loss = "inexact";
  return out;
}

Converted real_to_real(Kind from, Kind to, uint64_t bits) {
  if (from == to) return {bits, nullptr, false};
  double value = real_value(from, bits);
  if (to == Kind::kLreal) return {std::bit_cast<uint64_t>(value), nullptr, false};
  constexpr double kMax = std::numeric_limits<float>::max();
  if (std::isfinite(value) && std::fabs(value) > kMax) {
    auto limit = static_cast<float>(std::copysign(kMax, value));
    return {std::bit_cast<uint32_t>(limit), "saturates", false};
  }
  auto narrow = static_cast<float>(value);
  bool exact = std::isnan(value) || static_cast<double>(narrow) == value;
  return {std::bit_cast<uint32_t>(narrow), exact ? nullptr : "inexact", false};
}

Converted point_in_time(Kind from, Kind to, uint64_t bits) {
  if (!is_day(to) || is_day(from)) return {bits, nullptr, false};
  auto ns = static_cast<int64_t>(bits);
  int64_t rest = ((ns % ir::kNsPerDay) + ir::kNsPerDay) % ir::kNsPerDay;
  return {static_cast<uint64_t>(ns - rest), rest == 0 ? nullptr : "truncates", false};
}

Conversion classify_integral(Interval from, Kind to) {
  if (is_integral(to)) {
    return interval_of(to).contains(from) ? Conversion::kExact : Conversion::kMayLose;
  }
  Wide limit = Wide{1} << (to == Kind::kReal ? 24 : 53);
  return Interval{-limit, limit}.contains(from) ? Conversion::kExact : Conversion::kMayLose;
}

Conversion classify_elementary(Kind from, Kind to) {
  if (from == to) return Conversion::kSame;
  bool real_and_bool = (is_real(from) && to == Kind::kBool) || (is_real(to) && from == Kind::kBool);
  if (real_and_bool) return Conversion::kNone;
  if (is_integral(from) && (is_integral(to) || is_real(to))) {
    return classify_integral(interval_of(from), to);
  }
  if (is_real(from) && is_integral(to)) return Conversion::kMayLose;
  if (is_real(from) && is_real(to)) {
    return to == Kind::kLreal ? Conversion::kExact : Conversion::kMayLose;
  }
  Group group = ir::elementary_group(from);
  if (group == Group::kDuration && ir::elementary_group(to) == Group::kDuration) {
    return Conversion::kExact;
  }
  if (is_tod(from) && is_tod(to)) return Conversion::kExact;
  if (is_date_or_dt(from) && is_date_or_dt(to)) {
    return is_day(to) && !is_day(from) ? Conversion::kMayLose : Conversion::kExact;
  }
  if (group == Group::kChar && ir::elementary_group(to) == Group::kChar) {
    return to == Kind::kWchar ? Conversion::kExact : Conversion::kMayLose;
  }
  return Conversion::kNone;
}

const ir::EnumLiteral* literal_of_value(const ir::Type& type, int64_t value) {
  for (const ir::EnumLiteral& literal : type.literals) {
    if (literal.value == value) return &literal;
  }
  return nullptr;
}

const ir::EnumLiteral* literal_of_name(const ir::Type& type, std::string_view name) {
  for (const ir::EnumLiteral& literal : type.literals) {
    if (ir::same_name(literal.name, name)) return &literal;
  }
  return nullptr;
}

Conversion classify_enums(const ir::Type& from, const ir::Type& to, bool same_kind) {
  Conversion result = same_kind ? Conversion::kSame : Conversion::kExact;
  for (const ir::EnumLiteral& literal : from.literals) {
    const ir::EnumLiteral* twin = literal_of_name(to, literal.name);
    if (twin == nullptr) return Conversion::kMayLose;
    if (twin->value != literal.value) result = Conversion::kExact;
  }
  return result;
}

bool is_text(Kind kind) { return kind == Kind::kString || kind == Kind::kWstring; }

Conversion classify_strings(const ir::Type& from, const ir::Type& to) {
  if (from.kind == to.kind && from.capacity == to.capacity) return Conversion::kSame;
  if (to.capacity < from.capacity) return Conversion::kMayLose;
  bool narrows = from.kind == Kind::kWstring && to.kind == Kind::kString;
  return narrows ? Conversion::kMayLose : Conversion::kExact;
}

// Values that a variable of the type can hold; of integers only.
Interval values_of(const TypeTable& types, TypeId id) {
  const ir::Type& type = types[id];
  if (type.kind == Kind::kSubrange) return {type.low, type.high};
  return interval_of(types.root_kind(id));
}

Conversion classify_into_subrange(const TypeTable& old_types, TypeId old_type,
                                  const TypeTable& new_types, TypeId new_type) {
  Kind from = old_types.root_kind(old_type);
  Kind to = new_types.root_kind(new_type);
  Conversion plain = classify_elementary(from, to);
  if (plain == Conversion::kNone || !is_integral(from)) return plain;
  if (!values_of(new_types, new_type).contains(values_of(old_types, old_type))) {
    return Conversion::kMayLose;
  }
  return from == to ? Conversion::kSame : Conversion::kExact;
}

// A handle stays what it is while its target keeps its type; to another type it would be a lie.
Conversion classify_references(const TypeTable& old_types, TypeId old_type,
                               const TypeTable& new_types, TypeId new_type) {
  bool both = old_types.is_reference(old_type) && new_types.is_reference(new_type);
  bool alike = both && ir::same_name(old_types.text(old_types[old_type].base),
                                     new_types.text(new_types[new_type].base));
  return alike ? Conversion::kSame : Conversion::kNone;
}

uint32_t read_unit(std::span<const uint8_t> bytes, size_t index, uint32_t unit) {
  if (unit == 1) return bytes[index];
  return bytes[index * 2] | static_cast<uint32_t>(bytes[index * 2 + 1]) << 8;
}

void write_unit(std::span<uint8_t> bytes, size_t index, uint32_t unit, uint32_t code) {
  bytes[index * unit] = static_cast<uint8_t>(code);
  if (unit == 2) bytes[index * 2 + 1] = static_cast<uint8_t>(code >> 8);
}

}  // namespace

Conversion classify(const TypeTable& old_types, TypeId old_type, const TypeTable& new_types,
                    TypeId new_type) {
  const ir::Type& from = old_types[old_type];
  const ir::Type& to = new_types[new_type];
  if (is_text(from.kind) && is_text(to.kind)) return classify_strings(from, to);
  if (!old_types.is_scalar(old_type) || !new_types.is_scalar(new_type)) return Conversion::kNone;
  if (old_types.is_reference(old_type) || new_types.is_reference(new_type)) {
    return classify_references(old_types, old_type, new_types, new_type);
  }
  Kind from_kind = old_types.root_kind(old_type);
  Kind to_kind = new_types.root_kind(new_type);
  if (from.kind == Kind::kEnum && to.kind == Kind::kEnum) {
    return classify_enums(from, to, from_kind == to_kind);
  }
  if (to.kind == Kind::kEnum) {
    return is_integral(from_kind) ? Conversion::kMayLose : Conversion::kNone;
  }
  if (from.kind == Kind::kEnum && !is_integral(to_kind)) return Conversion::kNone;
  if (from.kind == Kind::kEnum && to.kind != Kind::kSubrange) {
    Conversion plain = classify_elementary(from_kind, to_kind);
    return plain == Conversion::kSame ? Conversion::kExact : plain;
  }
  if (to.kind == Kind::kSubrange || from.kind == Kind::kSubrange) {
    return classify_into_subrange(old_types, old_type, new_types, new_type);
  }
  return classify_elementary(from_kind, to_kind);
}

Converted convert(Kind from, Kind to, uint64_t bits) {
  if (is_real(from)) {
    if (is_real(to)) return real_to_real(from, to, bits);
    return real_to_integral(to, real_value(from, bits));
  }
  Group group = ir::elementary_group(from);
  if (group == Group::kDate) return point_in_time(from, to, bits);
  if (group == Group::kDuration) return {bits, nullptr, false};
  if (group == Group::kChar) {
    if (to == Kind::kChar && bits > 0xff) return {'?', "is replaced", false};
    return {bits, nullptr, false};
  }
  Wide value = wide_value(from, bits);
  if (is_real(to)) return integral_to_real(to, value);
  if (to == Kind::kBool) {
    return {value != 0 ? 1u : 0u, value == 0 || value == 1 ? nullptr : "saturates", false};
  }
  return clamp_to(interval_of(to), value);
}

Converted convert_scalar(const TypeTable& old_types, TypeId old_type, const TypeTable& new_types,
                         TypeId new_type, uint64_t bits) {
  const ir::Type& from = old_types[old_type];
  const ir::Type& to = new_types[new_type];
  if (from.kind == Kind::kEnum && to.kind == Kind::kEnum) {
    if (const ir::EnumLiteral* old_literal = literal_of_value(from, static_cast<int64_t>(bits))) {
      const ir::EnumLiteral* twin = literal_of_name(to, old_literal->name);
      if (twin == nullptr) return {0, "names a literal that is gone", true};
      return {static_cast<uint64_t>(twin->value), nullptr, false};
    }
  }
  Converted out = convert(old_types.root_kind(old_type), new_types.root_kind(new_type), bits);
  if (out.initialise) return out;
  if (to.kind == Kind::kEnum && literal_of_value(to, static_cast<int64_t>(out.bits)) == nullptr) {
    return {0, "is no literal, initialised", true};
  }
  if (to.kind == Kind::kSubrange) {
    Converted clamped =
        clamp_to({to.low, to.high}, wide_value(new_types.root_kind(new_type), out.bits));
    if (clamped.loss != nullptr) return clamped;
  }
  return out;
}

const char* convert_string(std::span<const uint8_t> from, uint32_t from_unit, std::span<uint8_t> to,
                           uint32_t to_unit) {
  size_t from_units = from.size() / from_unit;
  size_t capacity = to.size() / to_unit - 1;
  const char* loss = nullptr;
  size_t length = 0;
  for (; length < from_units; ++length) {
    uint32_t code = read_unit(from, length, from_unit);
    if (code == 0) break;
    if (length == capacity) {
      loss = "truncates";
      break;
    }
    if (to_unit == 1 && code > 0xff) {
      code = '?';
      loss = "is replaced in part";
    }
    write_unit(to, length, to_unit, code);
  }
  for (size_t i = length * to_unit; i < to.size(); ++i) to[i] = 0;
  return loss;
}

}  // namespace online_change
