// The standard library by name: what the front end resolves when no declaration of the project
// has that name, and what the reference page lists (registry.def).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "stdlib/sources.h"

namespace stdlib {

enum class FunctionId : uint8_t {
#define FUNCTION(id, name, rule, fewest, most, parameters, signature, meaning) id,
#include "stdlib/registry.def"
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
  // The operands have the types of the signature.
  kTimeSum,
  kTimeDifference,
  kTimeProduct,
  kTimeQuotient,
  kMoment,     // parts of a date or time -> that
  kSplit,      // a date or time => its parts
  kWeekday,    // a date or moment -> INT
  kByteOrder,  // elementary; the result has its type
  kValid,      // real or bit string -> BOOL
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
};

inline constexpr std::span<const FunctionRow> function_rows() { return kFunctionRows; }

// "TIME, ANY_NUM -> TIME": the types of a signature, for the rules that go by them. Empty when
// there is no such operand.
std::string_view operand_type(const FunctionRow& row, uint32_t number);
std::string_view result_type(const FunctionRow& row);

// Another name of a parameter of a library block: CODESYS has RESET where the standard has R.
struct AliasRow {
  std::string_view block;
  std::string_view name;
  std::string_view parameter;
};
std::span<const AliasRow> alias_rows();

// "IN2": the parameter of a function at that position, from 0. Empty: no such function or
// parameter.
std::string parameter_at(std::string_view function, uint32_t position);

// What CODESYS and TwinCAT call a parameter of a function: LEN(STR := s). Empty: no such name.
std::string_view other_name(std::string_view function, std::string_view name);

// Does a vendor call the library, or a part of it, by this name? Standard.TON, Tc2_Standard.TON.
bool is_vendor_library(std::string_view name);

// The whole table as the reference page shows it. A row without an interface is a heading.
struct PageRow {
  std::string_view name;
  std::string_view interface;
  std::string_view meaning;
  bool in_st = false;  // written in ST: stdlib/st
  LibraryDialects dialects = LibraryDialects::kAll;
};
std::span<const PageRow> page_rows();

}  // namespace stdlib
