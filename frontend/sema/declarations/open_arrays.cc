// ARRAY[*] in VAR_IN_OUT of methods and function blocks. Their code is one for all callers, so the
// parameter is a record of what it stands for: a pointer to the first element, and the bounds. (A
// function has code for each type that it is called with: calls/open_functions.h.) A function that
// is called with such a parameter has it as the caller does.
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"
#include "ir/types/parts.h"

namespace frontend {

bool Variables::is_open_array(const Variable& variable) const {
  if (variable.section != VarSection::kInOut || variable.pou == kNoPou) return false;
  const PouKind kind = sema_.declared.pous[variable.pou].decl->kind;
  const Spec& spec = sema_.tree[variable.decl->spec];
  return (kind == PouKind::kFunctionBlock || kind == PouKind::kMethod) &&
         spec.kind == SpecKind::kArray && spec.open_bounds;
}

// The type has the name by which people know it, and no member that a source could name.
ir::TypeId Variables::open_array_type(const Spec& spec) {
  const ir::TypeId element = ask<Types>().resolve_type(spec.element).type;
  if (!element.valid()) return {};
  ir::TypeTable& types = sema_.program.types;
  if (ir::holds_instance(types, element) || types.is_reference(element)) {
    error(DiagnosticCode::kSectionNotAllowed, spec.span,
          "an array of `" + sema_.report.type_text(element) + "` with open bounds `[*]`",
          "write the bounds");
    return {};
  }
  const OpenArray open{element, static_cast<uint32_t>(spec.dims.size())};
  for (const auto& [type, known] : sema_.declared.open_arrays) {
    if (known == open) return type;
  }
  std::string name = "ARRAY[*";
  for (uint32_t i = 1; i < open.dims; ++i) name += ", *";
  ir::Type made;
  made.kind = ir::Kind::kStruct;
  made.name = name + "] OF " + types.text(element);
  const auto add = [&](const std::string& member, ir::TypeId type) {
    ir::Member& added = made.members.emplace_back();
    added.name = member;
    added.type = type;
  };
  add("#data", types.pointer(element));
  for (uint32_t i = 1; i <= open.dims; ++i) {
    add("#low" + std::to_string(i), types.elementary(ir::Kind::kLint));
    add("#high" + std::to_string(i), types.elementary(ir::Kind::kLint));
  }
  const ir::TypeId type = types.declare(std::move(made));
  sema_.declared.open_arrays.emplace(type, open);
  return type;
}

}  // namespace frontend
