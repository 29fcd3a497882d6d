// Variables that declarations imply: those of VAR_STAT among the globals, those of VAR_INST in
// the instance, and what edge inputs remember.
#include <span>

#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/interfaces.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/sema.h"

namespace frontend {

// One for all instances and calls: a global that is named `Pou.variable`.
// Also for all that is made of one declaration: open functions, programs with connections; unless
// the type is open too.
VarId Collection::add_static(Variable variable, PouInfo& info) {
  const Spec& spec = sema_.tree[variable.decl->spec];
  const bool generic = spec.kind == SpecKind::kNamed && is_generic_name(spec.name.text);
  if (info.open && generic) return add_variable(variable, info.names);
  if (info.meaning != nullptr && !generic) {
    for (const PouInfo& original : sema_.declared.pous) {
      if (original.decl != info.decl || original.meaning != nullptr) continue;
      const VarId shared = original.names.at(variable.name.text);
      info.names.emplace(variable.name.text, shared);
      return shared;
    }
  }
  return add_own_static(variable, info);
}

VarId Collection::add_own_static(Variable variable, PouInfo& info) {
  variable.storage = Storage::kGlobal;
  if (info.static_list.empty()) info.static_list = sema_.declared.keep_name(static_list_name(info));
  variable.list = info.static_list;
  VarId id = add_variable(variable, info.names);
  if (id.valid()) ask<Variables>().place_global(id);
  return id;
}

// "#REAL#INT": what tells a function from others of its name, as it is written.
static std::string parameters_text(const Sema& sema, const PouDecl& decl) {
  std::string out;
  for (const VarBlock& block : decl.blocks) {
    if (!is_parameter(block.section)) continue;
    for (const VarDecl& parameter : block.vars) {
      const base::SourceSpan span = sema.tree[parameter.spec].span;
      const uint32_t file = sema.sources.file_of(span.begin);
      std::string type(
          sema.sources.text(file).substr(span.begin.offset - sema.sources.begin(file).offset,
                                         span.end.offset - span.begin.offset));
      std::erase_if(type, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; });
      for (size_t i = 0; i < parameter.names.size(); ++i) out += "#" + type;
    }
  }
  return out;
}

// Without the characters that paths are made of: instances of open functions have them.
std::string Collection::static_list_name(const PouInfo& info) const {
  if (info.self.valid()) {  // of a method: `Block#method`
    const std::string& block = sema_.program.types[info.self].name;
    if (info.owner == kNoPou) return block;
    const bool setter = info.decl->kind == PouKind::kSetter;
    return block + "#" + std::string(info.decl->name.text) + (setter ? "#Set" : "");
  }
  std::string name = info.open ? std::string(info.name) : sema_.program.pous[info.id.index].name;
  const auto first = sema_.declared.pou_names.find(info.name);
  if (first != sema_.declared.pou_names.end() && first->second != info.number)
    name += parameters_text(sema_, *info.decl);
  for (char& c : std::span(name).subspan(info.name.size())) {
    if (c == '.' || c == '[' || c == ']') c = '_';
  }
  return name;
}

// A variable of a method that is kept in the instance: a member that is named `Method#variable`.
VarId Collection::add_instance_variable(Variable variable, PouInfo& method) {
  if (method.owner == kNoPou ||
      sema_.declared.pous[method.owner].decl->kind == PouKind::kInterface) {
    error(DiagnosticCode::kSectionNotAllowed, variable.name.span,
          "VAR_INST stands in methods of function blocks, classes and programs");
    return {};
  }
  VarId id = add_variable(variable, method.names);
  if (!id.valid()) return {};
  sema_.declared.variables[id.index].method = method.decl->name.text;
  sema_.declared.pous[method.owner].variables.push_back(id);
  return id;
}

// After the globals that are there.
void Variables::place_global(VarId id) {
  if (!sema_.declared.globals_placed) {
    sema_.declared.variables[id.index].index =
        static_cast<uint32_t>(sema_.declared.global_order.size());
    sema_.declared.global_order.push_back(id);
    return;
  }
  // The globals are members already: bare addresses may stand after them.
  sema_.declared.variables[id.index].index =
      static_cast<uint32_t>(sema_.program.types[sema_.program.globals].members.size());
  const Variable& resolved = resolve(id);
  ir::Member member = ask<Interfaces>().member_of(resolved, ir::Section::kGlobal);
  sema_.program.types.edit(sema_.program.globals).members.push_back(std::move(member));
}

// `x#last` remembers, `x#edge` is what the body sees; no source can write these names.
void Collection::add_edge(VarId input, PouInfo& info) {
  const Variable original = sema_.declared.variables[input.index];
  auto add = [&](const char* suffix, VarSection section) {
    Variable hidden;
    hidden.name = original.name;
    hidden.name.text = sema_.declared.keep_name(std::string(original.name.text) + suffix);
    hidden.decl = original.decl;
    hidden.section = section;
    hidden.pou = original.pou;
    hidden.used = true;
    hidden.hidden = true;
    VarId id = add_variable(hidden, info.names);
    if (id.valid()) info.variables.push_back(id);
    return id;
  };
  VarId last = add("#last", VarSection::kLocal);
  VarId edge = add("#edge", VarSection::kTemp);
  sema_.declared.variables[input.index].last = last;
  sema_.declared.variables[input.index].edge = edge;
}

void Variables::check_edge(const Variable& variable) {
  if (variable.decl->edge == Edge::kNone || variable.hidden) return;
  bool kept = variable.storage == Storage::kMember && variable.section == VarSection::kInput;
  if (kept && traits_of(sema_.program.types, variable.type).boolean) return;
  error(
      DiagnosticCode::kBadEdge, variable.name.span,
      "`" + std::string(variable.name.text) + "` is no BOOL input of a function block or program");
}

}  // namespace frontend
