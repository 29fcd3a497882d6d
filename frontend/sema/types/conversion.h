// Which elementary types exist under which names, how they convert, and what two
// operands have in common (docs/LANGUAGE.md: implicit conversion is lossless).
#pragma once

#include <optional>
#include <string_view>

#include "frontend/compile.h"
#include "ir/types/types.h"

namespace frontend {

// Elementary types under all their names (TOD, DT, ...), STRING and WSTRING.
std::optional<ir::Kind> kind_of_name(std::string_view name);
// XINT, __UXINT, PVOID, ...: integers of the width of an address, in CODESYS and TwinCAT.
std::optional<ir::Kind> kind_of_address_name(std::string_view name);
// STRING or WSTRING without a length.
inline constexpr uint32_t kDefaultStringCapacity = 80;

// An explicit conversion function by its name.
struct Conversion {
  enum class Bcd : uint8_t { kNone, kFrom, kTo };
  bool any_source = false;  // TO_Y, TRUNC_Y: whatever the argument is
  bool truncate = false;
  Bcd bcd = Bcd::kNone;  // binary coded decimals on that side
  ir::Kind from = ir::Kind::kBool;
  ir::Kind to = ir::Kind::kBool;
  ir::TypeId enumeration;  // valid: to it, whose numbers are `to`
};
std::optional<Conversion> conversion_of_name(std::string_view name);
// Elementary kinds and strings: does an explicit conversion exist?
bool is_convertible(ir::Kind from, ir::Kind to);

enum class Fit : uint8_t {
  kSame,  // one machine representation, no code
  kLossless,
  kNarrowing,  // possible, but can lose: warning or error, by dialect
  kNone,
};
Fit implicit_fit(const ir::TypeTable& types, ir::TypeId from, ir::TypeId to, Dialect dialect);

// Type in which two scalar or string operands meet; invalid when there is none.
ir::TypeId common_type(const ir::TypeTable& types, ir::TypeId a, ir::TypeId b, Dialect dialect);

// The type without its subranges: what arithmetic is done in.
inline ir::TypeId without_range(const ir::TypeTable& types, ir::TypeId type) {
  while (type.valid() && types[type].kind == ir::Kind::kSubrange) type = types[type].base;
  return type;
}
bool is_enum(const ir::TypeTable& types, ir::TypeId type);
bool is_string(const ir::TypeTable& types, ir::TypeId type);  // STRING or WSTRING
// TOD or LTOD, whose values stay within a day.
bool is_time_of_day(const ir::TypeTable& types, ir::TypeId type);

// What an elementary type is good for. Enumerations and aggregates: none of them.
struct Traits {
  bool boolean = false;
  bool bits = false;     // BYTE..LWORD
  bool integer = false;  // SINT..ULINT
  bool real = false;
  bool duration = false;
  bool date = false;  // DATE, TOD, DT and long forms
  bool character = false;
  bool enumeration = false;
  bool number() const { return integer || real; }
};
Traits traits_of(const ir::TypeTable& types, ir::TypeId type);

}  // namespace frontend
