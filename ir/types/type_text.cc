// Types as people read them.
#include <algorithm>

#include "base/limits.h"
#include "ir/types/bounds_text.h"

namespace ir {

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
