// ANY_REAL functions (IEC 61131-3 tables 28 and 29) as native functions.
#include "stdlib/native/implementation.h"
#include "stdlib/native/math.h"

namespace stdlib {

#define UNARY(id, function)                         \
  template <>                                       \
  uint64_t native<NativeId::id>(NativeArg * args) { \
    return bits_of(function(double_of(args[0])));   \
  }
#define BINARY(id, function)                                          \
  template <>                                                         \
  uint64_t native<NativeId::id>(NativeArg * args) {                   \
    return bits_of(function(double_of(args[0]), double_of(args[1]))); \
  }

UNARY(kSin, sine)
UNARY(kCos, cosine)
UNARY(kTan, tangent)
UNARY(kAsin, arc_sine)
UNARY(kAcos, arc_cosine)
UNARY(kAtan, arc_tangent)
UNARY(kLn, natural_logarithm)
UNARY(kLog, decimal_logarithm)
UNARY(kExp, exponential)
BINARY(kAtan2, arc_tangent2)
BINARY(kExpt, power)

#undef UNARY
#undef BINARY

}  // namespace stdlib
