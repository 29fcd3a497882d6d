// Pointers and references in bodies, by the shapes of "References" in ir/program/ir.h.
#include "frontend/lower/call_code.h"
#include "frontend/lower/places.h"
#include "frontend/lower/pool_code.h"
#include "frontend/lower/references.h"
#include "frontend/lower/value_code.h"
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"

namespace frontend {
namespace {

bool is_wide(ir::Scalar scalar) { return ir::scalar_size(scalar) == 8; }

constexpr uint64_t kPastAll = uint64_t{1} << 32;  // elements: no variable has so many

}  // namespace

ir::Place ValueCode::target_place(ir::ValueId handle, ir::TypeId type) const {
  ir::Place place;
  place.base = ir::PlaceBase::kTarget;
  place.value = handle;
  place.base_type = place.type = type;
  return place;
}

// p^, and p[i].
ir::Place References::dereferenced_place(const Expr& expr) {
  const Typed pointer = natural(expr.operand);
  const ir::TypeId target = types()[pointer.type].base;
  set_line(expr.span);
  if (expr.kind == ExprKind::kDeref) return code_.target_place(pointer.value, target);
  const Typed index = natural(tree_.expr_lists[expr.list.first]);
  const ir::ValueId count = index_of_elements(index.value, scalar(index.type));
  return code_.target_place(code_.moved(pointer.value, count, target), target);
}

// So that its product with the size of an element, less than 2 GiB, is exact.
ir::ValueId References::index_of_elements(ir::ValueId index, ir::Scalar from) {
  if (is_wide(from)) {
    index = build_.binary(ir::Op::kMin, from, index, build_.constant(from, kPastAll));
    if (from == ir::Scalar::kI64) {
      index = build_.binary(ir::Op::kMax, from, index, build_.constant(from, ~kPastAll + 1));
    }
  }
  return code_.machine_convert(index, from, ir::Scalar::kI64);
}

ir::ValueId ValueCode::moved(ir::ValueId handle, ir::ValueId count, ir::TypeId element) {
  const ir::ValueId size =
      machine_convert(build_.size_of(element), ir::Scalar::kU32, ir::Scalar::kI64);
  return build_.move_handle(handle, build_.binary(ir::Op::kMul, ir::Scalar::kI64, count, size));
}

// The place itself, also of what is constant: references need a home.
ir::Place References::addressable_place(ExprId id) {
  if (sema_.declared.open_array(infer(id).type) != nullptr) {
    error(DiagnosticCode::kBadReference, tree_[id].span,
          "an array with open bounds has no address as a whole",
          "take that of its first element: ADR(a[LOWER_BOUND(a, 1)])");
    return temporary_place(infer(id).type);
  }
  const Expr& expr = tree_[id];
  ExprId whole = id;
  while (tree_[whole].kind == ExprKind::kMember || tree_[whole].kind == ExprKind::kIndex) {
    if (infer(whole).variable.valid()) break;
    whole = tree_[whole].operand;
  }
  if (VarId variable = infer(whole).variable; variable.valid()) {
    sema_.mark_written(variable);  // who has the address can
    ask<Places>().note_outer_use(variable, true, expr.span);
  }
  const Note& note = infer(id);
  const bool part = note.bit_size != 0;
  const bool value = expr.kind == ExprKind::kLiteral || expr.kind == ExprKind::kCall ||
                     expr.kind == ExprKind::kUnary || expr.kind == ExprKind::kBinary ||
                     expr.kind == ExprKind::kQualified || expr.kind == ExprKind::kAssign ||
                     expr.kind == ExprKind::kThis;
  if (!part && expr.kind == ExprKind::kName && note.variable.valid() && !note.reference.valid()) {
    return variable_place(note.variable);
  }
  const bool property = note.property != kNoPou && !note.reference.valid();
  if (!part && !value && !property && !note.constant) return place(id);
  error(DiagnosticCode::kBadReference, expr.span,
        part ? "a bit of a variable has no address" : "a value has no address",
        expr.kind == ExprKind::kThis ? "THIS is an address already"
                                     : "store it in a variable and refer to that");
  return temporary_place(note.type);
}

// The handle that leads to what `id` names.
ir::ValueId References::handle_of(ExprId id) {
  const Expr& expr = tree_[id];
  const Note& note = infer(id);
  if (!note.type.valid()) return code_.zero({});
  if (note.reference.valid()) return raw_reference(id);
  if (expr.kind == ExprKind::kDeref) return natural(expr.operand).value;
  if (ask<Places>().is_character(id)) {
    const ir::ValueId string = handle_of(expr.operand);
    return code_.moved(string, ask<Places>().character_position(expr), note.type);
  }
  return build_.handle(addressable_place(id));
}

// The value of a REFERENCE TO itself, which otherwise stands for its target.
ir::ValueId References::raw_reference(ExprId id) {
  const Expr& expr = tree_[id];
  if (expr.kind == ExprKind::kCall) return ask<CallCode>().emit_call(expr, infer(id).reference);
  return build_.load(ask<Places>().raw_place(id), ir::Scalar::kU64);
}

// What binds a REFERENCE TO: a variable, another reference, a pointer's value, or NULL.
ir::ValueId References::reference_value(ExprId id, ir::TypeId target) {
  const Note& note = infer(id);
  const ir::Type& reference = types()[target];
  if (!note.type.valid()) return code_.zero(target);
  const bool zero_literal = note.constant && note.flex == Flex::kInteger &&
                            sema_.options.dialect != Dialect::kIec &&
                            ask<Constants>().fold_integer(id) == 0;
  if ((note.constant && note.flex == Flex::kNull) || zero_literal) {
    return build_.constant(ir::Scalar::kU64, 0);
  }
  const bool pointer = types().is_reference(note.type) && types()[note.type].base == reference.base;
  if (pointer) return natural(id).value;
  if (note.type == reference.base || types().is_a(note.type, reference.base)) return handle_of(id);
  error(DiagnosticCode::kTypeMismatch, tree_[id].span,
        "`" + sema_.report.type_text(target) + "` cannot refer to a `" +
            sema_.report.type_text(note.type) + "`");
  return code_.zero(target);
}

// An instance where a variable of an interface is wanted.
ir::ValueId References::interface_value(ExprId id, ir::TypeId target) {
  const ir::TypeId type = infer(id).type;
  if (types().is_a(type, types()[target].base)) return handle_of(id);
  error(DiagnosticCode::kTypeMismatch, tree_[id].span,
        "`" + sema_.report.type_text(type) + "` does not implement `" +
            sema_.report.type_text(target) + "`",
        "declare it with IMPLEMENTS " + sema_.report.type_text(target));
  return code_.zero(target);
}

// r REF= x
void References::bind_reference(const Stmt& stmt) {
  const Note& note = infer(stmt.target);
  if (!note.type.valid()) return;
  if (!note.reference.valid()) {
    error(DiagnosticCode::kBadReference, tree_[stmt.target].span,
          "`" + sema_.report.type_text(note.type) + "` is not a REFERENCE TO", "assign with `:=`");
    return;
  }
  if (note.variable.valid()) sema_.mark_written(note.variable);
  const ir::Place where = ask<Places>().raw_place(stmt.target);
  const ir::ValueId handle = reference_value(stmt.value, note.reference);
  set_line(stmt.span);
  build_.store(where, ir::Scalar::kU64, handle);
}

ir::ValueId References::emit_reference_call(const Expr& expr, ReferenceCall call, ir::TypeId own) {
  const ExprId argument = tree_.args[expr.list.first].value;
  switch (call) {
    case ReferenceCall::kNew:
      return ask<PoolCode>().make(expr);
    case ReferenceCall::kDelete:
      ask<PoolCode>().destroy(expr);
      return code_.zero(own);
    case ReferenceCall::kQuery:
      return attempt(tree_.args[expr.list.first + 1].value, argument, expr.span).fits;
    case ReferenceCall::kSizeof:
      return code_.machine_convert(build_.size_of(ask<Calls>().type_of_argument(argument)),
                                   ir::Scalar::kU32, scalar(own));
    case ReferenceCall::kIsValid: {
      const bool raw = infer(argument).reference.valid();
      const ir::ValueId handle = raw ? raw_reference(argument) : natural(argument).value;
      const ir::ValueId address = build_.flat(handle);
      return build_.compare(ir::Op::kNe, ir::Scalar::kU32, address,
                            build_.constant(ir::Scalar::kU32, 0));
    }
    default:
      return handle_of(argument);
  }
}

ir::ValueId References::emit_pointer_arithmetic(BinaryOp op, ExprId left, ExprId right,
                                                ir::TypeId own) {
  const ir::TypeId dword = elementary(ir::Kind::kDword);
  const bool first = types().is_reference(infer(left).type);
  const bool second = types().is_reference(infer(right).type);
  if (!types().is_reference(own)) {
    if (first && second && op == BinaryOp::kSub) {
      const ir::ValueId a = build_.flat(natural(left).value);
      const ir::ValueId b = build_.flat(natural(right).value);
      return build_.unary(ir::Op::kWrap, scalar(own),
                          build_.binary(ir::Op::kSub, ir::Scalar::kU32, a, b));
    }
    const auto flat = [&](ExprId side) {
      const Note& note = infer(side);
      const bool whole = types().is_reference(note.type) || note.constant;
      return whole ? value(side, dword) : flat_number(natural(side));
    };
    const ir::ValueId a = flat(left);
    return code_.number_op(op, dword, a, flat(right));
  }
  const MovedPointer sum = moved_pointer(op, left, right);
  return build_.move_handle(sum.handle, sum.bytes);
}

// Pointers to integers and back (ADR 0005): 64 bits hold the handle's place, 32 bits the flat
// address.
// An address has 32 or 64 bits. With iec no number is one, which is an error anyway.
void References::check_address(ir::TypeId number, base::SourceSpan span) {
  if (!types().is_scalar(number) || types().is_reference(number)) return;
  if (ir::scalar_size(scalar(number)) >= 4) return;
  warning(DiagnosticCode::kImplicitNarrowing, span,
          "`" + sema_.report.type_text(number) + "` is too small for an address",
          "take that of a variable: ADR(x)");
}

ir::ValueId References::convert_reference(Typed from, ir::TypeId to, base::SourceSpan span) {
  const bool reference_source = types().is_reference(from.type);
  const bool reference_target = types().is_reference(to);
  const bool codesys = sema_.options.dialect != Dialect::kIec;
  if (reference_source && reference_target) {
    if (ask<OperatorTypes>().reference_fits(from.type, to)) {
      return is_instance_view(types(), from.type, to) ? whole_instance(build_, from.value)
                                                      : from.value;
    }
  } else if (reference_source) {
    const Traits traits = traits_of(types(), to);
    const uint32_t bytes = traits.integer || traits.bits ? ir::scalar_size(scalar(to)) : 0;
    if (codesys && bytes == 8) {
      return code_.machine_convert(compared_place(build_, from.value, false), ir::Scalar::kU64,
                                   scalar(to));
    }
    if (codesys && bytes == 4) {
      return code_.machine_convert(build_.flat(from.value), ir::Scalar::kU32, scalar(to));
    }
    if (codesys && bytes != 0) {
      error(DiagnosticCode::kBadReference, span,
            "an address does not fit into `" + sema_.report.type_text(to) + "`",
            "use DWORD or LWORD");
      return code_.zero(to);
    }
  } else {
    const Traits traits = traits_of(types(), from.type);
    if (codesys && (traits.integer || traits.bits)) {
      check_address(from.type, span);
      if (is_wide(scalar(from.type))) {
        return code_.machine_convert(from.value, scalar(from.type), ir::Scalar::kU64);
      }
      return build_.unflat(code_.machine_convert(from.value, scalar(from.type), ir::Scalar::kU32));
    }
  }
  error(DiagnosticCode::kTypeMismatch, span,
        "`" + sema_.report.type_text(from.type) + "` does not go with `" +
            sema_.report.type_text(to) + "`");
  return code_.zero(to);
}

// A constant where a pointer is wanted: NULL, 0, or an address.
ir::ValueId References::constant_reference(ExprId id) {
  if (infer(id).flex == Flex::kNull) return build_.constant(ir::Scalar::kU64, 0);
  const auto bits = ask<Constants>().fold_bits(id, elementary(ir::Kind::kLword));
  if (!bits || *bits == 0) return build_.constant(ir::Scalar::kU64, 0);
  // A literal has the width that its number needs.
  const Note& note = infer(id);
  const bool small = note.flex == Flex::kInteger && *bits <= 0xffff;
  check_address(small ? elementary(ir::Kind::kInt) : note.type, tree_[id].span);
  if (*bits > 0xffffffffu) return build_.constant(ir::Scalar::kU64, *bits);
  return build_.unflat(build_.constant(ir::Scalar::kU32, *bits));
}

}  // namespace frontend
