#include <algorithm>
#include <optional>
#include <unordered_set>

#include <unordered_set>
#include "base/limits.h"

#include "ir/program/verify_parts.h"
#include "ir/types/parts.h"

namespace ir {
namespace {

class TypesVerifier {
 public:
  explicit TypesVerifier(const TypeTable& types)
      : types_(types), state_(types.size(), State::kNew), leaves_(types.size(), 0) {}

  base::Status verify() {
    for (uint32_t i = 0; i < types_.size() && reason_.empty(); ++i) {
      check_type(TypeId(i));
    }
    for (uint32_t i = 0; i < types_.size() && reason_.empty(); ++i) {
      count_leaves(TypeId(i), 0);
    }
    for (uint32_t i = 0; i < types_.size() && reason_.empty(); ++i) {
      require(!types_.overlaps(TypeId(i)) || !holds_instance(types_, TypeId(i)), TypeId(i),
              "a union holds an instance");
    }
    if (!reason_.empty()) {
      return not_verified("type " + reason_);
    }
    return base::Ok{};
  }

 private:
  enum class State : uint8_t { kNew, kOpen, kDone };

  void fail(TypeId id, const std::string& why) {
    if (reason_.empty()) {
      reason_ = "%" + std::to_string(id.index) + " " + types_[id].name + ": " + why;
    }
  }

  void require(bool holds, TypeId id, const char* why) {
    if (!holds) {
      fail(id, why);
    }
  }

  void check_type(TypeId id) {
    const Type& type = types_[id];
    check_ancestors(id, type);
    require(is_elementary(type.kind) || type.kind > Kind::kChar, id, "unknown kind");
    switch (type.kind) {
      case Kind::kString:
      case Kind::kWstring:
        require(type.capacity <= base::kMaxStringCapacity, id, "capacity above the limit");
        break;
      case Kind::kEnum:
      case Kind::kSubrange:
        check_scalar_type(id, type);
        break;
      case Kind::kArray:
        check_array(id, type);
        break;
      case Kind::kPointer:
      case Kind::kRefTo:
      case Kind::kReferenceTo:
        require(types_.contains(type.base) && types_[type.base].kind != Kind::kGlobals, id,
                "target type does not exist");
        break;
      default:
        check_members(id, type);
    }
  }

  void check_scalar_type(TypeId id, const Type& type) {
    const bool integer =
        types_.contains(type.base) && types_.is_scalar(id) && is_integer(types_.scalar(id));
    require(integer, id, "the base is no integer type");
    // Bounds of ULINT and LWORD are bit patterns.
    const bool ordered = integer && types_.scalar(id) == Scalar::kU64
                             ? static_cast<uint64_t>(type.low) <= static_cast<uint64_t>(type.high)
                             : type.low <= type.high;
    require(ordered, id, "empty range");
  }

  void check_array(TypeId id, const Type& type) {
    require(types_.contains(type.base), id, "element type does not exist");
    require(!type.dims.empty() && type.dims.size() <= base::kMaxDimensions, id,
            "number of dimensions");
    uint64_t elements = 1;
    for (const Dimension& dim : type.dims) {
      require(dim.low <= dim.high, id, "empty dimension");
      const uint64_t extent = static_cast<uint64_t>(dim.high) - static_cast<uint64_t>(dim.low);
      require(extent < base::kMaxTypeBytes, id, "too many elements");
      elements = reason_.empty() ? elements * (extent + 1) : 1;
      require(elements <= base::kMaxTypeBytes, id, "too many elements");
    }
  }

  void check_members(TypeId id, const Type& type) {
    require(type.members.empty() || types_.has_members(id), id, "members of a scalar type");
    std::unordered_set<std::string> names;  // values of a running program are found by them
    for (const Member& member : type.members) {
      require(member.name.empty() || names.insert(fold_name(member.name)).second, id,
              "two members with one name");
      require(types_.contains(member.type), id, "type of a member does not exist");
      require(!types_.overlaps(id) || member.address.area == DirectArea::kNone, id,
              "a member of a union has an I/O address");
      require(member.section != Section::kInOut || types_.is_instance(id), id,
              "in-out outside of an instance");
      require(member.section != Section::kStamp ||
                  (types_.contains(member.type) && types_[member.type].kind == Kind::kDword &&
                   (types_.is_instance(id) || type.kind == Kind::kGlobals)),
              id, "a stamp that is no DWORD of an instance");
      if (types_.contains(member.type)) {
        const Kind kind = types_[member.type].kind;
        require((kind != Kind::kProgram || type.kind == Kind::kGlobals) && kind != Kind::kGlobals,
                id, "a program cannot be a member");
        require(kind != Kind::kInterface, id, "an interface cannot be a member");
      }
    }
  }

  void check_ancestors(TypeId id, const Type& type) {
    const bool block = type.kind == Kind::kFunctionBlock;
    require(type.interfaces.empty() || block || type.kind == Kind::kInterface, id,
            "interfaces of something that is no block");
    for (const TypeId parent : type.interfaces) {
      require(types_.contains(parent) && types_[parent].kind == Kind::kInterface, id,
              "it implements what is no interface");
      check_inherits_interfaces(id, type, parent);
    }
    if (block && type.base.valid()) {
      check_base(id, type);
      check_inherits_interfaces(id, type, type.base);
    }
  }

  void check_inherits_interfaces(TypeId id, const Type& type, TypeId from) {
    if (!reason_.empty()) {
      return;
    }
    for (const TypeId parent : types_[from].interfaces) {
      const auto& own = type.interfaces;
      require(parent != id && std::find(own.begin(), own.end(), parent) != own.end(), id,
              "its interfaces leave out an inherited one");
    }
  }

  void check_base(TypeId id, const Type& type) {
    const bool exists =
        types_.contains(type.base) && types_[type.base].kind == Kind::kFunctionBlock;
    require(exists, id, "the base is no function block");
    uint32_t depth = 0;
    for (TypeId base = type.base; types_.contains(base) && depth <= base::kMaxNesting; ++depth) {
      base = types_[base].base;
    }
    require(depth <= base::kMaxNesting, id, "it extends itself, or too many others");
    if (!reason_.empty()) {
      return;
    }
    const std::vector<Member>& inherited = types_[type.base].members;
    require(inherited.size() <= type.members.size(), id, "members of the base are missing");
    for (size_t i = 0; i < inherited.size() && reason_.empty(); ++i) {
      require(inherits(type.members[i], inherited[i]), id,
              "its first members are not those of its base");
    }
  }

  static bool inherits(const Member& member, const Member& of_base) {
    return same_name(member.name, of_base.name) && member.type == of_base.type &&
           member.section == of_base.section && member.constant == of_base.constant &&
           member.address == of_base.address;
  }

  // Scalars and strings in a value of the type, instances included: bounds both
  // memory and the depth of everything that walks a value.
  uint64_t count_leaves(TypeId id, uint32_t depth) {
    if (!reason_.empty() || state_[id.index] == State::kDone) {
      return leaves_[id.index];
    }
    if (state_[id.index] == State::kOpen || depth > base::kMaxNesting) {
      fail(id, "contains itself, or nests too deeply");
      return 0;
    }
    state_[id.index] = State::kOpen;
    leaves_[id.index] = sum_leaves(types_[id], depth);
    state_[id.index] = State::kDone;
    // What has an area of its own may hold several of the largest variables.
    bool area = types_.is_instance(id) || types_[id].kind == Kind::kGlobals;
    uint64_t limit = area ? uint64_t{base::kMaxDataBytes} : uint64_t{base::kMaxTypeBytes};
    require(leaves_[id.index] <= limit, id, "larger than the limit");
    return leaves_[id.index];
  }

  uint64_t sum_leaves(const Type& type, uint32_t depth) {
    if (type.kind == Kind::kArray) {
      uint64_t elements = 1;
      for (const Dimension& dim : type.dims) {
        elements *= dim.count();
      }
      return elements * count_leaves(type.base, depth + 1);
    }
    if (type.members.empty()) {
      return 1;
    }
    uint64_t sum = 1;
    for (const Member& member : type.members) {
      // An in-out is an address and a program in the globals another's ID, so their types
      // are visited for themselves only.
      const bool elsewhere =
          member.section == Section::kInOut || types_[member.type].kind == Kind::kProgram;
      sum += elsewhere ? 1 : count_leaves(member.type, depth + 1);
    }
    return sum;
  }

  const TypeTable& types_;
  std::vector<State> state_;
  std::vector<uint64_t> leaves_;
  std::string reason_;
};

}  // namespace

base::Status verify_types(const TypeTable& types) { return TypesVerifier(types).verify(); }

}  // namespace ir
