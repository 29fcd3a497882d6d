// First pass: every name that a declaration brings into the world, nothing resolved.
#include "frontend/sema/declarations/collection.h"
#include "frontend/parse/declared_twice.h"
#include "frontend/parse/global_lists.h"
#include "frontend/sema/configuration/configuration.h"
#include "frontend/sema/declarations/interfaces.h"
#include "frontend/sema/declarations/old_names.h"
#include "frontend/sema/declarations/rename_rules.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/tests/test_build.h"

namespace frontend {
namespace {

constexpr std::string_view kMadePrefix = "__";  // of programs that no source has

ir::PouKind ir_kind(PouKind kind) {
  switch (kind) {
    case PouKind::kFunction:
      return ir::PouKind::kFunction;
    case PouKind::kProgram:
      return ir::PouKind::kProgram;
    case PouKind::kMethod:
    case PouKind::kAction:
    case PouKind::kGetter:
    case PouKind::kSetter:
      return ir::PouKind::kMethod;
    default:
      return ir::PouKind::kFunctionBlock;
  }
}

ir::Kind instance_kind(PouKind kind) {
  switch (kind) {
    case PouKind::kProgram:
      return ir::Kind::kProgram;
    case PouKind::kInterface:
      return ir::Kind::kInterface;
    default:
      return ir::Kind::kFunctionBlock;
  }
}

}  // namespace

void Collection::collect() {
  ask<Configuration>().choose_resource();
  collect_pous();
  if (sema_.for_tests()) ask<TestBuild>().collect_tests();
  collect_types();
  const std::vector<const VarBlock*> heads = list_heads(sema_.tree, sema_.sources);
  for (size_t i = 0; i < heads.size(); ++i) {
    collect_globals(sema_.tree.globals[i], list_name(sema_.tree, sema_.sources, *heads[i]),
                    *heads[i]);
  }
  for (const ConfigDecl& config : sema_.tree.configs) {
    if (sema_.tree.in_namespace(config.scope)) {
      error(DiagnosticCode::kNotInNamespace, config.name.span,
            "a CONFIGURATION stands in a namespace", "put it outside");
    }
    collect_globals(config.globals, config.name.text);
    if (config.resources.size() > 1)
      sema_.declared.outer_globals = sema_.declared.global_order.size();
    for (const ResourceDecl& resource : config.resources) {
      if (&resource == sema_.declared.resource)
        collect_globals(resource.globals, resource.name.text);
    }
  }
  sema_.namespaces.check();
  ask<Objects>().inherit();
}

void Collection::collect_types() {
  for (const TypeDecl& decl : sema_.tree.types) {
    if (decl.name.empty() || !decl.spec.valid()) continue;
    if (sema_.library.holds(decl.name.span)) {
      collect_library_type(decl);
      continue;
    }
    const std::string_view name =
        sema_.namespaces.declare(NameSort::kDeclaration, decl.scope, decl.name, decl.access);
    const auto [type, added] = sema_.declared.types.emplace(name, decl.spec);
    const auto pou = sema_.declared.pou_names.find(name);
    if (!added || pou != sema_.declared.pou_names.end()) {
      const base::SourceSpan other = pou == sema_.declared.pou_names.end()
                                         ? sema_.facts.specs[type->second.index].name.span
                                         : sema_.declared.pous[pou->second].decl->name.span;
      declared_twice(name, decl.name.span, other);
      continue;
    }
    declare_type(decl, name);
    if (sema_.tree.find_attribute(decl.attributes, "qualified_only") != nullptr) continue;
    collect_enumerators(decl.spec, decl.scope, decl.access);
  }
}

void Collection::declare_type(const TypeDecl& decl, std::string_view name) {
  sema_.facts.specs[decl.spec.index].name = {name, decl.name.span};
  sema_.facts.specs[decl.spec.index].default_value = decl.init;
  forward_declare(decl, name);
}

void Collection::collect_library_type(const TypeDecl& decl) {
  sema_.library.types.emplace(decl.name.text, &decl);
  for (const Enumerator& enumerator : sema_.tree[decl.spec].enumerators) {
    sema_.library.literals.emplace(enumerator.name.text, &decl);
  }
}

// Library types enter the program when their name, or a literal that nobody else has, is first
// used.
bool Collection::use_library_type(std::string_view name) {
  auto found = sema_.library.types.find(name);
  if (found == sema_.library.types.end() || sema_.declared.types.contains(name)) return false;
  const TypeDecl& decl = *found->second;
  sema_.declared.types.emplace(decl.name.text, decl.spec);
  declare_type(decl, decl.name.text);
  return true;
}

bool Collection::use_library_literal(std::string_view name) {
  auto found = sema_.library.literals.find(name);
  if (found == sema_.library.literals.end()) return false;
  const TypeDecl& decl = *found->second;
  use_library_type(decl.name.text);
  if (sema_.declared.types.find(decl.name.text)->second != decl.spec) return false;
  const auto& enumerators = sema_.tree[decl.spec].enumerators;
  for (uint32_t i = 0; i < enumerators.size(); ++i) {
    if (ir::same_name(enumerators[i].name.text, name)) {
      sema_.declared.literals[enumerators[i].name.text].push_back({decl.spec, i});
    }
  }
  return true;
}

// References may lead to a structure whose content is not known yet.
void Collection::forward_declare(const TypeDecl& decl, std::string_view name) {
  const SpecKind kind = sema_.tree[decl.spec].kind;
  if (kind != SpecKind::kStruct && kind != SpecKind::kUnion) return;
  ir::Type type;
  type.kind = kind == SpecKind::kUnion ? ir::Kind::kUnion : ir::Kind::kStruct;
  type.name = name;
  sema_.facts.specs[decl.spec.index].forward = sema_.program.types.declare(std::move(type));
}

void Collection::collect_enumerators(SpecId spec, ScopeId scope, Access access) {
  if (!spec.valid()) return;
  const Spec& content = sema_.tree[spec];
  if (content.kind == SpecKind::kArray) collect_enumerators(content.element, scope, access);
  for (const VarDecl& member : content.fields) collect_enumerators(member.spec, scope, access);
  for (uint32_t i = 0; i < content.enumerators.size(); ++i) {
    const Name& name = content.enumerators[i].name;
    sema_.declared.literals[sema_.namespaces.declare(NameSort::kLiteral, scope, name, access)]
        .push_back({spec, i});
  }
}

void Collection::declared_twice(std::string_view name, base::SourceSpan here,
                                base::SourceSpan other) {
  error(DiagnosticCode::kDuplicateName, here,
        frontend::declared_twice(sema_.sources, name, here, other));
}

// `name`: by which the scope knows it, when that is not its own.
VarId Collection::add_variable(Variable variable, NameMap<VarId>& scope, std::string_view name) {
  VarId id(static_cast<uint32_t>(sema_.declared.variables.size()));
  if (name.empty()) name = variable.name.text;
  if (!scope.emplace(name, id).second) {
    const Variable& first = sema_.declared.variables[scope[name].index];
    if (first.decl != nullptr) {
      declared_twice(name, variable.name.span, first.name.span);
    } else {
      error(DiagnosticCode::kDuplicateName, variable.name.span,
            "`" + std::string(name) +
                "` is declared twice; the function's result has the function's name");
    }
    return {};
  }
  sema_.declared.variables.push_back(variable);
  return id;
}

void Collection::collect_pous() {
  for (const PouDecl& decl : sema_.tree.pous) {
    if (decl.name.empty()) continue;
    if (sema_.library.holds(decl.span)) {
      sema_.library.pous.emplace(decl.name.text, &decl);
      continue;
    }
    if (decl.kind == PouKind::kProgram && sema_.tree.in_namespace(decl.scope)) {
      error(DiagnosticCode::kNotInNamespace, decl.name.span, "a PROGRAM stands in a namespace",
            "put it outside, with USING for the names of the namespace");
      continue;
    }
    const std::string_view name =
        sema_.namespaces.declare(NameSort::kDeclaration, decl.scope, decl.name, decl.access);
    const auto same = sema_.declared.pou_names.find(name);
    if (same == sema_.declared.pou_names.end()) {
      add_pou(decl, false, name);
    } else if (decl.kind == PouKind::kFunction &&
               sema_.declared.pous[same->second].decl->kind == PouKind::kFunction) {
      uint32_t last = same->second;
      while (sema_.declared.pous[last].overload != kNoPou)
        last = sema_.declared.pous[last].overload;
      sema_.declared.pous[last].overload = static_cast<uint32_t>(sema_.declared.pous.size());
      add_pou(decl, false, name);
    } else {
      declared_twice(name, decl.name.span, sema_.declared.pous[same->second].decl->name.span);
    }
  }
}

uint32_t Collection::add_pou(const PouDecl& decl, bool of_library, std::string_view name) {
  uint32_t number = static_cast<uint32_t>(sema_.declared.pous.size());
  PouInfo& info = sema_.declared.pous.emplace_back();
  info.number = number;
  info.decl = &decl;
  info.name = name;
  info.library = of_library;
  info.open = is_open(decl);
  info.as_block =
      sema_.for_tests() && decl.kind == PouKind::kProgram && !name.starts_with(kMadePrefix);
  if (const std::string rule = renamed_from(sema_.tree, decl.attributes); !rule.empty()) {
    info.old_name = sema_.declared.keep_name(whole_old_names(name, rule));
  }
  sema_.declared.pou_names.emplace(name, number);
  if (!has_frame(decl.kind)) {
    ir::Type type;
    type.kind = instance_kind(decl.kind);
    type.name = name;
    type.old_name = ask<OldNames>().add(std::string(info.old_name));
    if (info.as_block) type.kind = ir::Kind::kFunctionBlock;
    info.self = sema_.program.types.declare(std::move(type));
    sema_.declared.pou_by_type.emplace(info.self, number);
  }
  if (!info.open && decl.kind != PouKind::kInterface) add_code(info, std::string(name));
  collect_interface(number);
  if (of_library) add_aliases(info);
  return number;
}

void Collection::add_code(PouInfo& info, std::string name) {
  info.id = ir::PouId(static_cast<uint32_t>(sema_.program.pous.size()));
  ir::Pou& pou = sema_.program.pous.emplace_back();
  pou.name = std::move(name);
  pou.kind = info.as_block ? ir::PouKind::kFunctionBlock : ir_kind(info.decl->kind);
  pou.self = info.self;
  pou.recursion_depth = ask<Objects>().recursion_depth(*info.decl);
}

void Collection::collect_interface(uint32_t number) {
  PouInfo& info = sema_.declared.pous[number];
  const PouDecl& decl = *info.decl;
  for (const VarBlock& block : decl.blocks) collect_variables(number, block);
  if (has_frame(decl.kind) && decl.result.valid()) {
    Variable result;
    result.name = decl.name;
    result.section = decl.kind == PouKind::kSetter ? VarSection::kInput : VarSection::kOutput;
    result.pou = number;
    result.used = true;
    VarId id = add_variable(result, info.names);
    if (id.valid()) info.variables.push_back(id);
    if (decl.kind != PouKind::kSetter) info.result = id;
  }
  ask<Objects>().collect(number);
  number_variables(info);
}

// For a program instance with code of its own: the variable of all instances that shares its place.
VarId Collection::shared_by_original(const PouInfo& info, const Variable& variable) const {
  if (info.meaning == nullptr || !variable.decl->has_address) return {};
  for (const PouInfo& original : sema_.declared.pous) {
    if (original.decl != info.decl || original.meaning != nullptr) continue;
    const auto found = original.names.find(variable.name.text);
    const bool shared = found != original.names.end() &&
                        sema_.declared.variables[found->second.index].storage == Storage::kGlobal;
    return shared ? VarId(found->second) : VarId();
  }
  return {};
}

void Collection::collect_variables(uint32_t pou, const VarBlock& block) {
  PouInfo& info = sema_.declared.pous[pou];
  if (block.section == VarSection::kAccess) return;
  if (block.section == VarSection::kStatic) allow_extension("VAR_STAT", block.span);
  if (block.retain && block.section == VarSection::kInOut) {
    allow_extension("RETAIN on VAR_IN_OUT", block.span, "the caller's variable is RETAIN or not");
  }
  if (block.retain && block.section == VarSection::kTemp) {
    allow_extension("RETAIN on VAR_TEMP", block.span, "declare it in VAR RETAIN");
  }
  for (const VarDecl& decl : block.vars) {
    if (info.meaning == nullptr) collect_enumerators(decl.spec, info.decl->scope);
    for (const Name& name : decl.names) {
      Variable variable;
      variable.name = name;
      variable.decl = &decl;
      variable.section = block.section;
      variable.constant = block.constant;
      variable.retain = block.retain;
      variable.non_retain = block.non_retain;
      variable.access = block.access;
      variable.pou = pou;
      variable.takes_any = takes_any(decl, block.section, *info.decl);
      if (block.section == VarSection::kStatic) {
        add_static(variable, info);
        continue;
      }
      if (block.section == VarSection::kInstance) {
        add_instance_variable(variable, info);
        continue;
      }
      if (is_call_instance(variable, info)) {
        add_call_instance(variable, info);
        continue;
      }
      if (const VarId shared = shared_by_original(info, variable); shared.valid()) {
        info.names.emplace(name.text, shared);
        continue;
      }
      VarId id = add_variable(variable, info.names);
      if (!id.valid()) continue;
      info.variables.push_back(id);
      bool keeps = !has_frame(info.decl->kind) && block.section == VarSection::kInput;
      if (decl.edge != Edge::kNone && keeps) add_edge(id, info);
    }
  }
}

// Members of an instance, or locals of a frame: parameters first, then the result.
// Actions see the VAR_TEMP of the body that calls them, so these are members then, which the
// body makes anew.
void Collection::number_variables(PouInfo& info) {
  bool function = has_frame(info.decl->kind);
  const std::vector<PouDecl>& members = info.decl->members;
  info.shares_temporaries =
      !function && std::any_of(members.begin(), members.end(), [](const PouDecl& member) {
        return member.kind == PouKind::kAction;
      });
  info.locals.clear();
  info.members.clear();
  auto place = [&](VarId id, Storage storage, std::vector<VarId>& order) {
    sema_.declared.variables[id.index].storage = storage;
    sema_.declared.variables[id.index].index = static_cast<uint32_t>(order.size());
    order.push_back(id);
  };
  if (function) {
    for (VarId id : info.variables) {
      if (id != info.result && is_parameter(sema_.declared.variables[id.index].section)) {
        place(id, Storage::kLocal, info.locals);
      }
    }
    if (info.result.valid()) place(info.result, Storage::kLocal, info.locals);
  }
  for (VarId id : info.variables) {
    VarSection section = sema_.declared.variables[id.index].section;
    if (section == VarSection::kExternal || id == info.result) continue;
    if (sema_.declared.variables[id.index].storage == Storage::kGlobal)
      continue;  // it shares bytes
    if (function && is_parameter(section)) continue;
    const bool stays = sema_.declared.variables[id.index].each_call;
    bool local = function || (section == VarSection::kTemp && !info.shares_temporaries && !stays);
    place(id, local ? Storage::kLocal : Storage::kMember, local ? info.locals : info.members);
  }
}

// CTU_DINT has the aliases of CTU.
void Collection::add_aliases(PouInfo& info) {
  std::string_view name = info.decl->name.text;
  for (const stdlib::AliasRow& row : stdlib::alias_rows()) {
    bool variant = name.size() > row.block.size() && name[row.block.size()] == '_';
    if (name.substr(0, row.block.size()) != row.block ||
        (!variant && name.size() != row.block.size())) {
      continue;
    }
    auto parameter = info.names.find(row.parameter);
    if (parameter != info.names.end()) info.names.emplace(row.name, VarId(parameter->second));
  }
}

// Library POUs enter the program when their name is first used.
bool Collection::use_library(std::string_view name) {
  auto found = sema_.library.pous.find(name);
  if (found == sema_.library.pous.end() || sema_.declared.pou_names.contains(name)) return false;
  uint32_t number = add_pou(*found->second, true, found->first);
  if (sema_.declared.complete)
    ask<Interfaces>().resolve_interface(number);  // a function first met in a body
  return true;
}

}  // namespace frontend
