// Floating point.
#include "vm/native/x64/emitter.h"

namespace vm::native::x64 {
namespace {

constexpr uint8_t kFloatAdd = 0x58;
constexpr uint8_t kFloatMul = 0x59;
constexpr uint8_t kFloatSub = 0x5c;
constexpr uint8_t kFloatMin = 0x5d;
constexpr uint8_t kFloatDiv = 0x5e;
constexpr uint8_t kFloatMax = 0x5f;
constexpr uint8_t kFloatSqrt = 0x51;
constexpr uint8_t kFloatAnd = 0x54;
constexpr uint8_t kFloatXor = 0x57;

uint8_t opcode_of(Op op) {
  switch (op) {
    case Op::kFAdd:
      return kFloatAdd;
    case Op::kFSub:
      return kFloatSub;
    case Op::kFMul:
      return kFloatMul;
    default:
      return kFloatDiv;
  }
}

}  // namespace

void Emitter::floating(const Node& n, const Step& step) {
  switch (n.op) {
    case Op::kFMin:
    case Op::kFMax:
      // c op b: what is no number, and equality, give b
      a_.float_move(kFloatScratch, float_register(step.in[1]));
      a_.float_op(n.op == Op::kFMin ? kFloatMin : kFloatMax, kFloatScratch, operand(step.in[0]),
                  n.width);
      return a_.float_move(float_register(step.result), kFloatScratch);
    case Op::kFNeg:
    case Op::kFAbs:
      return float_sign(n, step);
    case Op::kFSqrt:
      return a_.float_op(kFloatSqrt, float_register(step.result), operand(step.in[0]), n.width);
    case Op::kFSelect: {
      const Label no = a_.label();
      const uint8_t question = integer_register(step.in[0]);
      a_.float_move(kFloatScratch, float_register(step.in[2]));
      a_.test(question, question, 1);
      a_.jump_if(Condition::kEqual, no);
      a_.float_move(kFloatScratch, float_register(step.in[1]));
      a_.bind(no);
      return a_.float_move(float_register(step.result), kFloatScratch);
    }
    case Op::kIntToFloat:
      return a_.float_from_integer(float_register(step.result), integer_register(step.in[0]),
                                   n.width, n.from);
    case Op::kFloatToInt:
      return a_.integer_from_float(integer_register(step.result), float_register(step.in[0]),
                                   n.from, n.imm != 0);
    case Op::kFloatWidth:
      return a_.float_width(float_register(step.result), operand(step.in[0]), n.from);
    case Op::kBitsToFloat:
      return a_.bits_to_float(float_register(step.result), integer_register(step.in[0]), n.width);
    case Op::kFloatToBits:
      return a_.float_to_bits(integer_register(step.result), float_register(step.in[0]), n.width);
    default:
      break;
  }
  const uint8_t to = float_register(step.result);
  const uint8_t a = float_register(step.in[0]);
  const Operand b = operand(n, step, 1);
  const uint8_t opcode = opcode_of(n.op);
  if (b.memory || b.reg != to || to == a) {
    a_.float_move(to, a);
    return a_.float_op(opcode, to, b, n.width);
  }
  a_.float_move(kFloatScratch, a);
  a_.float_op(opcode, kFloatScratch, b, n.width);
  a_.float_move(to, kFloatScratch);
}

void Emitter::float_sign(const Node& n, const Step& step) {
  const uint64_t sign = n.width == 4 ? uint64_t{1} << 31 : uint64_t{1} << 63;
  const bool negates = n.op == Op::kFNeg;
  a_.move_imm(kScratch, negates ? sign : sign - 1);
  a_.bits_to_float(kFloatScratch, kScratch, 8);
  const uint8_t to = float_register(step.result);
  a_.float_move(to, float_register(step.in[0]));
  a_.float_logic(negates ? kFloatXor : kFloatAnd, to, kFloatScratch);
}

void Emitter::float_compare(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  const uint8_t a = float_register(step.in[0]);
  const uint8_t b = float_register(step.in[1]);
  if (n.cond == Cond::kLtS || n.cond == Cond::kLeS) {
    a_.float_compare(b, Operand::of(a), n.width);
    return a_.set(n.cond == Cond::kLtS ? Condition::kAbove : Condition::kAboveOrEqual, to);
  }
  a_.float_compare(a, Operand::of(b), n.width);
  const bool equal = n.cond == Cond::kEq;
  a_.set(equal ? Condition::kEqual : Condition::kNotEqual, to);
  a_.set(equal ? Condition::kNoParity : Condition::kParity, kScratch);
  a_.alu(equal ? Alu::kAnd : Alu::kOr, to, Operand::of(kScratch), 1);
}

}  // namespace vm::native::x64
