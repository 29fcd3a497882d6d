#include "ir/types/natural_layout.h"

#include <algorithm>
#include <limits>

namespace ir {
namespace {

// What is larger than any memory stays so: types of an image are as large as it says.
uint32_t saturated(uint64_t bytes) {
  return static_cast<uint32_t>(std::min<uint64_t>(bytes, std::numeric_limits<uint32_t>::max()));
}

uint32_t align_up(uint32_t value, uint32_t align) {
  return saturated((uint64_t{value} + align - 1) / align * align);
}

class Builder {
 public:
  explicit Builder(const TypeTable& types) : types_(types), done_(types.size()) {
    layouts_.of.resize(types.size());
  }

  Layouts build() {
    for (uint32_t i = 0; i < types_.size(); ++i) {
      of(TypeId(i));
    }
    return std::move(layouts_);
  }
  Layouts build(std::span<const TypeId> wanted) {
    for (const TypeId id : wanted) of(id);
    return std::move(layouts_);
  }
  uint32_t size(TypeId id) { return of(id).size; }

 private:
  const TypeLayout& of(TypeId id) {
    if (!done_[id.index]) {
      done_[id.index] = true;
      make(types_[id], id, layouts_.of[id.index]);
    }
    return layouts_[id];
  }

  void make(const Type& type, TypeId id, TypeLayout& layout) {
    switch (type.kind) {
      case Kind::kString:
        layout.size = type.capacity + 1;
        return;
      case Kind::kWstring:
        layout.size = 2 * (type.capacity + 1);
        layout.align = 2;
        return;
      case Kind::kArray:
        layout.size = of(type.base).size;
        layout.align = layouts_[type.base].align;
        for (const Dimension& dim : type.dims) {
          layout.size = saturated(layout.size * std::min<uint64_t>(dim.count(), 1u << 31));
        }
        return;
      default:
        break;
    }
    if (types_.has_members(id)) {
      return add_members(id, layout);
    }
    if (types_.is_scalar(id)) {  // no variable is of an interface type
      layout.size = layout.align = scalar_size(types_.scalar(id));
    }
  }

  // An instance inside is a slot, so areas may be asked for before they are complete.
  void add_members(TypeId id, TypeLayout& layout) {
    const bool area = !is_structure(types_[id].kind);
    if (area) {
      layout.size = layout.align = kSlotBytes;
    }
    for (const Member& member : types_[id].members) {
      const bool slot = member.section == Section::kInOut || types_.is_instance(member.type);
      const uint32_t size = slot ? kSlotBytes : of(member.type).size;
      const uint32_t align =
          member_alignment(types_[id], slot ? kSlotBytes : layouts_[member.type].align);
      const uint32_t at =
          types_.overlaps(id) ? member.address.bit_offset / 8 : align_up(layout.used, align);
      layout.member_offsets.push_back(at);
      layout.used = std::max(layout.used, saturated(uint64_t{at} + size));
      layout.align = std::max(layout.align, area ? kSlotBytes : align);
    }
    if (!area) {
      layout.size = align_up(std::max(layout.used, 1u), layout.align);
    }
    layout.area_capacity = align_up(layout.used, 8);
  }

  const TypeTable& types_;
  std::vector<bool> done_;
  Layouts layouts_;
};

}  // namespace

uint32_t natural_size(const TypeTable& types, TypeId type) { return Builder(types).size(type); }

Layouts natural_layouts(const TypeTable& types) { return Builder(types).build(); }

Layouts natural_layouts(const TypeTable& types, std::span<const TypeId> wanted) {
  return Builder(types).build(wanted);
}

}  // namespace ir
