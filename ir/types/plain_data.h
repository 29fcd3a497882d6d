// Plain data: values that mean the same wherever they are copied, since they hold no reference and
// no function block.
#pragma once

#include <optional>
#include <vector>

#include "base/hash.h"
#include "ir/types/layout.h"

namespace ir {

// Elementary values, strings, and structures and arrays of such; without an address of their own.
bool is_plain_data(const TypeTable& types, TypeId id);

// The digest of plain data: two types with the same digest, also of two programs, have the same
// values in the same order, whatever lies between them. nullopt: it is none, or it has more than
// kMaxPlainParts parts (an array of scalars is one).
inline constexpr uint32_t kMaxPlainParts = 1u << 20;
std::optional<base::Digest> plain_signature(const TypeTable& types, const Layouts& layouts,
                                            TypeId id);

// Where the bytes of such a value lie, in the order of its signature, without what lies between
// members: neighbours are one run.
struct PlainRun {
  uint32_t offset = 0;
  uint32_t size = 0;
  bool bools = false;  // of BOOLs alone, each 0 or 1
};
std::vector<PlainRun> plain_runs(const TypeTable& types, const Layouts& layouts, TypeId id);

}  // namespace ir
