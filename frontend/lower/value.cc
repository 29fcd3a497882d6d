// Scalar values of expressions, in the type that their place asks for.
#include "frontend/lower/assignments.h"
#include "frontend/lower/call_code.h"
#include "frontend/lower/current_results.h"
#include "frontend/lower/method_code.h"
#include "frontend/lower/places.h"
#include "frontend/lower/references.h"
#include "frontend/lower/value_code.h"
#include "frontend/lower/values.h"
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/expressions/operand_warnings.h"
#include "frontend/sema/expressions/width.h"

namespace frontend {

namespace {

// Existing sources take the milliseconds of a TIME, or the seconds of a DT, through a POINTER TO
// DWORD; here they would get something else.
void warn_of_half_times(const Phase& phase, ir::TypeId from, ir::TypeId to, base::SourceSpan span) {
  const ir::TypeTable& types = phase.sema().program.types;
  if (!types.is_reference(from) || !types.is_reference(to)) return;
  ir::TypeId source = types[without_range(types, from)].base;
  ir::TypeId target = types[without_range(types, to)].base;
  Traits time = traits_of(types, source);
  Traits number = traits_of(types, target);
  if (!time.duration && !time.date) return;
  if (!number.bits && !number.integer) return;
  uint32_t bytes = ir::scalar_size(types.scalar(target));
  if (bytes != 2 && bytes != 4) return;
  phase.warning(DiagnosticCode::kImplicitNarrowing, span,
                "`" + phase.sema().report.type_text(source) + "` is 64 bits of nanoseconds; a `" +
                    phase.sema().report.type_text(target) +
                    "` behind its address is a part of them",
                "convert the value, for example with TO_" + phase.sema().report.type_text(target));
}

}  // namespace

// SEL(q, 0, 1), MUX, MOVE and the like: literals that a BOOL has, where one is wanted.
static bool chooses_literals(const Phase& phase, ExprId id) {
  const Expr& expr = phase.sema().tree[id];
  if (expr.kind != ExprKind::kCall) return false;
  const Callee callee = phase.ask<Calls>().callee(expr);
  if (callee.kind != Callee::Kind::kStandard) return false;
  using stdlib::FunctionRule;
  const FunctionRule rule = callee.row->rule;
  return rule == FunctionRule::kSelect || rule == FunctionRule::kMux ||
         rule == FunctionRule::kMove || rule == FunctionRule::kExtreme ||
         rule == FunctionRule::kBitwise;
}

ir::TypeId Values::own_type(ExprId id, ir::TypeId target) {
  const Note& note = infer(id);
  if (!target.valid()) return note.type;
  Traits traits = traits_of(types(), target);
  ir::TypeId plain = without_range(types(), target);
  switch (note.flex) {
    case Flex::kNone:
      return signed_by_context(types(), note, target);
    case Flex::kInteger:
      if (traits.boolean && chooses_literals(*this, id)) return plain;
      return traits.number() || traits.bits ? plain : note.type;
    case Flex::kReal:
      return traits.real ? plain : note.type;
    case Flex::kEnum:
      return traits.enumeration ? plain : note.type;
    case Flex::kText:
      return note.type;
    case Flex::kNull:
      if (!types().is_reference(target)) return note.type;
      return is_instance_view(types(), note.type, plain) ? note.type : plain;
  }
  return note.type;
}

ir::ValueId Values::value(ExprId id, ir::TypeId target) {
  const Note& note = infer(id);
  const Expr& expr = tree_[id];
  if (!note.type.valid() || !target.valid()) return code_.zero(target);
  if (types()[target].kind == ir::Kind::kReferenceTo)
    return ask<References>().reference_value(id, target);
  if (note.constant && types().is_reference(target))
    return ask<References>().constant_reference(id);
  if (is_interface(types(), target) && types().is_instance(note.type)) {
    return ask<References>().interface_value(id, target);
  }
  if (is_known(note)) {
    auto bits = ask<Constants>().fold_bits(id, target,
                                           body_.evaluating ? Known::kInitially : Known::kConstant);
    set_line(expr.span);
    return bits ? build_.constant(scalar(target), *bits) : code_.zero(target);
  }
  const ir::TypeId own = own_type(id, target);
  if (!types().is_scalar(own)) {
    error(DiagnosticCode::kTypeMismatch, expr.span,
          "`" + sema_.report.type_text(own) + "` does not go with `" +
              sema_.report.type_text(target) + "`");
    return code_.zero(target);
  }
  warn_of_half_times(*this, note.type, target, expr.span);
  if (note.width == Width::kWide && !types().is_reference(target)) return stored(id, target);
  if (note.width == Width::kWraps && is_wider(types(), target, own))
    check_wrapped(*this, id, "widened");
  if (types().is_reference(own) && !types().is_reference(target) &&
      ask<References>().is_distance(id)) {
    return ask<References>().distance(id, target, expr.span);
  }
  if (ask<References>().is_of_two_pointers(id, target))
    return code_.machine_convert(emit(id, own), scalar(own), scalar(target));
  return convert({emit(id, own), own}, target, expr.span);
}

Typed Values::natural(ExprId id) {
  const Note& note = infer(id);
  ir::TypeId type = without_range(types(), note.type);
  if (!type.valid() || !types().is_scalar(type)) {
    return {code_.zero({}), elementary(ir::Kind::kDint)};
  }
  if (note.width == Width::kWide) {
    const ir::TypeId dint = elementary(ir::Kind::kDint);
    return {computed_in(id, dint), dint};
  }
  return {value(id, type), type};
}

ir::ValueId Values::loaded(ExprId id) {
  const ir::Place from = place(id);
  return build_.load(from, scalar(from.type));
}

ir::ValueId Values::emit(ExprId id, ir::TypeId own) {
  const Expr& expr = tree_[id];
  set_line(expr.span);
  if (infer(id).bit_size != 0) return emit_bit(id);
  if (ask<Places>().is_character(id)) return emit_character(expr);
  const Note& note = infer(id);
  if (note.property != kNoPou && !note.reference.valid())
    return ask<MethodCode>().read_property(id).value;
  switch (expr.kind) {
    case ExprKind::kThis:
      return build_.this_handle();
    case ExprKind::kName:
    case ExprKind::kMember:
    case ExprKind::kIndex:
    case ExprKind::kDeref:
    case ExprKind::kDirect:
      return loaded(id);
    case ExprKind::kUnary:
      return emit_unary(expr, own);
    case ExprKind::kBinary:
      return emit_binary(expr, own);
    case ExprKind::kCall:  // the result may be a REFERENCE TO the value
      return note.reference.valid() ? loaded(id) : ask<CallCode>().emit_call(expr, own);
    case ExprKind::kAssign:
      return ask<Assignments>().emit_assignment(expr);
    case ExprKind::kResult:
      return ask<CurrentResults>().emit_result(id);
    default:
      return code_.zero(own);
  }
}

ir::ValueId Values::emit_bit(ExprId id) {
  const Note part = infer(id);
  uint32_t offset = part.bit_number * part.bit_size;
  if (part.view) {
    ir::Place byte = ask<Places>().view_place(id);
    return code_.part_of(build_.load(byte, scalar(byte.type)), scalar(byte.type), offset, 1);
  }
  if (part.bit_member >= 0) {
    ir::Place word = ask<Places>().bit_word_place(tree_[id].operand, part);
    ir::ValueId bits = build_.load(word, scalar(word.type));
    return code_.part_of(bits, scalar(word.type), offset, 1);
  }
  Typed word = natural(tree_[id].operand);
  return code_.part_of(word.value, scalar(word.type), offset, part.bit_size);
}

ir::ValueId ValueCode::zero(ir::TypeId type) {
  bool usable = type.valid() && types().is_scalar(type);
  return build_.constant(usable ? scalar(type) : ir::Scalar::kI32, 0);
}

ir::ValueId ValueCode::part_of(ir::ValueId word, ir::Scalar machine, uint32_t offset,
                               uint32_t size) {
  ir::ValueId bits = word;
  if (offset != 0) {
    bits = build_.binary(ir::Op::kShr, machine, bits, build_.constant(ir::Scalar::kU32, offset));
  }
  if (size != 1) {
    ir::DirectAddress part;
    part.bit_size = size;
    return machine_convert(bits, machine, scalar(type_of_direct(types_, part)));
  }
  bits = build_.binary(ir::Op::kAnd, machine, bits, build_.constant(machine, 1));
  return build_.unary(ir::Op::kToBool, ir::Scalar::kBool, bits);
}

ir::ValueId Values::emit_unary(const Expr& expr, ir::TypeId own) {
  ir::ValueId operand = value(expr.operand, own);
  set_line({expr.op, expr.op});
  if (expr.unary == UnaryOp::kPlus) return operand;
  return build_.unary(expr.unary == UnaryOp::kNot ? ir::Op::kNot : ir::Op::kNeg, scalar(own),
                      operand);
}

ir::ValueId ValueCode::string_value(const ir::Place& place) {
  return build_.string(place, wide(place.type));
}

}  // namespace frontend
