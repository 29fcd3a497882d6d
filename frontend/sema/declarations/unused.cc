// What is declared and never used, or never written.
#include "frontend/sema/declarations/unused.h"

#include "frontend/sema/objects/objects.h"
#include "frontend/sema/phase.h"

namespace frontend {
namespace {

// FB_Init and its kind are called by the system, which asks for no result.
bool is_called_by_system(const Tree& tree, const PouInfo& pou) {
  if (pou.owner == kNoPou) return false;
  const std::string_view name = pou.decl->name.text;
  return ir::same_name(name, kFbInit) || ir::same_name(name, kFbExit) ||
         ir::same_name(name, kFbReinit) ||
         tree.find_attribute(pou.decl->attributes, kCallAfterInit) != nullptr;
}

// A block that makes itself known, or leaves its mark elsewhere, is used by that.
bool is_used_by_its_init(const Declarations& declared, const ir::TypeTable& types, ir::TypeId id) {
  while (types.contains(id) && types[id].kind == ir::Kind::kArray) id = types[id].base;
  const auto found = declared.pou_by_type.find(id);
  if (found == declared.pou_by_type.end()) return false;
  for (uint32_t block = found->second; block != kNoPou; block = declared.pous[block].base) {
    const auto& code = declared.pous[block].code;
    const auto init = code.find(kFbInit);
    if (init == code.end() || init->second.method == kNoPou) continue;
    if (declared.pous[init->second.method].reaches_out) return true;
  }
  return false;
}

// Covers functions and methods; a prototype has no body that could assign.
void report_unassigned_results(const Phase& phase) {
  for (const PouInfo& pou : phase.sema().declared.pous) {
    if (pou.library || pou.open || pou.made != MadeCode::kNone || !pou.result.valid()) continue;
    const PouKind kind = pou.decl->kind;
    if (kind != PouKind::kFunction && kind != PouKind::kMethod) continue;
    const bool prototype =
        pou.owner != kNoPou &&
        (pou.decl->is_abstract ||
         phase.sema().declared.pous[pou.owner].decl->kind == PouKind::kInterface);
    if (prototype || is_called_by_system(phase.sema().tree, pou)) continue;
    if (phase.resolve(pou.result).written) continue;
    phase.warning(DiagnosticCode::kResultNeverAssigned, pou.decl->name.span,
                  "`" + std::string(pou.decl->name.text) + "` never assigns its result",
                  "assign it: `" + std::string(pou.decl->name.text) + " := ...`");
  }
}

}  // namespace

// After errors much is unused that will not stay so.
void report_unused(const Phase& phase) {
  // Values that stay what their type begins with. Retained ones may come from somewhere.
  auto never_written = [&phase](const Variable& variable) {
    return !variable.written && !variable.constant && !variable.retain && !variable.hidden &&
           !variable.decl->init.valid() && variable.type.valid() &&
           phase.sema().program.types.is_scalar(variable.type) &&
           !phase.sema().program.types.is_reference(variable.type) &&
           !phase.sema().program.types[variable.type].init.valid();
  };
  if (phase.sema().report.has_hard_errors()) return;
  report_unassigned_results(phase);
  report_other_attributes(phase);
  for (const Variable& variable : phase.sema().declared.variables) {
    bool private_section = variable.section == VarSection::kLocal ||
                           variable.section == VarSection::kTemp ||
                           variable.section == VarSection::kStatic;
    if (variable.access == Access::kPublic) continue;  // as an output
    if (!private_section || variable.decl == nullptr) continue;
    if (variable.decl->has_address || variable.decl->implied) continue;
    if (variable.pou != kNoPou && phase.sema().declared.pous[variable.pou].open) continue;
    if (variable.used) {
      if (never_written(variable)) {
        phase.warning(
            DiagnosticCode::kNeverWritten, variable.name.span,
            "`" + std::string(variable.name.text) + "` is read, but nothing here writes it",
            "give it an initial value, if that is what it is for");
      }
      continue;
    }
    if (is_used_by_its_init(phase.sema().declared, phase.sema().program.types, variable.type)) {
      continue;
    }
    phase.warning(DiagnosticCode::kUnusedVariable, variable.name.span,
                  "`" + std::string(variable.name.text) + "` is never used");
  }
}

}  // namespace frontend
