// Names that the standard does not take.
#include "frontend/sema/declarations/interfaces.h"
#include "frontend/sema/sema.h"

namespace frontend {

// An identifier has no two underlines in a row (edition 3, 6.1.2).
void Interfaces::check_underlines() {
  if (sema_.options.dialect != Dialect::kIec) return;
  auto check = [this](const Name& name) {
    if (name.text.find("__") == std::string_view::npos) return;
    allow_extension("a name with two underlines in a row", name.span);
  };
  for (const Variable& variable : sema_.declared.variables) {
    if (variable.decl != nullptr && !variable.hidden) check(variable.name);
  }
  for (const PouInfo& pou : sema_.declared.pous) {
    if (pou.meaning == nullptr && !pou.test) check(pou.decl->name);  // a test has a text
  }
  for (const TypeDecl& type : sema_.tree.types) check(type.name);
  for (const Spec& spec : sema_.tree.specs) {
    for (const Enumerator& enumerator : spec.enumerators) check(enumerator.name);
    for (const VarDecl& field : spec.fields) {
      for (const Name& name : field.names) check(name);
    }
  }
}

}  // namespace frontend
