// ANY_REAL functions (IEC 61131-3 tables 28 and 29) as native functions.
#include "stdlib/native/implementation.h"
#include "stdlib/native/math.h"

namespace stdlib {

STC_NATIVE(kSin, sine)
STC_NATIVE(kCos, cosine)
STC_NATIVE(kTan, tangent)
STC_NATIVE(kAsin, arc_sine)
STC_NATIVE(kAcos, arc_cosine)
STC_NATIVE(kAtan, arc_tangent)
STC_NATIVE(kLn, natural_logarithm)
STC_NATIVE(kLog, decimal_logarithm)
STC_NATIVE(kExp, exponential)
STC_NATIVE(kAtan2, arc_tangent2)
STC_NATIVE(kExpt, power)

}  // namespace stdlib
