// ANY_REAL functions (IEC 61131-3 tables 29 and 30), all in double precision.
#include <cmath>

#include "stdlib/native/implementation.h"

namespace stdlib {

#define UNARY(id, function)                            \
  template <>                                          \
  uint64_t native<NativeId::id>(NativeArg * args) {    \
    return bits_of(std::function(double_of(args[0]))); \
  }
#define BINARY(id, function)                                               \
  template <>                                                              \
  uint64_t native<NativeId::id>(NativeArg * args) {                        \
    return bits_of(std::function(double_of(args[0]), double_of(args[1]))); \
  }

UNARY(kSin, sin)
UNARY(kCos, cos)
UNARY(kTan, tan)
UNARY(kAsin, asin)
UNARY(kAcos, acos)
UNARY(kAtan, atan)
UNARY(kLn, log)
UNARY(kLog, log10)
UNARY(kExp, exp)
BINARY(kAtan2, atan2)
BINARY(kExpt, pow)
BINARY(kFmod, fmod)

#undef UNARY
#undef BINARY

}  // namespace stdlib
