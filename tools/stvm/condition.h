// Conditions of a trial (X6-03): expressions without side effects over variables of the version on
// trial and over what they were when it began, as steps of a small stack machine. A tool translates
// them (condition_parse.h); the controller checks them against the version that it is given and
// computes them at each boundary. No step goes back, so a condition ends after as many steps as it
// has; what cannot be computed (a division by zero, an overflow) is an answer, not a trap.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/symbols.h"

namespace stvm {

enum class ConditionOp : uint8_t {
  kVariable,  // now
  kBaseline,  // when the trial began
  kInteger,
  kReal,
  kBool,
  kNot,
  kNegate,
  kAbs,
  kAnd,
  kOr,
  kXor,
  kEqual,
  kNotEqual,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kModulo,
  kMin,
  kMax,
};
inline constexpr ConditionOp kLastConditionOp = ConditionOp::kMax;

struct ConditionStep {
  ConditionOp op = ConditionOp::kBool;
  uint64_t operand = 0;  // number of a variable, or the value: two's complement, or bits of LREAL
};

struct Condition {
  std::string text;  // as it was written
  std::vector<ConditionStep> steps;
};

inline constexpr size_t kMostConditions = 16;
inline constexpr size_t kMostConditionSteps = 256;
inline constexpr size_t kMostConditionDepth = 32;
inline constexpr size_t kMostConditionNames = 64;

enum class ConditionType : uint8_t { kBool, kInteger, kReal };
std::string_view condition_type_name(ConditionType type);

// A whole number has 64 bits, with a sign; a REAL is computed as LREAL.
struct ConditionValue {
  ConditionType type = ConditionType::kBool;
  int64_t integer = 0;  // a BOOL too
  double real = 0;
};
std::string condition_text(const ConditionValue& value);

// A variable of a version: a BOOL, a number, a bit string or an enumeration.
struct ConditionVariable {
  uint32_t data = 0;
  uint8_t bit_mask = 0;
  ir::Kind kind = ir::Kind::kBool;
};
// kNoSuchVariable, kBadValue: of a type that conditions do not know.
base::Result<ConditionVariable> condition_variable(const ir::Image& image, const std::string& name);
ConditionType condition_type(const ConditionVariable& variable);
// False: it is a whole number that has no room in 64 bits with a sign.
bool read_variable(const ConditionVariable& variable, const uint8_t* memory, ConditionValue& value);

// Whether it is a BOOL that can be computed. kBadValue, kTooLarge.
base::Status check_condition(const Condition& condition,
                             std::span<const ConditionVariable> variables);

enum class Computed : uint8_t { kTrue, kFalse, kByZero, kOverflow };
// Of a condition that was checked; allocates nothing.
Computed compute(const Condition& condition, std::span<const ConditionValue> now,
                 std::span<const ConditionValue> baseline);

}  // namespace stvm
