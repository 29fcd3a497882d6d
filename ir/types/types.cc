#include "ir/types/types.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "base/limits.h"
#include "ir/types/bounds_text.h"

namespace ir {
namespace {

constexpr auto kScalarNames = std::to_array<std::string_view>({
#define SCALAR(id, text, bytes) text,
#include "ir/types/scalars.def"
#undef SCALAR
});
static_assert(kScalarNames.size() == kScalarCount);

struct ElementaryRow {
  std::string_view name;
  Scalar scalar;
  Group group;
};
constexpr auto kElementary = std::to_array<ElementaryRow>({
#define ELEMENTARY(id, name, scalar, group) {name, Scalar::scalar, Group::group},
#include "ir/types/elementary.def"
#undef ELEMENTARY
});
static_assert(kElementary.size() == kElementaryCount);

const ElementaryRow& row(Kind kind) { return kElementary[static_cast<size_t>(kind)]; }

}  // namespace

uint64_t Type::element_count() const {
  uint64_t count = 1;
  for (const Dimension& dim : dims) count *= dim.count();
  return count;
}

std::string_view scalar_name(Scalar scalar) { return kScalarNames[static_cast<size_t>(scalar)]; }
std::string_view elementary_name(Kind kind) {
  return is_elementary(kind) ? row(kind).name : std::string_view();
}
Group elementary_group(Kind kind) { return is_elementary(kind) ? row(kind).group : Group::kNone; }

TypeTable::TypeTable() {
  for (uint32_t i = 0; i < kElementaryCount; ++i) {
    Type type;
    type.kind = static_cast<Kind>(i);
    type.name = elementary_name(type.kind);
    types_.push_back(std::move(type));
  }
}

TypeId TypeTable::declare(Type type) {
  types_.push_back(std::move(type));
  return TypeId(size() - 1);
}

OldNameId TypeTable::add_old_name(std::string name) {
  old_names_.push_back(std::move(name));
  return OldNameId(static_cast<uint32_t>(old_names_.size() - 1));
}

TypeId TypeTable::intern(std::string key, Type type) {
  auto [found, inserted] = interned_.try_emplace(std::move(key), TypeId(size()));
  if (inserted) {
    types_.push_back(std::move(type));
  }
  if (found->second.index == next_in_turn_) {
    ++next_in_turn_;
  } else if (found->second.index > next_in_turn_) {
    in_turn_ = false;
  }
  return found->second;
}

TypeId TypeTable::string(uint32_t capacity) {
  Type type;
  type.kind = Kind::kString;
  type.capacity = capacity;
  return intern("S" + std::to_string(capacity), std::move(type));
}

TypeId TypeTable::wstring(uint32_t capacity) {
  Type type;
  type.kind = Kind::kWstring;
  type.capacity = capacity;
  return intern("W" + std::to_string(capacity), std::move(type));
}

TypeId TypeTable::array(TypeId element, std::vector<Dimension> dims) {
  std::string key = "A" + std::to_string(element.index) + "[" + dimensions_text(dims);
  Type type;
  type.kind = Kind::kArray;
  type.base = element;
  type.dims = std::move(dims);
  return intern(std::move(key), std::move(type));
}

TypeId TypeTable::subrange(TypeId base, int64_t low, int64_t high) {
  std::string key = "R" + std::to_string(base.index) + "(" + bounds_text(low, high);
  Type type;
  type.kind = Kind::kSubrange;
  type.base = base;
  type.low = low;
  type.high = high;
  return intern(std::move(key), std::move(type));
}

TypeId TypeTable::reference(Kind kind, TypeId target) {
  base::check(ir::is_reference(kind), "reference() of another kind");
  Type type;
  type.kind = kind;
  type.base = target;
  return intern(
      "P" + std::to_string(static_cast<uint32_t>(kind)) + "," + std::to_string(target.index),
      std::move(type));
}

// The table may come from a damaged image, so the chain of bases may be endless.
Kind TypeTable::kind_below(TypeId id) const {
  Kind kind = Kind::kStruct;
  for (uint32_t depth = 0; depth < base::kMaxNesting && contains(id); ++depth) {
    kind = types_[id.index].kind;
    if (kind != Kind::kSubrange && kind != Kind::kEnum) {
      return kind;
    }
    id = types_[id.index].base;
  }
  return kind;
}

Scalar TypeTable::scalar(TypeId id) const {
  const Kind root = root_kind(id);
  if (ir::is_reference(root)) {
    return Scalar::kU64;
  }
  base::check(is_elementary(root), "scalar() of a type that is not scalar");
  return row(root).scalar;
}

bool TypeTable::has_members(TypeId id) const {
  return contains(id) && types_[id.index].kind >= Kind::kStruct &&
         types_[id.index].kind <= Kind::kGlobals;
}

// The table may come from a damaged image, so the chain of bases may be endless.
bool TypeTable::is_a(TypeId id, TypeId wanted) const {
  if (contains(id) && id != wanted) {
    const std::vector<TypeId>& interfaces = types_[id.index].interfaces;
    if (std::find(interfaces.begin(), interfaces.end(), wanted) != interfaces.end()) {
      return true;
    }
  }
  for (uint32_t depth = 0; depth < base::kMaxNesting && contains(id) && id != wanted; ++depth) {
    id = types_[id.index].kind == Kind::kFunctionBlock ? types_[id.index].base : TypeId();
  }
  return id.valid() && id == wanted;
}

int32_t TypeTable::find_member(TypeId id, std::string_view name) const {
  const std::vector<Member>& members = types_[id.index].members;
  for (size_t i = 0; i < members.size(); ++i) {
    if (same_name(members[i].name, name)) {
      return static_cast<int32_t>(i);
    }
  }
  return -1;
}

}  // namespace ir
