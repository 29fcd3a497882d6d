// Pointers and references (docs/adr/0005): their types, what they lead to, their arithmetic.
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/expressions/expressions.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/objects/pools.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"

namespace frontend {
namespace {

struct Named {
  std::string_view name;
  ReferenceCall call;
};
constexpr Named kCalls[] = {{"ADR", ReferenceCall::kAdr},
                            {"REF", ReferenceCall::kRef},
                            {"SIZEOF", ReferenceCall::kSizeof},
                            {"XSIZEOF", ReferenceCall::kSizeof},
                            {"__ISVALIDREF", ReferenceCall::kIsValid},
                            {"__NEW", ReferenceCall::kNew},
                            {"__DELETE", ReferenceCall::kDelete},
                            {"__QUERYINTERFACE", ReferenceCall::kQuery},
                            {"__QUERYPOINTER", ReferenceCall::kQuery}};

ir::Kind reference_kind(SpecKind kind) {
  switch (kind) {
    case SpecKind::kPointer:
      return ir::Kind::kPointer;
    case SpecKind::kRefTo:
      return ir::Kind::kRefTo;
    default:
      return ir::Kind::kReferenceTo;
  }
}

}  // namespace

ReferenceCall reference_call_of_name(std::string_view name) {
  for (const Named& row : kCalls) {
    if (ir::same_name(row.name, name)) return row.call;
  }
  return ReferenceCall::kNone;
}

// The target may be a type whose content is being found out just now, or later: structures may
// lead back to themselves.
TypeUse Types::resolve_reference(const Spec& spec) {
  const Spec& element = sema_.tree[spec.element];
  ir::TypeId target;
  if (element.kind == SpecKind::kNamed) {
    const std::string_view name =
        sema_.namespaces.find(NameSort::kDeclaration, element.qualifiers, element.name);
    if (auto known = sema_.declared.types.find(name); known != sema_.declared.types.end()) {
      target = sema_.facts.specs[known->second.index].forward;
    }
  }
  if (!target.valid()) target = resolve_type(spec.element).type;
  if (!target.valid()) return {};
  if (sema_.program.types[target].kind == ir::Kind::kReferenceTo) {
    error(DiagnosticCode::kBadReference, spec.span,
          "a reference to a `" + sema_.report.type_text(target) + "`",
          "REFERENCE TO stands for its target; refer to that");
    return {};
  }
  return {sema_.program.types.reference(reference_kind(spec.kind), target), {}};
}

Note Expressions::infer_deref(const Expr& expr) {
  const Note& operand = infer(expr.operand);
  if (!operand.type.valid()) return {};
  const bool null = operand.flex == Flex::kNull && operand.constant;
  if (!sema_.program.types.is_reference(operand.type) || null) {
    error(DiagnosticCode::kNotReference, expr.span,
          "`" + sema_.report.type_text(operand.type) + "` is not a reference");
    return {};
  }
  Note note;
  note.type = sema_.program.types[without_range(sema_.program.types, operand.type)].base;
  note.calls = operand.calls;
  note.can_trap = true;
  return note;
}

// p[i] is the i-th value after the pointer; nothing but the area bounds i.
Note Expressions::infer_pointer_index(const Expr& expr, const Note& operand) {
  Note note;
  if (expr.list.count != 1) {
    error(DiagnosticCode::kWrongIndexCount, expr.span, "a pointer takes one index");
    return {};
  }
  const ExprId at = sema_.tree.expr_lists[expr.list.first];
  const Note& index = infer(at);
  if (!index.type.valid()) return {};
  const Traits traits = traits_of(sema_.program.types, index.type);
  if (!traits.integer && !traits.bits) {
    error(DiagnosticCode::kIndexNotInteger, sema_.tree[at].span,
          "the index is `" + sema_.report.type_text(index.type) + "`");
    return {};
  }
  note.type = sema_.program.types[operand.type].base;
  note.calls = operand.calls || index.calls;
  note.can_trap = true;
  return note;
}

// A reference outlives what is made anew at each call; the standard takes none to it.
static void check_lasting(const Phase& phase, ExprId argument) {
  const Sema& sema = phase.sema();
  ExprId whole = argument;
  while (sema.tree[whole].kind == ExprKind::kMember || sema.tree[whole].kind == ExprKind::kIndex) {
    if (phase.infer(whole).variable.valid()) break;
    whole = sema.tree[whole].operand;
  }
  const VarId id = phase.infer(whole).variable;
  if (!id.valid()) return;
  const Variable& variable = sema.declared.variables[id.index];
  const bool anew = variable.storage == Storage::kLocal || variable.section == VarSection::kTemp;
  if (!anew || variable.section == VarSection::kInOut) return;
  phase.error(DiagnosticCode::kBadReference, sema.tree[argument].span,
              "`" + std::string(variable.name.text) + "` is made anew at each call",
              "refer to a variable of a program, of an instance, or a global one");
}

Note Calls::infer_reference_call(const Expr& expr, ReferenceCall call) {
  const uint32_t wanted = call == ReferenceCall::kQuery ? 2 : 1;
  if (call == ReferenceCall::kNew && expr.list.count == 2) {
    error(DiagnosticCode::kBadPool, expr.span, "a pool gives one element at a time",
          "take an array: TYPE {attribute 'pool' := '2'} Ten : ARRAY[1..10] OF INT; END_TYPE and "
          "__NEW(Ten)");
    return {};
  }
  bool given = plain_arguments(expr, nullptr).size() == wanted;  // EN and ENO stand behind them
  for (uint32_t i = 0; i < wanted && given; ++i) {
    const Arg& arg = sema_.tree.args[expr.list.first + i];
    given = arg.value.valid() && !arg.output && !is_enable(arg, nullptr);
  }
  if (!given) {
    error(DiagnosticCode::kWrongArgumentCount, expr.span,
          "`" + std::string(sema_.tree[expr.operand].name.text) + "` takes " +
              (wanted == 1 ? "one argument" : "two arguments"));
    return {};
  }
  const ExprId argument = sema_.tree.args[expr.list.first].value;
  Note note;
  mark_enabled(expr, note);
  if (call == ReferenceCall::kNew) return ask<Pools>().infer_new(argument);
  if (call == ReferenceCall::kSizeof) {
    const ir::TypeId type = type_of_argument(argument);
    if (!type.valid()) return {};
    if (sema_.declared.open_array(type) != nullptr) {
      error(DiagnosticCode::kBadReference, sema_.tree[argument].span,
            "an array with open bounds has no size that is known here",
            "multiply the number of its elements by SIZEOF of one");
      return {};
    }
    note.type = sema_.program.types.elementary(ir::Kind::kUdint);
    note.flex = Flex::kInteger;
    // What a block or program has inside is not known before all declarations are.
    if (!sema_.program.types.is_instance(type)) note.known = Known::kByCall;
    return note;
  }
  const Note& operand = infer(argument);
  if (!operand.type.valid()) return {};
  if (call == ReferenceCall::kDelete) return ask<Pools>().infer_delete(argument);
  note.calls = note.calls || operand.calls;
  note.can_trap = operand.can_trap;
  switch (call) {
    case ReferenceCall::kQuery:
      infer(sema_.tree.args[expr.list.first + 1].value);
      note.calls = true;
      note.type = sema_.program.types.elementary(ir::Kind::kBool);
      return note;
    case ReferenceCall::kAdr:
      note.type = sema_.program.types.pointer(operand.type);
      note.flex = Flex::kNull;
      return note;
    case ReferenceCall::kRef:
      if (sema_.options.dialect == Dialect::kIec) check_lasting(*this, argument);
      note.type = sema_.program.types.ref_to(operand.type);
      return note;
    default:
      if (!operand.reference.valid() && !sema_.program.types.is_reference(operand.type)) {
        error(DiagnosticCode::kBadReference, expr.span,
              "`" + sema_.report.type_text(operand.type) + "` is not a reference");
        return {};
      }
      note.type = sema_.program.types.elementary(ir::Kind::kBool);
      return note;
  }
}

// SIZEOF takes a variable or a type.
ir::TypeId Calls::type_of_argument(ExprId argument) {
  const Expr& expr = sema_.tree[argument];
  if (expr.kind == ExprKind::kType) return ask<Types>().resolve_type(expr.spec()).type;
  if (expr.kind == ExprKind::kName ? !ask<Variables>().find_variable(expr.name).valid()
                                   : sema_.namespaces.declares(scope_, expr)) {
    if (auto use =
            ask<Types>().find_type(sema_.namespaces.find(NameSort::kDeclaration, scope_, expr)))
      return use->type;
  }
  return infer(argument).type;
}

// Sums move a pointer by bytes; the distance of two pointers is a number; every other
// operation takes the pointer as the number that its address is.
Note OperatorTypes::infer_pointer_arithmetic(BinaryOp op, const Note& left, const Note& right,
                                             base::SourceSpan span) {
  const ir::TypeTable& types = sema_.program.types;
  Note note;
  note.calls = left.calls || right.calls;
  note.can_trap = left.can_trap || right.can_trap;
  const bool first = types.is_reference(left.type);
  const bool second = types.is_reference(right.type);
  auto number = [&](const Note& side) {
    const Traits traits = traits_of(types, side.type);
    return traits.integer || traits.bits;
  };
  if (first && second && op == BinaryOp::kSub) {
    note.type = types.elementary(ir::Kind::kDint);
    return note;
  }
  if (first && number(right) && (op == BinaryOp::kAdd || op == BinaryOp::kSub)) {
    note.type = left.type;
    return note;
  }
  if (second && number(left) && op == BinaryOp::kAdd) {
    note.type = right.type;
    return note;
  }
  if ((first || number(left)) && (second || number(right)) && op != BinaryOp::kPower) {
    note.type = types.elementary(ir::Kind::kDword);
    return note;
  }
  report_not_defined(op, left, right, span);
  return {};
}

// What a reference is compared with: another one, NULL, or an integer that holds an address.
ir::TypeId OperatorTypes::common_reference(const Note& a, const Note& b) {
  const ir::TypeTable& types = sema_.program.types;
  if (types.is_reference(a.type) && types.is_reference(b.type)) {
    return a.flex == Flex::kNull ? b.type : a.type;
  }
  const Note& pointer = types.is_reference(a.type) ? a : b;
  const Note& other = types.is_reference(a.type) ? b : a;
  if (other.flex == Flex::kInteger) return pointer.type;
  const Traits traits = traits_of(types, other.type);
  if (!traits.integer && !traits.bits) return {};
  const bool wide = ir::scalar_size(types.scalar(other.type)) == 8;
  return types.elementary(wide ? ir::Kind::kLword : ir::Kind::kDword);
}

// May a reference of type `from` go where `to` is wanted? Pointers go to pointers (existing code
// casts buffers so); typed references only to what their target is or extends.
bool OperatorTypes::reference_fits(ir::TypeId from, ir::TypeId to) const {
  const ir::TypeTable& types = sema_.program.types;
  if (from == to) return true;
  const ir::TypeId source = types[from].base;
  const ir::TypeId target = types[to].base;
  if (source == target) return true;
  if (types[to].kind == ir::Kind::kPointer && types[from].kind == ir::Kind::kPointer) return true;
  return types.is_a(source, target);
}

}  // namespace frontend
