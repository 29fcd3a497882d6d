#include <algorithm>

#include "ir/types/layout.h"
#include "ir/types/member_finder.h"

namespace ir {
namespace {

constexpr uint32_t kMaxComparedDepth = 1000;

struct Side {
  const TypeTable& types;
  const Layouts& layouts;
};

// Has every literal of the old type its value in the new one? Others may have come.
bool keeps_literals(const Type& old_type, const Type& new_type) {
  const std::vector<EnumLiteral>& now = new_type.literals;
  size_t at = 0;  // literals mostly stay in their order
  for (const EnumLiteral& literal : old_type.literals) {
    const auto same = [&](const EnumLiteral& other) { return same_name(other.name, literal.name); };
    auto found = std::find_if(now.begin() + static_cast<ptrdiff_t>(at), now.end(), same);
    if (found == now.end()) found = std::find_if(now.begin(), now.end(), same);
    if (found == now.end() || found->value != literal.value) return false;
    at = static_cast<size_t>(found - now.begin()) + 1;
  }
  return true;
}

bool same(const Side& old_side, TypeId old_type, const Side& new_side, TypeId new_type,
          uint32_t depth);

// Members are found by name: their order in the source means nothing.
bool same_members(const Side& old_side, TypeId old_type, const Side& new_side, TypeId new_type,
                  uint32_t depth) {
  const std::vector<Member>& old_members = old_side.types[old_type].members;
  const std::vector<Member>& new_members = new_side.types[new_type].members;
  if (old_members.size() != new_members.size()) return false;
  MemberFinder finder(old_side.types, old_type);
  for (size_t i = 0; i < new_members.size(); ++i) {
    const std::optional<size_t> number = finder.find(new_members[i].name);
    if (!number) return false;
    if (old_side.layouts[old_type].member_offsets[*number] !=
        new_side.layouts[new_type].member_offsets[i]) {
      return false;
    }
    if (!same(old_side, old_members[*number].type, new_side, new_members[i].type, depth + 1)) {
      return false;
    }
  }
  return true;
}

bool same(const Side& old_side, TypeId old_type, const Side& new_side, TypeId new_type,
          uint32_t depth) {
  const Type& a = old_side.types[old_type];
  const Type& b = new_side.types[new_type];
  if (a.kind != b.kind || depth > kMaxComparedDepth || !same_name(a.name, b.name)) return false;
  switch (a.kind) {
    case Kind::kString:
    case Kind::kWstring:
      return a.capacity == b.capacity;
    case Kind::kEnum:
      return keeps_literals(a, b) && same(old_side, a.base, new_side, b.base, depth + 1);
    case Kind::kSubrange:
      return a.low == b.low && a.high == b.high &&
             same(old_side, a.base, new_side, b.base, depth + 1);
    case Kind::kArray:
      return a.dims == b.dims && same(old_side, a.base, new_side, b.base, depth + 1);
    case Kind::kPointer:
    case Kind::kRefTo:
    case Kind::kReferenceTo:
      // A handle means the same whatever its target is made of, and a target may lead back here.
      return same_name(old_side.types.text(a.base), new_side.types.text(b.base));
    case Kind::kStruct:
    case Kind::kUnion:
      return a.overlap == b.overlap &&
             old_side.layouts[old_type].size == new_side.layouts[new_type].size &&
             same_members(old_side, old_type, new_side, new_type, depth);
    default:
      return true;  // elementary; instances: an ID slot for the same type name
  }
}

}  // namespace

bool same_value_type(const TypeTable& old_types, const Layouts& old_layouts, TypeId old_type,
                     const TypeTable& new_types, const Layouts& new_layouts, TypeId new_type) {
  return same({old_types, old_layouts}, old_type, {new_types, new_layouts}, new_type, 0);
}

}  // namespace ir
