#include "tools/stc/declared_places.h"

#include "base/name_case.h"
#include "frontend/compile.h"
#include "frontend/parse/global_lists.h"
#include "tools/stc/unit_slices.h"

namespace stc {
namespace {

std::string scope_prefix(const frontend::Tree& tree, frontend::ScopeId scope) {
  std::string out;
  for (; scope.valid(); scope = tree[scope].parent) {
    if (!tree[scope].name.empty()) out = std::string(tree[scope].name.text) + "." + out;
  }
  return out;
}

}  // namespace

DeclaredPlaces::DeclaredPlaces(const Project& project) {
  frontend::Tree tree;
  base::Diagnostics ignored;  // who built it has reported them
  frontend::parse_all(project.sources, project.compile, tree, ignored);
  for (const frontend::PouDecl& pou : tree.pous) add_pou(pou, scope_prefix(tree, pou.scope));
  const std::vector<const frontend::VarBlock*> heads = frontend::list_heads(tree, project.sources);
  for (size_t i = 0; i < heads.size(); ++i) add_block(project, tree, tree.globals[i], *heads[i]);
  for (const frontend::ConfigDecl& config : tree.configs) add_config(project, tree, config);
}

base::SourceSpan DeclaredPlaces::find(const Places& places, const std::string& name) {
  const auto found = places.find(base::fold_name(name));
  return found == places.end() ? base::SourceSpan() : found->second;
}

void DeclaredPlaces::add_pou(const frontend::PouDecl& pou, const std::string& prefix) {
  const std::string name = prefix + std::string(pou.name.text);
  units_.emplace(base::fold_name(name), pou.name.span);
  for (const frontend::PouDecl& member : pou.members) add_pou(member, name + ".");
  if (pou.kind != frontend::PouKind::kProgram) return;
  for (const frontend::VarBlock& block : pou.blocks) {
    for (const frontend::VarDecl& variable : block.vars) {
      for (const frontend::Name& part : variable.names) {
        variables_.emplace(base::fold_name(name + "." + std::string(part.text)), part.span);
      }
    }
  }
}

// A global goes by its own name, or by that of its namespace or list in front of it.
void DeclaredPlaces::add_block(const Project& project, const frontend::Tree& tree,
                               const frontend::VarBlock& block, const frontend::VarBlock& head) {
  const std::string prefixes[] = {
      scope_prefix(tree, block.scope),
      std::string(frontend::list_name(tree, project.sources, head)) + "."};
  for (const frontend::VarDecl& variable : block.vars) {
    for (const frontend::Name& name : variable.names) {
      for (const std::string& prefix : prefixes) {
        variables_.emplace(base::fold_name(prefix + std::string(name.text)), name.span);
      }
    }
    if (!variable.path.valid()) continue;
    // Sources can name the resource in front of the program, images do not.
    const base::SourceSpan span = tree[variable.path].span;
    std::string path = base::fold_name(Slices(project.sources).plain(span));
    variables_.emplace(path, span);
    path.erase(0, path.find('.') + 1);
    variables_.emplace(path, span);
  }
}

void DeclaredPlaces::add_config(const Project& project, const frontend::Tree& tree,
                                const frontend::ConfigDecl& config) {
  for (const frontend::VarBlock& block : config.globals) add_block(project, tree, block, block);
  for (const frontend::ResourceDecl& resource : config.resources) {
    for (const frontend::VarBlock& block : resource.globals) add_block(project, tree, block, block);
  }
}

}  // namespace stc
