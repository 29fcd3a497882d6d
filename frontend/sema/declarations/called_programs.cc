// Programs that other POUs call or look into: `P();`, `P.x`. There is one instance, of the
// program's own name.
#include <algorithm>

#include "frontend/sema/declarations/interfaces.h"
#include "frontend/sema/declarations/old_names.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

// No device writes the inputs of a test: they are variables as others are.
void free_inputs(ir::TypeTable& types) {
  const auto is_input = [](const ir::Member& member) {
    return member.address.area == ir::DirectArea::kInput;
  };
  for (uint32_t i = 0; i < types.size(); ++i) {
    const std::vector<ir::Member>& members = types[ir::TypeId(i)].members;
    if (std::none_of(members.begin(), members.end(), is_input)) continue;
    for (ir::Member& member : types.edit(ir::TypeId(i)).members) {
      if (is_input(member)) member.address = {};
    }
  }
}

}  // namespace

// The global through which code reaches the program; invalid: there is no such program.
VarId Variables::program_variable(std::string_view name, bool called) {
  auto found = sema_.declared.pou_names.find(name);
  if (found == sema_.declared.pou_names.end() ||
      sema_.declared.pous[found->second].decl->kind != PouKind::kProgram)
    return {};
  PouInfo& info = sema_.declared.pous[found->second];
  info.called = info.called || called;
  if (info.global.valid()) return info.global;
  VarId id(static_cast<uint32_t>(sema_.declared.variables.size()));
  Variable variable;
  variable.name = info.decl->name;
  variable.section = VarSection::kGlobal;
  variable.storage = Storage::kGlobal;
  variable.used = true;
  variable.hidden = true;
  variable.type = info.self;
  variable.progress = Progress::kDone;
  sema_.declared.variables.push_back(variable);
  info.global = id;
  place_global(id);
  return id;
}

void Interfaces::warn_never_runs(const PouInfo& info) {
  const std::string name(info.decl->name.text);
  std::string text = "program `" + name + "` is in no task, and nobody calls it: it never runs";
  std::string help = "PROGRAM " + name + " WITH task : " + name + "; or " + name + "();";
  for (const ir::ProgramInstance& other : sema_.program.instances) {
    if (other.type != info.self) continue;
    text += "; `" + other.name + "` is an instance with variables of its own";
    help = "PROGRAM " + name + " in place of PROGRAM " + other.name;
    break;
  }
  warning(DiagnosticCode::kNeverRuns, info.decl->name.span, std::move(text), std::move(help));
}

// After all bodies. What is called does not run by itself, unless a CONFIGURATION says so.
void Interfaces::finish_programs() {
  if (sema_.for_tests()) return free_inputs(sema_.program.types);  // programs are blocks then
  for (const PouInfo& info : sema_.declared.pous) {
    if (!info.global.valid()) continue;
    ir::ProgramInstance* instance = nullptr;
    for (ir::ProgramInstance& other : sema_.program.instances) {
      if (ir::same_name(other.name, info.decl->name.text)) instance = &other;
    }
    if (instance == nullptr) {
      if (!info.called) warn_never_runs(info);
      sema_.program.instances.push_back({std::string(info.decl->name.text),
                                         info.self,
                                         ir::kNoTask,
                                         {},
                                         ask<OldNames>().add(std::string(info.old_name))});
    } else if (instance->type != info.self) {
      error(DiagnosticCode::kDuplicateName, info.decl->name.span,
            "the program instance `" + instance->name +
                "` is of another type than the program "
                "of that name, which other POUs use",
            "give the instance another name");
    } else if (sema_.tree.configs.empty() && info.called) {
      instance->task = ir::kNoTask;
    }
  }
}

}  // namespace frontend
