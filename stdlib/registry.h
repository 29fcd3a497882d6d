// The standard functions by name: what the front end resolves when no declaration
// of the project has that name, and what the reference page lists.
//
// Conversions have no row each. `X_TO_Y` and `TO_Y` exist for all elementary types
// X and Y (strings included) under all their names; `TRUNC_Y`, `REAL_TRUNC_Y` and
// `LREAL_TRUNC_Y` for integer types Y. Reals round half to even and trap when the
// target cannot hold the result; integers keep their low bits; TIME counts in ms
// and LTIME in ns, DATE and DT in seconds, TOD in ms, their long forms in ns.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace stdlib {

enum class FunctionId : uint8_t {
#define FUNCTION(id, name, rule, fewest, most, parameters, signature, meaning) id,
#include "stdlib/registry.def"
#undef FUNCTION
};

// How arguments and result of a standard function are typed.
enum class FunctionRule : uint8_t {
  kNumberSame,    // one number (or duration); the result has its type
  kReal,          // reals; the result has their type
  kTrunc,         // real -> DINT
  kArithmetic,    // as the operator of that name, from left to right
  kMove,          // any; the result has its type
  kShift,         // bit string or integer, count
  kBitwise,       // as the operator
  kNot,           // as the operator
  kSelect,        // BOOL, then values of one type
  kExtreme,       // ordered values of one type
  kMux,           // index, then values of one type
  kCompare,       // ordered values of one type -> BOOL
  kString,        // strings of one kind, then integers -> string
  kStringNumber,  // strings of one kind -> INT
  kClock,         // nothing -> TIME or LTIME
};

struct FunctionRow {
  FunctionId id;
  std::string_view name;
  FunctionRule rule;
  uint32_t fewest;
  uint32_t most;                // 0: any number, unless fewest is 0 too
  std::string_view parameters;  // names, separated by blanks; "IN1+": IN1, IN2, ...
  std::string_view signature;
  std::string_view meaning;
};

inline constexpr FunctionRow kFunctionRows[] = {
#define FUNCTION(id, name, rule, fewest, most, parameters, signature, meaning) \
  {FunctionId::id, name, FunctionRule::rule, fewest, most, parameters, signature, meaning},
#include "stdlib/registry.def"
#undef FUNCTION
};

inline constexpr std::span<const FunctionRow> function_rows() { return kFunctionRows; }

}  // namespace stdlib
