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

STC_NATIVE(kSinF32, real::sine)
STC_NATIVE(kCosF32, real::cosine)
STC_NATIVE(kTanF32, real::tangent)
STC_NATIVE(kAsinF32, real::arc_sine)
STC_NATIVE(kAcosF32, real::arc_cosine)
STC_NATIVE(kAtanF32, real::arc_tangent)
STC_NATIVE(kLnF32, real::natural_logarithm)
STC_NATIVE(kLogF32, real::decimal_logarithm)
STC_NATIVE(kExpF32, real::exponential)
STC_NATIVE(kAtan2F32, real::arc_tangent2)
STC_NATIVE(kExptF32, real::power)

}  // namespace stdlib
