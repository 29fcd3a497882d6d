#include "ir/program/eval_references.h"

#include <algorithm>

#include "base/limits.h"
#include "ir/types/handle.h"
#include "ir/types/inside.h"
#include "ir/types/natural_layout.h"
#include "ir/types/parts.h"

namespace ir {
namespace {

constexpr uint32_t kExposedDataBegin = 0xf8000000u;  // where frames are (ir/bytecode/image.h)
constexpr uint32_t kNowhere = 0xf0000000u;

}  // namespace

void References::add_area(Variable& root, uint32_t id, uint32_t generation, uint32_t data) {
  Home home;
  home.root = &root;
  home.segment = area_segment(id, generation);
  home.data = data;
  home.used = layouts_[root.type].used;
  home.capacity = std::max(home.used, layouts_[root.type].area_capacity);
  home.slots = SlotFinder(program_.types, layouts_).inside(root.type);
  home.reaches = area_reaches(program_.types, layouts_, root.type);
  segment_of_[&root] = home.segment;
  areas_[home.segment] = std::move(home);
}

void References::name_area(const Variable& root, std::string path) {
  areas_[segment_of_.at(&root)].path = std::move(path);
}

std::optional<uint64_t> References::handle_of(const Address& at, uint32_t task) {
  if (const auto area = segment_of_.find(at.root); area != segment_of_.end()) {
    return make_handle(area->second, at.offset);
  }
  if (at.constant) {
    return make_handle(0, kNowhere);  // a constant has no handle: any use traps
  }
  for (const Home& home : exposed_) {
    if (home.root == at.root && home.frame == at.frame) {
      return make_handle(home.segment, at.offset);
    }
  }
  if (exposed_.size() >= base::kMaxExposures) {
    return std::nullopt;
  }
  Home home;
  home.root = at.root;
  home.frame = at.frame;
  home.segment = new_segment(task);
  home.used = home.capacity = layouts_[at.root->type].size;
  home.reaches = {{0, home.used, false}};
  home.data = kExposedDataBegin + next_data_;
  next_data_ = (next_data_ + home.used + 7) / 8 * 8 % (1u << 26);
  exposed_.push_back(std::move(home));
  return make_handle(exposed_.back().segment, at.offset);
}

// Numbers begin again after 2^21, and those of outer calls are still in use then.
uint32_t References::new_segment(uint32_t task) {
  uint32_t segment = 0;
  do {
    segment = exposed_segment(task, ++exposures_[task]);
  } while (home_of(make_handle(segment, 0)) != nullptr);
  return segment;
}

Reach References::reach_in(const Home& home, uint64_t handle) {
  return reach_of(home.reaches, home.used, handle);
}

uint64_t References::move(uint64_t handle, uint64_t bytes) const {
  if (is_far(bytes)) return lost(handle);
  const Home* home = home_of(handle);
  const auto count = static_cast<uint32_t>(bytes);
  return home == nullptr ? move_offset(handle, count)
                         : moved_from(reach_in(*home, handle), handle, count);
}

uint64_t References::handle_of_instance(const Variable& instance) const {
  const auto area = segment_of_.find(&instance);
  return area == segment_of_.end() ? 0 : make_handle(area->second, 0);
}

Variable* References::instance_of(uint64_t handle) const {
  const Home* home = home_of(handle);
  const bool whole = home != nullptr && home->frame == 0 && handle_offset(handle) == 0 &&
                     is_inside(handle) && program_.types.is_instance(home->root->type);
  return whole ? home->root : nullptr;
}

void References::leave(uint64_t frame) {
  std::erase_if(exposed_, [frame](const Home& home) { return home.frame == frame; });
}

const References::Home* References::home_of(uint64_t handle) const {
  const uint32_t segment = handle_segment(handle);
  if (const auto area = areas_.find(segment); area != areas_.end()) {
    return &area->second;
  }
  const auto local = std::find_if(exposed_.begin(), exposed_.end(),
                                  [segment](const Home& home) { return home.segment == segment; });
  return local == exposed_.end() ? nullptr : &*local;
}

bool References::touches_slot(const Home& home, uint64_t begin, uint64_t end) {
  const auto next = std::partition_point(home.slots.begin(), home.slots.end(),
                                         [begin](uint64_t at) { return at + kSlotBytes <= begin; });
  return next != home.slots.end() && *next < end;
}

// Bytes from `offset` to the next slot or the end of the variable.
uint32_t References::room_for_string(const Home& home, Reach reach, uint32_t offset) const {
  if (!reach.holds(offset) || touches_slot(home, offset, uint64_t{offset} + 1)) {
    return 0;
  }
  const auto next = std::lower_bound(home.slots.begin(), home.slots.end(), offset);
  return (next == home.slots.end() ? reach.end : std::min(reach.end, *next)) - offset;
}

std::optional<Address> References::resolve_instance(const Home& home, uint64_t handle,
                                                    TypeId type) const {
  const uint32_t offset = handle_offset(handle);
  if (!is_inside(handle)) {
    return std::nullopt;
  }
  if (program_.types.is_instance(type)) {
    const bool right = offset == 0 && home.frame == 0 && program_.types.is_a(home.root->type, type);
    return right ? std::optional(Address{home.root, 0, home.root, 0, type, 0, false})
                 : std::nullopt;
  }
  Variable* part = bytes_.find(*home.root, offset, type);
  return part != nullptr
             ? std::optional(Address{part, home.frame, home.root, offset, type, 0, false})
             : std::nullopt;
}

std::optional<Address> References::resolve(uint64_t handle, TypeId type, bool short_string) const {
  const Home* home = home_of(handle);
  const uint32_t offset = handle_offset(handle);
  if (home == nullptr) {
    return std::nullopt;
  }
  if (holds_instance(program_.types, type)) {
    return resolve_instance(*home, handle, type);
  }
  const Type& wanted = program_.types[type];
  Address at{nullptr, home->frame, home->root, offset, type, wanted.capacity, false};
  const Reach reach = reach_in(*home, handle);
  uint64_t size = layouts_[type].size;
  if (short_string) {
    const uint32_t unit = wanted.kind == Kind::kWstring ? 2 : 1;
    const uint32_t units = room_for_string(*home, reach, offset) / unit;
    at.capacity = std::min(wanted.capacity, units - std::min(units, 1u));
    size = (uint64_t{at.capacity} + 1) * unit;
  }
  const uint64_t end = offset + size;
  if (!reach.covers(offset, size) || touches_slot(*home, offset, end)) {
    return std::nullopt;
  }
  at.variable = bytes_.find(*home->root, offset, type);
  return at;
}

std::string References::why_unresolved(uint64_t handle, TypeId type, bool short_string) const {
  const Home* home = home_of(handle);
  if (home == nullptr || holds_instance(program_.types, type)) {
    return "";
  }
  const Reach reach = reach_in(*home, handle);
  const uint32_t unit = program_.types[type].kind == Kind::kWstring ? 2 : 1;
  const uint32_t size = short_string ? unit : layouts_[type].size;
  const bool left =
      reach.size() == 0 ? handle_away(handle) == kLost : !reach.covers(handle_offset(handle), size);
  const TypeId area = home->frame == 0 ? home->root->type : TypeId();
  return left ? left_text(program_.types, layouts_, area, handle) : "";
}

uint32_t References::flat(uint64_t handle) const {
  if (handle_segment(handle) == 0) {
    return handle_offset(handle);
  }
  const Home* home = home_of(handle);
  return home == nullptr ? 0 : home->data + handle_offset(handle);
}

uint64_t References::unflat(uint32_t data) const {
  const auto inside = [data](const Home& home) { return data - home.data < home.capacity; };
  for (const auto& [segment, home] : areas_) {
    if (inside(home)) {
      return make_handle(segment, data - home.data);
    }
  }
  for (const Home& home : exposed_) {
    if (inside(home)) {
      return make_handle(home.segment, data - home.data);
    }
  }
  return make_handle(0, data);
}

std::string References::text(uint64_t handle, TypeId target) const {
  if (handle == 0) {
    return "NULL";
  }
  const auto area = areas_.find(handle_segment(handle));
  if (area == areas_.end()) {
    return "ref";
  }
  return reference_text(area->second.path, handle_text(program_.types, layouts_,
                                                       area->second.root->type, handle, target));
}

}  // namespace ir
