#include "ir/types/types.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "base/limits.h"

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

std::string bounds_text(int64_t low, int64_t high) {
  return std::to_string(low) + ".." + std::to_string(high);
}

std::string dimensions_text(const std::vector<Dimension>& dims) {
  std::string text;
  for (const Dimension& dim : dims) {
    text += (text.empty() ? "" : ",") + bounds_text(dim.low, dim.high);
  }
  return text;
}

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

namespace {

// Spells a type out. Text and depth are bounded because an anonymous structure
// of a damaged image may contain itself; what is cut off is told apart by its id.
class TypeText {
 public:
  explicit TypeText(const TypeTable& types) : types_(types) {}

  std::string take() { return std::move(text_); }

  void append(TypeId id, uint32_t depth) {
    if (!types_.contains(id)) {
      text_ += "?";
    } else if (const Type& type = types_[id]; !type.name.empty()) {
      text_ += type.name;
    } else if (depth > base::kMaxNesting || text_.size() > kMaxText) {
      text_ += "...#" + std::to_string(id.index);
    } else {
      append_anonymous(type, depth + 1);
    }
  }

 private:
  static constexpr size_t kMaxText = 64 * 1024;

  void append_anonymous(const Type& type, uint32_t depth) {
    switch (type.kind) {
      case Kind::kString:
        text_ += "STRING[" + std::to_string(type.capacity) + "]";
        break;
      case Kind::kWstring:
        text_ += "WSTRING[" + std::to_string(type.capacity) + "]";
        break;
      case Kind::kSubrange:
        append(type.base, depth);
        text_ += "(" + range_text(type) + ")";
        break;
      case Kind::kArray:
        text_ += "ARRAY[" + dimensions_text(type.dims) + "] OF ";
        append(type.base, depth);
        break;
      case Kind::kPointer:
      case Kind::kRefTo:
      case Kind::kReferenceTo:
        text_ += reference_word(type.kind);
        append(type.base, depth);
        break;
      case Kind::kEnum:
        append_enum(type, depth);
        break;
      case Kind::kInterface:
        text_ += "INTERFACE";
        break;
      default:
        append_members(type, depth);
    }
  }

  // Bounds of ULINT and LWORD are bit patterns.
  std::string range_text(const Type& type) const {
    const Kind root = types_.contains(type.base) ? types_.root_kind(type.base) : Kind::kLint;
    return root == Kind::kUlint || root == Kind::kLword
               ? std::to_string(static_cast<uint64_t>(type.low)) + ".." +
                     std::to_string(static_cast<uint64_t>(type.high))
               : bounds_text(type.low, type.high);
  }

  void append_enum(const Type& type, uint32_t depth) {
    append(type.base, depth);
    text_ += " (";
    for (const EnumLiteral& literal : type.literals) {
      text_ +=
          (text_.back() == '(' ? "" : ", ") + literal.name + " := " + std::to_string(literal.value);
    }
    text_ += ")";
  }

  static std::string_view reference_word(Kind kind) {
    return kind == Kind::kPointer ? "POINTER TO "
           : kind == Kind::kRefTo ? "REF_TO "
                                  : "REFERENCE TO ";
  }

  void append_members(const Type& type, uint32_t depth) {
    const bool is_union = type.kind == Kind::kUnion;
    text_ += is_union ? "UNION " : type.overlap ? "STRUCT OVERLAP " : "STRUCT ";
    for (const Member& member : type.members) {
      text_ += member.name + " : ";
      append(member.type, depth);
      text_ += "; ";
    }
    text_ += is_union ? "END_UNION" : "END_STRUCT";
  }

  const TypeTable& types_;
  std::string text_;
};

}  // namespace

std::string TypeTable::text(TypeId id) const {
  TypeText text(*this);
  text.append(id, 0);
  return text.take();
}

std::string TypeTable::shown(TypeId id) const {
  constexpr size_t kMaxShown = 200;
  std::string all = text(id);
  if (all.size() <= kMaxShown || (contains(id) && !types_[id.index].name.empty())) return all;
  all.resize(std::min(all.rfind(' ', kMaxShown), kMaxShown));  // between words
  return all + " ...";
}

}  // namespace ir
