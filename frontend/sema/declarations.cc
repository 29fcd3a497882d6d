// First pass: every name that a declaration brings into the world, nothing resolved.
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

ir::PouKind ir_kind(PouKind kind) {
  switch (kind) {
    case PouKind::kFunction:
      return ir::PouKind::kFunction;
    case PouKind::kFunctionBlock:
      return ir::PouKind::kFunctionBlock;
    case PouKind::kProgram:
      return ir::PouKind::kProgram;
  }
  return ir::PouKind::kFunction;
}

bool is_parameter(VarSection section) {
  return section == VarSection::kInput || section == VarSection::kOutput ||
         section == VarSection::kInOut;
}

}  // namespace

void Sema::collect() {
  collect_pous();
  collect_types();
  collect_globals(tree.globals);
  for (const ConfigDecl& config : tree.configs) {
    collect_globals(config.globals);
    for (const ResourceDecl& resource : config.resources) collect_globals(resource.globals);
  }
}

void Sema::collect_types() {
  for (const TypeDecl& decl : tree.types) {
    if (decl.name.empty() || !decl.spec.valid()) continue;
    if (!types_.emplace(decl.name.text, decl.spec).second || pou_names_.contains(decl.name.text)) {
      error(DiagnosticCode::kDuplicateName, decl.name.span,
            "`" + std::string(decl.name.text) + "` is declared twice");
      continue;
    }
    specs_[decl.spec.index].name = decl.name;
    specs_[decl.spec.index].default_value = decl.init;
    collect_enumerators(decl.spec);
  }
}

void Sema::collect_enumerators(SpecId spec) {
  if (!spec.valid()) return;
  const Spec& content = tree[spec];
  for (uint32_t i = 0; i < content.enumerators.size(); ++i) {
    literals_[content.enumerators[i].name.text].push_back({spec, i});
  }
}

VarId Sema::add_variable(Variable variable, NameMap<VarId>& scope) {
  VarId id(static_cast<uint32_t>(variables_.size()));
  if (!scope.emplace(variable.name.text, id).second) {
    const Variable& first = variables_[scope[variable.name.text].index];
    std::string where = first.decl == nullptr
                            ? "the function's result has the function's name"
                            : "first declared in line " +
                                  std::to_string(sources.locate(first.name.span.begin).line);
    error(DiagnosticCode::kDuplicateName, variable.name.span,
          "`" + std::string(variable.name.text) + "` is declared twice; " + where);
    return {};
  }
  variables_.push_back(variable);
  return id;
}

void Sema::collect_globals(const std::vector<VarBlock>& blocks) {
  for (const VarBlock& block : blocks) {
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
        VarId id = add_variable(variable, globals_);
        if (id.valid()) global_order_.push_back(id);
      }
    }
  }
}

void Sema::collect_pous() {
  for (const PouDecl& decl : tree.pous) {
    if (decl.name.empty()) continue;
    bool library = sources.file_of(decl.span.begin) >= library_file_;
    if (library) {
      library_.emplace(decl.name.text, &decl);
    } else if (pou_names_.contains(decl.name.text)) {
      error(DiagnosticCode::kDuplicateName, decl.name.span,
            "`" + std::string(decl.name.text) + "` is declared twice");
    } else {
      add_pou(decl, false);
    }
  }
}

uint32_t Sema::add_pou(const PouDecl& decl, bool library) {
  uint32_t number = static_cast<uint32_t>(pous.size());
  PouInfo& info = pous.emplace_back();
  info.decl = &decl;
  info.library = library;
  info.id = ir::PouId(static_cast<uint32_t>(program.pous.size()));
  pou_names_.emplace(decl.name.text, number);
  ir::Pou& pou = program.pous.emplace_back();
  pou.name = decl.name.text;
  pou.kind = ir_kind(decl.kind);
  if (decl.kind != PouKind::kFunction) {
    ir::Type type;
    type.kind = decl.kind == PouKind::kProgram ? ir::Kind::kProgram : ir::Kind::kFunctionBlock;
    type.name = decl.name.text;
    info.self = program.types.declare(std::move(type));
    pou.self = info.self;
    pou_by_type_.emplace(info.self, number);
  }
  for (const VarBlock& block : decl.blocks) collect_variables(number, block);
  if (decl.kind == PouKind::kFunction && decl.result.valid()) {
    Variable result;
    result.name = decl.name;
    result.section = VarSection::kOutput;
    result.pou = number;
    result.used = true;
    info.result = add_variable(result, info.names);
    if (info.result.valid()) info.variables.push_back(info.result);
  }
  number_variables(info);
  return number;
}

void Sema::collect_variables(uint32_t pou, const VarBlock& block) {
  PouInfo& info = pous[pou];
  for (const VarDecl& decl : block.vars) {
    collect_enumerators(decl.spec);
    for (const Name& name : decl.names) {
      Variable variable;
      variable.name = name;
      variable.decl = &decl;
      variable.section = block.section;
      variable.constant = block.constant;
      variable.retain = block.retain;
      variable.pou = pou;
      VarId id = add_variable(variable, info.names);
      if (id.valid()) info.variables.push_back(id);
    }
  }
}

// Members of an instance, or locals of a frame: parameters first, then the result.
void Sema::number_variables(PouInfo& info) {
  bool function = info.decl->kind == PouKind::kFunction;
  auto place = [&](VarId id, Storage storage, std::vector<VarId>& order) {
    variables_[id.index].storage = storage;
    variables_[id.index].index = static_cast<uint32_t>(order.size());
    order.push_back(id);
  };
  if (function) {
    for (VarId id : info.variables) {
      if (id != info.result && is_parameter(variables_[id.index].section)) {
        place(id, Storage::kLocal, info.locals);
      }
    }
    if (info.result.valid()) place(info.result, Storage::kLocal, info.locals);
  }
  for (VarId id : info.variables) {
    VarSection section = variables_[id.index].section;
    if (section == VarSection::kExternal || id == info.result) continue;
    if (function && is_parameter(section)) continue;
    bool local = function || section == VarSection::kTemp;
    place(id, local ? Storage::kLocal : Storage::kMember, local ? info.locals : info.members);
  }
}

// Library POUs enter the program when their name is first used.
bool Sema::use_library(std::string_view name) {
  auto found = library_.find(name);
  if (found == library_.end() || pou_names_.contains(name)) return false;
  add_pou(*found->second, true);
  return true;
}

void Sema::report_unused() {
  for (const Variable& variable : variables_) {
    bool private_section =
        variable.section == VarSection::kLocal || variable.section == VarSection::kTemp;
    if (variable.used || !private_section || variable.decl->has_address) continue;
    warning(DiagnosticCode::kUnusedVariable, variable.name.span,
            "`" + std::string(variable.name.text) + "` is never used");
  }
}

}  // namespace frontend
