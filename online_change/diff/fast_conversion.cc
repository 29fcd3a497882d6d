#include "online_change/diff/fast_conversion.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace online_change {
namespace {

using ir::Kind;

struct Boolean {};  // one byte, 0 or 1

template <class T>
using Storage = std::conditional_t<std::is_same_v<T, Boolean>, uint8_t, T>;

template <class To, class From>
bool exact_to_integer(From value, To& out) {
  if constexpr (std::is_integral_v<From>) {
    out = static_cast<To>(value);
    return std::in_range<To>(value);
  } else {
    // Both limits are exact in From or just outside; NaN fails the comparison.
    constexpr From kLow = static_cast<From>(std::numeric_limits<To>::min());
    constexpr int kBits = std::numeric_limits<To>::digits;
    if (!(value >= kLow && value < std::ldexp(From{1}, kBits))) return false;
    out = static_cast<To>(value);
    return static_cast<From>(out) == value;
  }
}

template <class To, class From>
bool exact_to_real(From value, To& out) {
  if constexpr (std::is_integral_v<From>) {
    out = static_cast<To>(value);
    From back = 0;
    return exact_to_integer<From>(out, back) && back == value;
  } else {
    if (sizeof(To) < sizeof(From) && !(std::fabs(value) <= std::numeric_limits<To>::max())) {
      return false;
    }
    out = static_cast<To>(value);
    return static_cast<From>(out) == value;
  }
}

template <class From, class To>
size_t convert_run(const ValueRun& run) {
  using Source = Storage<From>;
  using Target = Storage<To>;
  for (size_t i = 0; i < run.count; ++i) {
    Source value;
    std::memcpy(&value, run.from + i * run.from_stride, sizeof value);
    Target out{};
    bool exact = false;
    if constexpr (std::is_same_v<To, Boolean>) {
      exact = exact_to_integer<Target>(value, out) && out <= 1;
    } else if constexpr (std::is_integral_v<Target>) {
      exact = exact_to_integer<Target>(value, out);
    } else {
      exact = exact_to_real<Target>(value, out);
    }
    if (!exact) return i;
    std::memcpy(run.to + i * sizeof out, &out, sizeof out);
  }
  return run.count;
}

template <class From>
FastConverter converter_to(Kind to) {
  switch (to) {
    case Kind::kBool:
      return convert_run<From, Boolean>;
    case Kind::kSint:
      return convert_run<From, int8_t>;
    case Kind::kInt:
      return convert_run<From, int16_t>;
    case Kind::kDint:
      return convert_run<From, int32_t>;
    case Kind::kLint:
      return convert_run<From, int64_t>;
    case Kind::kUsint:
    case Kind::kByte:
      return convert_run<From, uint8_t>;
    case Kind::kUint:
    case Kind::kWord:
      return convert_run<From, uint16_t>;
    case Kind::kUdint:
    case Kind::kDword:
      return convert_run<From, uint32_t>;
    case Kind::kUlint:
    case Kind::kLword:
      return convert_run<From, uint64_t>;
    case Kind::kReal:
      return convert_run<From, float>;
    case Kind::kLreal:
      return convert_run<From, double>;
    default:
      return nullptr;
  }
}

FastConverter converter_between(Kind from, Kind to) {
  switch (from) {
    case Kind::kBool:
      return converter_to<Boolean>(to);
    case Kind::kSint:
      return converter_to<int8_t>(to);
    case Kind::kInt:
      return converter_to<int16_t>(to);
    case Kind::kDint:
      return converter_to<int32_t>(to);
    case Kind::kLint:
      return converter_to<int64_t>(to);
    case Kind::kUsint:
    case Kind::kByte:
      return converter_to<uint8_t>(to);
    case Kind::kUint:
    case Kind::kWord:
      return converter_to<uint16_t>(to);
    case Kind::kUdint:
    case Kind::kDword:
      return converter_to<uint32_t>(to);
    case Kind::kUlint:
    case Kind::kLword:
      return converter_to<uint64_t>(to);
    case Kind::kReal:
      return converter_to<float>(to);
    case Kind::kLreal:
      return converter_to<double>(to);
    default:
      return nullptr;
  }
}

}  // namespace

FastConverter fast_converter(const ir::TypeTable& old_types, ir::TypeId old_type,
                             const ir::TypeTable& new_types, ir::TypeId new_type) {
  Kind to = new_types[new_type].kind;
  if (to == Kind::kEnum || to == Kind::kSubrange) return nullptr;
  if (!old_types.is_scalar(old_type) || !new_types.is_scalar(new_type)) return nullptr;
  return converter_between(old_types.root_kind(old_type), to);
}

}  // namespace online_change
