// Every operation on floating point, in both widths, on values at the edges: machine code of this
// machine against plain C++.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "ir/types/not_a_number.h"
#include "tests/unit/native/native_functions.h"

namespace vm::native {
namespace {

template <class T>
using Bits = std::conditional_t<sizeof(T) == 4, uint32_t, uint64_t>;

template <class T>
std::vector<T> edges() {
  using Limits = std::numeric_limits<T>;
  std::vector<T> out = {0,
                        T(0.3),
                        T(0.5),
                        1,
                        T(1.5),
                        2,
                        T(2.5),
                        127,
                        T(127.5),
                        T(255.5),
                        T(32768),
                        T(2e9),
                        T(3e9),
                        T(9.2e18),
                        T(9223372036854775808.0),
                        T(1e19),
                        Limits::max(),
                        Limits::min(),
                        Limits::denorm_min(),
                        Limits::infinity(),
                        Limits::quiet_NaN(),
                        std::bit_cast<T>(std::bit_cast<Bits<T>>(Limits::quiet_NaN()) | 5),
                        std::bit_cast<T>(std::bit_cast<Bits<T>>(Limits::infinity()) | 3)};
  for (size_t i = out.size(); i-- > 0;) out.push_back(-out[i]);
  out.push_back(std::nextafter(T(9223372036854775808.0), T(0)));
  return out;
}

struct Operation {
  Op op = Op::kFAdd;
  Cond cond = Cond::kEq;
  bool branches = false;
  bool truncates = false;
};

constexpr Operation kBinary[] = {{Op::kFAdd},
                                 {Op::kFSub},
                                 {Op::kFMul},
                                 {Op::kFDiv},
                                 {Op::kFMin},
                                 {Op::kFMax},
                                 {Op::kFCompare, Cond::kEq},
                                 {Op::kFCompare, Cond::kNe},
                                 {Op::kFCompare, Cond::kLtS},
                                 {Op::kFCompare, Cond::kLeS},
                                 {Op::kFCompare, Cond::kEq, true},
                                 {Op::kFCompare, Cond::kNe, true},
                                 {Op::kFCompare, Cond::kLtS, true},
                                 {Op::kFCompare, Cond::kLeS, true}};
constexpr Operation kUnary[] = {{Op::kFNeg},        {Op::kFAbs},
                                {Op::kFSqrt},       {Op::kFloatWidth},
                                {Op::kFloatToBits}, {Op::kBitsToFloat},
                                {Op::kFloatToInt},  {Op::kFloatToInt, Cond::kEq, false, true}};

bool is_comparison(const Operation& o) { return o.op == Op::kFCompare; }

template <class T>
Function binary(const Operation& o) {
  constexpr uint8_t kWidth = sizeof(T);
  FunctionMaker maker(o.branches ? 3 : 1);
  const Val b = maker.load(0, kWidth, true);
  const Val c = maker.load(8, kWidth, true);
  if (o.branches) {
    maker.branch(Op::kFCompare, o.cond, kWidth, b, c);
    return maker.function();
  }
  Node node;
  node.op = o.op;
  node.cond = o.cond;
  node.width = kWidth;
  node.in[0] = b;
  node.in[1] = c;
  const uint8_t width = is_comparison(o) ? 1 : kWidth;
  maker.store(16, maker.append(node, width, !is_comparison(o)), width);
  maker.end();
  return maker.function();
}

template <class T>
T arithmetic(Op op, T b, T c) {
  switch (op) {
    case Op::kFAdd:
      return ir::with_nan_of(b + c, b, c);
    case Op::kFSub:
      return ir::with_nan_of(b - c, b, c);
    case Op::kFMul:
      return ir::with_nan_of(b * c, b, c);
    case Op::kFDiv:
      return ir::with_nan_of(b / c, b, c);
    case Op::kFMin:
      return c < b ? c : b;
    default:
      return b < c ? c : b;
  }
}

template <class T>
bool holds(Cond cond, T b, T c) {
  if (cond == Cond::kEq) return b == c;
  if (cond == Cond::kNe) return b != c;
  return cond == Cond::kLtS ? b < c : b <= c;
}

// The same bits, also of what is no number.
template <class T>
void expect_same(Bits<T> got, T wanted, const std::string& text) {
  EXPECT_EQ(got, std::bit_cast<Bits<T>>(wanted)) << text;
}

template <class T>
void test_binary(bool folds) {
  NativeFunctions functions(folds);
  for (const Operation& o : kBinary) functions.add(binary<T>(o));
  functions.finish();
  for (uint32_t i = 0; i < std::size(kBinary); ++i) {
    const Operation& o = kBinary[i];
    for (const T b : edges<T>()) {
      for (const T c : edges<T>()) {
        std::array<uint64_t, 3> frame = {std::bit_cast<Bits<T>>(b), std::bit_cast<Bits<T>>(c), 0};
        functions.run(i, frame.data());
        const std::string text = "operation " + std::to_string(i) + " of " + std::to_string(b) +
                                 " and " + std::to_string(c);
        if (is_comparison(o)) {
          EXPECT_EQ(frame[2], holds(o.cond, b, c) ? 1u : 0u) << text;
        } else {
          expect_same(static_cast<Bits<T>>(frame[2]), arithmetic(o.op, b, c), text);
        }
      }
    }
  }
}

TEST(FloatOperations, OfTwoGiveWhatTheBytecodeSays) {
  if (!host::kIsAvailable) GTEST_SKIP() << "no native tier for this machine";
  test_binary<float>(false);
  test_binary<float>(true);
  test_binary<double>(false);
  test_binary<double>(true);
}

template <class T>
Function unary(const Operation& o) {
  constexpr uint8_t kWidth = sizeof(T);
  FunctionMaker maker;
  Node node;
  node.op = o.op;
  node.imm = o.truncates ? 1 : 0;
  node.from = kWidth;
  node.width = kWidth;
  if (o.op == Op::kFloatWidth) node.width = 12 - kWidth;
  if (o.op == Op::kFloatToInt) node.width = 8;
  node.in[0] = maker.load(0, kWidth, o.op != Op::kBitsToFloat);
  const bool floating = o.op != Op::kFloatToInt && o.op != Op::kFloatToBits;
  maker.store(16, maker.append(node, node.width, floating), node.width);
  maker.end();
  return maker.function();
}

template <class T>
int64_t to_integer(T b, bool truncates) {
  if (!(b >= -T(9223372036854775808.0) && b < T(9223372036854775808.0))) return INT64_MIN;
  return static_cast<int64_t>(truncates ? std::trunc(b) : std::nearbyint(b));
}

template <class T>
void test_unary(bool folds) {
  using Other = std::conditional_t<sizeof(T) == 4, double, float>;
  NativeFunctions functions(folds);
  for (const Operation& o : kUnary) functions.add(unary<T>(o));
  functions.finish();
  for (uint32_t i = 0; i < std::size(kUnary); ++i) {
    const Operation& o = kUnary[i];
    for (const T b : edges<T>()) {
      std::array<uint64_t, 3> frame = {std::bit_cast<Bits<T>>(b), 0, 0};
      functions.run(i, frame.data());
      const auto got = static_cast<Bits<T>>(frame[2]);
      const std::string text = "operation " + std::to_string(i) + " of " + std::to_string(b);
      if (o.op == Op::kFloatToInt) {
        EXPECT_EQ(static_cast<int64_t>(frame[2]), to_integer(b, o.truncates)) << text;
      } else if (o.op == Op::kFloatWidth) {
        expect_same(static_cast<Bits<Other>>(frame[2]), static_cast<Other>(b), text);
      } else if (o.op == Op::kFNeg) {
        expect_same(got, -b, text);
      } else if (o.op == Op::kFAbs) {
        expect_same(got, std::fabs(b), text);
      } else if (o.op == Op::kFSqrt) {
        expect_same(got, ir::with_nan_of(std::sqrt(b), b, b), text);
      } else {
        expect_same(got, b, text);
      }
    }
  }
}

TEST(FloatOperations, OfOneGiveWhatTheBytecodeSays) {
  if (!host::kIsAvailable) GTEST_SKIP() << "no native tier for this machine";
  test_unary<float>(false);
  test_unary<float>(true);
  test_unary<double>(false);
  test_unary<double>(true);
}

template <class T>
void test_from_integer() {
  NativeFunctions functions;
  for (const uint8_t from : {uint8_t{4}, uint8_t{8}}) {
    FunctionMaker maker;
    Node node;
    node.op = Op::kIntToFloat;
    node.width = sizeof(T);
    node.from = from;
    node.in[0] = maker.load(0, from);
    maker.store(16, maker.append(node, sizeof(T), true), sizeof(T));
    maker.end();
    functions.add(maker.function());
  }
  functions.finish();
  for (const int64_t v :
       {INT64_MIN, INT64_MIN + 1, int64_t{INT32_MIN}, int64_t{-16777217}, int64_t{-1}, int64_t{0},
        int64_t{1}, int64_t{16777217}, int64_t{INT32_MAX}, (int64_t{1} << 53) + 1, INT64_MAX}) {
    for (const bool wide : {false, true}) {
      std::array<int64_t, 3> frame = {v, 0, 0};
      functions.run(wide ? 1 : 0, frame.data());
      const T wanted = wide ? static_cast<T>(v) : static_cast<T>(static_cast<int32_t>(v));
      expect_same(static_cast<Bits<T>>(frame[2]), wanted, std::to_string(v));
    }
  }
}

TEST(FloatOperations, NumbersAreRoundedToTheNearest) {
  if (!host::kIsAvailable) GTEST_SKIP() << "no native tier for this machine";
  test_from_integer<float>();
  test_from_integer<double>();
}

// Constants as instructions hold them, and as they do not.
TEST(FloatOperations, ConstantsAreWhatTheyAre) {
  if (!host::kIsAvailable) GTEST_SKIP() << "no native tier for this machine";
  const double values[] = {0.0, -0.0, 1.0, -2.5, 31.0, 32.0, 0.1, 1e300};
  NativeFunctions functions;
  for (const double v : values) {
    FunctionMaker maker;
    Node node;
    node.op = Op::kFSub;
    node.width = 8;
    node.in[0] = maker.constant(std::bit_cast<uint64_t>(v), 8, true);
    node.in[1] = maker.load(0, 8, true);
    maker.store(16, maker.append(node, 8, true), 8);
    maker.store(24, maker.constant(std::bit_cast<uint32_t>(static_cast<float>(v)), 4, true), 4);
    maker.end();
    functions.add(maker.function());
  }
  functions.finish();
  for (uint32_t i = 0; i < std::size(values); ++i) {
    std::array<uint64_t, 4> frame = {0, 0, 0, 0};
    functions.run(i, frame.data());
    EXPECT_EQ(frame[2], std::bit_cast<uint64_t>(values[i] - 0.0)) << values[i];
    EXPECT_EQ(frame[3], std::bit_cast<uint32_t>(static_cast<float>(values[i]))) << values[i];
  }
}

}  // namespace
}  // namespace vm::native
