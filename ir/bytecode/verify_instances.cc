// V13: every area inside data memory and apart from all others; every ID slot names
// a live instance of its type whose parent it belongs to; the instances form a tree.
#include <algorithm>

#include "base/limits.h"
#include "ir/bytecode/verify_parts.h"

namespace ir::verification {
namespace {

constexpr uint32_t kAreaAlign = 8;

struct IdSlot {
  uint32_t offset = 0;
  TypeId type;
  bool in_out = false;
};

class InstancesVerifier {
 public:
  explicit InstancesVerifier(const Context& context)
      : context_(context),
        image_(context.image),
        slots_(image_.types.size()),
        slots_known_(image_.types.size()),
        named_(image_.instances.size()) {}

  base::Status run() {
    if (image_.instances.empty() || image_.instances[0].type != image_.globals) {
      return refuse(Refusal::kBadInstance, "row 0 of the instance table is not the globals");
    }
    for (uint32_t id = 0; id < image_.instances.size(); ++id) {
      if (base::Status s = check_row(id); !s) return s;
    }
    if (base::Status s = check_areas(); !s) return s;
    for (uint32_t id = 0; id < image_.instances.size(); ++id) {
      if (!is_live(id)) continue;
      if (base::Status s = check_slots_of(id); !s) return s;
    }
    for (uint32_t id = 1; id < image_.instances.size(); ++id) {
      if (is_live(id) && !named_[id] && !is_program(id)) {
        return bad(id, "no slot holds its ID");
      }
    }
    return check_tree();
  }

 private:
  bool is_live(uint32_t id) const { return id == 0 || image_.instances[id].live; }
  bool is_program(uint32_t id) const {
    return image_.types[image_.instances[id].type].kind == Kind::kProgram;
  }

  base::Error bad(uint32_t id, const std::string& why) const {
    return refuse(Refusal::kBadInstance, "instance " + std::to_string(id) + " `" +
                                             image_.instances[id].name + "`: " + why);
  }

  base::Status check_row(uint32_t id) const {
    const Instance& row = image_.instances[id];
    if (!image_.types.knows(row.old_name)) return bad(id, "has an old name that is nowhere");
    if (!is_live(id)) return check_free(id);
    if (id == 0) {
      const bool root = row.live && row.parent == 0 && row.pou == 0;
      if (!root) return bad(id, "is not the root of all others");
    } else {
      if (!image_.types.is_instance(row.type)) return bad(id, "has no instance type");
      if (context_.pou_of_type[row.type.index] != row.pou || row.pou >= image_.pous.size()) {
        return bad(id, "POU " + std::to_string(row.pou) + " is not that of its type");
      }
      if (row.parent >= image_.instances.size() || !is_live(row.parent)) {
        return bad(id, "its parent " + std::to_string(row.parent) + " is not live");
      }
      if (is_program(id) && row.parent != 0) return bad(id, "is a program and has a parent");
    }
    const uint64_t end = uint64_t{row.data} + image_.layouts[row.type].area_capacity;
    if (row.data < kDataBegin || end > image_.data_capacity) {
      return bad(id, "area " + std::to_string(row.data) + ".." + std::to_string(end) +
                         " is outside data memory of " + std::to_string(image_.data_capacity) +
                         " bytes");
    }
    if (row.data % kAreaAlign != 0) {
      return bad(id, "area at " + std::to_string(row.data) + " is not aligned to 8");
    }
    return base::Ok{};
  }

  // Nobody looks at the row of a free ID, or all find the same: no area, no code, no parent.
  base::Status check_free(uint32_t id) const {
    const Instance& row = image_.instances[id];
    const bool empty = row.type == image_.globals && row.data == 0 && row.pou == 0 &&
                       row.parent == 0;
    return empty ? base::Status(base::Ok{}) : bad(id, "is free and has a type or an area");
  }

  struct Area {
    uint64_t begin, end;
    std::string (*name)(uint32_t);
    uint32_t number;
  };

  base::Status check_areas() const {
    std::vector<Area> areas;
    for (uint32_t id = 0; id < image_.instances.size(); ++id) {
      if (!is_live(id)) continue;
      const Instance& row = image_.instances[id];
      areas.push_back({row.data, uint64_t{row.data} + image_.layouts[row.type].area_capacity,
                       [](uint32_t n) { return "the area of instance " + std::to_string(n); }, id});
    }
    for (uint32_t i = 0; i < image_.free.size(); ++i) {
      const Extent& extent = image_.free[i];
      const uint64_t end = uint64_t{extent.offset} + extent.size;
      if (extent.size == 0 || extent.offset < kDataBegin || end > image_.data_capacity) {
        return refuse(Refusal::kBadInstance,
                      "free area " + std::to_string(i) + " is outside data memory");
      }
      areas.push_back(
          {extent.offset, end, [](uint32_t n) { return "free area " + std::to_string(n); }, i});
    }
    std::erase_if(areas, [](const Area& area) { return area.begin == area.end; });
    std::sort(areas.begin(), areas.end(),
              [](const Area& a, const Area& b) { return a.begin < b.begin; });
    for (size_t i = 1; i < areas.size(); ++i) {
      if (areas[i].begin >= areas[i - 1].end) continue;
      return refuse(Refusal::kBadInstance, areas[i - 1].name(areas[i - 1].number) + " and " +
                                               areas[i].name(areas[i].number) + " overlap at " +
                                               std::to_string(areas[i].begin));
    }
    return base::Ok{};
  }

  // The slots in an area of that type, found once per type. Ends early when there
  // are more than the image has instances, so no array is walked in vain.
  const std::vector<IdSlot>& slots_of(TypeId type) {
    if (!slots_known_[type.index]) {
      slots_known_[type.index] = true;
      add_members(type, 0, slots_[type.index]);
    }
    return slots_[type.index];
  }

  bool full(const std::vector<IdSlot>& slots) const {
    return slots.size() >
           image_.instances.size() + image_.types[image_.globals].members.size() + base::kMaxPous;
  }

  void add_members(TypeId type, uint32_t begin, std::vector<IdSlot>& out) const {
    const std::vector<Member>& members = image_.types[type].members;
    for (size_t i = 0; i < members.size() && !full(out); ++i) {
      const uint32_t at = begin + image_.layouts[type].member_offsets[i];
      if (members[i].section == Section::kInOut) {
        out.push_back({at, members[i].type, true});
      } else {
        add_value(members[i].type, at, out);
      }
    }
  }

  void add_value(TypeId type, uint32_t at, std::vector<IdSlot>& out) const {
    if (image_.types.is_instance(type)) {
      out.push_back({at, type, false});
    } else if (context_.facts[type.index].has_slots) {
      if (image_.types[type].kind == Kind::kArray) return add_elements(type, at, out);
      add_members(type, at, out);
    }
  }

  void add_elements(TypeId type, uint32_t at, std::vector<IdSlot>& out) const {
    const TypeId element = image_.types[type].base;
    uint64_t count = 1;
    for (const Dimension& dim : image_.types[type].dims) count *= dim.count();
    for (uint64_t i = 0; i < count && !full(out); ++i) {
      add_value(element, at + static_cast<uint32_t>(i * image_.layouts[element].size), out);
    }
  }

  base::Status check_slots_of(uint32_t holder) {
    const Instance& row = image_.instances[holder];
    for (const IdSlot& slot : slots_of(row.type)) {
      const uint32_t id = initial_id(image_, row.data + slot.offset);
      if (slot.in_out) {
        if (id == 0) continue;
        return bad(holder, "the in-out at " + std::to_string(slot.offset) + " starts bound");
      }
      const auto bad_slot = [&](const char* why) {
        return bad(holder, "its slot at " + std::to_string(slot.offset) + " names instance " +
                               std::to_string(id) + why);
      };
      if (id == 0 || id >= image_.instances.size() || !is_live(id)) {
        return bad_slot(", which is not live");
      }
      const Instance& child = image_.instances[id];
      if (child.type != slot.type) return bad_slot(", which has another type");
      if (is_program(id)) continue;  // of the globals; it exists anyway
      if (child.parent != holder) return bad_slot(", which has another parent");
      if (named_[id]) return bad_slot(", which is named twice");
      named_[id] = true;
    }
    return base::Ok{};
  }

  // From every instance its parents lead to the globals, and no value nests deeper than
  // the limit, instances included.
  base::Status check_tree() const {
    constexpr uint32_t kOpen = kNone;
    std::vector<uint32_t> depth(image_.instances.size(), kOpen);
    depth[0] = 0;
    std::vector<uint32_t> way;
    for (uint32_t start = 1; start < image_.instances.size(); ++start) {
      if (!is_live(start)) continue;
      way.clear();
      uint32_t id = start;
      for (; depth[id] == kOpen; id = image_.instances[id].parent) {
        way.push_back(id);
        if (way.size() > base::kMaxNesting) return bad(start, "its parents never end");
      }
      for (size_t i = way.size(); i-- > 0;) {
        const Instance& row = image_.instances[way[i]];
        depth[way[i]] = depth[row.parent] + 1 + context_.facts[row.type.index].depth;
        if (depth[way[i]] > base::kMaxNesting) return bad(way[i], "is nested too deeply");
      }
    }
    return base::Ok{};
  }

  const Context& context_;
  const Image& image_;
  std::vector<std::vector<IdSlot>> slots_;  // by type
  std::vector<bool> slots_known_;
  std::vector<bool> named_;
};

}  // namespace

base::Status verify_instances(const Context& context) { return InstancesVerifier(context).run(); }

}  // namespace ir::verification
