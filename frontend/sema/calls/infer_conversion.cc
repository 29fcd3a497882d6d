// Explicit conversions: what may be converted into what.
#include <algorithm>

#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/standard_calls.h"
#include "frontend/sema/expressions/operand_warnings.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"

namespace frontend {
namespace {

bool is_text(ir::Kind kind) { return kind == ir::Kind::kString || kind == ir::Kind::kWstring; }

std::string kind_text(ir::Kind kind) {
  if (is_text(kind)) return kind == ir::Kind::kString ? "STRING" : "WSTRING";
  return std::string(ir::elementary_name(kind));
}

}  // namespace

// TO_Mode, INT_TO_Mode: the literal of that number, as an implicit conversion takes it (W0001).
std::optional<Conversion> StandardCalls::conversion_to_enumeration(std::string_view name) {
  constexpr std::string_view kTo = "TO_";
  for (size_t at = 0; at + kTo.size() < name.size(); ++at) {
    if (!ir::same_name(name.substr(at, kTo.size()), kTo)) continue;
    Conversion out;
    out.any_source = at == 0;
    if (at != 0) {
      const auto source = name[at - 1] == '_' ? kind_of_name(name.substr(0, at - 1)) : std::nullopt;
      if (!source) continue;
      out.from = *source;
    }
    const auto found = ask<Types>().find_type(name.substr(at + kTo.size()));
    if (!found || !is_enum(sema_.program.types, found->type)) continue;
    out.enumeration = found->type;
    out.to = sema_.program.types.root_kind(found->type);
    return out;
  }
  return std::nullopt;
}

Note StandardCalls::infer_conversion(const Expr& expr, const Conversion& conversion) {
  ExprId argument = ask<Calls>().conversion_argument(expr);
  if (!argument.valid()) {
    error(DiagnosticCode::kWrongArgumentCount, expr.span, "a conversion takes one argument");
    return {};
  }
  if (conversion.enumeration.valid()) {
    allow_extension("a conversion to an enumeration", expr.span, "choose the literal with CASE");
  }
  Note note = infer(argument);
  if (!note.type.valid()) return {};
  bool text = is_string(sema_.program.types, note.type);
  if (!sema_.program.types.is_scalar(note.type) && !text) {
    error(DiagnosticCode::kWrongArgument, expr.span,
          "`" + sema_.report.type_text(note.type) + "` cannot be converted");
    return {};
  }
  ir::Kind from =
      text ? sema_.program.types[note.type].kind : sema_.program.types.root_kind(note.type);
  if (!check_conversion(expr, conversion, from, note)) return {};
  uint32_t capacity = text ? sema_.program.types[note.type].capacity : kDefaultStringCapacity;
  Traits source = traits_of(sema_.program.types, note.type);
  note.variable = {};
  note.constant = false;
  note.bit_size = 0;
  note.known = std::min(note.known, Known::kByCall);
  ask<Calls>().mark_enabled(expr, note);
  note.flex = Flex::kNone;
  const Note given = infer(argument);
  note.width = Width::kOwn;
  note.type = conversion.to == ir::Kind::kString    ? sema_.program.types.string(capacity)
              : conversion.to == ir::Kind::kWstring ? sema_.program.types.wstring(capacity)
                                                    : sema_.program.types.elementary(conversion.to);
  if (conversion.enumeration.valid()) note.type = conversion.enumeration;
  if (given.width == Width::kWraps) check_cut_argument(argument, conversion, note);
  bool rounds = source.real && !traits_of(sema_.program.types, note.type).real;
  note.can_trap = note.can_trap || rounds || conversion.bcd != Conversion::Bcd::kNone;
  return note;
}

// `made`: the result. TO_DINT(a * 3) comes too late.
void StandardCalls::check_cut_argument(ExprId argument, const Conversion& conversion, Note& made) {
  const ir::TypeTable& types = sema_.program.types;
  const Note& given = infer(argument);
  const bool own = conversion.any_source || types.root_kind(given.type) == conversion.from;
  if (!own || !types.is_scalar(made.type)) return;  // else it is passed to another type
  const Traits to = traits_of(types, made.type);
  if (is_wider(types, made.type, given.type) || to.duration) {
    check_wrapped(*this, argument, "widened");
  } else if ((to.integer || to.bits) && ir::scalar_size(types.scalar(made.type)) ==
                                            ir::scalar_size(types.scalar(given.type))) {
    made.width = Width::kCopies;
  }
}

// As CODESYS has it: the number, unless the type says {attribute 'to_string'}.
bool StandardCalls::prints_names(ir::TypeId enumeration) const {
  const std::string& name =
      sema_.program.types[without_range(sema_.program.types, enumeration)].name;
  for (const TypeDecl& decl : sema_.tree.types) {
    if (!decl.spec.valid() || !ir::same_name(sema_.facts.specs[decl.spec.index].name.text, name))
      continue;
    return sema_.tree.find_attribute(decl.attributes, "to_string") != nullptr;
  }
  return false;
}

bool StandardCalls::check_conversion(const Expr& expr, const Conversion& conversion, ir::Kind from,
                                     const Note& argument) {
  bool named = !conversion.any_source;
  std::string name(sema_.tree[expr.operand].name.text);
  if (named && !is_convertible(conversion.from, conversion.to)) {
    error(DiagnosticCode::kNoConversion, expr.span, "there is no conversion " + name);
    return false;
  }
  Traits traits = traits_of(sema_.program.types, argument.type);
  bool literal = argument.flex == Flex::kInteger;
  const char* wanted = nullptr;
  if (conversion.truncate && !traits.real) wanted = "REAL or LREAL";
  if (conversion.bcd == Conversion::Bcd::kFrom && !traits.bits && !literal) {
    wanted = "BYTE, WORD, DWORD or LWORD";
  }
  const bool whole = traits.integer || traits.bits || traits.enumeration;
  if (conversion.enumeration.valid() && !whole) wanted = "a whole number";
  if (conversion.bcd == Conversion::Bcd::kTo && !traits.integer) wanted = "an integer";
  // A literal text is a CHAR where one is wanted.
  bool character =
      ir::elementary_group(conversion.from) == ir::Group::kChar && argument.flex == Flex::kText;
  bool texts = is_text(from) || is_text(conversion.from);
  bool mismatch = named && texts && from != conversion.from && !character;
  if (wanted != nullptr || mismatch) {
    error(DiagnosticCode::kWrongArgument, expr.span,
          name + " takes " + (wanted != nullptr ? wanted : kind_text(conversion.from)) +
              ", the argument is `" + sema_.report.type_text(argument.type) + "`");
    return false;
  }
  if (character || literal || is_convertible(from, conversion.to)) return true;
  error(DiagnosticCode::kNoConversion, expr.span,
        "there is no conversion of `" + sema_.report.type_text(argument.type) + "` to `" +
            kind_text(conversion.to) + "`");
  return false;
}

}  // namespace frontend
