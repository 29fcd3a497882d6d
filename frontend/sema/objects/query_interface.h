// `__SYSTEM.IQueryInterface`, which CODESYS sources extend so that __QUERYINTERFACE works.
// Here it works for every interface: the name adds nothing.
#pragma once

#include "frontend/parse/tree.h"

namespace frontend {

inline bool is_query_interface(const Tree& tree, const Spec& spec) {
  return spec.kind == SpecKind::kNamed && spec.qualifiers.count == 1 &&
         ir::same_name(tree.names[spec.qualifiers.first].text, "__SYSTEM") &&
         ir::same_name(spec.name.text, "IQueryInterface");
}

}  // namespace frontend
