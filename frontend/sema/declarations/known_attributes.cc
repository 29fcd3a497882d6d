// Attributes of other tools that change what a program does, and do not here.
#include <algorithm>
#include <string_view>

#include "frontend/sema/declarations/unused.h"
#include "frontend/sema/phase.h"

namespace frontend {
namespace {

struct OtherAttribute {
  std::string_view name;
  const char* what;
  const char* instead;
};

constexpr OtherAttribute kOthers[] = {
    {"pack_mode", "members are aligned",
     "copy members one by one where bytes have to stand in an order"},
    {"call_after_init", "nothing is called after FB_Init", "call the method in FB_Init, or once"},
    {"initialize_on_call", "an input that a call leaves out keeps its value",
     "give the input a value in each call"},
    {"subsequent", "variables lie where the compiler puts them", "use an array or a structure"},
    {"instance-path", "the text stays as it is declared", "give the name as an input"},
};

}  // namespace

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
}

}  // namespace frontend
