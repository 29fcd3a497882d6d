// The type of every expression from the inside out, before its context has spoken.
// Each expression is visited once; the note stays.
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/shared_addresses.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/expressions/expressions.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/expressions/width.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"

namespace frontend {
namespace {

// Operator chains nest without parentheses; this keeps them off the stack.
constexpr uint32_t kMaxDepth = 900;

ir::Kind literal_kind(const Literal& literal) {
  switch (literal.kind) {
    case LiteralKind::kBool:
      return ir::Kind::kBool;
    case LiteralKind::kDuration:
      return literal.is_long ? ir::Kind::kLtime : ir::Kind::kTime;
    case LiteralKind::kDate:
      return literal.is_long ? ir::Kind::kLdate : ir::Kind::kDate;
    case LiteralKind::kTimeOfDay:
      return literal.is_long ? ir::Kind::kLtod : ir::Kind::kTod;
    case LiteralKind::kDateAndTime:
      return literal.is_long ? ir::Kind::kLdt : ir::Kind::kDt;
    default:
      return ir::Kind::kLreal;
  }
}

ir::Kind integer_kind(const Literal& literal) {
  if (literal.integer <= 0x7fffffffu) return ir::Kind::kDint;
  return literal.integer <= 0x7fffffffffffffffu ? ir::Kind::kLint : ir::Kind::kUlint;
}

}  // namespace

const Note& Expressions::infer_now(ExprId id, Note& note) {
  const Expr& expr = sema_.tree[id];
  if (sema_.facts.depth > kMaxDepth) {
    error(DiagnosticCode::kTooDeep, expr.span, "the expression is nested too deeply",
          "split it with intermediate variables");
    note.progress = Progress::kDone;
    return note;
  }
  ++sema_.facts.depth;
  note = infer_kind(id, expr);
  if (expr.kind != ExprKind::kName && expr.kind != ExprKind::kMember) note.property = kNoPou;
  note.any_sign = note.any_sign && expr.kind == ExprKind::kBinary;
  note.reference = {};
  if (note.type.valid() && sema_.program.types[note.type].kind == ir::Kind::kReferenceTo) {
    note.reference = note.type;
    note.type = sema_.program.types[note.type].base;
    note.constant = false;
    note.can_trap = true;
  }
  if (note.constant) note.known = Known::kConstant;
  --sema_.facts.depth;
  note.progress = Progress::kDone;
  return note;
}

// A BOOL at a bit of shared bytes is a part of a BYTE, though it has a name.
static void mark_bit(Note& note, const AddressView& view) {
  if (view.bit < 0) return;
  note.view = true;
  note.bit_size = 1;
  note.bit_number = static_cast<uint32_t>(view.bit);
}

Note Expressions::infer_kind(ExprId, const Expr& expr) {
  switch (expr.kind) {
    case ExprKind::kLiteral:
      return infer_literal(expr);
    case ExprKind::kName:
      return infer_name(expr);
    case ExprKind::kQualified:
      return infer_qualified(expr);
    case ExprKind::kMember:
      return infer_member(expr);
    case ExprKind::kBit:
      return infer_bit(expr);
    case ExprKind::kIndex:
      return infer_index(expr);
    case ExprKind::kUnary:
      return infer_unary(expr);
    case ExprKind::kBinary:
      return ask<OperatorTypes>().infer_binary(expr);
    case ExprKind::kCall:
      return ask<Calls>().infer_call(expr);
    case ExprKind::kAssign:
      return infer_assign(expr);
    case ExprKind::kResult:
      return infer_result(expr);
    case ExprKind::kDirect: {
      Note note;
      note.type = ask<Variables>().type_of_direct(sema_.tree.directs[expr.number].address);
      if (const AddressView* view = direct_view(*this, expr)) mark_bit(note, *view);
      return note;
    }
    case ExprKind::kDeref:
      return infer_deref(expr);
    case ExprKind::kArrayInit:
    case ExprKind::kRepeat:
    case ExprKind::kStructInit:
      error(DiagnosticCode::kNotAValue, expr.span,
            "a list of values stands where a single value is needed");
      return {};
    case ExprKind::kThis:
    case ExprKind::kSuper:
      return ask<Objects>().infer_this(expr);
    case ExprKind::kType:
      error(DiagnosticCode::kNotAValue, expr.span, "a type stands where a value is needed",
            "only SIZEOF takes a type that has no name");
      return {};
    case ExprKind::kError:
      return {};
  }
  return {};
}

Note Expressions::infer_literal(const Expr& expr) {
  const Literal& literal = sema_.tree.literals[expr.number];
  Note note;
  note.constant = true;
  if (literal.too_large) return {};
  if (const Name prefix = sema_.tree.name(literal.prefix); !prefix.empty()) {
    auto use = ask<Types>().find_type(sema_.namespaces.find(NameSort::kDeclaration, prefix));
    if (!use) {
      error(DiagnosticCode::kUnknownType, prefix.span,
            "`" + std::string(prefix.text) + "` is not a type");
      return {};
    }
    const ir::TypeId type = use->type;
    const bool single =
        type.valid() && !sema_.program.types.is_reference(type) &&
        (sema_.program.types.is_scalar(type) || is_string(sema_.program.types, type));
    if (type.valid() && !single) {
      error(DiagnosticCode::kUnknownType, prefix.span,
            "`" + std::string(prefix.text) + "` has no literals");
    }
    if (!single) return {};
    note.type = type;
    return note;
  }
  switch (literal.kind) {
    case LiteralKind::kInteger:
      note.flex = Flex::kInteger;
      note.type = sema_.program.types.elementary(integer_kind(literal));
      return note;
    case LiteralKind::kReal:
      note.flex = Flex::kReal;
      note.type = sema_.program.types.elementary(ir::Kind::kLreal);
      return note;
    case LiteralKind::kString: {
      note.flex = Flex::kText;
      uint32_t length = static_cast<uint32_t>(sema_.tree.texts[literal.text].size());
      note.type = sema_.program.types.string(length == 0 ? 1 : length);
      return note;
    }
    case LiteralKind::kWstring: {
      note.flex = Flex::kText;
      uint32_t length = static_cast<uint32_t>(sema_.tree.texts[literal.text].size() / 2);
      note.type = sema_.program.types.wstring(length == 0 ? 1 : length);
      return note;
    }
    default:
      note.type = sema_.program.types.elementary(literal_kind(literal));
      return note;
  }
}

Note Expressions::infer_name(const Expr& expr) {
  VarId id = ask<Variables>().find_variable(expr);
  if (!id.valid() && expr.global) {
    NearestName nearest(expr.name.text);
    nearest.offer_all(sema_.declared.globals);
    error(DiagnosticCode::kUnknownName, expr.span,
          "there is no global variable `" + std::string(expr.name.text) + "`", nearest.fix());
    return {};
  }
  if (!id.valid() && ir::same_name(expr.name.text, "NULL")) {
    Note note;
    note.type = sema_.program.types.ref_to(sema_.program.types.elementary(ir::Kind::kByte));
    note.flex = Flex::kNull;
    note.constant = true;
    return note;
  }
  if (!id.valid()) return infer_enum_name(expr);
  const Variable& variable = sema_.declared.variables[id.index];
  if (variable.access == Access::kPrivate) {  // of a base
    ask<Objects>().check_access(variable.access, variable.pou, expr.name);
  }
  return variable_note(id);
}

Note Expressions::variable_note(VarId id) {
  sema_.mark_used(id);
  const Variable* variable = &resolve(id);
  if (variable->external.valid()) {
    id = variable->external;
    sema_.mark_used(id);
    variable = &resolve(id);
  }
  Note note;
  note.variable = id;
  note.type = variable->type;
  const bool known = has_known_value(*variable);
  note.constant = known && variable->type.valid() &&
                  (sema_.program.types.is_scalar(variable->type) ||
                   is_string(sema_.program.types, variable->type));
  bool has_initial = variable->section != VarSection::kInOut;
  note.known = known ? Known::kConstant : has_initial ? Known::kInitially : Known::kNo;
  mark_bit(note, variable->view);
  return note;
}

// `name`, or `A.name` where A is a namespace.
Note Expressions::infer_enum_name(const Expr& expr) {
  const bool plain = expr.kind == ExprKind::kName;
  const uint32_t own = plain ? sema_.declared.block_of(scope_) : kNoPou;
  Objects::Found code;
  if (own != kNoPou) code = ask<Objects>().find_code(own, expr.name.text);
  if (code.code.is_property()) return ask<Objects>().infer_property(expr.name, code);
  if (code.owner != kNoPou) {
    error(DiagnosticCode::kNotAValue, expr.span,
          "`" + std::string(expr.name.text) + "` is a method",
          "call it: `" + std::string(expr.name.text) + "()`");
    return {};
  }
  std::string_view name = sema_.namespaces.find(NameSort::kLiteral, scope_, expr);
  auto found = sema_.declared.literals.find(name);
  if (found == sema_.declared.literals.end() && plain &&
      ask<Collection>().use_library_literal(name))
    found = sema_.declared.literals.find(name);
  Note note;
  if (plain && sema_.declared.forming_literal(expr.name.text, &note.type) != nullptr) {
    note.constant = true;
    note.flex = Flex::kInteger;
    return note;
  }
  if (found == sema_.declared.literals.end()) {
    VarId id = plain ? ask<Variables>().program_variable(name, false) : VarId();
    if (id.valid()) return variable_note(id);
    name = sema_.namespaces.find(NameSort::kDeclaration, scope_, expr);
    if (sema_.namespaces.is_path(expr)) {
      error(DiagnosticCode::kNotAValue, expr.span, "`" + std::string(name) + "` is a namespace");
      return {};
    }
    bool pou = sema_.declared.pou_names.contains(name) || sema_.declared.types.contains(name) ||
               sema_.library.pous.contains(name) || sema_.library.functions.contains(name);
    error(pou ? DiagnosticCode::kNotAValue : DiagnosticCode::kUnknownName, expr.span,
          "`" + std::string(name) + (pou ? "` is not a variable" : "` is not declared"),
          pou ? Fix() : ask<Variables>().name_suggestion(name, false));
    return {};
  }
  note.constant = true;
  const bool several = found->second.size() > 1 || sema_.namespaces.is_ambiguous(expr.name);
  if (several) note.flex = Flex::kEnum;
  note.type = ask<Types>().resolve_type(found->second[0].spec).type;
  return note;
}

// Color#Red, A.Color#Red
Note Expressions::infer_qualified(const Expr& expr) {
  const Name type = sema_.tree.name(expr.number);
  if (!expr.operand.valid()) {
    return infer_literal_of(sema_.namespaces.find(NameSort::kDeclaration, type), type.span,
                            expr.name);
  }
  Expr whole;  // A.Color
  whole.kind = ExprKind::kMember;
  whole.operand = expr.operand;
  whole.name = type;
  whole.span = {sema_.tree[expr.operand].span.begin, type.span.end};
  const std::string_view name = sema_.namespaces.find(NameSort::kDeclaration, scope_, whole);
  if (!name.empty()) return infer_literal_of(name, whole.span, expr.name);
  error(DiagnosticCode::kUnknownName, sema_.tree[expr.operand].span,
        "what stands before `" + std::string(type.text) + "#` is not a namespace");
  return {};
}

// `span`: of the type's name.
Note Expressions::infer_literal_of(std::string_view name, base::SourceSpan span,
                                   const Name& wanted) {
  auto use = ask<Types>().find_type(name);
  bool known = use && use->type.valid();
  if (use && !known) return {};
  if (!known || !is_enum(sema_.program.types, use->type)) {
    NearestName type(name);
    type.offer_all(sema_.declared.types);
    error(known ? DiagnosticCode::kNotEnumeration : DiagnosticCode::kUnknownType, span,
          "`" + std::string(name) + "` is not an enumeration", known ? "" : type.fix());
    return {};
  }
  if (sema_.declared.find_literal(use->type, wanted.text) >= 0) {
    Note note;
    note.type = use->type;
    note.constant = true;
    return note;
  }
  NearestName nearest(wanted.text);
  for (const ir::EnumLiteral& literal : sema_.program.types[use->type].literals) {
    nearest.offer(literal.name);
  }
  error(DiagnosticCode::kNotEnumeration, wanted.span,
        "`" + sema_.report.type_text(use->type) + "` has no literal `" + std::string(wanted.text) +
            "`",
        nearest.fix());
  return {};
}

Note Expressions::infer_bit(const Expr& expr) {
  const Note& operand = infer(expr.operand);
  if (!operand.type.valid()) return {};
  Traits traits = traits_of(sema_.program.types, operand.type);
  if (!traits.bits && !traits.integer) {
    error(DiagnosticCode::kBadOperand, expr.span,
          "`" + sema_.report.type_text(operand.type) + "` has no bits to access");
    return {};
  }
  if (!check_part(operand.type, expr.number, expr.bit_size, expr.span)) return {};
  return part_note(operand, expr.number, expr.bit_size);
}

// What the variable holds then; of S= and R= the value on the right.
Note Expressions::infer_assign(const Expr& expr) {
  allow_extension("an assignment inside an expression", expr.span, "write two statements");
  bool set = expr.assign == AssignOp::kSet || expr.assign == AssignOp::kReset;
  Note note;
  note.calls = true;
  note.type = set ? sema_.program.types.elementary(ir::Kind::kBool) : infer(expr.operand).type;
  return note;
}

bool Expressions::check_part(ir::TypeId whole, uint32_t number, uint8_t size,
                             base::SourceSpan span) {
  uint32_t width = ir::scalar_size(sema_.program.types.scalar(whole)) * 8;
  if ((uint64_t{number} + 1) * size <= width) return true;
  error(DiagnosticCode::kBitOutOfRange, span,
        "number " + std::to_string(number) + " in `" + sema_.report.type_text(whole) + "`",
        "the highest is " + std::to_string(width / size - 1));
  return false;
}

Note Expressions::part_note(const Note& whole, uint32_t number, uint8_t size) const {
  Note note = whole;
  note.progress = Progress::kNew;
  note.flex = Flex::kNone;
  note.width = Width::kOwn;
  note.constant = false;
  note.variable = {};
  note.property = kNoPou;
  note.bit_size = size;
  note.view = false;
  note.bit_member = -1;
  note.bit_number = number;
  ir::DirectAddress bits;
  bits.bit_size = size;
  note.type = ask<Variables>().type_of_direct(bits);
  return note;
}

Note Expressions::infer_unary(const Expr& expr) {
  const Note& operand = infer(expr.operand);
  if (!operand.type.valid()) return {};
  Note note = operand;
  note.variable = {};
  note.bit_size = 0;
  Traits traits = traits_of(sema_.program.types, operand.type);
  note.type = without_range(sema_.program.types, operand.type);
  bool good = false;
  if (expr.unary == UnaryOp::kNot) {
    good =
        traits.boolean || traits.bits ||
        (traits.integer && (sema_.options.dialect != Dialect::kIec || operand.flex != Flex::kNone));
  } else {
    good = traits.number() || traits.duration ||
           (traits.bits && sema_.options.dialect != Dialect::kIec);
  }
  if (good && expr.unary == UnaryOp::kNegate) note.width = width_of(sema_, note, true);
  if (good) return note;
  error(DiagnosticCode::kBadOperand, expr.span,
        std::string(expr.unary == UnaryOp::kNot ? "NOT" : "a sign") + " is not defined for `" +
            sema_.report.type_text(operand.type) + "`");
  return {};
}

}  // namespace frontend
