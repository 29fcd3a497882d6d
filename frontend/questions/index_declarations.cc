// What declarations bring, and the names in them.
#include <algorithm>

#include "frontend/questions/indexer.h"
#include "frontend/sema/objects/objects.h"

namespace frontend::questions {

Index Indexer::run() {
  find_specs();
  for (const TypeDecl& decl : tree_.types) {
    if (sema_.library.holds(decl.name.span) || !decl.spec.valid()) continue;
    add(decl.name.span, type_symbol(sema_.facts.specs[decl.spec.index].name.text), Role::kDeclared);
    spec(decl.spec);
    initial(decl.init, sema_.facts.specs[decl.spec.index].use.type);
  }
  blocks(tree_.globals);
  for (const PouDecl& decl : tree_.pous) pou(decl);
  for (const PouDecl& decl : tree_.tests) pou(decl);
  for (const ConfigDecl& config : tree_.configs) configuration(config);
  auto& found = out_.occurrences;
  std::stable_sort(found.begin(), found.end(), [](const Occurrence& a, const Occurrence& b) {
    return a.span.begin < b.span.begin;
  });
  // What has instances of its own, or a diagram that reads a value twice, names it once.
  const auto same = [](const Occurrence& a, const Occurrence& b) {
    return a.span.begin == b.span.begin && a.symbol == b.symbol;
  };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  out_.uses.resize(out_.symbols.size());
  for (uint32_t i = 0; i < found.size(); ++i) out_.uses[found[i].symbol].push_back(i);
  return std::move(out_);
}

void Indexer::find_specs() {
  for (uint32_t i = 0; i < tree_.specs.size(); ++i) {
    const SpecKind kind = tree_.specs[i].kind;
    const bool named = kind == SpecKind::kStruct || kind == SpecKind::kUnion;
    if (!named && kind != SpecKind::kEnum) continue;
    const ir::TypeId type =
        i < sema_.facts.specs.size() ? sema_.facts.specs[i].use.type : ir::TypeId();
    if (!type.valid() || !specs_.emplace(type, SpecId(i)).second) continue;
    NameMap<Name>& members = members_[type];
    for (const VarDecl& field : tree_.specs[i].fields) {
      for (const Name& name : field.names) members.emplace(name.text, name);
    }
    for (const Enumerator& one : tree_.specs[i].enumerators) {
      members.emplace(one.name.text, one.name);
    }
  }
  const auto& variables = sema_.declared.variables;
  for (uint32_t i = 0; i < variables.size(); ++i) {
    if (!variables[i].hidden) variables_.emplace(variables[i].name.span.begin.offset, VarId(i));
  }
  for (const PouInfo& info : sema_.declared.pous) {
    const PouInfo*& known = infos_[info.decl];
    if (known == nullptr || (known->open && !info.open)) known = &info;
  }
}

VarId Indexer::declared(const Name& name) const {
  const auto found = variables_.find(name.span.begin.offset);
  return found == variables_.end() ? VarId() : found->second;
}

void Indexer::pou(const PouDecl& decl) {
  if (sema_.library.holds(decl.span)) return;
  const auto found = infos_.find(&decl);
  const PouScope before = scope_;
  if (found != infos_.end()) scope_ = PouScope(*found->second);
  if (found != infos_.end()) {
    add(decl.name.span, pou_symbol(*found->second), Role::kDeclared);
  }
  spec(decl.result);
  for (const SpecId base : decl.extends) spec(base);
  for (const SpecId interface : decl.implements) spec(interface);
  blocks(decl.blocks);
  statements(decl.body);
  if (decl.chart != kNoChart) {
    steps(tree_.charts[decl.chart]);
    chart(tree_.charts[decl.chart]);
  }
  for (const PouDecl& member : decl.members) pou(member);
  scope_ = before;
}

void Indexer::blocks(const std::vector<VarBlock>& blocks) {
  for (const VarBlock& one : blocks) block(one);
}

void Indexer::block(const VarBlock& block) {
  for (const VarDecl& decl : block.vars) {
    expression(decl.path);
    if (decl.implied) continue;
    spec(decl.spec);
    ir::TypeId type;
    for (const Name& name : decl.names) {
      variable(decl, name, block.section);
      if (const VarId id = declared(name); id.valid())
        type = sema_.declared.variables[id.index].type;
    }
    initial(decl.init, type);
  }
}

void Indexer::variable(const VarDecl&, const Name& name, VarSection section) {
  if (name.text.find('#') != std::string_view::npos) return;  // no source has it: of a diagram
  const bool external = section == VarSection::kExternal;
  add(name.span, variable_symbol(declared(name)), external ? Role::kRead : Role::kDeclared);
}

// Lists of values name fields and parameters of their type.
void Indexer::initial(ExprId init, ir::TypeId type) {
  if (!init.valid()) return;
  const Expr& expr = tree_[init];
  if (expr.kind == ExprKind::kArrayInit || expr.kind == ExprKind::kRepeat) {
    const bool array = type.valid() && sema_.program.types[type].kind == ir::Kind::kArray;
    const ir::TypeId element = expr.kind == ExprKind::kRepeat ? type
                               : array                        ? sema_.program.types[type].base
                                                              : ir::TypeId();
    expression(expr.operand);
    for (uint32_t i = 0; i < expr.list.count; ++i) {
      initial(tree_.expr_lists[expr.list.first + i], element);
    }
    return;
  }
  if (expr.kind != ExprKind::kStructInit) return expression(init);
  const PouInfo* block = type.valid() ? sema_.declared.pou_of(type) : nullptr;
  for (uint32_t i = 0; i < expr.list.count; ++i) {
    const Arg& arg = tree_.args[expr.list.first + i];
    std::optional<Symbol> part;
    if (!arg.name.empty() && type.valid()) {
      part = block == nullptr
                 ? field_symbol(type, arg.name)
                 : variable_symbol(Objects(sema_, scope_).find_parameter(*block, arg.name.text));
    }
    add(arg.name.span, part, Role::kWritten);
    initial(arg.value, part ? part->type : ir::TypeId());
  }
}

// Steps and actions are variables that the chart declares; who names them, names those.
void Indexer::steps(const Chart& chart) {
  const auto named = [&](const Name& name) -> std::optional<Symbol> {
    if (scope_.pou == nullptr) return std::nullopt;
    const auto found = scope_.pou->names.find(name.text);
    return found == scope_.pou->names.end() ? std::nullopt : variable_symbol(found->second);
  };
  for (const ChartStep& step : chart.steps) {
    add(step.name.span, named(step.name), Role::kDeclared);
    for (const ActionUse& use : step.uses) {  // or a variable, which is found as an expression
      const bool action = std::any_of(
          chart.actions.begin(), chart.actions.end(),
          [&](const auto& one) { return ir::same_name(one.name.text, use.action.text); });
      if (action) add(use.action.span, named(use.action), Role::kRead);
    }
  }
  for (const ChartAction& action : chart.actions) {
    add(action.name.span, named(action.name), Role::kDeclared);
  }
  for (const ChartTransition& transition : chart.transitions) {
    for (const Name& step : transition.from) add(step.span, named(step), Role::kRead);
    for (const Name& step : transition.to) add(step.span, named(step), Role::kRead);
    if (transition.name.empty()) continue;
    plain_declaration(SymbolKind::kTransition, transition.name);
  }
}

// Of what has a name and nothing more that is asked.
Symbol Indexer::plain_declaration(SymbolKind kind, const Name& name) {
  Symbol symbol;
  symbol.kind = kind;
  symbol.name = std::string(name.text);
  symbol.defined = name.span;
  add(symbol.defined, symbol, Role::kDeclared);
  return symbol;
}

void Indexer::configuration(const ConfigDecl& config) {
  blocks(config.globals);
  for (const ResourceDecl& resource : config.resources) {
    blocks(resource.globals);
    NameMap<Symbol> tasks;
    for (const TaskDecl& task : resource.tasks) {
      tasks.emplace(task.name.text, plain_declaration(SymbolKind::kTask, task.name));
      expression(task.interval);
      expression(task.priority);
      expression(task.single);
    }
    for (const ProgramDecl& program : resource.programs) {
      plain_declaration(SymbolKind::kInstance, program.name);
      const PouInfo* type = sema_.declared.find_pou(program.type.text);
      if (type != nullptr) add(program.type.span, pou_symbol(*type), Role::kRead);
      if (const auto task = tasks.find(program.task.text); task != tasks.end()) {
        add(program.task.span, task->second, Role::kRead);
      }
      for (uint32_t i = 0; type != nullptr && i < program.args.count; ++i) {
        const Arg& arg = tree_.args[program.args.first + i];
        const auto parameter = type->names.find(arg.name.text);
        if (parameter != type->names.end()) {
          add(arg.name.span, variable_symbol(parameter->second), Role::kRead);
        }
        expression(arg.value, arg.output ? Use::kWritten : Use::kRead);
      }
    }
  }
}

void Indexer::visit(const Spec& spec, SpecId id) {
  for (const VarDecl& field : spec.fields) {
    for (const Name& name : field.names) {
      const ir::TypeId type =
          id.index < sema_.facts.specs.size() ? sema_.facts.of(scope_, id).use.type : ir::TypeId();
      if (type.valid()) add(name.span, field_symbol(type, name), Role::kDeclared);
    }
  }
  if (spec.kind == SpecKind::kEnum && id.index < sema_.facts.specs.size()) {
    const ir::TypeId type = sema_.facts.of(scope_, id).use.type;
    for (const Enumerator& enumerator : spec.enumerators) {
      add(enumerator.name.span, enumerator_symbol(type, enumerator.name.text), Role::kDeclared);
    }
  }
  if (spec.kind != SpecKind::kNamed) return;
  add(spec.name.span,
      declaration_named(sema_.namespaces.find(NameSort::kDeclaration, spec.qualifiers, spec.name)),
      Role::kRead);
}

}  // namespace frontend::questions
