// Every operation on integers, in every width, on values at the edges with anything in the upper
// bits: machine code of this machine against plain C++.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/unit/native/native_functions.h"

namespace vm::native {
namespace {

constexpr uint64_t kEdges[] = {0,
                               1,
                               2,
                               7,
                               8,
                               31,
                               32,
                               63,
                               64,
                               0x7f,
                               0x80,
                               0x81,
                               0xff,
                               0x100,
                               0x7fff,
                               0x8000,
                               0xffff,
                               0x12345678,
                               0x7fffffff,
                               0x80000000,
                               0xffffffff,
                               0x100000000,
                               0x7fffffffffffffff,
                               0x8000000000000000,
                               0x0123456789abcdef,
                               0xfffffffffffffffe,
                               0xffffffffffffffff};

uint64_t low(uint64_t v, uint8_t width) {
  return width == 8 ? v : v & ((uint64_t{1} << (8 * width)) - 1);
}
int64_t as_signed(uint64_t v, uint8_t width) {
  const unsigned shift = 64 - 8u * width;
  return static_cast<int64_t>(v << shift) >> shift;
}

struct Operation {
  Op op = Op::kAdd;
  uint8_t width = 4;
  uint8_t from = 0;
  Cond cond = Cond::kEq;
  bool constant = false;  // the second operand is one
  uint64_t bits = 0;      // of it
  std::string text() const {
    return "op " + std::to_string(static_cast<int>(op)) + " width " + std::to_string(width) +
           " from " + std::to_string(from) + " cond " + std::to_string(static_cast<int>(cond)) +
           (constant ? " constant " + std::to_string(bits) : "");
  }
};

bool answer_of(Cond cond, uint64_t a, uint64_t b, uint8_t width) {
  const int64_t s = as_signed(a, width);
  const int64_t t = as_signed(b, width);
  const uint64_t u = low(a, width);
  const uint64_t v = low(b, width);
  const bool of[] = {u == v, u != v,       s<t, s <= t, s> t, s >= t, u<v, u <= v, u> v,
                     u >= v, (u & v) == 0, (u & v) != 0};
  return of[static_cast<size_t>(cond)];
}

uint64_t rotated_left(uint64_t v, uint64_t count, uint8_t width) {
  const unsigned bits = 8u * width;
  const auto n = static_cast<unsigned>(count % bits);
  const uint64_t u = low(v, width);
  return n == 0 ? u : low(u << n | u >> (bits - n), width);
}

// What the bytecode says about `a op b`; `a` and `b` in memory, as wide as the operation.
uint64_t expected(const Operation& o, uint64_t a, uint64_t b) {
  const uint8_t w = o.width;
  const unsigned bits = 8u * w;
  const uint64_t u = low(a, w);
  const uint64_t v = low(b, w);
  const int64_t s = as_signed(a, w);
  const int64_t t = as_signed(b, w);
  const uint64_t count = b & 0xffffffff;
  const bool wraps = t == -1;
  switch (o.op) {
    case Op::kAdd:
      return u + v;
    case Op::kAddShifted:
      return u + (v << o.from);
    case Op::kSub:
      return u - v;
    case Op::kMul:
      return u * v;
    case Op::kAnd:
      return u & v;
    case Op::kOr:
      return u | v;
    case Op::kXor:
      return u ^ v;
    case Op::kShl:
      return count < bits ? u << count : 0;
    case Op::kShr:
      return count < bits ? u >> count : 0;
    case Op::kSar:
      return count < bits ? static_cast<uint64_t>(s >> count) : 0;
    case Op::kRol:
      return rotated_left(a, count, w);
    case Op::kRor:
      return rotated_left(a, bits - count % bits, w);
    case Op::kDivS:
      return wraps ? uint64_t{0} - u : static_cast<uint64_t>(s / t);
    case Op::kDivU:
      return u / v;
    case Op::kModS:
      return wraps ? 0 : static_cast<uint64_t>(s % t);
    case Op::kModU:
      return u % v;
    case Op::kMulHighS:
      return static_cast<uint64_t>(static_cast<__int128>(s) * t >> 64);
    case Op::kMulHighU:
      return static_cast<uint64_t>(static_cast<unsigned __int128>(u) * v >> 64);
    case Op::kNeg:
      return uint64_t{0} - u;
    case Op::kNot:
      return ~u;
    case Op::kCompare:
    case Op::kExitIf:  // a branch
      return answer_of(o.cond, a, b, w) ? 1 : 0;
    case Op::kSelectCmp:
      return answer_of(o.cond, a, b, o.from) ? a : b;
    case Op::kSext:
      return static_cast<uint64_t>(as_signed(a, o.from));
    case Op::kZext:
      return low(a, o.from);
    default:
      return 0;
  }
}

bool is_shift(Op op) {
  return op == Op::kShl || op == Op::kShr || op == Op::kSar || op == Op::kRol || op == Op::kRor;
}
bool is_division(Op op) {
  return op == Op::kDivS || op == Op::kDivU || op == Op::kModS || op == Op::kModU;
}

// frame[16] := frame[0] op frame[8]
Function function_of(const Operation& o) {
  FunctionMaker maker(o.op == Op::kExitIf ? 3 : 1);
  // The upper bits of 1 and 2 bytes may be anything; those of 4 are zero.
  const bool has_from = o.op == Op::kSext || o.op == Op::kZext || o.op == Op::kSelectCmp;
  const uint8_t wide = has_from ? o.from : o.width;
  const bool extended = wide == 4 || (o.op == Op::kShr && wide < 4);
  const Val a = maker.load(0, extended ? wide : 8);
  Val b = kNone;
  if (o.constant) {
    const uint8_t width = is_shift(o.op) ? 4 : wide;
    b = maker.constant(low(o.bits, width), width);
  } else {
    b = maker.load(8, is_shift(o.op) || wide == 4 ? 4 : 8);
  }
  if (o.op == Op::kExitIf) {
    maker.branch(Op::kCompare, o.cond, o.width, a, b);
    return maker.function();
  }
  Node node;
  node.op = o.op;
  node.width = o.width;
  node.from = o.from;
  node.cond = o.cond;
  node.imm = o.from;
  node.in[0] = a;
  const bool unary = o.op == Op::kNeg || o.op == Op::kNot || o.op == Op::kSext || o.op == Op::kZext;
  if (!unary) node.in[1] = b;
  if (o.op == Op::kSelectCmp) {
    node.in[2] = a;
    node.in[3] = b;
  }
  const uint8_t width = o.op == Op::kCompare ? 1 : o.width;
  maker.store(16, maker.append(node, width), width);
  maker.end();
  return maker.function();
}

std::vector<Operation> all_operations() {
  std::vector<Operation> out;
  constexpr Cond kConds[] = {Cond::kEq,  Cond::kNe,  Cond::kLtS,   Cond::kLeS,
                             Cond::kGtS, Cond::kGeS, Cond::kLtU,   Cond::kLeU,
                             Cond::kGtU, Cond::kGeU, Cond::kNoBit, Cond::kAnyBit};
  // Constants that instructions take, and that they do not.
  constexpr uint64_t kConstants[] = {0,
                                     1,
                                     2,
                                     3,
                                     0x10,
                                     0x55,
                                     0x7f,
                                     0x80,
                                     0xff,
                                     0xfff,
                                     0x1000,
                                     0x1234,
                                     0xfff0,
                                     0xffff,
                                     0x12345678,
                                     0xffffffffffffff01,
                                     0x8000000000000000,
                                     0xffffffffffffffff};
  const auto add = [&](Operation o) {
    out.push_back(o);
    o.constant = true;
    for (const uint64_t bits : kConstants) {
      o.bits = bits;
      if (is_division(o.op) && low(bits, o.width) == 0) continue;
      if (is_shift(o.op) && bits >= 8u * o.width) continue;
      out.push_back(o);
    }
  };
  for (uint8_t shift = 1; shift <= 3; ++shift) out.push_back({Op::kAddShifted, 8, shift});
  for (const uint8_t width : {uint8_t{1}, uint8_t{2}, uint8_t{4}, uint8_t{8}}) {
    for (const Op op :
         {Op::kAdd, Op::kSub, Op::kMul, Op::kAnd, Op::kOr, Op::kXor, Op::kShl, Op::kShr}) {
      add({op, width, 0, Cond::kEq});
    }
    if (width >= 4) {
      for (const Op op :
           {Op::kSar, Op::kRol, Op::kRor, Op::kDivS, Op::kDivU, Op::kModS, Op::kModU}) {
        add({op, width, 0, Cond::kEq});
      }
    } else {
      for (uint32_t n = 1; n < 8u * width; ++n) {
        out.push_back({Op::kRol, width, 0, Cond::kEq, true, n});
        out.push_back({Op::kRor, width, 0, Cond::kEq, true, n});
      }
    }
    if (width == 8) {
      add({Op::kMulHighS, width, 0, Cond::kEq});
      add({Op::kMulHighU, width, 0, Cond::kEq});
    }
    out.push_back({Op::kNeg, width});
    out.push_back({Op::kNot, width});
    out.push_back({Op::kSext, 8, width});
    out.push_back({Op::kZext, 8, width});
    for (const Cond cond : kConds) {
      add({Op::kCompare, width, 0, cond});
      add({Op::kExitIf, width, 0, cond});
      add({Op::kSelectCmp, width, width, cond});
    }
  }
  return out;
}

void test_operations(bool folds) {
  const std::vector<Operation> operations = all_operations();
  NativeFunctions functions(folds);
  for (const Operation& o : operations) functions.add(function_of(o));
  functions.finish();
  for (size_t i = 0; i < operations.size(); ++i) {
    const Operation& o = operations[i];
    const uint8_t width = o.op == Op::kCompare || o.op == Op::kExitIf ? uint8_t{1} : o.width;
    for (const uint64_t x : kEdges) {
      for (const uint64_t y : kEdges) {
        if (is_division(o.op) && !o.constant && low(y, o.width) == 0) continue;
        std::array<uint64_t, 3> frame = {x, y, 0};
        functions.run(static_cast<uint32_t>(i), frame.data());
        const uint64_t right = o.constant ? o.bits : y;
        ASSERT_EQ(low(frame[2], width), low(expected(o, x, right), width))
            << o.text() << " of " << x << " and " << right << (folds ? " in memory" : "");
      }
    }
  }
}

TEST(Operations, GiveWhatTheBytecodeSaysInEveryWidth) {
  if (!host::kIsAvailable) GTEST_SKIP() << "no native tier for this machine";
  test_operations(false);
  test_operations(true);
}

// With what every machine of its kind has, and with what this one has.
TEST(Operations, BoolsAndAndOrNot) {
  if (!host::kIsAvailable) GTEST_SKIP() << "no native tier for this machine";
  for (const bool plain : {false, true}) {
    NativeFunctions functions;
    for (const Op op : {Op::kAndNot, Op::kOrNot}) {
      FunctionMaker maker;
      Node node;
      node.op = op;
      node.width = 1;
      node.in[0] = maker.load(0, 1);
      node.in[1] = maker.load(8, 1);
      maker.store(16, maker.append(node, 1), 1);
      maker.end();
      functions.add(maker.function(), plain);
    }
    functions.finish();
    for (uint64_t a = 0; a < 2; ++a) {
      for (uint64_t b = 0; b < 2; ++b) {
        std::array<uint64_t, 3> frame = {a, b, 7};
        functions.run(0, frame.data());
        EXPECT_EQ(low(frame[2], 1), a & (b ^ 1)) << a << b << plain;
        functions.run(1, frame.data());
        EXPECT_EQ(low(frame[2], 1), a | (b ^ 1)) << a << b << plain;
      }
    }
  }
}

}  // namespace
}  // namespace vm::native
