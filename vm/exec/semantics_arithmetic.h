// Arithmetic. Integers wrap in their width; REAL follows IEEE 754.
#pragma once

#include <cmath>
#include <limits>

#include "ir/types/not_a_number.h"
#include "vm/exec/step.h"

namespace vm {

#define SUMS(suffix, T)                                      \
  STC_BINARY(ADD_##suffix, T, T, T, Wide<T>(b) + Wide<T>(c)) \
  STC_BINARY(SUB_##suffix, T, T, T, Wide<T>(b) - Wide<T>(c)) \
  STC_BINARY(MUL_##suffix, T, T, T, Wide<T>(b) * Wide<T>(c))
STC_WORDS(SUMS)

// x86-64 gives the NaN of ir::with_nan_of by itself when the operands stand in this order, which
// the compiler may exchange in sums and products.
#if defined(__x86_64__)
#define FLOAT_OPERATION(name, operation, instruction) \
  STC_INLINE float name(float b, float c) {           \
    asm(instruction "ss %1, %0" : "+x"(b) : "xm"(c)); \
    return b;                                         \
  }                                                   \
  STC_INLINE double name(double b, double c) {        \
    asm(instruction "sd %1, %0" : "+x"(b) : "xm"(c)); \
    return b;                                         \
  }
#else
#define FLOAT_OPERATION(name, operation, instruction) \
  template <class T>                                  \
  STC_INLINE T name(T b, T c) {                       \
    return ir::with_nan_of(b operation c, b, c);      \
  }
#endif
FLOAT_OPERATION(float_sum, +, "add")
FLOAT_OPERATION(float_difference, -, "sub")
FLOAT_OPERATION(float_product, *, "mul")
FLOAT_OPERATION(float_quotient, /, "div")
#undef FLOAT_OPERATION

#define FLOATS(suffix, T)                                   \
  STC_BINARY(ADD_##suffix, T, T, T, float_sum(b, c))        \
  STC_BINARY(SUB_##suffix, T, T, T, float_difference(b, c)) \
  STC_BINARY(MUL_##suffix, T, T, T, float_product(b, c))    \
  STC_BINARY(DIV_##suffix, T, T, T, float_quotient(b, c))   \
  STC_UNARY(SQRT_##suffix, T, T, ir::with_nan_of(std::sqrt(b), b, b))
STC_FLOATS(FLOATS)
#undef FLOATS

#define NEGATION(suffix, T) STC_UNARY(NEG_##suffix, T, T, Wide<T>(0) - Wide<T>(b))
STC_WORDS(NEGATION)
STC_UNARY(NEG_F32, float, float, -b)
STC_UNARY(NEG_F64, double, double, -b)

#define ABSOLUTE(suffix, T)     \
  STC_UNARY(ABS_##suffix, T, T, \
            b < 0 ? Wide<T>(0) - static_cast<Wide<T>>(b) : static_cast<Wide<T>>(b))
STC_SIGNED(ABSOLUTE)
STC_UNARY(ABS_F32, float, float, std::fabs(b))
STC_UNARY(ABS_F64, double, double, std::fabs(b))

// The divisor -1 is apart: most negative / -1 wraps here, but faults in the processor.
template <class T>
struct Quotient : Binary<T, T, T> {
  static constexpr ir::TrapKind kTrap = ir::TrapKind::kDivisionByZero;
  static bool fails(T, T c) { return c == 0; }
  static T apply(T b, T c) {
    if constexpr (std::is_signed_v<T>) {
      if (c == -1) return static_cast<T>(Wide<T>(0) - static_cast<Wide<T>>(b));
    }
    return static_cast<T>(b / c);
  }
};
template <class T>
struct Remainder : Binary<T, T, T> {
  static constexpr ir::TrapKind kTrap = ir::TrapKind::kDivisionByZero;
  static bool fails(T, T c) { return c == 0; }
  static T apply(T b, T c) {
    if constexpr (std::is_signed_v<T>) {
      if (c == -1) return 0;
    }
    return static_cast<T>(b % c);
  }
};
#define DIVISION(suffix, T)                                    \
  template <>                                                  \
  struct Semantics<ir::Opcode::DIV_##suffix> : Quotient<T> {}; \
  template <>                                                  \
  struct Semantics<ir::Opcode::MOD_##suffix> : Remainder<T> {};
STC_SIGNED(DIVISION)
STC_UNSIGNED(DIVISION)

#define EXTREMES(suffix, T)                        \
  STC_BINARY(MIN_##suffix, T, T, T, c < b ? c : b) \
  STC_BINARY(MAX_##suffix, T, T, T, b < c ? c : b)
STC_SIGNED(EXTREMES)
STC_UNSIGNED(EXTREMES)
STC_FLOATS(EXTREMES)

}  // namespace vm
