// Arc functions: all of them are the angle of a point.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "stdlib/native/math.h"

namespace stdlib {
namespace {

constexpr Pair kPi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr double kTinyArc = 0x1p-28;  // below it, arc functions of x are x within half a unit

// arc tangent of k / 16
constexpr std::array<Pair, 17> kArcs = {{
    {0x0.0p+0, 0x0.0p+0},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
}};

// arctan(y / x) for 0 <= y <= x, x > 0. With c = k / 16 near y / x, arctan(y / x) is arctan c +
// arctan t, t = (y - c x) / (x + c y), |t| < 0.032; the terms from t^3 on are plain doubles, below
// 2^-11 of t.
constexpr Pair steep_angle(Pair y, Pair x) {
  const double k = static_cast<int32_t>(16 * (y.high / x.high) + 0.5);
  const Pair c = {k / 16, 0};
  const Pair t = divide(add(y, negate(multiply(c, x))), add(x, multiply(c, y)));
  const double z = t.high * t.high;
  double tail = 0;
  for (int32_t divisor = 15; divisor >= 3; divisor -= 2) tail = 1.0 / divisor - z * tail;
  const double rest = -t.high * z * tail;
  return add(kArcs[static_cast<uint32_t>(k)], fast_two_sum(t.high, t.low + rest));
}

// arctan (y / x) for y >= 0 and x > 0: what the compiler makes tables of.
constexpr Pair exact_arc(Pair y, Pair x) {
  const bool above = y.high > x.high;
  const Pair result = above ? steep_angle(x, y) : steep_angle(y, x);
  return above ? add(kHalfPi, negate(result)) : result;
}

// arctan t = t + t^3 * tail for |t| <= 1 / 8, to 2^-58 of it.
double arc_tail(double z, double square) {
  const double first = (z * (1.0 / 5) - 1.0 / 3) + square * (z * (1.0 / 9) - 1.0 / 7);
  const double second = (z * (1.0 / 13) - 1.0 / 11) + square * (z * (1.0 / 17) - 1.0 / 15);
  return first + square * square * second;
}

// The numbers from 1/8 to 16 with five bits after the first, by their bits.
constexpr uint64_t kFirstArc = uint64_t{0x3fc} << 5;
constexpr double kInfiniteArc = std::numeric_limits<double>::infinity();

constexpr std::array<Pair, 7 * 32 + 1> arcs_of_steps() {
  std::array<Pair, 7 * 32 + 1> arcs = {};
  for (uint64_t i = 0; i < arcs.size(); ++i) {
    arcs[i] = exact_arc({std::bit_cast<double>((kFirstArc + i) << 47), 0}, {1, 0});
  }
  return arcs;
}
constexpr std::array<Pair, 7 * 32 + 1> kArcsOfSteps = arcs_of_steps();

// arctan q for q >= 0, as a sum that is within 0.05 units of the true value.
Pair arc(Pair q) {
  if (q.high < 0.125) {
    const double z = q.high * q.high;
    return {q.high, q.low + q.high * z * arc_tail(z, z * z)};
  }
  if (q.high >= 16) {
    // What is left is at most 1 / 16, and the result at least 1.5.
    const double t = -1 / q.high;
    const double z = t * t;
    return {kHalfPi.high, kHalfPi.low + t + t * z * arc_tail(z, z * z)};
  }
  // c is q with five bits after the first; arctan q is arctan c + arctan t.
  const uint64_t bits = std::bit_cast<uint64_t>(q.high) + (uint64_t{1} << 46);
  const double c = std::bit_cast<double>(bits & ~((uint64_t{1} << 47) - 1));
  const double t = ((q.high - c) + q.low) / (1 + c * q.high);
  const double z = t * t;
  const Pair& whole = kArcsOfSteps[(bits >> 47) - kFirstArc];
  const double tail = t * z * (z * (1.0 / 5 - z * (1.0 / 7)) - 1.0 / 3);
  return {whole.high, t + (whole.low + tail)};
}

// Angle of (x, y) from the x axis, y >= 0 and x > 0; `left`: of (-x, y).
double angle_of(Pair y, Pair x, bool left) {
  const Pair right = arc(x.high == 0 ? Pair{kInfiniteArc, 0} : short_quotient(y, x));
  if (!left) return value_of(right);
  const Pair size = two_sum(kPi.high, -right.high);
  return size.high + (size.low + (kPi.low - right.low));
}

// The root of 1 - x^2.
Pair cathetus(double x) {
  const Pair square = two_product(x, x);
  const Pair rest = add(two_sum(1, -square.high), {-square.low, 0});
  const double root = std::sqrt(rest.high);
  if (root == 0) return {0, 0};
  const Pair error = add(rest, negate(two_product(root, root)));
  return fast_two_sum(root, error.high / (2 * root));
}

int32_t exponent_of(double x) {  // of a finite number; subnormal ones count as the smallest
  return static_cast<int32_t>(std::bit_cast<uint64_t>(x) >> 52 & 0x7ff);
}

// x * 2^exponent, where nothing but a subnormal x or result is inexact.
double shifted(double x, int32_t exponent) {
  const int32_t half = exponent / 2;
  auto factor = [](int32_t power) {
    return std::bit_cast<double>(static_cast<uint64_t>(power + 1023) << 52);
  };
  return x * factor(half) * factor(exponent - half);
}

// arctan2 of positive finite numbers.
double angle_of_point(double y, double x, bool left) {
  const int32_t difference = exponent_of(y) - exponent_of(x);
  if (difference > 60) return kHalfPi.high;
  if (difference < -60 && left) return kPi.high;
  if (difference < -60) return y / x;
  const int32_t scale = 1023 - std::max(exponent_of(y), exponent_of(x));
  return angle_of({shifted(y, scale), 0}, {shifted(x, scale), 0}, left);
}

// One of them is 0 or infinite; y has no sign.
double angle_at_edge(double y, double x, bool left) {
  const bool y_infinite = std::isinf(y);
  const bool x_infinite = std::isinf(x);
  if (y_infinite && x_infinite) return left ? 0x1.2d97c7f3321d2p+1 : 0x1.921fb54442d18p-1;
  if (y_infinite || (x == 0 && y != 0)) return kHalfPi.high;
  return left ? kPi.high : 0;
}

}  // namespace

double arc_tangent2(double y, double x) {
  if (y != y || x != x) return std::numeric_limits<double>::quiet_NaN();
  const double height = std::fabs(y);
  const double width = std::fabs(x);
  const bool edge = height == 0 || width == 0 || std::isinf(height) || std::isinf(width);
  const double size = edge ? angle_at_edge(height, width, std::signbit(x))
                           : angle_of_point(height, width, std::signbit(x));
  return std::copysign(size, y);
}

double arc_tangent(double x) {
  if (!(std::fabs(x) >= kTinyArc)) return x;
  return std::copysign(value_of(arc({std::fabs(x), 0})), x);
}

double arc_sine(double x) {
  if (!(std::fabs(x) <= 1)) return std::numeric_limits<double>::quiet_NaN();
  if (std::fabs(x) < kTinyArc) return x;
  return std::copysign(angle_of({std::fabs(x), 0}, cathetus(x), false), x);
}

double arc_cosine(double x) {
  if (!(std::fabs(x) <= 1)) return std::numeric_limits<double>::quiet_NaN();
  return angle_of(cathetus(x), {std::fabs(x), 0}, x < 0);
}

// Numbers of 24 bits have no error that counts in double.
namespace real {

float arc_tangent(float x) { return static_cast<float>(stdlib::arc_tangent(x)); }

float arc_tangent2(float y, float x) {
  const double height = std::fabs(y);
  const double width = std::fabs(x);
  if (y != y || x != x) return std::numeric_limits<float>::quiet_NaN();
  if (height == 0 || (std::isinf(height) && std::isinf(width))) {
    return static_cast<float>(stdlib::arc_tangent2(y, x));
  }
  const double angle = stdlib::arc_tangent(height / width);  // of infinity, where the width is 0
  return static_cast<float>(std::copysign(std::signbit(x) ? kPi.high - angle : angle, y));
}

float arc_sine(float x) {
  const double size = std::fabs(x);
  if (!(size <= 1)) return std::numeric_limits<float>::quiet_NaN();
  const double angle = stdlib::arc_tangent(size / std::sqrt((1 - size) * (1 + size)));
  return static_cast<float>(std::copysign(angle, x));
}

float arc_cosine(float x) {
  const double at = x;
  if (!(std::fabs(at) <= 1)) return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(2 * stdlib::arc_tangent(std::sqrt((1 - at) / (1 + at))));
}

}  // namespace real
}  // namespace stdlib
