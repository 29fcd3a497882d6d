#include <algorithm>

#include "base/limits.h"
#include "ir/bytecode/verify_parts.h"

namespace ir::verification {
namespace {

bool is_area(Kind kind) {
  return kind == Kind::kFunctionBlock || kind == Kind::kProgram || kind == Kind::kGlobals;
}

class TypesVerifier {
 public:
  explicit TypesVerifier(const Image& image)
      : image_(image), types_(image.types), facts_(image.types.size()) {}

  base::Result<std::vector<TypeFacts>> run() {
    if (image_.layouts->of.size() != types_.size()) {
      return refuse(Refusal::kBadFormat, std::to_string(types_.size()) + " types, but " +
                                             std::to_string(image_.layouts->of.size()) +
                                             " layouts");
    }
    for (uint32_t i = 0; i < types_.size(); ++i) {
      if (base::Status s = check_references(i); !s) return s.error();
    }
    if (base::Status s = order_by_embedding(); !s) return s.error();
    for (uint32_t i : order_) {
      if (base::Status s = check_layout(i); !s) return s.error();
    }
    for (uint32_t i = 0; i < types_.size(); ++i) {
      if (base::Status s = check_ancestors(i); !s) return s.error();
    }
    if (!types_.contains(image_.globals) || types_[image_.globals].kind != Kind::kGlobals) {
      return refuse(Refusal::kBadFormat, "the globals are not of a globals type");
    }
    return std::move(facts_);
  }

 private:
  base::Error bad(uint32_t type, const std::string& why) const {
    const std::string& name = types_[TypeId(type)].name;
    return refuse(Refusal::kBadFormat, "type " + std::to_string(type) +
                                           (name.empty() ? "" : " `" + name + "`") + ": " + why);
  }

  // Calls visit(type) for every type whose value is part of a value of type `i`.
  template <class Visit>
  void for_each_embedded(uint32_t i, Visit visit) const {
    const Type& type = types_[TypeId(i)];
    if (type.kind == Kind::kArray || type.kind == Kind::kEnum || type.kind == Kind::kSubrange) {
      visit(type.base);
    }
    for (const Member& member : type.members) {
      if (member.section != Section::kInOut && !types_.is_instance(member.type)) {
        visit(member.type);
      }
    }
  }

  base::Status check_references(uint32_t i) const {
    const Type& type = types_[TypeId(i)];
    if (!old_names_known(type)) return bad(i, "has an old name that is nowhere");
    const bool needs_base = type.kind == Kind::kArray || type.kind == Kind::kEnum ||
                            type.kind == Kind::kSubrange || is_reference(type.kind);
    if (needs_base && !types_.contains(type.base)) return bad(i, "its base does not exist");
    if (!needs_base && type.kind != Kind::kFunctionBlock && type.base.valid()) {
      return bad(i, "has a base, which its kind has not");
    }
    if (needs_base && types_[type.base].kind == Kind::kGlobals) {
      return bad(i, "is made of the globals");
    }
    if (type.kind == Kind::kArray && !may_be_part(type.base, false)) {
      return bad(i, "has elements that nothing can be");
    }
    if (!types_.has_members(TypeId(i)) && !type.members.empty()) return bad(i, "has members");
    for (const Member& member : type.members) {
      if (!types_.contains(member.type) || types_[member.type].kind == Kind::kGlobals) {
        return bad(i, "the type of member `" + member.name + "` does not exist");
      }
      if (!may_be_part(member.type, type.kind == Kind::kGlobals)) {
        return bad(i, "member `" + member.name + "` is of a type that no member can be of");
      }
    }
    return base::Ok{};
  }

  bool old_names_known(const Type& type) const {
    bool good = types_.knows(type.old_name);
    for (const Member& member : type.members) good = good && types_.knows(member.old_name);
    for (const EnumLiteral& literal : type.literals) good = good && types_.knows(literal.old_name);
    return good;
  }

  // Nothing is an interface; a program is a part of the globals only (and lives elsewhere).
  bool may_be_part(TypeId type, bool of_globals) const {
    const Kind kind = types_[type].kind;
    return kind != Kind::kInterface && (kind != Kind::kProgram || of_globals);
  }

  // What works on the base works on `i`: the same members at the same offsets.
  base::Status check_ancestors(uint32_t i) const {
    const Type& type = types_[TypeId(i)];
    const bool block = type.kind == Kind::kFunctionBlock;
    if (!type.interfaces.empty() && !block && type.kind != Kind::kInterface) {
      return bad(i, "implements interfaces and is no block");
    }
    for (const TypeId parent : type.interfaces) {
      const bool good = types_.contains(parent) && types_[parent].kind == Kind::kInterface;
      if (!good) return bad(i, "implements what is no interface");
    }
    if (!block || !type.base.valid()) return base::Ok{};
    uint32_t depth = 0;
    for (TypeId base = type.base; base.valid(); base = types_[base].base) {
      if (!types_.contains(base) || types_[base].kind != Kind::kFunctionBlock) {
        return bad(i, "extends what is no function block");
      }
      if (++depth > base::kMaxNesting) return bad(i, "extends itself, or too many others");
    }
    return check_inherited(i);
  }

  base::Status check_inherited(uint32_t i) const {
    const Type& type = types_[TypeId(i)];
    const std::vector<Member>& inherited = types_[type.base].members;
    if (inherited.size() > type.members.size()) return bad(i, "lacks members of its base");
    for (size_t m = 0; m < inherited.size(); ++m) {
      const Member& own = type.members[m];
      const bool same =
          same_name(own.name, inherited[m].name) && own.type == inherited[m].type &&
          own.section == inherited[m].section && own.constant == inherited[m].constant &&
          own.address == inherited[m].address &&
          image_.layouts->of[i].member_offsets[m] == image_.layouts[type.base].member_offsets[m];
      if (!same) return bad(i, "member `" + own.name + "` is not that of its base");
    }
    return base::Ok{};
  }

  // Kahn's order, parts first; also the depth of nesting.
  base::Status order_by_embedding() {
    std::vector<std::vector<uint32_t>> users(types_.size());
    std::vector<uint32_t> open(types_.size());
    for (uint32_t i = 0; i < types_.size(); ++i) {
      for_each_embedded(i, [&](TypeId part) {
        users[part.index].push_back(i);
        ++open[i];
      });
      if (open[i] == 0) order_.push_back(i);
    }
    for (size_t done = 0; done < order_.size(); ++done) {
      const uint32_t part = order_[done];
      for (uint32_t user : users[part]) {
        facts_[user].depth = std::max(facts_[user].depth, facts_[part].depth + 1);
        if (--open[user] == 0) order_.push_back(user);
      }
    }
    for (uint32_t i = 0; i < types_.size(); ++i) {
      if (open[i] != 0) return bad(i, "contains itself");
      if (facts_[i].depth > base::kMaxNesting) return bad(i, "is nested too deeply");
    }
    return base::Ok{};
  }

  base::Status check_layout(uint32_t i) {
    const Type& type = types_[TypeId(i)];
    const TypeLayout& layout = image_.layouts->of[i];
    const bool power_of_two = layout.align != 0 && (layout.align & (layout.align - 1)) == 0;
    if (!power_of_two || layout.align > 4096) return bad(i, "its alignment is no power of two");
    if (types_.has_members(TypeId(i))) return check_members(i);
    if (!layout.member_offsets.empty()) return bad(i, "has offsets of members");
    if (type.kind == Kind::kArray) return check_array(i);
    uint64_t size = 0;
    if (type.kind == Kind::kInterface) return check_size(i, 0);
    if (type.kind == Kind::kString || type.kind == Kind::kWstring) {
      if (type.capacity > base::kMaxStringCapacity) return bad(i, "its capacity is too large");
      size = (uint64_t{type.capacity} + 1) * (type.kind == Kind::kString ? 1 : 2);
    } else {
      if (!types_.is_scalar(TypeId(i))) return bad(i, "is made of something that is no scalar");
      size = scalar_size(types_.scalar(TypeId(i)));
    }
    return check_size(i, size);
  }

  base::Status check_size(uint32_t i, uint64_t size) const {
    if (size == image_.layouts->of[i].size) return base::Ok{};
    return bad(i, "takes " + std::to_string(size) + " bytes, its layout says " +
                      std::to_string(image_.layouts->of[i].size));
  }

  base::Status check_array(uint32_t i) {
    const Type& type = types_[TypeId(i)];
    if (type.dims.empty() || type.dims.size() > base::kMaxDimensions) {
      return bad(i, std::to_string(type.dims.size()) + " dimensions");
    }
    uint64_t size = image_.layouts[type.base].size;
    for (const Dimension& dim : type.dims) {
      const uint64_t steps = static_cast<uint64_t>(dim.high) - static_cast<uint64_t>(dim.low);
      if (dim.high < dim.low || steps >= base::kMaxTypeBytes) return bad(i, "bad bounds");
      size *= steps + 1;  // below 2^61: both factors are at most 2^30
      if (size > base::kMaxTypeBytes) return bad(i, "is too large");
    }
    facts_[i].has_slots = facts_[type.base.index].has_slots || types_.is_instance(type.base);
    return check_size(i, size);
  }

  base::Status check_members(uint32_t i) {
    const Type& type = types_[TypeId(i)];
    const TypeLayout& layout = image_.layouts->of[i];
    if (layout.member_offsets.size() != type.members.size()) {
      return bad(i, std::to_string(type.members.size()) + " members, but " +
                        std::to_string(layout.member_offsets.size()) + " offsets");
    }
    const uint32_t room = is_area(type.kind) ? layout.area_capacity : layout.size;
    if (room > (is_area(type.kind) ? base::kMaxDataBytes : base::kMaxTypeBytes)) {
      return bad(i, "is too large");
    }
    if (layout.used > room) {
      return bad(i, "uses " + std::to_string(layout.used) + " bytes of " + std::to_string(room));
    }
    const uint32_t limit = is_area(type.kind) ? layout.used : room;
    if (is_area(type.kind) && type.kind != Kind::kGlobals && layout.size != 4) {
      return bad(i, "its slot takes " + std::to_string(layout.size) + " bytes, not 4");
    }
    if (type.capacity > 8 || (type.capacity & (type.capacity - 1)) != 0) {
      return bad(i, "is packed by " + std::to_string(type.capacity) + ", not by 1, 2, 4 or 8");
    }
    if (types_.overlaps(TypeId(i))) return check_overlapping(i, limit);
    for (const Member& member : type.members) {
      const bool dword = types_[member.type].kind == Kind::kDword;
      if (member.section == Section::kStamp && (!is_area(type.kind) || !dword)) {
        return bad(i, "`" + member.name + "` is no stamp of an instance");
      }
      const bool slot = member.section == Section::kInOut || types_.is_instance(member.type);
      facts_[i].has_slots |= slot || facts_[member.type.index].has_slots;
    }
    return check_disjoint(i, limit);
  }

  // No slot may lie where something else can be written.
  base::Status check_overlapping(uint32_t i, uint32_t limit) const {
    const Type& type = types_[TypeId(i)];
    for (size_t m = 0; m < type.members.size(); ++m) {
      const Member& member = type.members[m];
      if (member.section == Section::kInOut || types_.is_instance(member.type) ||
          facts_[member.type.index].has_slots) {
        return bad(i, "member `" + member.name + "` overlaps others and holds an instance");
      }
      const uint32_t at = image_.layouts->of[i].member_offsets[m];
      if (at != member.address.bit_offset / 8) {
        return bad(i, "member `" + member.name + "` does not lie where its address says");
      }
      if (uint64_t{at} + image_.layouts[member.type].size > limit) {
        return bad(i, "member `" + member.name + "` ends after its end");
      }
    }
    return base::Ok{};
  }

  base::Status check_disjoint(uint32_t i, uint32_t limit) {
    const Type& type = types_[TypeId(i)];
    std::vector<std::pair<uint64_t, uint64_t>>& extents = extents_;
    extents.clear();
    bool sorted = true;
    for (size_t m = 0; m < type.members.size(); ++m) {
      const Member& member = type.members[m];
      const uint64_t begin = image_.layouts->of[i].member_offsets[m];
      const uint64_t size =
          member.section == Section::kInOut ? 4 : image_.layouts[member.type].size;
      if (begin + size > limit) {
        return bad(i, "member `" + member.name + "` ends at " + std::to_string(begin + size) +
                          ", after its end at " + std::to_string(limit));
      }
      sorted = sorted && (extents.empty() || extents.back() <= std::pair(begin, begin + size));
      extents.emplace_back(begin, begin + size);
    }
    if (!sorted) std::sort(extents.begin(), extents.end());
    for (size_t m = 1; m < extents.size(); ++m) {
      if (extents[m].first < extents[m - 1].second) {
        return bad(i, "members overlap at offset " + std::to_string(extents[m].first));
      }
    }
    return base::Ok{};
  }

  const Image& image_;
  const TypeTable& types_;
  std::vector<TypeFacts> facts_;
  std::vector<uint32_t> order_;                         // parts before what they are part of
  std::vector<std::pair<uint64_t, uint64_t>> extents_;  // of check_disjoint()
};

}  // namespace

base::Result<std::vector<TypeFacts>> verify_types(const Image& image) {
  return TypesVerifier(image).run();
}

// Initial values are read when a later version is planned: every one exists, and
// none contains itself.
base::Status verify_constants(const Image& image) {
  const ConstTable& constants = image.constants;
  const auto exists = [&](ConstId id) { return !id.valid() || constants.contains(id); };
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    const Type& type = image.types[TypeId(i)];
    bool good = exists(type.init);
    for (const Member& member : type.members) good = good && exists(member.init);
    if (!good) {
      return refuse(Refusal::kBadReference,
                    "type " + std::to_string(i) + ": an initial value does not exist");
    }
  }
  std::vector<std::vector<uint32_t>> users(constants.size());
  std::vector<uint32_t> open(constants.size());
  std::vector<uint32_t> depth(constants.size());
  std::vector<uint32_t> order;
  for (uint32_t i = 0; i < constants.size(); ++i) {
    for (const ConstElement& element : constants[ConstId(i)].elements) {
      if (!element.value.valid()) continue;
      if (!constants.contains(element.value)) {
        return refuse(Refusal::kBadReference,
                      "initial value " + std::to_string(i) + ": a part of it does not exist");
      }
      users[element.value.index].push_back(i);
      ++open[i];
    }
    if (open[i] == 0) order.push_back(i);
  }
  for (size_t done = 0; done < order.size(); ++done) {
    for (uint32_t user : users[order[done]]) {
      depth[user] = std::max(depth[user], depth[order[done]] + 1);
      if (--open[user] == 0) order.push_back(user);
    }
  }
  for (uint32_t i = 0; i < constants.size(); ++i) {
    if (open[i] == 0 && depth[i] <= base::kMaxNesting) continue;
    return refuse(Refusal::kBadReference,
                  "initial value " + std::to_string(i) + " contains itself or is too deep");
  }
  return base::Ok{};
}

bool Context::valid(Region region) const {
  if (!image.types.contains(region.type)) return false;
  const Type& type = image.types[region.type];
  if (region.dim == 0) return type.kind != Kind::kInterface;
  if (type.kind != Kind::kArray) return false;
  return region.dim < type.dims.size() ||
         (region.dim == type.dims.size() && image.types.is_instance(type.base));
}

}  // namespace ir::verification
