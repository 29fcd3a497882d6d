// Distances: `pt - start`, where `start` is a number that holds an address, and `pt - pt2`. What is
// subtracted may be an offset, too, and a pointer comes out then. A number of 64 bits tells: an
// address in it has a segment (ADR 0005), and no offset is so large.
#include "frontend/lower/conversions.h"
#include "frontend/lower/references.h"
#include "frontend/lower/value_code.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/types/conversion.h"
#include "ir/types/handle.h"

namespace frontend {
namespace {

constexpr uint64_t kFirstAddress = uint64_t{1} << 32;  // of segment 1

bool has_sign(ir::Scalar scalar) { return ir::is_signed(scalar); }

}  // namespace

// The type is a pointer's, and so is what a constant moves it by.
bool References::is_distance(ExprId id) {
  const Expr& expr = tree_[id];
  if (expr.kind != ExprKind::kBinary) return false;
  if (expr.binary != BinaryOp::kAdd && expr.binary != BinaryOp::kSub) return false;
  if (!types().is_reference(infer(expr.operand).type)) return false;
  if (expr.binary == BinaryOp::kSub && !infer(expr.right).constant) return true;
  return is_distance(expr.operand);
}

// `number` has 64 bits.
ir::ValueId References::holds_address(ir::ValueId number) {
  const ir::Scalar u64 = ir::Scalar::kU64;
  const ir::ValueId first = build_.constant(u64, kFirstAddress);
  const ir::ValueId above = build_.binary(ir::Op::kSub, u64, number, first);
  const ir::ValueId count = build_.constant(u64, ir::kPlaceMask + 1 - kFirstAddress);
  return build_.compare(ir::Op::kLt, u64, above, count);
}

// The number that 32 bits hold for what `number` holds: the flat address, or its low bits.
ir::ValueId References::flat_number(Typed number) {
  const ir::ValueId low =
      code_.machine_convert(number.value, scalar(number.type), ir::Scalar::kU32);
  if (ir::scalar_size(scalar(number.type)) != 8) return low;
  const ir::ValueId wide =
      code_.machine_convert(number.value, scalar(number.type), ir::Scalar::kU64);
  return build_.select(ir::Scalar::kU32, holds_address(wide), low, build_.flat(wide));
}

// A distance goes into 64 bits with its sign, a pointer as the number that its address is.
ir::ValueId References::distance(ExprId id, ir::TypeId target, base::SourceSpan span) {
  set_line(span);
  const MovedPointer sum = pointer_of_sum(id);
  const ir::ValueId handle = build_.move_handle(sum.handle, sum.bytes);
  const Traits to = traits_of(types(), target);
  const bool number = to.integer || to.bits;
  const ir::TypeId dword = elementary(ir::Kind::kDword);
  const bool wide = number && ir::scalar_size(scalar(target)) == 8;
  if (!wide || sum.unsigned_number) {
    return ask<Conversions>().convert({build_.flat(handle), dword}, target, span);
  }
  const ir::TypeId lword = elementary(ir::Kind::kLword);
  const ir::TypeId lint = elementary(ir::Kind::kLint);
  const bool is_signed = has_sign(scalar(target));
  const ir::ValueId place = compared_place(build_, handle, false);
  if (!sum.has_address.valid()) {
    const ir::ValueId out = code_.machine_convert(place, ir::Scalar::kU64, scalar(target));
    return ask<Conversions>().convert({out, is_signed ? lint : lword}, target, span);
  }
  const ir::ValueId flat = build_.unary(ir::Op::kWrap, ir::Scalar::kI32, build_.flat(handle));
  const ir::ValueId far = build_.unary(ir::Op::kWrap, ir::Scalar::kU64, flat);
  const ir::ValueId bits = build_.select(ir::Scalar::kU64, sum.has_address, place, far);
  const ir::ValueId out = code_.machine_convert(bits, ir::Scalar::kU64, scalar(target));
  return ask<Conversions>().convert({out, is_signed ? lint : lword}, target, span);
}

// What a distance is compared as beside `other`; invalid: it is compared as a pointer.
ir::TypeId References::compared_distance(ExprId distance, ExprId other) {
  if (!is_distance(distance) || types().is_reference(infer(other).type)) return {};
  const Note& note = infer(other);
  const Traits traits = traits_of(types(), note.type);
  if (!traits.integer && !traits.bits) return {};
  const ir::Scalar machine = scalar(note.type);
  const bool is_signed = has_sign(machine);
  if (ir::scalar_size(machine) == 8) {
    return elementary(is_signed ? ir::Kind::kLint : ir::Kind::kLword);
  }
  const bool small = ir::scalar_size(machine) < 4;
  return elementary(is_signed || small ? ir::Kind::kDint : ir::Kind::kDword);
}

// pt - pt2 has a sign, and goes into all types that an address goes into.
bool References::is_of_two_pointers(ExprId id, ir::TypeId target) {
  const Expr& expr = tree_[id];
  if (expr.kind != ExprKind::kBinary || expr.binary != BinaryOp::kSub) return false;
  if (!types().is_reference(infer(expr.right).type)) return false;
  const Traits to = traits_of(types(), target);
  const bool plain = types()[target].kind != ir::Kind::kSubrange;
  return plain && (to.integer || to.bits) && ir::scalar_size(scalar(target)) >= 4;
}

// A chain of sums moves its pointer once, by all that is added: ADR(a) + 4 * i - 4 may leave the
// variable on its way.
MovedPointer References::moved_pointer(BinaryOp op, ExprId left, ExprId right) {
  const bool first = types().is_reference(infer(left).type);
  MovedPointer sum;
  Typed number;
  if (first) sum = pointer_of_sum(left);
  const ExprId moved_by = first ? right : left;
  number = natural(moved_by);
  if (!first) sum = pointer_of_sum(right);
  const bool subtracts = op == BinaryOp::kSub;
  const ir::Scalar i64 = ir::Scalar::kI64;
  ir::Scalar from = scalar(number.type);
  if (from == ir::Scalar::kU32) {  // which wraps inside of an address
    from = ir::Scalar::kI32;
    number.value = build_.unary(ir::Op::kWrap, from, number.value);
    if (subtracts && !infer(moved_by).constant) sum.unsigned_number = true;
  }
  ir::ValueId bytes = code_.machine_convert(number.value, from, i64);
  const bool may_hold = ir::scalar_size(from) == 8 && !infer(moved_by).constant;
  if (may_hold && (subtracts || sum.has_address.valid())) {
    const ir::ValueId bits = code_.machine_convert(bytes, i64, ir::Scalar::kU64);
    const ir::ValueId holds = holds_address(bits);
    // Frames lie above 2 GiB, and a pointer does not come back from so far.
    const ir::ValueId flat = build_.unary(ir::Op::kWrap, ir::Scalar::kI32, build_.flat(bits));
    bytes = build_.select(i64, holds, bytes, build_.unary(ir::Op::kWrap, i64, flat));
    sum.has_address = subtracts && sum.has_address.valid()
                          ? build_.binary(ir::Op::kOr, ir::Scalar::kBool, sum.has_address, holds)
                      : subtracts ? holds
                                  : sum.has_address;
  }
  if (sum.bytes.valid()) {
    sum.bytes = build_.binary(subtracts ? ir::Op::kSub : ir::Op::kAdd, i64, sum.bytes, bytes);
  } else {
    sum.bytes = subtracts ? build_.unary(ir::Op::kNeg, i64, bytes) : bytes;
  }
  return sum;
}

MovedPointer References::pointer_of_sum(ExprId id) {
  const Expr& expr = tree_[id];
  const bool sum = expr.kind == ExprKind::kBinary &&
                   (expr.binary == BinaryOp::kAdd || expr.binary == BinaryOp::kSub);
  if (!sum || infer(id).constant) return {natural(id).value, {}, {}};
  return moved_pointer(expr.binary, expr.operand, expr.right);
}

}  // namespace frontend
