#include "ir/types/inside.h"

#include <algorithm>

#include "base/limits.h"
#include "ir/types/natural_layout.h"
#include "ir/types/reach.h"
#include "ir/types/shared_bytes.h"

namespace ir {
namespace {

uint32_t member_size(const Layouts& layouts, const Member& member) {
  return member.section == Section::kInOut ? kSlotBytes : layouts[member.type].size;
}

// A part on the way down and what remains of the offset in it.
struct Inner {
  TypeId type;
  uint32_t rest = 0;
  bool slot = false;
};

bool covers(const Layouts& layouts, TypeId owner, size_t member, const Member& of, uint32_t at) {
  const uint32_t begin = layouts[owner].member_offsets[member];
  return at >= begin && at - begin < member_size(layouts, of);
}

// Among members that overlap, one of the wanted type comes before others.
size_t member_inside(const TypeTable& types, const Layouts& layouts, const Inner& part,
                     TypeId target) {
  const std::vector<Member>& members = types[part.type].members;
  const size_t count = std::min(members.size(), layouts[part.type].member_offsets.size());
  size_t first = count;
  for (size_t i = 0; i < count; ++i) {
    if (!covers(layouts, part.type, i, members[i], part.rest)) continue;
    const bool wanted = part.rest == layouts[part.type].member_offsets[i] && target.valid() &&
                        types.is_a(members[i].type, target);
    if (wanted || !types.overlaps(part.type)) return i;
    first = std::min(first, i);
  }
  return first;
}

// The member or element that covers the offset; false in holes and at leaves.
bool step_down(const TypeTable& types, const Layouts& layouts, Inner& part, TypeId target,
               std::string& path) {
  const Type& type = types[part.type];
  if (part.slot) {
    return false;
  }
  if (type.kind == Kind::kArray) {
    const uint32_t stride = layouts[type.base].size;
    if (stride == 0 || part.rest >= layouts[part.type].size) {
      return false;
    }
    path += index_text(type, part.rest / stride);
    part = {type.base, part.rest % stride, types.is_instance(type.base)};
    return true;
  }
  const size_t number = member_inside(types, layouts, part, target);
  if (number >= type.members.size()) return false;
  const Member& member = type.members[number];
  const bool shared = type.kind == Kind::kGlobals && is_shared(types, member);
  if (!shared) path += "." + member.name;
  const bool slot = member.section == Section::kInOut || types.is_instance(member.type);
  part = {member.type, part.rest - layouts[part.type].member_offsets[number], slot};
  return true;
}

// The variable of an area's type that holds the offset.
const Member* member_at(const TypeTable& types, const Layouts& layouts, TypeId area,
                        uint32_t offset, uint32_t& begin) {
  const Type& type = types[area];
  const std::vector<uint32_t>& offsets = layouts[area].member_offsets;
  for (size_t i = 0; i < type.members.size() && i < offsets.size(); ++i) {
    begin = offsets[i];
    if (offset - begin < member_size(layouts, type.members[i])) return &type.members[i];
  }
  return nullptr;
}

}  // namespace

std::string handle_text(const TypeTable& types, const Layouts& layouts, TypeId area,
                        uint64_t handle, TypeId target) {
  if (is_inside(handle)) {
    return path_inside(types, layouts, area, handle_offset(handle), target);
  }
  uint32_t begin = 0;
  const bool lost = handle_away(handle) == kLost;
  const Member* const member =
      lost ? nullptr : member_at(types, layouts, area, anchor_of(handle), begin);
  if (member == nullptr) return ".?";
  const auto position = static_cast<int32_t>(handle_offset(handle) - begin);
  return "." + member->name + (position < 0 ? "" : "+") + std::to_string(position);
}

std::string left_text(const TypeTable& types, const Layouts& layouts, TypeId area,
                      uint64_t handle) {
  uint32_t begin = 0;
  const int32_t away = handle_away(handle);
  const bool known = area.valid() && away != kLost && away != kWhole;
  const Member* const member =
      known ? member_at(types, layouts, area, anchor_of(handle), begin) : nullptr;
  return "the pointer has left " + (member == nullptr ? "its variable" : "`" + member->name + "`");
}

std::string index_text(const Type& array, uint64_t flat) {
  std::string text;
  for (size_t i = array.dims.size(); i-- > 0;) {
    const uint64_t count = array.dims[i].count();
    const auto index =
        static_cast<int64_t>(static_cast<uint64_t>(array.dims[i].low) + flat % count);
    text = std::to_string(index) + (text.empty() ? "" : ",") + text;
    flat /= count;
  }
  return "[" + text + "]";
}

std::string path_inside(const TypeTable& types, const Layouts& layouts, TypeId root,
                        uint32_t offset, TypeId target) {
  std::string path;
  Inner part{root, offset, false};
  for (uint32_t depth = 0; depth < base::kMaxNesting; ++depth) {
    if (part.rest == 0 && target.valid() && types.is_a(part.type, target)) {
      break;
    }
    if (!step_down(types, layouts, part, target, path)) {
      break;
    }
  }
  return part.rest == 0 ? path : path + "+" + std::to_string(part.rest);
}

std::string reference_text(const std::string& area, std::string inside) {
  if (area.empty() && inside.starts_with('.')) {
    return inside.substr(1);
  }
  return area.empty() ? "ref" : area + inside;
}

std::vector<uint32_t> SlotFinder::inside(TypeId root) {
  slots_.clear();
  members(root, 0, 0);
  std::sort(slots_.begin(), slots_.end());
  return slots_;
}

void SlotFinder::members(TypeId id, uint32_t begin, uint32_t depth) {
  const std::vector<Member>& members = types_[id].members;
  for (size_t i = 0; i < members.size(); ++i) {
    const uint32_t at = begin + layouts_[id].member_offsets[i];
    if (members[i].section == Section::kInOut) {
      slots_.push_back(at);
    } else {
      value(members[i].type, at, depth + 1);
    }
  }
}

bool SlotFinder::holds(TypeId id, uint32_t depth) {
  if (types_.is_instance(id)) {
    return true;
  }
  Holds& known = holds_[id.index];
  if (known == Holds::kUnknown) {
    known = Holds::kNo;
    bool found = false;
    const Type& type = types_[id];
    if (depth < base::kMaxNesting && type.kind == Kind::kArray) {
      found = holds(type.base, depth + 1);
    }
    for (size_t i = 0; i < type.members.size() && depth < base::kMaxNesting; ++i) {
      found = found || holds(type.members[i].type, depth + 1);
    }
    holds_[id.index] = found ? Holds::kYes : Holds::kNo;
  }
  return holds_[id.index] == Holds::kYes;
}

void SlotFinder::value(TypeId id, uint32_t at, uint32_t depth) {
  if (types_.is_instance(id)) {
    slots_.push_back(at);
  } else if (holds(id, 0) && depth < base::kMaxNesting) {
    if (types_[id].kind == Kind::kArray) {
      return elements(id, at, depth);
    }
    members(id, at, depth);
  }
}

void SlotFinder::elements(TypeId id, uint32_t at, uint32_t depth) {
  const TypeId element = types_[id].base;
  const uint32_t stride = layouts_[element].size;
  for (uint32_t done = 0; stride != 0 && done < layouts_[id].size; done += stride) {
    value(element, at + done, depth + 1);
  }
}

}  // namespace ir
