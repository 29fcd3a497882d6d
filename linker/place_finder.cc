#include "linker/place_finder.h"

#include <algorithm>
#include <numeric>

#include "ir/bytecode/regions.h"

namespace linker {
namespace {

using ir::Kind;
using ir::Region;
using ir::Type;

constexpr uint32_t kInOutBytes = 4;
constexpr uint32_t kMaxSteps = 4096;  // types nest far less; ends every descent

bool is_area(Kind kind) {
  return kind == Kind::kFunctionBlock || kind == Kind::kProgram || kind == Kind::kGlobals;
}

}  // namespace

PlaceFinder::PlaceFinder(const ir::Image& image) : image_(image), by_offset_(image.types.size()) {
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    const ir::TypeId id(i);
    if (image.types.overlaps(id)) continue;
    const std::vector<uint32_t>& offsets = image.layouts[id].member_offsets;
    std::vector<uint32_t>& order = by_offset_[i];
    order.resize(image.types[id].members.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return offsets[a] < offsets[b]; });
  }
}

uint32_t PlaceFinder::size_of(const ir::Member& member) const {
  return member.section == ir::Section::kInOut ? kInOutBytes : image_.layouts[member.type].size;
}

std::optional<FoundPlace> PlaceFinder::find(Region root, uint32_t offset,
                                            const SpotTest& wanted) const {
  const Type& type = image_.types[root.type];
  Spot spot{root, offset, root.dim == 0 && is_area(type.kind), false};
  FoundPlace found;
  uint32_t budget = kMaxSteps;
  if (!go_down(spot, wanted, budget, found)) return std::nullopt;
  return found;
}

// Fills `found` on success, and leaves it as it was without.
bool PlaceFinder::go_down(Spot spot, const SpotTest& wanted, uint32_t& budget,
                          FoundPlace& found) const {
  const FoundPlace before = found;
  for (; budget > 0; --budget) {
    if (wanted(spot)) {
      found.result = spot.region;
      return true;
    }
    const Type& type = image_.types[spot.region.type];
    if (spot.in_out) break;
    if (type.kind == Kind::kArray) {
      if (!enter_element(spot, found)) break;
      continue;
    }
    if (!ir::is_structure(type.kind) && !spot.area) break;
    const bool overlaid = image_.types.overlaps(spot.region.type);
    const bool there = try_members(spot, [&](size_t number) {
      const ir::Member& member = type.members[number];
      Spot part{{member.type, 0}, spot.offset, false, member.section == ir::Section::kInOut};
      part.offset -= image_.layouts[spot.region.type].member_offsets[number];
      FoundPlace inside = found;
      ir::Step step;
      step.index = static_cast<uint32_t>(number);
      inside.steps.push_back(step);
      inside.overlaid |= overlaid;
      --budget;
      if (budget == 0 || !go_down(part, wanted, budget, inside)) return false;
      found = std::move(inside);
      return true;
    });
    if (there) return true;
    break;
  }
  found = before;
  return false;
}

bool PlaceFinder::try_members(const Spot& spot, const std::function<bool(size_t)>& each) const {
  const std::vector<ir::Member>& members = image_.types[spot.region.type].members;
  const std::vector<uint32_t>& offsets = image_.layouts[spot.region.type].member_offsets;
  const auto covers = [&](size_t number) {
    return spot.offset >= offsets[number] &&
           spot.offset - offsets[number] < size_of(members[number]);
  };
  if (image_.types.overlaps(spot.region.type)) {
    for (size_t i = 0; i < members.size(); ++i) {
      if (covers(i) && each(i)) return true;
    }
    return false;
  }
  const std::vector<uint32_t>& order = by_offset_[spot.region.type.index];
  const auto after =
      std::upper_bound(order.begin(), order.end(), spot.offset,
                       [&](uint32_t at, uint32_t number) { return at < offsets[number]; });
  return after != order.begin() && covers(*(after - 1)) && each(*(after - 1));
}

// The slot of an instance in an array stays a region of the array, as in objects.
bool PlaceFinder::enter_element(Spot& spot, FoundPlace& found) const {
  const Type& type = image_.types[spot.region.type];
  if (spot.region.dim >= type.dims.size()) return false;
  const uint64_t stride = ir::index_stride(image_.types, image_.layouts, spot.region);
  const ir::Dimension& dimension = type.dims[spot.region.dim];
  if (stride == 0 || spot.offset / stride >= dimension.count()) return false;
  ir::Step step;
  step.kind = ir::StepKind::kIndex;
  step.constant_index = dimension.low + static_cast<int64_t>(spot.offset / stride);
  found.steps.push_back(step);
  spot.offset = static_cast<uint32_t>(spot.offset % stride);
  spot.region = ir::indexed_region(image_.types, spot.region);
  return true;
}

SpotTest PlaceFinder::scalar(ir::Class cls) const {
  return [this, cls](const Spot& spot) {
    return !spot.area && !spot.in_out && spot.offset == 0 &&
           image_.types.is_scalar(spot.region.type) &&
           ir::class_of(image_.types.scalar(spot.region.type)) == cls;
  };
}

SpotTest PlaceFinder::region(Region wanted) const {
  const Type& type = image_.types[wanted.type];
  const bool area = wanted.dim == 0 && is_area(type.kind);
  const bool text = type.kind == Kind::kString || type.kind == Kind::kWstring;
  return [this, wanted, area, text](const Spot& spot) {
    if (spot.offset != 0 || spot.in_out || spot.area != area) return false;
    if (spot.region == wanted) return true;
    const Type& have = image_.types[spot.region.type];
    const Type& need = image_.types[wanted.type];
    return text && have.kind == need.kind && have.capacity >= need.capacity;
  };
}

SpotTest PlaceFinder::string(ir::Class cls, uint32_t capacity) const {
  const Kind kind = cls == ir::Class::kS ? Kind::kString : Kind::kWstring;
  return [this, kind, capacity](const Spot& spot) {
    const Type& type = image_.types[spot.region.type];
    return spot.offset == 0 && !spot.in_out && type.kind == kind && type.capacity >= capacity;
  };
}

SpotTest PlaceFinder::in_out_slot() const {
  return [](const Spot& spot) { return spot.offset == 0 && spot.in_out; };
}

SpotTest PlaceFinder::instance_slot() const {
  return [this](const Spot& spot) {
    if (spot.offset != 0 || spot.area || spot.in_out) return false;
    const Type& type = image_.types[spot.region.type];
    if (type.kind == Kind::kArray) {
      return spot.region.dim == type.dims.size() && image_.types.is_instance(type.base);
    }
    return image_.types.is_instance(spot.region.type);
  };
}

std::optional<ir::TypeId> PlaceFinder::type_of_size(uint32_t size) const {
  for (uint32_t i = 0; i < image_.types.size(); ++i) {
    const ir::TypeId id(i);
    const ir::TypeLayout& layout = image_.layouts[id];
    if ((image_.types.is_instance(id) ? layout.used : layout.size) == size) return id;
  }
  return std::nullopt;
}

}  // namespace linker
