// Floating point.
#include <bit>

#include "ir/types/not_a_number.h"
#include "vm/native/arm64/emitter.h"

namespace vm::native::arm64 {

Condition float_condition_of(Cond cond) {
  switch (cond) {
    case Cond::kEq:
      return Condition::kEqual;
    case Cond::kNe:
      return Condition::kNotEqual;
    case Cond::kLtS:
    case Cond::kLtU:
      return Condition::kMinus;
    case Cond::kLeS:
    case Cond::kLeU:
      return Condition::kBelowOrEqual;
    case Cond::kGtS:
    case Cond::kGtU:
      return Condition::kGreater;
    case Cond::kGeS:
    case Cond::kGeU:
      return Condition::kGreaterOrEqual;
    case Cond::kNoBit:
    case Cond::kAnyBit:
      break;  // of integers
  }
  return Condition::kEqual;
}

void Emitter::floating(const Node& n, const Step& step) {
  const Place& a = step.in[0];
  const auto to = [&] { return float_register(step.result); };
  // What is no number is made of the operands: they must be there still.
  const auto result_beside = [&](uint8_t x, uint8_t y) {
    return to() == x || to() == y ? kFloatScratch : to();
  };
  const auto binary = [&](FloatBinary op) {
    const uint8_t x = float_register(a);
    const uint8_t y = float_register(step.in[1]);
    const uint8_t result = result_beside(x, y);
    a_.float_binary(op, result, x, y, n.width);
    settle_nan(result, x, y, n.width);
    if (result != to()) a_.float_move(to(), result);
  };
  const auto unary = [&](FloatUnary op) { a_.float_unary(op, to(), float_register(a), n.width); };
  switch (n.op) {
    case Op::kFAdd:
      return binary(FloatBinary::kAdd);
    case Op::kFSub:
      return binary(FloatBinary::kSub);
    case Op::kFMul:
      return binary(FloatBinary::kMul);
    case Op::kFDiv:
      return binary(FloatBinary::kDiv);
    case Op::kFMin:
    case Op::kFMax: {
      // c op b ? c : b: what is no number, and equality, give b
      const uint8_t c = float_register(step.in[1]);
      a_.float_compare(c, float_register(a), n.width);
      const Cond cond = n.op == Op::kFMin ? Cond::kLtS : Cond::kGtS;
      return a_.float_select(float_condition_of(cond), to(), c, float_register(a));
    }
    case Op::kFNeg:
      return unary(FloatUnary::kNeg);
    case Op::kFAbs:
      return unary(FloatUnary::kAbs);
    case Op::kFSqrt: {
      const uint8_t result = result_beside(float_register(a), float_register(a));
      a_.float_unary(FloatUnary::kSqrt, result, float_register(a), n.width);
      settle_nan(result, float_register(a), float_register(a), n.width);
      if (result != to()) a_.float_move(to(), result);
      return;
    }
    case Op::kFSelect:
      ask_bool(integer_register(a));
      return a_.float_select(Condition::kNotEqual, to(), float_register(step.in[1]),
                             float_register(step.in[2]));
    case Op::kIntToFloat:
      return a_.float_from_integer(to(), integer_register(a), n.width, n.from);
    case Op::kFloatToInt:
      return float_to_int(n, step);
    case Op::kFloatWidth:
      return a_.float_width(to(), float_register(a), n.from);
    case Op::kBitsToFloat:
      return a_.bits_to_float(to(), integer_register(a), n.width);
    case Op::kFloatToBits:
      return a_.float_to_bits(integer_register(step.result), float_register(a), n.width);
    default:
      return a_.trap();
  }
}

// The machine prefers a signalling NaN to the first one, and makes a positive one by itself. The
// rule: ir/types/not_a_number.h.
void Emitter::settle_nan(uint8_t result, uint8_t a, uint8_t b, uint8_t width) {
  const NanStub stub{a_.label(), a_.label(), result, a, b, width};
  a_.float_compare(result, result, width);
  a_.jump_if(Condition::kOverflow, stub.label);
  a_.bind(stub.back);
  nan_stubs_.push_back(stub);
}

void Emitter::own_stubs() {
  for (const NanStub& stub : nan_stubs_) {
    const Label not_a = a_.label();
    a_.bind(stub.label);
    a_.float_compare(stub.a, stub.a, stub.width);
    a_.jump_if(Condition::kNoOverflow, not_a);
    a_.float_binary(FloatBinary::kAdd, stub.result, stub.a, stub.a, stub.width);
    a_.jump(stub.back);
    a_.bind(not_a);
    if (stub.b != stub.a) {  // if that is none, the machine has taken it
      a_.float_compare(stub.b, stub.b, stub.width);
      a_.jump_if(Condition::kOverflow, stub.back);
    }
    const bool single = stub.width == 4;
    a_.move_imm(kScratch, single ? std::bit_cast<uint32_t>(ir::default_nan<float>())
                                 : std::bit_cast<uint64_t>(ir::default_nan<double>()));
    a_.bits_to_float(stub.result, kScratch, stub.width);
    a_.jump(stub.back);
  }
}

// The machine gives the nearest number for what is too large, and 0 for what is no number. Here
// all of these are the smallest number, as what is too small is already.
void Emitter::float_to_int(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  const uint8_t from = float_register(step.in[0]);
  a_.move_imm(kScratch, n.from == 4 ? 0x5f000000u : 0x43e0000000000000u);  // 2^63
  a_.bits_to_float(kFloatScratch, kScratch, n.from);
  a_.float_compare(from, kFloatScratch, n.from);
  a_.integer_from_float(to, from, n.from, n.imm != 0);
  a_.move_imm(kScratch, uint64_t{1} << 63);
  a_.select(Condition::kMinus, to, to, kScratch);
}

void Emitter::float_compare(const Node& n, const Step& step) {
  a_.float_compare(float_register(step.in[0]), float_register(step.in[1]), n.width);
  a_.set(float_condition_of(n.cond), integer_register(step.result));
}

}  // namespace vm::native::arm64
