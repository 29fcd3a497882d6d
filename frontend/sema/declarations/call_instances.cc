// Function block instances that are made anew at each call: VAR of functions and methods, VAR_TEMP
// (codesys, twincat). No frame has a place that others could point to, so each is a variable that
// stays: of a function as VAR_STAT is, of a method as VAR_INST is, of a block or program a member.
// The body begins with its initial values and FB_Init (lower/frame.cc). That is the same as an
// instance for each call as long as no two calls meet; check_call_instances() refuses the others.
#include <map>

#include "frontend/sema/configuration/common_uses.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"
#include "ir/types/stamps.h"

namespace frontend {
namespace {

constexpr uint32_t kDeepestSpec = 32;

}  // namespace

// By names alone: nothing is resolved yet. A name that means something else somewhere costs a
// variable that stays, nothing more.
bool Collection::holds_block(SpecId id, uint32_t depth) {
  if (!id.valid() || depth > kDeepestSpec) return false;
  const Spec& spec = sema_.tree[id];
  switch (spec.kind) {
    case SpecKind::kArray:
      return holds_block(spec.element, depth + 1);
    case SpecKind::kStruct:
      return holds_block(spec.element, depth + 1) ||
             std::ranges::any_of(spec.fields, [&](const VarDecl& field) {
               return holds_block(field.spec, depth + 1);
             });
    case SpecKind::kNamed: {
      NameMap<SpecId>& known = block_names();
      const auto found = known.find(spec.name.text);
      if (found == known.end()) return false;
      const SpecId declared = found->second;
      if (!declared.valid()) return true;
      known.erase(found);  // holds none, until one is found in it: a name is looked into once
      const bool holds = holds_block(declared, depth + 1);
      if (holds) known.emplace(spec.name.text, SpecId());
      return holds;
    }
    default:
      return false;
  }
}

// Function blocks, and what is known to hold one, without a type; types that nobody has asked for.
NameMap<SpecId>& Collection::block_names() {
  if (sema_.declared.block_names) return *sema_.declared.block_names;
  NameMap<SpecId>& names = sema_.declared.block_names.emplace();
  for (const PouDecl& decl : sema_.tree.pous) {
    if (decl.kind == PouKind::kFunctionBlock) names.emplace(decl.name.text, SpecId());
  }
  for (const TypeDecl& decl : sema_.tree.types) names.emplace(decl.name.text, decl.spec);
  return names;
}

bool Collection::is_call_instance(const Variable& variable, const PouInfo& info) {
  const bool temporary = variable.section == VarSection::kTemp;
  const bool local = has_frame(info.decl->kind) && variable.section == VarSection::kLocal;
  return (temporary || local) && sema_.options.dialect != Dialect::kIec &&
         holds_block(variable.decl->spec, 0);
}

void Collection::add_call_instance(Variable variable, PouInfo& info) {
  variable.each_call = true;
  VarId id;
  if (!has_frame(info.decl->kind)) {
    id = add_variable(variable, info.names);
    if (id.valid()) info.variables.push_back(id);
  } else if (info.owner != kNoPou) {
    variable.section = VarSection::kInstance;
    id = add_instance_variable(variable, info);
  } else if (info.open) {  // its instances have one each
    add_variable(variable, info.names);
    return;
  } else {
    variable.section = VarSection::kStatic;
    id = add_own_static(variable, info);
  }
  if (id.valid()) info.call_instances.push_back(id);
}

// Would a second call begin while the first one is in the middle?
void CommonUses::check_call_instances() {
  if (sema_.report.has_errors()) return;
  bool any = false;
  for (const PouInfo& info : sema_.declared.pous) any = any || !info.call_instances.empty();
  if (!any) return;
  const std::vector<bool> circles = leads_to_circle();
  for (const PouInfo& info : sema_.declared.pous) {
    if (circles[info.number] && !info.call_instances.empty() && calls_itself(info.number)) {
      report_call_instance(info, "calls itself", "declare it in VAR of a function block");
    }
  }
  std::map<uint32_t, uint32_t> task_of;  // function -> task
  for (const ir::ProgramInstance& instance : sema_.program.instances) {
    if (instance.task == ir::kNoTask) continue;
    const ir::Task& task = sema_.program.tasks[instance.task];
    if (task.name == ir::kStartProgram) continue;  // runs alone
    check_call_instances({instance.type}, instance.task, task_of);
  }
  for (const ir::BlockTask& block : sema_.program.block_tasks) {
    const ir::TypeId program = sema_.program.instances[block.program].type;
    const ir::TypeId type = sema_.program.types[program].members[block.member].type;
    check_call_instances({type}, block.task, task_of);
  }
}

void CommonUses::check_call_instances(const std::vector<ir::TypeId>& starts, uint32_t task,
                                      std::map<uint32_t, uint32_t>& task_of) {
  for (const uint32_t pou : reached_from(starts)) {
    const PouInfo& info = sema_.declared.pous[pou];
    if (info.call_instances.empty() || info.owner != kNoPou || info.self.valid()) continue;
    const uint32_t first = task_of.emplace(pou, task).first->second;
    if (first == task) continue;
    task_of[pou] = task;
    report_call_instance(info,
                         "is called by task " + quoted(sema_.program.tasks[first].name) +
                             " and by task " + quoted(sema_.program.tasks[task].name),
                         "pass the instance as VAR_IN_OUT, or make a method of the function");
  }
}

// Who has left no callee is taken away, and so on: nobody, as a rule, is left then.
std::vector<bool> CommonUses::leads_to_circle() const {
  const auto& pous = sema_.declared.pous;
  std::vector<bool> leads(pous.size(), true);
  std::vector<size_t> left(pous.size());
  std::vector<std::vector<uint32_t>> callers(pous.size());
  std::vector<uint32_t> done;
  for (const PouInfo& info : pous) {
    left[info.number] = info.callees.size();
    for (const uint32_t callee : info.callees) callers[callee].push_back(info.number);
    if (info.callees.empty()) done.push_back(info.number);
  }
  while (!done.empty()) {
    const uint32_t callee = done.back();
    done.pop_back();
    leads[callee] = false;
    for (const uint32_t caller : callers[callee]) {
      if (--left[caller] == 0) done.push_back(caller);
    }
  }
  return leads;
}

bool CommonUses::calls_itself(uint32_t pou) const {
  std::vector<bool> seen(sema_.declared.pous.size());
  std::vector<uint32_t> open{pou};
  while (!open.empty()) {
    const PouInfo& info = sema_.declared.pous[open.back()];
    open.pop_back();
    for (const uint32_t callee : info.callees) {
      if (callee == pou) return true;
      if (!seen[callee]) open.push_back(callee);
      seen[callee] = true;
    }
  }
  return false;
}

void CommonUses::report_call_instance(const PouInfo& info, const std::string& why,
                                      const char* help) const {
  const Variable& variable = sema_.declared.variables[info.call_instances[0].index];
  error(DiagnosticCode::kSectionNotAllowed, variable.name.span,
        quoted(variable.name) + " is one instance for all calls, but " + quoted(info.decl->name) +
            " " + why,
        help);
}

}  // namespace frontend
