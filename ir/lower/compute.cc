// Pure operations: one instruction each where the table has one that fits.
#include <utility>

#include "ir/lower/opcodes.h"
#include "ir/lower/select.h"
#include "ir/types/not_a_number.h"

namespace ir::codegen {
namespace {

bool commutes(Op op) {
  switch (op) {
    case Op::kAdd:
    case Op::kMul:
    case Op::kAnd:
    case Op::kOr:
    case Op::kXor:
    case Op::kEq:
    case Op::kNe:
      return true;
    default:
      return false;
  }
}

bool is_comparison(Op op) {
  return op == Op::kEq || op == Op::kNe || op == Op::kLt || op == Op::kLe;
}

// Can NOT go into the comparison? Not into the order of floats: NaN.
bool can_negate(const Inst& inst) {
  return inst.op == Op::kEq || inst.op == Op::kNe ||
         ((inst.op == Op::kLt || inst.op == Op::kLe) && !is_float(inst.scalar));
}

}  // namespace

void Selector::compute(const Inst& inst, Operand dest) {
  switch (inst.op) {
    case Op::kNot:
      return compute_not(inst, dest);
    case Op::kAnd:
    case Op::kOr:
      return inst.scalar == Scalar::kBool ? compute_logic(inst, dest) : compute_binary(inst, dest);
    case Op::kEq:
    case Op::kNe:
    case Op::kLt:
    case Op::kLe:
      return compute_compare(inst, false, dest);
    case Op::kNeg:
    case Op::kAbs:
    case Op::kSqrt:
      return emit(operation_opcode(inst.op, inst.scalar), dest, use(inst.operands[0]));
    case Op::kSelect:
      return compute_select(inst, dest);
    case Op::kWrap:
    case Op::kToFloat:
    case Op::kRound:
    case Op::kTrunc:
    case Op::kToBool:
    case Op::kBits:
      return compute_conversion(inst, dest);
    case Op::kTaskTime:
      return emit(Opcode::TASK_TIME, dest);
    case Op::kTrapKind:
      return emit(Opcode::TRAP_KIND, dest);
    case Op::kThis: {
      ObjectPlace self;
      self.result = {pou_.self, 0};
      return emit(Opcode::HANDLE, dest, Operand::place(Base::kSelf, 0), {}, tables_.place(self));
    }
    case Op::kIsType:
      return emit(Opcode::IS_TYPE, dest, use(inst.operands[0]), {}, tables_.region({inst.type, 0}));
    case Op::kHandle:
      return compute_handle(inst, dest);
    case Op::kMoveHandle: {
      const Operand handle = use(inst.operands[0]);
      return emit(Opcode::HANDLE_ADD, dest, handle, use(inst.operands[1]));
    }
    case Op::kFlat:
      return emit(Opcode::FLAT, dest, use(inst.operands[0]));
    case Op::kUnflat:
      return emit(Opcode::UNFLAT, dest, use(inst.operands[0]));
    case Op::kSizeOf:
      return emit(Opcode::SIZE_OF, dest, {}, {}, tables_.region({inst.type, 0}));
    case Op::kAddress:
      return compute_address(inst, dest);
    case Op::kString:
      return compute_string(inst, dest);
    default:
      return compute_binary(inst, dest);
  }
}

void Selector::compute_binary(const Inst& inst, Operand dest) {
  ValueId left = inst.operands[0];
  ValueId right = inst.operands[1];
  if (commutes(inst.op) && values_.is_constant(left) && !values_.is_constant(right) &&
      !ir::is_nan(inst.scalar, values_.constant_bits(left))) {
    std::swap(left, right);
  }
  const Operand b = use(left);
  const Operand c = use(right);
  emit(operation_opcode(inst.op, inst.scalar), dest, b, c);
}

// If `value` is a pending NOT of a BOOL, replaces it by what it negates.
bool Selector::take_not(ValueId& value) {
  const Inst* definition = pending_definition(value);
  if (definition == nullptr || definition->op != Op::kNot || definition->scalar != Scalar::kBool) {
    return false;
  }
  consume(value);
  value = definition->operands[0];
  return true;
}

void Selector::compute_logic(const Inst& inst, Operand dest) {
  ValueId left = inst.operands[0];
  ValueId right = inst.operands[1];
  bool negated = take_not(right);
  if (!negated && take_not(left)) {
    std::swap(left, right);
    negated = true;
  }
  if (!negated) {
    if (values_.is_constant(left)) std::swap(left, right);
    const Operand b = use(left);
    return emit(operation_opcode(inst.op, Scalar::kBool), dest, b, use(right));
  }
  const Operand b = use(left);
  const Operand c = use(right);
  emit(inst.op == Op::kAnd ? Opcode::ANDN_B : Opcode::ORN_B, dest, b, c);
}

void Selector::compute_not(const Inst& inst, Operand dest) {
  ValueId value = inst.operands[0];
  const Inst* definition = pending_definition(value);
  if (inst.scalar == Scalar::kBool && definition != nullptr && is_comparison(definition->op) &&
      can_negate(*definition)) {
    consume(value);
    return compute_compare(*definition, true, dest);
  }
  emit(operation_opcode(Op::kNot, inst.scalar), dest, use(value));
}

// FALSE < TRUE.
void Selector::compute_bool_order(const Inst& inst, bool negated, Operand dest) {
  const Operand left = use(inst.operands[0]);
  const Operand right = use(inst.operands[1]);
  const bool strict = (inst.op == Op::kLt) != negated;
  const Opcode op = strict ? Opcode::ANDN_B : Opcode::ORN_B;
  if (negated) return emit(op, dest, left, right);
  emit(op, dest, right, left);
}

void Selector::compute_compare(const Inst& inst, bool negated, Operand dest) {
  const bool equality = inst.op == Op::kEq || inst.op == Op::kNe;
  if (inst.scalar == Scalar::kBool && !equality) return compute_bool_order(inst, negated, dest);
  const bool swap = !is_float(inst.scalar) && values_.is_constant(inst.operands[0]) &&
                    !values_.is_constant(inst.operands[1]);
  Operand left = use(inst.operands[0]);
  Operand right = use(inst.operands[1]);
  if (swap) std::swap(left, right);
  if (equality) {
    const Op op = (inst.op == Op::kEq) != negated ? Op::kEq : Op::kNe;
    return emit(operation_opcode(op, inst.scalar), dest, left, right);
  }
  // Negation turns < into >=, exchanging the operands turns < into >.
  const bool greater = negated != swap;
  const bool strict = (inst.op == Op::kLt) != negated;
  if (!greater) {
    return emit(operation_opcode(strict ? Op::kLt : Op::kLe, inst.scalar), dest, left, right);
  }
  emit(strict ? greater_opcode(inst.scalar) : greater_or_equal_opcode(inst.scalar), dest, left,
       right);
}

void Selector::compute_select(const Inst& inst, Operand dest) {
  const Operand condition = use(inst.operands[0]);
  const Operand if_true = use(inst.operands[2]);
  const Operand if_false = use(inst.operands[1]);
  const Class cls = class_of(inst.scalar);
  const bool in_place = dest.is_register() && dest != condition && dest != if_true;
  const Operand chosen = in_place ? dest : new_register(cls, {}, false);
  move(cls, chosen, if_false);
  emit(conditional_move_opcode(cls), chosen, condition, if_true);
  if (!in_place) move(cls, dest, chosen);
}

void Selector::compute_conversion(const Inst& inst, Operand dest) {
  const Scalar from = pou_.values[inst.operands[0].index].scalar;
  const Scalar to = inst.scalar;
  const Operand operand = use(inst.operands[0]);
  switch (inst.op) {
    case Op::kToFloat:
      return emit(to_float_opcode(from, to), dest, operand);
    case Op::kRound:
      return emit(round_opcode(from, to), dest, operand);
    case Op::kTrunc:
      return emit(truncate_opcode(from, to), dest, operand);
    case Op::kToBool:
      return emit(to_bool_opcode(from), dest, operand);
    case Op::kBits:
      return emit(bits_opcode(from, to), dest, operand);
    default:
      break;
  }
  if (from == Scalar::kBool) {
    if (scalar_size(to) == 1) return emit(Opcode::B_TO_8, dest, operand);
    const Operand byte = new_register(Class::k8, {}, true);
    emit(Opcode::B_TO_8, byte, operand);
    return emit(extend_opcode(Scalar::kU8, to), dest, byte);
  }
  const bool widens = scalar_size(to) > scalar_size(from);
  emit(widens ? extend_opcode(from, to) : narrow_opcode(from, to), dest, operand);
}

}  // namespace ir::codegen
