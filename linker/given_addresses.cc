#include "linker/given_addresses.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "base/limits.h"
#include "ir/types/location.h"
#include "ir/types/natural_layout.h"
#include "linker/data.h"
#include "linker/extents.h"

namespace linker {
namespace {

constexpr uint64_t kMaxBytes = (uint64_t{ir::kOpenAddress} - 64) / 8;  // an address counts bits
constexpr size_t kAreas = 4;

// A variable without an address, and where it was in the running version.
struct Open {
  ir::DirectArea area = ir::DirectArea::kNone;
  ir::TypeId type;
  uint32_t data = 0;
  const ir::IoBinding* before = nullptr;
};

// A place in the running version; no type: it is new.
struct BasePlace {
  ir::TypeId type;
  uint64_t data = 0;
};

class AddressGiver {
 public:
  AddressGiver(ir::Image& image, const std::vector<InstanceNode>& nodes, const ir::Image* base)
      : image_(image), nodes_(nodes), base_(base), holds_(image.types.size(), Holds::kUnknown) {}

  base::Status run() {
    if (!std::ranges::any_of(nodes_, [&](const auto& node) { return holds_open(node.type, 0); })) {
      return base::Ok{};
    }
    for (const ir::IoBinding& row : image_.io) placed_.insert(row.data);
    if (base_ != nullptr) {
      for (const ir::IoBinding& row : base_->io) of_base_.emplace(row.data, &row);
    }
    find_open();
    natural_ = ir::natural_layouts(image_.types);
    for (const ir::IoBinding& row : image_.io) take(row.address, bytes_at(row));
    keep();
    take_all_of_base();
    for (const Open& open : open_) {
      if (open.before != nullptr) continue;
      if (base::Status given = give(open); !given.ok()) return given;
    }
    return base::Ok{};
  }

 private:
  enum class Holds : uint8_t { kUnknown, kNo, kYes };

  // Function blocks are nodes of their own.
  bool holds_open(ir::TypeId id, uint32_t depth) {
    if (holds_[id.index] != Holds::kUnknown) return holds_[id.index] == Holds::kYes;
    holds_[id.index] = Holds::kNo;
    const ir::Type& type = image_.types[id];
    bool found = type.kind == ir::Kind::kArray && holds_inside(type.base, depth);
    if (image_.types.has_members(id) && !image_.types.is_reference(id)) {
      found = std::ranges::any_of(type.members, [&](const ir::Member& member) {
        return is_open(member) || holds_inside(member.type, depth);
      });
    }
    if (found) holds_[id.index] = Holds::kYes;
    return found;
  }
  bool holds_inside(ir::TypeId id, uint32_t depth) {
    return depth < base::kMaxNesting && !image_.types.is_instance(id) && holds_open(id, depth + 1);
  }
  static bool is_open(const ir::Member& member) {
    return member.section != ir::Section::kInOut && member.address.area != ir::DirectArea::kNone &&
           member.address.bit_offset == ir::kOpenAddress;
  }

  void find_open() {
    for (const InstanceNode& node : nodes_) {
      if (!holds_open(node.type, 0)) continue;
      BasePlace before;
      // An instance that lives on has its number.
      if (base_ != nullptr && node.id < base_->instances.size()) {
        const ir::Instance& row = base_->instances[node.id];
        if (row.live) before = {row.type, row.data};
      }
      find_members(node.type, image_.instances[node.id].data, before);
    }
  }

  void find_members(ir::TypeId type, uint32_t at, const BasePlace& before) {
    const std::vector<ir::Member>& members = image_.types[type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      const ir::Member& member = members[i];
      if (member.section == ir::Section::kInOut) continue;
      const bool inside = holds_inside(member.type, 0);
      if (!inside && !is_open(member)) continue;
      const uint32_t data = at + image_.layouts[type].member_offsets[i];
      const BasePlace part = member_before(before, member.name);
      if (is_open(member)) add(member, data, part);
      if (inside) find_parts(member.type, data, part);
    }
  }

  BasePlace member_before(const BasePlace& whole, const std::string& name) const {
    if (!whole.type.valid() || !base_->types.has_members(whole.type)) return {};
    const int32_t found = base_->types.find_member(whole.type, name);
    if (found < 0) return {};
    const auto number = static_cast<size_t>(found);
    return {base_->types[whole.type].members[number].type,
            whole.data + base_->layouts[whole.type].member_offsets[number]};
  }

  void find_parts(ir::TypeId type, uint32_t at, const BasePlace& before) {
    if (image_.types[type].kind != ir::Kind::kArray) return find_members(type, at, before);
    const ir::TypeId element = image_.types[type].base;
    uint64_t count = 1;
    for (const ir::Dimension& dim : image_.types[type].dims) count *= dim.count();
    for (uint64_t i = 0; i < count; ++i) {
      find_parts(element, at + static_cast<uint32_t>(i) * image_.layouts[element].size,
                 element_before(before, type, i));
    }
  }

  // Elements are known by their index; of several dimensions when all bounds are as before.
  BasePlace element_before(const BasePlace& whole, ir::TypeId type, uint64_t flat) const {
    if (!whole.type.valid() || base_->types[whole.type].kind != ir::Kind::kArray) return {};
    const ir::Type& old = base_->types[whole.type];
    const std::vector<ir::Dimension>& dims = image_.types[type].dims;
    if (dims.size() == 1 && old.dims.size() == 1) {
      const int64_t index = dims[0].low + static_cast<int64_t>(flat);
      if (index < old.dims[0].low || index > old.dims[0].high) return {};
      flat = static_cast<uint64_t>(index - old.dims[0].low);
    } else if (dims != old.dims) {
      return {};
    }
    return {old.base, whole.data + flat * base_->layouts[old.base].size};
  }

  void add(const ir::Member& member, uint32_t data, const BasePlace& before) {
    if (placed_.contains(data)) return;
    Open open{member.address.area, member.type, data, nullptr};
    if (before.type.valid()) {
      const auto row = of_base_.find(before.data);
      if (row != of_base_.end()) open.before = row->second;
    }
    open_.push_back(open);
  }

  uint64_t bytes_at(const ir::IoBinding& row) const {
    const uint64_t bits = ir::located_bits(image_.types, natural_, row.type, row.address);
    return (row.address.bit_offset % 8 + bits + 7) / 8;
  }
  Extents& taken(ir::DirectArea area) { return taken_[static_cast<size_t>(area)]; }
  void take(const ir::DirectAddress& address, uint64_t bytes) {
    taken(address.area).add(address.bit_offset / 8, bytes);
  }

  // First what lives on, so that nothing new comes into its place.
  void keep() {
    for (Open& open : open_) {
      if (open.before == nullptr) continue;
      const ir::DirectAddress address = open.before->address;
      const uint64_t bytes = bytes_at({address, open.data, open.type});
      const uint64_t begin = address.bit_offset / 8;
      const bool same =
          address.area == open.area && address.bit_size == address_at(open, 0).bit_size;
      const bool free =
          taken(open.area).first_gap(begin, begin + bytes, bytes, 1).value_or(~begin) == begin;
      if (!same || !free) {
        open.before = nullptr;
      } else {
        place(open, address);
      }
    }
  }

  // What a variable leaves goes to no other one in the same change.
  void take_all_of_base() {
    if (base_ == nullptr || base_->io.empty()) return;
    const ir::Layouts natural = ir::natural_layouts(base_->types);
    for (const ir::IoBinding& row : base_->io) {
      const uint64_t bits = ir::located_bits(base_->types, natural, row.type, row.address);
      take(row.address, (row.address.bit_offset % 8 + bits + 7) / 8);
    }
  }

  base::Status give(const Open& open) {
    const uint64_t bytes = bytes_at({address_at(open, 0), open.data, open.type});
    const std::optional<uint64_t> begin =
        taken(open.area).first_gap(0, kMaxBytes, bytes, align_of(open.type));
    if (!begin) {
      return base::Error{base::Refusal::kTooMany, "no address is left for a variable of type `" +
                                                      image_.types.text(open.type) + "`"};
    }
    place(open, address_at(open, *begin));
    return base::Ok{};
  }

  void place(const Open& open, const ir::DirectAddress& address) {
    bind_address(image_, address, open.data, open.type);
    take(address, bytes_at(image_.io.back()));
  }

  uint64_t align_of(ir::TypeId type) const { return std::max<uint64_t>(natural_[type].align, 1); }
  // What has several parts begins at a byte, and has a byte for each BOOL.
  ir::DirectAddress address_at(const Open& open, uint64_t byte) const {
    uint32_t bits = 8;
    if (image_.types.is_scalar(open.type)) {
      const ir::Scalar machine = image_.types.scalar(open.type);
      bits = machine == ir::Scalar::kBool ? 1 : ir::scalar_size(machine) * 8;
    }
    return {open.area, static_cast<uint32_t>(byte * 8), bits};
  }

  ir::Image& image_;
  const std::vector<InstanceNode>& nodes_;
  const ir::Image* base_;
  ir::Layouts natural_;
  std::vector<Holds> holds_;             // by type
  std::unordered_set<uint32_t> placed_;  // data offsets of variables that have their address
  std::unordered_map<uint64_t, const ir::IoBinding*> of_base_;  // by data offset
  std::vector<Open> open_;
  Extents taken_[kAreas];  // bytes, by area
};

}  // namespace

base::Status give_addresses(ir::Image& image, const std::vector<InstanceNode>& nodes,
                            const ir::Image* base) {
  return AddressGiver(image, nodes, base).run();
}

}  // namespace linker
