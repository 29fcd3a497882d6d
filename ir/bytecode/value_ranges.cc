#include "ir/bytecode/value_ranges.h"

#include <algorithm>

#include "base/limits.h"

namespace ir {

bool ValueRanges::add(const Symbol& symbol) {
  const TypeLayout& layout = image_.layouts[symbol.type];
  const bool area = image_.types.is_instance(symbol.type) || symbol.type == image_.globals;
  return add_range(symbol.data, area ? layout.used : layout.size) &&
         instances(symbol.type, symbol.data, 0);
}

bool ValueRanges::add_range(uint32_t data, uint32_t size) {
  const uint64_t counted = std::max(size, kLineBytes);
  if (counted > left_) return false;
  left_ -= counted;
  ranges_.push_back({data, size});
  return true;
}

// The areas after the slots in a value of this type.
bool ValueRanges::instances(TypeId id, uint32_t data, uint32_t depth) {
  if (depth > base::kMaxNesting || !holds_instance(id, depth)) return true;
  const Type& type = image_.types[id];
  if (type.kind == Kind::kArray) {
    uint64_t count = 1;
    for (const Dimension& dim : type.dims) count *= dim.count();
    const uint64_t stride = image_.layouts[type.base].size;
    bool fits = true;
    for (uint64_t i = 0; i < count && fits; ++i) {
      fits = part(type.base, data + static_cast<uint32_t>(i * stride), depth + 1);
    }
    return fits;
  }
  const std::vector<uint32_t>& offsets = image_.layouts[id].member_offsets;
  bool fits = true;
  for (size_t i = 0; i < type.members.size() && fits; ++i) {
    if (!is_listed(type.members[i])) continue;
    fits = part(type.members[i].type, data + offsets[i], depth + 1);
  }
  return fits;
}

bool ValueRanges::part(TypeId id, uint32_t data, uint32_t depth) {
  if (!image_.types.is_instance(id)) return instances(id, data, depth);
  const uint32_t instance = initial_id(image_, data);
  if (instance == 0 || instance >= image_.instances.size()) return true;
  const uint32_t area = image_.instances[instance].data;
  return add_range(area, image_.layouts[id].used) && instances(id, area, depth);
}

// A slot of an instance, or something around one.
bool ValueRanges::holds_instance(TypeId id, uint32_t depth) {
  if (holds_.empty()) holds_.resize(image_.types.size(), Holds::kUnknown);
  if (depth > base::kMaxNesting) return false;
  if (holds_[id.index] != Holds::kUnknown) return holds_[id.index] == Holds::kYes;
  const Type& type = image_.types[id];
  const auto is_one = [&](TypeId inner) {
    return image_.types.is_instance(inner) || holds_instance(inner, depth + 1);
  };
  bool found = type.kind == Kind::kArray && is_one(type.base);
  if (image_.types.has_members(id)) {
    found = std::any_of(type.members.begin(), type.members.end(),
                        [&](const Member& member) { return is_one(member.type); });
  }
  holds_[id.index] = found ? Holds::kYes : Holds::kNo;
  return found;
}

}  // namespace ir
