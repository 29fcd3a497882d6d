// Tasks and program instances.
#include "base/limits.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

constexpr int64_t kDefaultPeriodNs = 10'000'000;
constexpr int64_t kMaxPriority = 65535;

std::string quoted(const Name& name) { return "`" + std::string(name.text) + "`"; }

}  // namespace

void Sema::configure() {
  if (tree.configs.empty()) {
    default_configuration();
    return;
  }
  if (tree.configs.size() > 1) {
    error(DiagnosticCode::kTwoConfigurations, tree.configs[1].span,
          "a second CONFIGURATION " + quoted(tree.configs[1].name));
  }
  const ConfigDecl& config = tree.configs[0];
  program.name = config.name.text;
  if (config.resources.size() > 1) {
    error(DiagnosticCode::kTwoConfigurations, config.resources[1].name.span,
          "a second RESOURCE " + quoted(config.resources[1].name),
          "put its tasks into the first; one controller runs one resource");
  }
  if (!config.resources.empty()) configure_resource(config.resources[0]);
  bool named = false;
  for (const ResourceDecl& resource : config.resources) named = named || !resource.programs.empty();
  if (!named) {
    error(DiagnosticCode::kNoPrograms, config.span, "the CONFIGURATION names no program to run",
          "add PROGRAM name WITH task : Type;");
  }
  if (program.tasks.empty()) program.tasks.push_back({"Main", kDefaultPeriodNs, 0, 0});
}

void Sema::default_configuration() {
  program.tasks.push_back({"Main", kDefaultPeriodNs, 0, 0});
  for (const PouInfo& pou : pous) {
    if (pou.decl->kind != PouKind::kProgram) continue;
    program.instances.push_back({std::string(pou.decl->name.text), pou.self, 0, {}});
  }
}

void Sema::configure_resource(const ResourceDecl& resource) {
  if (resource.tasks.size() > base::kMaxTasks) {
    error(DiagnosticCode::kTooComplex, resource.name.span, "too many tasks");
    return;
  }
  for (const TaskDecl& task : resource.tasks) add_task(task);
  for (const ProgramDecl& decl : resource.programs) add_instance(decl);
}

void Sema::add_task(const TaskDecl& decl) {
  for (const ir::Task& task : program.tasks) {
    if (!ir::same_name(task.name, decl.name.text)) continue;
    error(DiagnosticCode::kDuplicateName, decl.name.span,
          "task " + quoted(decl.name) + " is declared twice");
  }
  ir::Task task;
  task.name = decl.name.text;
  if (decl.single.valid()) {
    error(DiagnosticCode::kNotSupported, decl.span, "event tasks (SINGLE)",
          "give the task an INTERVAL and test the event in its program");
  }
  if (decl.interval.valid()) {
    auto period = fold_bits(decl.interval, program.types.elementary(ir::Kind::kTime));
    task.period_ns = period ? static_cast<int64_t>(*period) : kDefaultPeriodNs;
    if (task.period_ns <= 0) {
      error(DiagnosticCode::kBadInterval, decl.span,
            "task " + quoted(decl.name) + " has the interval " + std::to_string(task.period_ns) +
                " ns");
    }
  }
  if (decl.priority.valid()) {
    int64_t priority = fold_integer(decl.priority).value_or(0);
    if (priority < 0 || priority > kMaxPriority) {
      error(DiagnosticCode::kBadPriority, decl.span,
            "task " + quoted(decl.name) + " has the priority " + std::to_string(priority),
            "use 0 (highest) to " + std::to_string(kMaxPriority));
      priority = 0;
    }
    task.priority = static_cast<uint32_t>(priority);
  }
  program.tasks.push_back(std::move(task));
}

void Sema::add_instance(const ProgramDecl& decl) {
  auto found = pou_names_.find(decl.type.text);
  if (found == pou_names_.end() || pous[found->second].decl->kind != PouKind::kProgram) {
    NearestName nearest(decl.type.text);
    for (const PouInfo& pou : pous) {
      if (pou.decl->kind == PouKind::kProgram) nearest.offer(pou.decl->name.text);
    }
    error(DiagnosticCode::kUnknownProgram, decl.type.span, quoted(decl.type) + " is not a PROGRAM",
          nearest.fix());
    return;
  }
  for (const ir::ProgramInstance& other : program.instances) {
    if (!ir::same_name(other.name, decl.name.text)) continue;
    error(DiagnosticCode::kDuplicateName, decl.name.span,
          "program " + quoted(decl.name) + " is declared twice");
  }
  ir::ProgramInstance instance;
  instance.name = decl.name.text;
  instance.type = pous[found->second].self;
  if (decl.task.empty()) {
    if (program.tasks.empty()) program.tasks.push_back({"Main", kDefaultPeriodNs, 0, 0});
  } else {
    while (instance.task < program.tasks.size() &&
           !ir::same_name(program.tasks[instance.task].name, decl.task.text)) {
      ++instance.task;
    }
    if (instance.task == program.tasks.size()) {
      NearestName nearest(decl.task.text);
      for (const ir::Task& task : program.tasks) nearest.offer(task.name);
      error(DiagnosticCode::kUnknownTask, decl.task.span, quoted(decl.task) + " is not a task",
            nearest.fix());
      return;
    }
  }
  instance.init = program_arguments(decl, pous[found->second]);
  program.instances.push_back(std::move(instance));
}

ir::ConstId Sema::program_arguments(const ProgramDecl& decl, const PouInfo& info) {
  ir::ConstValue value;
  for (uint32_t i = 0; i < decl.args.count; ++i) {
    const Arg& arg = tree.args[decl.args.first + i];
    auto found = info.names.find(arg.name.text);
    if (found == info.names.end()) {
      error(DiagnosticCode::kUnknownParameter, arg.span,
            quoted(decl.type) + " has no parameter " + quoted(arg.name));
      continue;
    }
    const Variable& variable = resolve(found->second);
    bool input = variable.section == VarSection::kInput && !arg.output && arg.value.valid();
    if (!input || !infer(arg.value).constant) {
      error(DiagnosticCode::kNotSupported, arg.span,
            "connecting " + quoted(arg.name) + " to a variable",
            "give inputs constant values here; connect variables in the program's body");
      continue;
    }
    ir::ConstId init = initial_value(arg.value, variable.type);
    if (init.valid()) value.elements.push_back({variable.index, 1, init});
  }
  if (value.elements.empty()) return {};
  return program.constants.add(std::move(value));
}

}  // namespace frontend
