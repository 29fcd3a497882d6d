#include "ir/bytecode/regions.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "ir/types/natural_layout.h"

namespace ir {
namespace {

constexpr uint32_t kMaxSteps = 4096;  // types nest far less; ends every descent

// A place on the way down: `offset` is what remains inside it.
struct Spot {
  Region region;
  uint32_t offset = 0;
  uint32_t begin = 0;   // from the start of the whole region
  bool area = false;    // the own variables of an instance or of the globals, not an ID slot
  bool in_out = false;  // the slot of an in-out of region.type
  PlaceFlags flags;
};

bool has_area(Kind kind) {
  return kind == Kind::kFunctionBlock || kind == Kind::kProgram || kind == Kind::kGlobals;
}

Spot spot_of(const TypeTable& types, Region region, uint32_t offset) {
  const Type& type = types[region.type];
  Spot spot{region, offset, 0, has_area(type.kind), false, {}};
  if (type.kind == Kind::kArray && region.dim >= type.dims.size()) {
    spot.region = {type.base, 0};
    spot.area = false;
  }
  return spot;
}

uint32_t embedded_size(const Layouts& layouts, const Member& member) {
  return member.section == Section::kInOut ? kSlotBytes : layouts[member.type].size;
}

struct LinearSearch {
  const TypeTable& types;
  const Layouts& layouts;
  // Number of the member that covers `offset`; -1 when none does.
  int64_t operator()(TypeId id, uint32_t offset) const {
    const Type& type = types[id];
    const TypeLayout& layout = layouts[id];
    for (size_t i = 0; i < type.members.size() && i < layout.member_offsets.size(); ++i) {
      const uint32_t begin = layout.member_offsets[i];
      if (offset >= begin && offset - begin < embedded_size(layouts, type.members[i])) {
        return static_cast<int64_t>(i);
      }
    }
    return -1;
  }
  // At most so many of those that cover `offset`, in order of declaration.
  std::vector<uint32_t> covering(TypeId id, uint32_t offset, uint32_t most) const {
    std::vector<uint32_t> out;
    const Type& type = types[id];
    const TypeLayout& layout = layouts[id];
    for (uint32_t i = 0; i < type.members.size() && i < layout.member_offsets.size(); ++i) {
      const uint32_t begin = layout.member_offsets[i];
      const bool here = offset >= begin && offset - begin < embedded_size(layouts, type.members[i]);
      if (here && out.size() < most) out.push_back(i);
    }
    return out;
  }
};

// The tree over `ends` finds members that reach after an offset: node i has the furthest end of
// nodes 2 i and 2 i + 1; the leaves are as many as half of it.
class Reaching {
 public:
  Reaching(std::span<const uint32_t> ends, uint32_t offset, size_t begun, uint32_t most)
      : ends_(ends), offset_(offset), begun_(begun), most_(most) {
    if (!ends.empty()) look(1, 0, ends.size() / 2);
  }
  std::vector<uint32_t> found;  // places in the order by offset

 private:
  void look(size_t node, size_t first, size_t count) {
    if (first >= begun_ || ends_[node] <= offset_ || found.size() >= most_) return;
    if (count == 1) return found.push_back(static_cast<uint32_t>(first));
    look(2 * node, first, count / 2);
    look(2 * node + 1, first + count / 2, count / 2);
  }

  std::span<const uint32_t> ends_;
  uint32_t offset_;
  size_t begun_;
  uint32_t most_;
};

struct IndexedSearch {
  const TypeTable& types;
  const Layouts& layouts;
  const std::vector<uint32_t>& first_member;
  const std::vector<uint32_t>& order;
  const std::unordered_map<TypeId, std::vector<uint32_t>>& ends;
  int64_t operator()(TypeId id, uint32_t offset) const {
    const std::span sorted(order.begin() + first_member[id.index],
                           order.begin() + first_member[id.index + 1]);
    const std::vector<uint32_t>& offsets = layouts[id].member_offsets;
    const auto behind =
        std::upper_bound(sorted.begin(), sorted.end(), offset,
                         [&](uint32_t at, uint32_t number) { return at < offsets[number]; });
    if (behind == sorted.begin()) return -1;
    const uint32_t number = *(behind - 1);
    const uint32_t size = embedded_size(layouts, types[id].members[number]);
    return offset - offsets[number] < size ? static_cast<int64_t>(number) : -1;
  }
  std::vector<uint32_t> covering(TypeId id, uint32_t offset, uint32_t most) const {
    const std::span sorted(order.begin() + first_member[id.index],
                           order.begin() + first_member[id.index + 1]);
    const std::vector<uint32_t>& offsets = layouts[id].member_offsets;
    const auto begun = std::partition_point(
        sorted.begin(), sorted.end(), [&](uint32_t number) { return offsets[number] <= offset; });
    const auto tree = ends.find(id);
    if (tree == ends.end()) return {};
    Reaching members(tree->second, offset, static_cast<size_t>(begun - sorted.begin()), most);
    for (uint32_t& place : members.found) place = sorted[place];
    std::sort(members.found.begin(), members.found.end());
    return std::move(members.found);
  }
};

void enter_member(const TypeTable& types, const Layouts& layouts, size_t number, Spot& spot) {
  const Member& member = types[spot.region.type].members[number];
  const uint32_t begin = layouts[spot.region.type].member_offsets[number];
  spot.begin += begin;
  spot.offset -= begin;
  spot.region = {member.type, 0};
  spot.area = false;
  spot.in_out = member.section == Section::kInOut;
  spot.flags.constant |= member.constant;
  spot.flags.input |= member.address.area == DirectArea::kInput;
  spot.flags.output |= member.address.area == DirectArea::kOutput;
}

bool enter_element(const TypeTable& types, const Layouts& layouts, Spot& spot) {
  const Type& type = types[spot.region.type];
  const uint64_t stride = index_stride(types, layouts, spot.region);
  if (stride == 0 || spot.offset >= region_size(types, layouts, spot.region)) return false;
  const uint32_t inside = static_cast<uint32_t>(spot.offset % stride);
  const bool last = spot.region.dim + 1u >= type.dims.size();
  spot.begin += spot.offset - inside;
  spot.offset = inside;
  spot.region = last ? Region{type.base, 0}
                     : Region{spot.region.type, static_cast<uint8_t>(spot.region.dim + 1)};
  return true;
}

// Moves `spot` to its part that covers the offset; false when there is none, or no parts.
template <class Search>
bool descend(const TypeTable& types, const Layouts& layouts, const Search& search, Spot& spot) {
  const Type& type = types[spot.region.type];
  if (spot.in_out) return false;
  if (type.kind == Kind::kArray) return enter_element(types, layouts, spot);
  if (!is_structure(type.kind) && !spot.area) return false;
  const int64_t number = search(spot.region.type, spot.offset);
  if (number < 0) return false;
  enter_member(types, layouts, static_cast<size_t>(number), spot);
  return true;
}

// Goes down from `spot` until found(spot) holds. Where members overlap, every one that covers
// the offset is tried, in order of declaration; `budget` bounds what a hostile table can cost.
template <class Search, class Found>
bool go_down(const TypeTable& types, const Layouts& layouts, const Search& search, Spot spot,
             uint32_t& budget, const Found& found) {
  for (; budget > 0; --budget) {
    if (found(spot)) return true;
    if (spot.in_out || !types.overlaps(spot.region.type)) {
      if (!descend(types, layouts, search, spot)) return false;
      continue;
    }
    for (const uint32_t member : search.covering(spot.region.type, spot.offset, budget)) {
      if (budget-- <= 1) return false;
      Spot part = spot;
      enter_member(types, layouts, member, part);
      if (go_down(types, layouts, search, part, budget, found)) return true;
    }
    return false;
  }
  return false;
}

std::optional<LeafKind> leaf_kind(const TypeTable& types, const Layouts& layouts,
                                  const Spot& spot) {
  const Type& type = types[spot.region.type];
  const bool inside = spot.offset < (spot.in_out ? kSlotBytes : layouts[spot.region.type].size);
  if (spot.in_out && inside) return LeafKind::kInOutSlot;
  if (spot.area || !inside) return std::nullopt;
  if (type.kind == Kind::kString || type.kind == Kind::kWstring) return LeafKind::kStringByte;
  if (types.is_instance(spot.region.type)) return LeafKind::kInstanceSlot;
  if (types.is_scalar(spot.region.type)) return LeafKind::kScalar;
  return std::nullopt;
}

template <class Search>
std::optional<Leaf> find_leaf(const TypeTable& types, const Layouts& layouts, const Search& search,
                              Region region, uint32_t offset, const LeafTest& accept) {
  std::optional<Leaf> leaf;
  uint32_t budget = kMaxSteps;
  const bool found = go_down(
      types, layouts, search, spot_of(types, region, offset), budget, [&](const Spot& spot) {
        const auto kind = leaf_kind(types, layouts, spot);
        if (!kind) return false;
        const PlaceFlags& flags = spot.flags;
        leaf = Leaf{*kind, spot.region.type, spot.begin, flags.constant, flags.input, flags.output};
        return accept(*leaf);
      });
  return found ? leaf : std::nullopt;
}

bool matches(const TypeTable& types, const Spot& have, const Spot& wanted) {
  if (have.in_out || have.area != wanted.area) return false;
  if (have.region == wanted.region) return true;
  const Type& a = types[have.region.type];
  const Type& b = types[wanted.region.type];
  const bool strings = a.kind == Kind::kString || a.kind == Kind::kWstring;
  return strings && a.kind == b.kind && a.capacity >= b.capacity;
}

template <class Search>
std::optional<PlaceFlags> find_place(const TypeTable& types, const Layouts& layouts,
                                     const Search& search, Region region, uint32_t offset,
                                     Region wanted) {
  const Spot goal = spot_of(types, wanted, 0);
  std::optional<PlaceFlags> flags;
  uint32_t budget = kMaxSteps;
  go_down(types, layouts, search, spot_of(types, region, offset), budget, [&](const Spot& spot) {
    if (spot.offset == 0 && matches(types, spot, goal)) flags = spot.flags;
    return flags.has_value();
  });
  return flags;
}

}  // namespace

uint64_t index_stride(const TypeTable& types, const Layouts& layouts, Region from) {
  const Type& type = types[from.type];
  uint64_t stride = layouts[type.base].size;
  for (size_t dim = from.dim + size_t{1}; dim < type.dims.size(); ++dim) {
    stride *= type.dims[dim].count();
  }
  return stride;
}

uint32_t region_size(const TypeTable& types, const Layouts& layouts, Region region) {
  const Type& type = types[region.type];
  if (has_area(type.kind)) return layouts[region.type].area_capacity;
  if (type.kind != Kind::kArray || region.dim == 0) return layouts[region.type].size;
  if (region.dim >= type.dims.size()) return layouts[type.base].size;
  return static_cast<uint32_t>(index_stride(types, layouts, region) *
                               type.dims[region.dim].count());
}

Region indexed_region(const TypeTable& types, Region from) {
  const Type& type = types[from.type];
  const Region next{from.type, static_cast<uint8_t>(from.dim + 1)};
  if (next.dim < type.dims.size() || types.is_instance(type.base)) return next;
  return {type.base, 0};
}

std::optional<Leaf> leaf_at(const TypeTable& types, const Layouts& layouts, Region region,
                            uint32_t offset) {
  return find_leaf(types, layouts, LinearSearch{types, layouts}, region, offset, LeafTest());
}

bool has_region_at(const TypeTable& types, const Layouts& layouts, Region region, uint32_t offset,
                   Region wanted) {
  return find_place(types, layouts, LinearSearch{types, layouts}, region, offset, wanted)
      .has_value();
}

RegionMap::RegionMap(const TypeTable& types, const Layouts& layouts)
    : types_(types), layouts_(layouts) {
  first_member_.reserve(types.size() + 1);
  first_scalar_.reserve(types.size() + 1);
  for (uint32_t i = 0; i < types.size(); ++i) {
    first_member_.push_back(static_cast<uint32_t>(order_.size()));
    first_scalar_.push_back(static_cast<uint32_t>(scalars_.size()));
    add_members(TypeId(i));
  }
  first_member_.push_back(static_cast<uint32_t>(order_.size()));
  first_scalar_.push_back(static_cast<uint32_t>(scalars_.size()));
}

void RegionMap::add_members(TypeId type) {
  if (types_.is_scalar(type)) {
    scalars_.push_back({0, class_of(types_.scalar(type)), {}});
    return;
  }
  const std::vector<Member>& members = types_[type].members;
  const std::vector<uint32_t>& offsets = layouts_[type].member_offsets;
  const auto first = static_cast<std::ptrdiff_t>(order_.size());
  order_.resize(order_.size() + std::min(members.size(), offsets.size()));
  std::iota(order_.begin() + first, order_.end(), 0u);
  const auto before = [&](uint32_t a, uint32_t b) {
    if (offsets[a] != offsets[b]) return offsets[a] < offsets[b];
    // Empty ones first: they cover nothing.
    return embedded_size(layouts_, members[a]) < embedded_size(layouts_, members[b]);
  };
  if (!std::is_sorted(order_.begin() + first, order_.end(), before)) {
    std::sort(order_.begin() + first, order_.end(), before);
  }
  if (types_.overlaps(type)) return add_ends(type);
  for (auto number = order_.begin() + first; number != order_.end(); ++number) {
    const Member& member = members[*number];
    if (member.section == Section::kInOut || !types_.is_scalar(member.type)) continue;
    const DirectArea area = member.address.area;
    scalars_.push_back(
        {offsets[*number],
         class_of(types_.scalar(member.type)),
         {member.constant, area == DirectArea::kInput, area == DirectArea::kOutput}});
  }
}

void RegionMap::add_ends(TypeId type) {
  const std::vector<Member>& members = types_[type].members;
  const std::span sorted = std::span(order_).subspan(first_member_[type.index]);
  size_t leaves = 1;
  while (leaves < sorted.size()) leaves *= 2;
  std::vector<uint32_t> ends(2 * leaves);
  for (size_t i = 0; i < sorted.size(); ++i) {
    const uint64_t end = uint64_t{layouts_[type].member_offsets[sorted[i]]} +
                         embedded_size(layouts_, members[sorted[i]]);
    ends[leaves + i] = static_cast<uint32_t>(std::min<uint64_t>(end, UINT32_MAX));
  }
  for (size_t i = leaves - 1; i > 0; --i) ends[i] = std::max(ends[2 * i], ends[2 * i + 1]);
  ends_.emplace(type, std::move(ends));
}

const ScalarPlace* RegionMap::scalar_at(Region region, uint32_t offset) const {
  if (region.dim != 0) return nullptr;
  const auto begin = scalars_.begin() + first_scalar_[region.type.index];
  const auto end = scalars_.begin() + first_scalar_[region.type.index + 1];
  const auto found = std::lower_bound(
      begin, end, offset, [](const ScalarPlace& p, uint32_t at) { return p.offset < at; });
  return found == end || found->offset != offset ? nullptr : &*found;
}

std::optional<Leaf> RegionMap::leaf_at(Region region, uint32_t offset,
                                       const LeafTest& accept) const {
  const IndexedSearch search{types_, layouts_, first_member_, order_, ends_};
  return find_leaf(types_, layouts_, search, region, offset, accept);
}

std::optional<PlaceFlags> RegionMap::find(Region region, uint32_t offset, Region wanted) const {
  const IndexedSearch search{types_, layouts_, first_member_, order_, ends_};
  return find_place(types_, layouts_, search, region, offset, wanted);
}

bool RegionMap::same(Region have, Region wanted) const {
  return matches(types_, spot_of(types_, have, 0), spot_of(types_, wanted, 0));
}

}  // namespace ir
