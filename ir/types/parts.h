// Of what a value is made.
#pragma once

#include <unordered_set>
#include <vector>

#include "ir/types/types.h"

namespace ir {

// The type of the elements of an array of any depth; any other type is its own.
inline TypeId element_of(const TypeTable& types, TypeId type) {
  while (types.contains(type) && types[type].kind == Kind::kArray) type = types[type].base;
  return type;
}

// Is `test` true of a structure or union, or of one in it at any depth, and one of its members?
// Instances and references are not entered. Looks at each type once: of thirty structures that hold
// the one before twice, the last has a billion parts.
template <class Test>
bool any_member(const TypeTable& types, TypeId type, Test test) {
  std::vector<TypeId> open{element_of(types, type)};
  std::unordered_set<TypeId> seen;
  while (!open.empty()) {
    const TypeId at = open.back();
    open.pop_back();
    if (!types.contains(at) || !is_structure(types[at].kind) || !seen.insert(at).second) continue;
    for (const Member& member : types[at].members) {
      if (test(member)) return true;
      open.push_back(element_of(types, member.type));
    }
  }
  return false;
}

// Is `test` true of the type of elements, or of one of what these are made of?
template <class Test>
bool any_part(const TypeTable& types, TypeId type, Test test) {
  const auto part = [&](TypeId id) { return test(element_of(types, id)); };
  return part(type) ||
         any_member(types, type, [&](const Member& member) { return part(member.type); });
}

// Is it an instance, or does it embed one?
bool holds_instance(const TypeTable& types, TypeId type);

}  // namespace ir
