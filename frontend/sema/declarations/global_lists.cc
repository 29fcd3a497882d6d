// Global variables and the lists that they stand in: `List.x`, `.x`.
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/expressions/expressions.h"
#include "frontend/sema/sema.h"

namespace frontend {

void Collection::collect_globals(const std::vector<VarBlock>& blocks, std::string_view list) {
  for (const VarBlock& block : blocks) collect_globals(block, list, block);
}

// In a namespace, the namespace is the list that variables belong to.
void Collection::collect_globals(const VarBlock& block, std::string_view list,
                                 const VarBlock& head) {
  if (block.section != VarSection::kGlobal) return;
  const bool closed = sema_.tree.in_namespace(block.scope);
  const bool qualified = sema_.tree.find_attribute(head.attributes, "qualified_only") != nullptr;
  if (closed) allow_extension("VAR_GLOBAL in a namespace", block.span);
  const std::string_view list_name =
      sema_.namespaces.declare(NameSort::kList, block.scope, {list, block.span}, block.access);
  GlobalList& names = sema_.declared.lists[list_name];
  for (const VarDecl& decl : block.vars) {
    collect_enumerators(decl.spec, block.scope);
    for (const Name& name : decl.names) {
      Variable variable;
      variable.name = name;
      variable.decl = &decl;
      variable.section = VarSection::kGlobal;
      variable.constant = block.constant;
      variable.retain = block.retain;
      variable.storage = Storage::kGlobal;
      variable.index = static_cast<uint32_t>(sema_.declared.global_order.size());
      std::string_view whole;
      if (qualified) {
        variable.list = list_name;
        whole = sema_.declared.keep_name(std::string(list_name) + "." + std::string(name.text));
      } else {
        whole = sema_.namespaces.declare(NameSort::kVariable, block.scope, name, block.access);
        if (closed) variable.list = whole.substr(0, whole.rfind('.'));
      }
      VarId id = add_variable(variable, sema_.declared.globals, whole);
      if (!id.valid()) continue;
      names.names.emplace(name.text, id);
      sema_.declared.global_order.push_back(id);
    }
  }
}

// List.x or A.x; nullopt when neither a list nor a namespace stands before the dot.
std::optional<Note> Expressions::infer_list_member(const Expr& expr) {
  const Expr& head = sema_.tree[expr.operand];
  const VarId variable = sema_.namespaces.find_global(scope_, expr);
  if (variable.valid()) return variable_note(variable);
  if (sema_.namespaces.is_namespace(scope_, head)) return infer_enum_name(expr);
  const GlobalList* list = sema_.namespaces.list(scope_, head);
  if (list == nullptr) return std::nullopt;
  const std::string_view other = sema_.namespaces.find(NameSort::kDeclaration, scope_, head);
  if (sema_.declared.types.contains(other) || sema_.declared.pou_names.contains(other))
    return std::nullopt;
  NearestName nearest(expr.name.text);
  nearest.offer_all(list->names);
  error(DiagnosticCode::kUnknownName, expr.name.span,
        "the global variables `" + std::string(head.name.text) + "` have no `" +
            std::string(expr.name.text) + "`",
        nearest.fix());
  return Note();
}

}  // namespace frontend
