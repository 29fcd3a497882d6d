#include "frontend/sema/old_names.h"

#include "frontend/sema/rename_rules.h"
#include "frontend/sema/sema.h"

namespace frontend {

ir::OldNameId OldNames::add(std::string name) {
  return name.empty() ? ir::OldNameId() : sema_.program.types.add_old_name(std::move(name));
}

ir::OldNameId OldNames::of_rule(Range32 attributes) {
  return add(std::string(renamed_from(sema_.tree, attributes)));
}

ir::OldNameId OldNames::of(const Variable& variable) { return add(old_member(variable)); }

void OldNames::rename_types() {
  for (const TypeDecl& decl : sema_.tree.types) {
    const std::string_view rule = renamed_from(sema_.tree, decl.attributes);
    if (rule.empty() || !decl.spec.valid() || sema_.in_library(decl.name.span)) continue;
    const SpecInfo& info = sema_.spec_info(decl.spec);
    if (!info.use.type.valid()) continue;
    ir::Type& type = sema_.program.types.edit(info.use.type);
    const bool own = ir::same_name(type.name, info.name.text) &&
                     (ir::is_structure(type.kind) || type.kind == ir::Kind::kEnum);
    if (own) {
      type.old_name = add(whole_old_name(info.name.text, rule));
      continue;
    }
    sema_.error(DiagnosticCode::kBadRename, decl.name.span,
                "`" + std::string(decl.name.text) +
                    "` is another name for a type; its variables keep their values by themselves",
                "take the rule away");
  }
}

// Of the list in front of the names of VAR_STAT variables; "" when it has not changed.
std::string OldNames::old_list(const PouInfo& info) const {
  if (info.owner == kNoPou) return std::string(info.old_name);
  const PouInfo& block = sema_.pous[info.owner];
  if (block.old_name.empty() && info.old_name.empty()) return {};
  const std::string_view method = info.old_name.empty() ? info.name : info.old_name;
  const std::string_view owner = block.old_name.empty() ? block.name : block.old_name;
  return std::string(owner) + "#" + std::string(method);
}

// "" where no rule says anything.
std::string OldNames::old_member(const Variable& variable) const {
  if (variable.decl == nullptr) {  // the program itself, among the globals
    const PouInfo* called = variable.type.valid() ? sema_.pou_of(variable.type) : nullptr;
    const bool whole = called != nullptr && called->decl->kind == PouKind::kProgram;
    return whole ? std::string(called->old_name) : std::string();
  }
  const std::string_view own = renamed_from(sema_.tree, variable.decl->attributes);
  if (own.find('.') != std::string_view::npos) return std::string(own);
  std::string front;
  bool renamed = !own.empty();
  if (!variable.list.empty()) front = std::string(variable.list) + ".";
  if (!variable.method.empty()) front = std::string(variable.method) + "#";
  if (variable.pou != kNoPou && !front.empty()) {
    const PouInfo& info = sema_.pous[variable.pou];
    const std::string before =
        variable.method.empty() ? old_list(info) : std::string(info.old_name);
    if (!before.empty()) front = before + front.back();
    renamed = renamed || !before.empty();
  }
  if (!renamed) return {};
  // `x#last`, `x#action` are made for x.
  const std::string_view name = variable.name.text;
  if (own.empty()) return front + std::string(name);
  return front + std::string(own) + std::string(name.substr(std::min(name.find('#'), name.size())));
}

}  // namespace frontend
