#include "frontend/sema/constants/start_values.h"
#include "frontend/sema/constants/constants.h"

#include "base/hash.h"
#include "frontend/sema/sema.h"
#include "ir/types/handle.h"

namespace frontend {

ir::ConstId StartValues::add(const PouScope& scope, ExprId id) {
  const base::SourceSpan span = sema_.tree[id].span;
  const uint32_t file = sema_.sources.file_of(span.begin);
  const uint32_t begin = sema_.sources.begin(file).offset;
  std::string text(sema_.sources.text(file).substr(span.begin.offset - begin,
                                                   span.end.offset - span.begin.offset));
  text = scope_name(scope) + ":" + ir::fold_name(text);
  for (uint64_t seed = 0;; ++seed) {
    const uint64_t handle = ir::unbound_handle(base::hash64(base::as_bytes(text), seed));
    auto [found, added] = expressions_.try_emplace(handle, Expression{id, text});
    if (added || found->second.text == text) return sema_.program.constants.scalar(handle);
  }
}

// The name of the POU that is looked at; "" outside of all.
std::string StartValues::scope_name(const PouScope& scope) const {
  if (scope.pou == nullptr) return {};
  const PouInfo& pou = *scope.pou;
  if (pou.self.valid()) return ir::fold_name(sema_.program.types[pou.self].name);
  return ir::fold_name(pou.decl->name.text);
}

ExprId StartValues::find(uint64_t handle) const {
  auto found = expressions_.find(handle);
  return found == expressions_.end() ? ExprId() : found->second.expr;
}

bool StartValues::inside(ir::TypeId type, ir::ConstId init) {
  if (expressions_.empty() || !type.valid()) return false;
  if (auto known = inside_.find({type, init}); known != inside_.end()) return known->second;
  const bool result = look_inside(type, init);
  inside_[{type, init}] = result;
  return result;
}

bool StartValues::look_inside(ir::TypeId id, ir::ConstId init) {
  const ir::Program& program = sema_.program;
  const ir::Type type = program.types[id];
  if (!init.valid()) init = type.init;
  if (program.types.is_reference(id)) {
    return init.valid() && find(program.constants[init].bits).valid();
  }
  std::vector<ir::ConstElement> given;
  if (init.valid()) given = program.constants[init].elements;
  if (type.kind == ir::Kind::kArray) {
    bool found = inside(type.base, {});
    for (const ir::ConstElement& element : given) found = found || inside(type.base, element.value);
    return found;
  }
  if (!program.types.has_members(id) || program.types.overlaps(id)) return false;
  for (uint32_t i = 0; i < type.members.size(); ++i) {
    const ir::Member& member = type.members[i];
    if (!ir::is_listed(member)) continue;
    const ir::ConstId listed = Constants(sema_).listed(init, i);
    const bool own = ir::is_structure(type.kind) || listed.valid();
    if (own && inside(member.type, listed.valid() ? listed : member.init)) return true;
  }
  return false;
}

}  // namespace frontend
