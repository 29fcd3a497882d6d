#include "ir/types/parts.h"

namespace ir {

bool holds_instance(const TypeTable& types, TypeId type) {
  return any_part(types, type, [&](TypeId part) { return types.is_instance(part); });
}

}  // namespace ir
