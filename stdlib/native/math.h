// The functions of ANY_REAL (IEC 61131-3 table 28) in double precision. They are
// made of IEEE 754 basic operations and integers, never of the C library, whose results
// differ between machines and versions: the same arguments give the same bits everywhere
// (ARCHITECTURE.md, invariant 5). Every result is less than one unit in the last place
// from the true value (subnormal ones less than one and a half): tests/unit/stdlib/math_test.cc
// measures it. Special values are those of C's functions (IEEE 754, clause 9.2).
#pragma once

#include <cstdint>

#include "stdlib/native/double_double.h"

namespace stdlib {

double sine(double x);
double cosine(double x);
double tangent(double x);
double arc_sine(double x);
double arc_cosine(double x);
double arc_tangent(double x);
double arc_tangent2(double y, double x);
double natural_logarithm(double x);
double decimal_logarithm(double x);
double exponential(double x);
double power(double base, double exponent);

// Those of REAL are computed in double with fewer terms, and rounded once: within 0.51 units.
namespace real {
float sine(float x);
float cosine(float x);
float tangent(float x);
float arc_sine(float x);
float arc_cosine(float x);
float arc_tangent(float x);
float arc_tangent2(float y, float x);
float natural_logarithm(float x);
float decimal_logarithm(float x);
float exponential(float x);
float power(float base, double exponent);
}  // namespace real

// x = (quadrant + fraction) * pi / 2 modulo two pi; `angle` = fraction * pi / 2 lies in
// [-pi/4, pi/4]. For finite x of any size.
struct Reduced {
  uint32_t quadrant;  // 0 .. 3
  Pair angle;
};
Reduced reduce_angle(double x);

}  // namespace stdlib
