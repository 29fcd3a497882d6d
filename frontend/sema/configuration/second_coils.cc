// A global has one coil among the ladders of the programs that run by themselves: the program that
// runs last decides, and the others have no effect. Coils of one body are another matter
// (network/suspicious.h), and bodies that somebody calls may take turns.
#include <optional>
#include <set>
#include <utility>

#include "frontend/network/suspicious.h"
#include "frontend/sema/configuration/common_uses.h"
#include "frontend/sema/declarations/namespaces.h"
#include "frontend/sema/declarations/variables.h"
#include "ir/types/address_text.h"

namespace frontend {
namespace {

// The global, and what of it; a direct address has none and is all text. Nothing for what belongs
// to the program.
using CoilPlace = std::pair<uint32_t, std::string>;

std::string_view head_of(std::string_view place) {
  return place.substr(0, place.find_first_of(".["));
}

std::optional<CoilPlace> global_of(const Sema& sema, VarId id, std::string_view rest) {
  const Variable* variable = &sema.declared.variables[id.index];
  if (variable->external.valid()) id = variable->external;
  if (sema.declared.variables[id.index].same_as.valid())
    id = sema.declared.variables[id.index].same_as;
  variable = &sema.declared.variables[id.index];
  if (variable->decl != nullptr && variable->decl->has_address && !variable->decl->incomplete) {
    const std::string address = ir::fold_name(ir::address_text(variable->decl->address));
    return CoilPlace{VarId().index, address + std::string(rest)};
  }
  if (variable->pou != kNoPou) return std::nullopt;
  return CoilPlace{id.index, std::string(rest)};
}

std::optional<CoilPlace> place_of(Sema& sema, const PouInfo& pou, const network::PlainCoil& coil) {
  std::string_view rest = coil.place;
  if (rest.starts_with('%')) return CoilPlace{VarId().index, coil.place};
  const base::SourceSpan span = coil.element->operand.span;
  const std::string_view head = head_of(rest);
  rest.remove_prefix(head.size());
  const Name name{head, span};
  const VarId own = Variables(sema, PouScope(pou)).find_variable(name);
  if (own.valid()) return global_of(sema, own, rest);
  // List.name
  const auto list = sema.declared.lists.find(sema.namespaces.find(NameSort::kList, name));
  if (list == sema.declared.lists.end() || !rest.starts_with('.')) return std::nullopt;
  rest.remove_prefix(1);
  const std::string_view member = head_of(rest);
  rest.remove_prefix(member.size());
  const auto global = list->second.names.find(member);
  if (global == list->second.names.end()) return std::nullopt;
  return global_of(sema, global->second, rest);
}

}  // namespace

void CommonUses::check_second_coils() {
  struct First {
    const PouInfo* pou;
    base::SourceSpan span;
  };
  std::map<CoilPlace, First> coils;
  std::set<const PouInfo*> seen;
  for (const ir::ProgramInstance& instance : sema_.program.instances) {
    const PouInfo* const pou = sema_.declared.pou_of(instance.type);
    if (pou == nullptr || pou->library || pou->test || !seen.insert(pou).second) continue;
    if (instance.task == ir::kNoTask || pou->called || pou->decl->diagram == kNoDiagram) continue;
    std::set<CoilPlace> told;
    for (const network::PlainCoil& coil :
         network::plain_coils(sema_.tree.diagrams[pou->decl->diagram])) {
      std::optional<CoilPlace> place = place_of(sema_, *pou, coil);
      if (!place) continue;
      const network::Text& operand = coil.element->operand;
      const auto [first, fresh] = coils.emplace(*place, First{pou, operand.span});
      if (fresh || first->second.pou == pou || !told.insert(*std::move(place)).second) continue;
      sema_.report.warning(DiagnosticCode::kSecondCoil, operand.span,
                           "`" + operand.text + "` has a coil in `" +
                               std::string(first->second.pou->decl->name.text) +
                               "`, too; only the one that runs last has an effect",
                           "join both conditions in one rung, or use (S) and (R)",
                           {{first->second.span, "its first coil"}});
    }
  }
}

}  // namespace frontend
