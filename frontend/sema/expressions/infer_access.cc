// Members and elements.
#include <algorithm>

#include "frontend/sema/constants/constants.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/expressions/expressions.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"

namespace frontend {

// Here such an input is the value itself, and a pointer to it would lead to a copy.
bool Expressions::refuse_any_part(const Expr& expr, const Note& operand) {
  if (!operand.variable.valid() || !Collection::is_any_part(expr.name.text)) return false;
  const Variable& variable = resolve(operand.variable);
  if (variable.decl == nullptr || variable.section != VarSection::kInput) return false;
  const Spec& spec = sema_.tree[variable.decl->spec];
  if (spec.kind != SpecKind::kNamed || !ask<Collection>().is_generic_name(spec.name.text) ||
      sema_.declared.find_field(operand.type, expr.name.text) != nullptr) {
    return false;
  }
  error(DiagnosticCode::kNoMembers, expr.span,
        quoted(variable.name) + " is the value that is given, of type `" +
            sema_.report.type_text(operand.type) + "`; it has no " + quoted(expr.name),
        "use the value itself and SIZEOF(" + std::string(variable.name.text) +
            "), or pass ADR(..) and SIZEOF(..) as inputs of their own");
  return true;
}

Note Expressions::infer_member(const Expr& expr) {
  const Expr& head = sema_.tree[expr.operand];
  if (std::string_view type = enumeration_named(head); !type.empty()) {  // E.a, A.E.a
    return infer_literal_of(type, head.span, expr.name);
  }
  if (auto global = infer_list_member(expr)) return *global;
  if (ask<Objects>().is_own(head)) {
    const uint32_t owner = ask<Objects>().receiver(expr.operand);
    return owner == kNoPou ? Note() : ask<Objects>().infer_member(expr, owner, {});
  }
  const Note& operand = infer(expr.operand);
  if (!operand.type.valid()) return {};
  if (auto bit = infer_named_bit(expr, operand)) return *bit;
  if (refuse_any_part(expr, operand)) return {};
  Note note = operand;
  note.property = kNoPou;
  note.variable = {};
  note.constant = false;
  note.bit_size = 0;
  note.bit_member = -1;
  note.flex = Flex::kNone;
  const ir::Type& type = sema_.program.types[operand.type];
  if (ir::is_structure(type.kind)) {
    if (const StructureField* field = sema_.declared.find_field(operand.type, expr.name.text)) {
      if (field->bit >= 0) {
        note = part_note(note, static_cast<uint32_t>(field->bit), 1);
        note.bit_member = static_cast<int32_t>(field->member);
        note.known = Known::kNo;
        return note;
      }
      note.type = type.members[field->member].type;
      return note;
    }
    NearestName nearest(expr.name.text);
    for (const ir::Member& other : type.members) nearest.offer(other.name);
    error(DiagnosticCode::kUnknownMember, expr.name.span,
          "`" + sema_.report.type_text(operand.type) + "` has no member " + quoted(expr.name),
          nearest.fix());
    return {};
  }
  const uint32_t owner = ask<Objects>().receiver(expr.operand);
  if (owner != kNoPou) return ask<Objects>().infer_member(expr, owner, note);
  const bool block = sema_.program.types.is_reference(operand.type) &&
                     sema_.declared.pou_of(sema_.program.types[operand.type].base) != nullptr;
  error(DiagnosticCode::kNoMembers, expr.span,
        "`" + sema_.report.type_text(operand.type) + "` has no members",
        block                            ? "write `^.` to reach what it refers to"
        : sema_.namespaces.is_path(head) ? "the variable hides the namespace of that name"
                                         : "");
  return {};
}

// The type that stands before `.a`; "": none does. `colour : Colour` is common: the type is meant
// where the variable has no members.
std::string_view Expressions::enumeration_named(const Expr& head) {
  auto enumeration = [this](ir::TypeId type) {
    return type.valid() && is_enum(sema_.program.types, type);
  };
  const VarId variable =
      head.kind == ExprKind::kName ? ask<Variables>().find_variable(head.name) : VarId();
  if (variable.valid() && !enumeration(resolve(variable).type)) return {};
  const std::string_view name = sema_.namespaces.find(NameSort::kDeclaration, scope_, head);
  if (name.empty() || !sema_.declared.types.contains(name)) return {};
  if (!variable.valid()) return name;
  auto use = ask<Types>().find_type(name);
  return use && enumeration(use->type) ? name : std::string_view();
}

// `x.NUMBER`: the bit that a constant names.
std::optional<Note> Expressions::infer_named_bit(const Expr& expr, const Note& operand) {
  Traits traits = traits_of(sema_.program.types, operand.type);
  if (!traits.bits && !traits.integer) return std::nullopt;
  VarId id = ask<Variables>().find_variable(expr.name);
  if (!id.valid()) return std::nullopt;
  const Variable& constant = resolve(id);
  sema_.mark_used(id);
  allow_extension("a constant as the number of a bit", expr.span);
  if (!has_known_value(constant) || !traits_of(sema_.program.types, constant.type).integer)
    return std::nullopt;
  ir::ConstId init = constant.init;
  uint64_t number = init.valid() ? sema_.program.constants[init].bits : 0;
  uint32_t bit = static_cast<uint32_t>(std::min<uint64_t>(number, 0xffff'ffffu));
  if (!check_part(operand.type, bit, 1, expr.span)) return Note();
  return part_note(operand, bit, 1);
}

Note Expressions::infer_index(const Expr& expr) {
  if (const Note& operand = infer(expr.operand);
      operand.type.valid() && sema_.program.types[operand.type].kind == ir::Kind::kPointer) {
    return infer_pointer_index(expr, operand);
  }
  Note note = infer(expr.operand);
  note.variable = {};
  note.constant = false;
  note.bit_size = 0;
  note.flex = Flex::kNone;
  for (uint32_t i = 0; i < expr.list.count; ++i) {
    const Note& index = infer(sema_.tree.expr_lists[expr.list.first + i]);
    note.known = std::min(note.known, index.known);
    note.calls = note.calls || index.calls;
    note.can_trap = note.can_trap || index.can_trap || !index.constant;
  }
  if (!note.type.valid()) return {};
  if (is_string(sema_.program.types, note.type)) return infer_character(expr, note);
  const OpenArray* open = sema_.declared.open_array(note.type);
  ir::Type as_array;
  const ir::Type& array = open == nullptr ? sema_.program.types[note.type] : as_array;
  if (open != nullptr) {
    as_array.kind = ir::Kind::kArray;
    as_array.base = open->element;
    as_array.dims.assign(open->dims, {INT64_MIN, INT64_MAX});
    note.known = Known::kNo;
    note.can_trap = true;
  }
  if (array.kind != ir::Kind::kArray) {
    error(DiagnosticCode::kNotArray, expr.span,
          "`" + sema_.report.type_text(note.type) + "` is not an array");
    return {};
  }
  if (array.dims.size() != expr.list.count) {
    error(DiagnosticCode::kWrongIndexCount, expr.span,
          std::to_string(expr.list.count) + " indices for `" + sema_.report.type_text(note.type) +
              "`",
          "give " + std::to_string(array.dims.size()));
    return {};
  }
  ir::TypeId element = array.base;
  check_index_list(expr, array);
  note.type = element;
  return note;
}

// Characters count from 0 and are BYTE or WORD, as in CODESYS; with `iec`, from 1 and CHAR
// or WCHAR (edition 3, 6.4.2.1). Position n of STRING[n] holds the NUL: `s[n] := 0` is common.
Note Expressions::infer_character(const Expr& expr, Note note) {
  if (expr.list.count != 1) {
    error(DiagnosticCode::kWrongIndexCount, expr.span,
          std::to_string(expr.list.count) + " indices for `" + sema_.report.type_text(note.type) +
              "`",
          "give 1");
    return {};
  }
  ir::Type characters;
  bool iec = sema_.options.dialect == Dialect::kIec;
  characters.dims.push_back({iec ? 1 : 0, sema_.program.types[note.type].capacity});
  check_index_list(expr, characters);
  bool wide = sema_.program.types[note.type].kind == ir::Kind::kWstring;
  ir::Kind kind = iec    ? wide ? ir::Kind::kWchar : ir::Kind::kChar
                  : wide ? ir::Kind::kWord
                         : ir::Kind::kByte;
  note.type = sema_.program.types.elementary(kind);
  note.known = Known::kNo;
  return note;
}

void Expressions::check_index_list(const Expr& expr, const ir::Type& array) {
  std::vector<ir::Dimension> dims = array.dims;
  for (uint32_t i = 0; i < expr.list.count; ++i) {
    ExprId index = sema_.tree.expr_lists[expr.list.first + i];
    const Note& note = infer(index);
    if (!note.type.valid()) continue;
    Traits traits = traits_of(sema_.program.types, note.type);
    bool enumeration = is_enum(sema_.program.types, note.type);
    if (!traits.integer && !traits.bits && !enumeration) {
      error(DiagnosticCode::kIndexNotInteger, sema_.tree[index].span,
            "the index is `" + sema_.report.type_text(note.type) + "`");
      continue;
    }
    if (!note.constant) continue;
    auto value = ask<Constants>().fold_integer(index);
    if (!value || (*value >= dims[i].low && *value <= dims[i].high)) continue;
    error(DiagnosticCode::kIndexOutOfBounds, sema_.tree[index].span,
          "index " + std::to_string(*value) + " is outside " + std::to_string(dims[i].low) + ".." +
              std::to_string(dims[i].high));
  }
}

}  // namespace frontend
