// Attributes of other tools that change what a program does, and do not here.
#include <algorithm>
#include <string_view>
#include <vector>

#include "base/diagnostics_render.h"
#include "frontend/sema/declarations/unused.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/phase.h"
#include "frontend/sema/types/types.h"

namespace frontend {
namespace {

struct OtherAttribute {
  std::string_view name;
  const char* what;
  const char* instead;
};

constexpr OtherAttribute kOthers[] = {
    {"subsequent", "variables lie where the compiler puts them", "use an array or a structure"},
    {"instance-path", "the text stays as it is declared", "give the name as an input"},
};

// It stands in front of the method and of its block.
void report_lone_call_after_init(const Phase& phase, const PouInfo& method) {
  if (method.owner == kNoPou || method.decl->kind != PouKind::kMethod) return;
  const Tree& tree = phase.sema().tree;
  const PouDecl& block = *phase.sema().declared.pous[method.owner].decl;
  const Attribute* own = tree.find_attribute(method.decl->attributes, kCallAfterInit);
  if (own == nullptr || tree.find_attribute(block.attributes, kCallAfterInit) != nullptr) return;
  phase.warning(
      DiagnosticCode::kOtherAttribute, own->name.span,
      "`call_after_init` has no effect: `" + std::string(block.name.text) + "` does not have it",
      "write it in front of the FUNCTION_BLOCK too");
}

// Where the attributes of packed structures stand, in order.
std::vector<uint32_t> packing_places(const Tree& tree) {
  std::vector<uint32_t> places;
  for (const Spec& spec : tree.specs) {
    if (packing_of(tree, spec.attributes) == 0) continue;
    for (uint32_t i = 0; i < spec.attributes.count; ++i) {
      places.push_back(tree.attributes[spec.attributes.first + i].name.span.begin.offset);
    }
  }
  std::ranges::sort(places);
  return places;
}

void report_idle_packing(const Phase& phase) {
  const Tree& tree = phase.sema().tree;
  const std::vector<uint32_t> packing = packing_places(tree);
  uint32_t last = 0;  // one that is joined to others is there twice
  for (const Attribute& attribute : tree.attributes) {
    const uint32_t at = attribute.name.span.begin.offset;
    if (!ir::same_name(kPackMode, attribute.name.text) || at == last) continue;
    if (std::ranges::binary_search(packing, at)) continue;
    last = at;
    phase.warning(DiagnosticCode::kOtherAttribute, attribute.name.span,
                  "`pack_mode` has no effect here: members are aligned",
                  "write it in front of a STRUCT or UNION, with 0, 1, 2, 4 or 8");
  }
}

void report_obsolete_instances(const Phase& phase) {
  const ir::TypeTable& types = phase.sema().program.types;
  for (const Variable& variable : phase.sema().declared.variables) {
    if (variable.decl == nullptr || variable.hidden || !types.contains(variable.type)) continue;
    ir::TypeId type = variable.type;
    while (types[type].kind == ir::Kind::kArray) type = types[type].base;
    const PouInfo* block = types.is_instance(type) ? phase.sema().declared.pou_of(type) : nullptr;
    if (block != nullptr) report_obsolete(phase, *block, variable.name.span);
  }
}

}  // namespace

void report_obsolete(const Phase& phase, const PouInfo& pou, base::SourceSpan span) {
  const Attribute* found = phase.sema().tree.find_attribute(pou.decl->attributes, "obsolete");
  if (found == nullptr) return;
  std::string text = "`" + std::string(pou.decl->name.text) + "` is obsolete";
  if (!found->value.empty()) text += ": " + base::printable(found->value);
  phase.warning(DiagnosticCode::kObsolete, span, std::move(text));
}

void report_other_attributes(const Phase& phase) {
  for (const Attribute& attribute : phase.sema().tree.attributes) {
    if (phase.sema().library.holds(attribute.name.span)) continue;
    const auto* const other = std::ranges::find_if(kOthers, [&](const OtherAttribute& one) {
      return ir::same_name(one.name, attribute.name.text);
    });
    if (other == std::end(kOthers)) continue;
    phase.warning(DiagnosticCode::kOtherAttribute, attribute.name.span,
                  "`" + std::string(other->name) + "` has no effect: " + other->what,
                  other->instead);
  }
  report_idle_packing(phase);
  report_obsolete_instances(phase);
  for (const PouInfo& pou : phase.sema().declared.pous) report_lone_call_after_init(phase, pou);
}

}  // namespace frontend
