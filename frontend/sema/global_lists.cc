// Global variables and the lists that they stand in: `List.x`, `.x`.
#include "frontend/sema/sema.h"

namespace frontend {

// A list's name: what {attribute 'list' := 'Name'} says, else the file's name without folder
// and extension.
std::string_view Sema::list_of(const VarBlock& block) const {
  const Attribute* named = tree.find_attribute(block.attributes, "list");
  if (named != nullptr && !named->value.empty()) return named->value;
  std::string_view file = sources.file_name(sources.file_of(block.span.begin));
  file.remove_prefix(file.find_last_of("/\\") + 1);
  return file.substr(0, file.find('.'));
}

void Sema::collect_globals(const std::vector<VarBlock>& blocks, std::string_view list) {
  for (const VarBlock& block : blocks) collect_globals(block, list);
}

void Sema::collect_globals(const VarBlock& block, std::string_view list) {
  if (block.section != VarSection::kGlobal) return;
  bool qualified = tree.find_attribute(block.attributes, "qualified_only") != nullptr;
  for (const VarDecl& decl : block.vars) {
    collect_enumerators(decl.spec);
    for (const Name& name : decl.names) {
      Variable variable;
      variable.name = name;
      variable.decl = &decl;
      variable.section = VarSection::kGlobal;
      variable.constant = block.constant;
      variable.retain = block.retain;
      variable.storage = Storage::kGlobal;
      variable.index = static_cast<uint32_t>(global_order_.size());
      if (qualified) variable.list = list;
      VarId id = add_global(variable, lists_[list]);
      if (id.valid()) global_order_.push_back(id);
    }
  }
}

VarId Sema::add_global(Variable variable, GlobalList& list) {
  if (!variable.list.empty()) return add_variable(variable, list.names);
  VarId id = add_variable(variable, globals_);
  if (id.valid()) list.names.emplace(variable.name.text, id);
  return id;
}

// Is it the name of a list, and of nothing nearer?
bool Sema::names_list(const Expr& head) {
  return head.kind == ExprKind::kName && !head.global && lists_.contains(head.name.text) &&
         !find_variable(head.name.text).valid();
}

// List.x; nullopt when `x` stands in no list of that name.
std::optional<Note> Sema::infer_list_member(const Expr& expr) {
  const Expr& head = tree[expr.operand];
  if (!names_list(head)) return std::nullopt;
  auto list = lists_.find(head.name.text);
  auto found = list->second.names.find(expr.name.text);
  if (found != list->second.names.end()) return variable_note(found->second);
  if (types_.contains(head.name.text) || pou_names_.contains(head.name.text)) return std::nullopt;
  NearestName nearest(expr.name.text);
  nearest.offer_all(list->second.names);
  error(DiagnosticCode::kUnknownName, expr.name.span,
        "the global variables `" + std::string(head.name.text) + "` have no `" +
            std::string(expr.name.text) + "`",
        nearest.fix());
  return Note();
}

}  // namespace frontend
