// The resource that is compiled: its tasks and program instances.
#include <algorithm>

#include "base/limits.h"
#include "frontend/parse/declared_twice.h"
#include "frontend/sema/configuration/configuration.h"
#include "frontend/sema/configuration/instance_paths.h"
#include "frontend/sema/configuration/task_attributes.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/interfaces.h"
#include "frontend/sema/declarations/old_names.h"
#include "frontend/sema/declarations/rename_rules.h"
#include "frontend/sema/phase.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/tests/test_build.h"

namespace frontend {
namespace {

ir::Task main_task() {
  ir::Task task;
  task.name = "Main";
  task.period_ns = kDefaultPeriodNs;
  return task;
}

// By which people address them, and folders are called.
bool check_resource_names(const Phase& phase, const ConfigDecl& config) {
  if (config.resources.size() < 2) return true;
  if (config.resources.size() > base::kMaxResources) {
    phase.error(DiagnosticCode::kTooComplex, config.resources[base::kMaxResources].name.span,
                "more than " + std::to_string(base::kMaxResources) + " RESOURCEs");
  }
  bool good = true;
  NameMap<const ResourceDecl*> names;
  for (const ResourceDecl& resource : config.resources) {
    const bool first =
        !resource.name.empty() && names.emplace(resource.name.text, &resource).second;
    good = good && first;
    if (first) continue;
    if (resource.name.empty()) {
      phase.error(DiagnosticCode::kTwoConfigurations, config.name.span,
                  "CONFIGURATION " + quoted(config.name) +
                      " has tasks or programs of its own beside its RESOURCEs",
                  "move them into a RESOURCE");
    } else {
      phase.error(DiagnosticCode::kDuplicateName, resource.name.span,
                  declared_twice(phase.sema().sources, resource.name.text, resource.name.span,
                                 names.at(resource.name.text)->name.span));
    }
  }
  return good;
}

}  // namespace

// One image runs one resource: the one that was asked for, else the first.
void Configuration::choose_resource() {
  const base::SourceSpan asked = sema_.options.resource_at;
  if (sema_.tree.configs.empty()) {
    if (sema_.options.resource.empty()) return;
    return error(DiagnosticCode::kUnknownResource, asked,
                 "there is no RESOURCE `" + sema_.options.resource + "`: nothing declares one",
                 asked.begin.valid() ? "leave `resource` out" : "leave --resource out");
  }
  const ConfigDecl& config = sema_.tree.configs[0];
  if (sema_.tree.configs.size() > 1) {
    error(DiagnosticCode::kTwoConfigurations, sema_.tree.configs[1].span,
          "a second CONFIGURATION " + quoted(sema_.tree.configs[1].name));
  }
  NearestName nearest(sema_.options.resource);
  const bool named = check_resource_names(*this, config);
  for (const ResourceDecl& resource : config.resources) {
    nearest.offer(resource.name.text);
    bool wanted =
        sema_.options.resource.empty() || ir::same_name(resource.name.text, sema_.options.resource);
    if (wanted && sema_.declared.resource == nullptr) sema_.declared.resource = &resource;
  }
  if (sema_.declared.resource == nullptr && !sema_.options.resource.empty()) {
    error(DiagnosticCode::kUnknownResource, asked.begin.valid() ? asked : config.span,
          "there is no RESOURCE `" + sema_.options.resource + "`", nearest.fix());
  } else if (named && sema_.options.resource.empty() && config.resources.size() > 1) {
    warning(DiagnosticCode::kResourceChosen, config.resources[1].name.span,
            "RESOURCE " + quoted(sema_.declared.resource->name) + " is compiled, " +
                quoted(config.resources[1].name) + " is left out",
            "say which one is meant: --resource NAME");
  }
}

void Configuration::configure() {
  if (sema_.for_tests()) return ask<TestBuild>().configure_tests();
  if (sema_.tree.configs.empty()) {
    default_configuration();
    return;
  }
  const ConfigDecl& config = sema_.tree.configs[0];
  sema_.program.name = config.name.text;
  if (config.resources.size() > 1 && sema_.declared.resource != nullptr) {
    sema_.program.name += "." + std::string(sema_.declared.resource->name.text);
  }
  if (sema_.declared.resource != nullptr) {
    apply_schedule(*this, config.name, config.attributes);
    apply_schedule(*this, sema_.declared.resource->name, sema_.declared.resource->attributes);
    configure_resource(*sema_.declared.resource);
  }
  if (sema_.declared.resource == nullptr || sema_.declared.resource->programs.empty()) {
    error(DiagnosticCode::kNoPrograms, config.span, "the CONFIGURATION names no program to run",
          "add PROGRAM name WITH task : Type;");
  }
  if (sema_.program.tasks.empty()) sema_.program.tasks.push_back(main_task());
  InstancePaths paths(sema_);
  paths.configure(sema_.tree.globals);
  paths.configure(config.globals);
  if (sema_.declared.resource != nullptr) paths.configure(sema_.declared.resource->globals);
  paths.check_open_addresses();
}

void Configuration::default_configuration() {
  sema_.program.tasks.push_back(main_task());
  for (const PouInfo& pou : sema_.declared.pous) {
    if (pou.decl->kind != PouKind::kProgram) continue;
    sema_.program.instances.push_back({std::string(pou.decl->name.text),
                                       pou.self,
                                       0,
                                       {},
                                       ask<OldNames>().add(std::string(pou.old_name))});
  }
  InstancePaths paths(sema_);
  paths.configure(sema_.tree.globals);
  paths.check_open_addresses();
}

void Configuration::configure_resource(const ResourceDecl& resource) {
  if (resource.tasks.size() > base::kMaxTasks) {
    error(DiagnosticCode::kTooComplex, resource.name.span, "too many tasks");
    return;
  }
  for (const TaskDecl& task : resource.tasks) add_task(task, resource);
  check_base_cycle(*this, resource.tasks);
  for (const ProgramDecl& decl : resource.programs) add_instance(decl, resource);
}

std::optional<uint32_t> Configuration::find_task(const Name& name) {
  NearestName nearest(name.text);
  for (uint32_t i = 0; i < sema_.program.tasks.size(); ++i) {
    if (ir::same_name(sema_.program.tasks[i].name, name.text)) return i;
    nearest.offer(sema_.program.tasks[i].name);
  }
  error(DiagnosticCode::kUnknownTask, name.span, quoted(name) + " is not a task", nearest.fix());
  return std::nullopt;
}

std::optional<uint32_t> Configuration::find_program(const ProgramDecl& decl) {
  auto found = sema_.declared.pou_names.find(decl.type.text);
  if (found != sema_.declared.pou_names.end() &&
      sema_.declared.pous[found->second].decl->kind == PouKind::kProgram) {
    return found->second;
  }
  NearestName nearest(decl.type.text);
  for (const PouInfo& pou : sema_.declared.pous) {
    if (pou.decl->kind == PouKind::kProgram) nearest.offer(pou.decl->name.text);
  }
  error(DiagnosticCode::kUnknownProgram, decl.type.span, quoted(decl.type) + " is not a PROGRAM",
        nearest.fix());
  return std::nullopt;
}

void Configuration::check_once(const Name& name, const Name& other) {
  if (!ir::same_name(name.text, other.text)) return;
  error(DiagnosticCode::kDuplicateName, name.span,
        declared_twice(sema_.sources, name.text, name.span, other.span));
}

void Configuration::add_instance(const ProgramDecl& decl, const ResourceDecl& resource) {
  auto pou = find_program(decl);
  if (!pou) return;
  for (const ProgramDecl& other : resource.programs) {
    if (&other == &decl) break;
    check_once(decl.name, other.name);
  }
  ir::ProgramInstance instance;
  instance.name = decl.name.text;
  instance.old_name = ask<OldNames>().of_rule(decl.attributes);
  if (decl.task.empty()) {
    if (sema_.program.tasks.empty()) sema_.program.tasks.push_back(main_task());
  } else if (auto task = find_task(decl.task)) {
    instance.task = *task;
  } else {
    return;
  }
  auto same_type = [&](const ProgramDecl& other) {
    return ir::same_name(other.type.text, decl.type.text);
  };
  bool alone = std::count_if(resource.programs.begin(), resource.programs.end(), same_type) == 1;
  std::vector<Connection> connections;
  instance.init = program_arguments(decl, sema_.declared.pous[*pou], connections);
  bool own = !connections.empty() || decl.retain;
  if (own && !alone) *pou = clone_program(*pou, decl);
  sema_.declared.pous[*pou].connections = std::move(connections);
  if (decl.retain) retain_program(sema_.declared.pous[*pou]);
  instance.type = sema_.declared.pous[*pou].self;
  sema_.program.instances.push_back(std::move(instance));
  for (const BlockTask& block : decl.block_tasks) add_block_task(block, sema_.declared.pous[*pou]);
}

// PROGRAM p : T (fb WITH task): the block runs in a task of its own.
void Configuration::add_block_task(const BlockTask& decl, const PouInfo& info) {
  auto task = find_task(decl.task);
  if (!task) return;
  auto found = info.names.find(decl.block.text);
  const Variable* block = found == info.names.end() ? nullptr : &resolve(found->second);
  bool instance = block != nullptr && block->storage == Storage::kMember && block->type.valid() &&
                  sema_.program.types[block->type].kind == ir::Kind::kFunctionBlock &&
                  block->section != VarSection::kInOut;
  if (!instance) {
    error(DiagnosticCode::kUnknownMember, decl.block.span,
          quoted(decl.block) + " is no function block of " + quoted(info.decl->name));
    return;
  }
  auto number = static_cast<uint32_t>(sema_.program.instances.size() - 1);
  sema_.program.block_tasks.push_back({number, block->index, *task});
}

// Constants become initial values, everything else is copied around the program's scan.
ir::ConstId Configuration::program_arguments(const ProgramDecl& decl, const PouInfo& info,
                                             std::vector<Connection>& connections) {
  ir::ConstValue value;
  for (uint32_t i = 0; i < decl.args.count; ++i) {
    const Arg& arg = sema_.tree.args[decl.args.first + i];
    auto found = info.names.find(arg.name.text);
    const Variable* variable = found == info.names.end() ? nullptr : &resolve(found->second);
    bool parameter = variable != nullptr && (variable->section == VarSection::kInput ||
                                             variable->section == VarSection::kOutput);
    if (!parameter) {
      error(DiagnosticCode::kUnknownParameter, arg.span,
            quoted(decl.type) + " has no input or output " + quoted(arg.name));
      continue;
    }
    bool output = variable->section == VarSection::kOutput;
    if (arg.output != output) {
      error(DiagnosticCode::kWrongDirection, arg.span,
            quoted(arg.name) + (output ? " is an output" : " is no output"),
            output ? "write `=>`" : "write `:=`");
      continue;
    }
    if (!arg.value.valid() || !variable->type.valid()) continue;
    ExprKind kind = sema_.tree[arg.value].kind;
    bool list = kind == ExprKind::kArrayInit || kind == ExprKind::kStructInit;
    bool constant = !output && (list || infer(arg.value).known >= Known::kByCall);
    if (!constant) {
      connections.push_back({found->second, decl.args.first + i});
      continue;
    }
    ir::ConstId init = ask<Constants>().initial_value(arg.value, variable->type, variable->init);
    if (init.valid()) value.elements.push_back({variable->index, 1, init});
  }
  if (value.elements.empty()) return {};
  return sema_.program.constants.add(std::move(value));
}

// PROGRAM RETAIN p: all that its POU does not declare NON_RETAIN.
void Configuration::retain_program(const PouInfo& info) {
  std::vector<ir::Member>& members = sema_.program.types.edit(info.self).members;
  for (VarId id : info.members) {
    Variable& variable = sema_.declared.variables[id.index];
    bool lasts = variable.section != VarSection::kInOut && variable.section != VarSection::kTemp;
    variable.retain = lasts && !variable.non_retain;
    members[variable.index].retain = variable.retain;
  }
  std::vector<ir::Member>& globals = sema_.program.types.edit(sema_.program.globals).members;
  for (const auto& [name, id] : info.names) {  // those that share their place
    const Variable& variable = sema_.declared.variables[id.index];
    const bool shared =
        variable.storage == Storage::kGlobal && variable.section == VarSection::kLocal;
    if (shared && !variable.non_retain) globals[variable.index].retain = true;
  }
}

// A program whose instances are connected differently, or not all RETAIN, has code and a type for
// each.
uint32_t Configuration::clone_program(uint32_t original, const ProgramDecl& decl) {
  const Name& instance = decl.name;
  const std::string old_instance = renamed_from(sema_.tree, decl.attributes);
  auto number = static_cast<uint32_t>(sema_.declared.pous.size());
  PouInfo& info = sema_.declared.pous.emplace_back();
  info.number = number;
  info.decl = sema_.declared.pous[original].decl;
  info.name = sema_.declared.pous[original].name;
  info.meaning = std::make_unique<Meaning>();
  info.id = ir::PouId(static_cast<uint32_t>(sema_.program.pous.size()));
  ir::Pou code;
  code.name = std::string(info.decl->name.text) + "(" + std::string(instance.text) + ")";
  code.kind = ir::PouKind::kProgram;
  ir::Type type;
  type.kind = ir::Kind::kProgram;
  type.name = code.name;
  const std::string_view before = sema_.declared.pous[original].old_name;
  if (!before.empty() || !old_instance.empty()) {
    type.old_name = ask<OldNames>().of_clone(info.name, before, instance.text, old_instance);
  }
  info.self = code.self = sema_.program.types.declare(std::move(type));
  sema_.declared.pou_by_type.emplace(info.self, number);
  sema_.program.pous.push_back(std::move(code));
  ask<Collection>().collect_interface(number);
  for (uint32_t i = number; i < sema_.declared.pous.size(); ++i)
    ask<Interfaces>().resolve_interface(i);  // its methods too
  return number;
}

}  // namespace frontend
