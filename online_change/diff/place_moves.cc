#include "online_change/diff/place_moves.h"

#include <algorithm>

#include "base/limits.h"
#include "ir/types/handle.h"
#include "online_change/diff/areas.h"
#include "online_change/diff/instance_match.h"
#include "online_change/diff/moved_parts.h"
#include "online_change/diff/type_diff.h"
#include "online_change/diff/value_conversion.h"

namespace online_change {
namespace {

using ir::TypeId;

std::unordered_map<std::string, uint32_t> members_by_name(const ir::Type& type) {
  std::unordered_map<std::string, uint32_t> out;
  for (uint32_t i = 0; i < type.members.size(); ++i) {
    out.emplace(ir::fold_name(type.members[i].name), i);
  }
  return out;
}

Target target_of(const ir::Image& image, const std::vector<uint32_t>& names, TypeId reference) {
  const TypeId base = image.types[reference].base;
  const bool instance =
      image.types.is_instance(base) || image.types[base].kind == ir::Kind::kInterface;
  return {names[base.index], instance};
}

}  // namespace

// Makes the tables of a PlaceMoves.
class PlaceMoves::Maker {
 public:
  Maker(PlaceMoves& out, const ir::Image& old_image, const ir::Image& new_image, Way way)
      : out_(out), old_(old_image), new_(new_image), back_(way == Way::kBack) {}

  void run() {
    number_types(old_, out_.old_names_);
    number_types(new_, out_.new_names_);
    const InstanceMatch match = match_instances(old_, new_);
    out_.areas_.resize(old_.instances.size());
    for (uint32_t id : match.old_order) {
      Area& area = out_.areas_[id];
      area.old_segment = ir::area_segment(id, old_.instances[id].generation);
      const uint32_t twin = match.new_of_old[id];
      if (twin != kNoInstance) {
        area.new_segment = ir::area_segment(twin, new_.instances[twin].generation);
        area.pair = areas_pair(old_.instances[id].type, new_.instances[twin].type);
      }
      const bool stays = area.new_segment == area.old_segment && out_.pairs_[area.pair].same &&
                         out_.pairs_[area.pair].no_more.empty();
      out_.trivial_ = out_.trivial_ && stays;
    }
  }

 private:
  void number_types(const ir::Image& image, std::vector<uint32_t>& names) {
    for (uint32_t i = 0; i < image.types.size(); ++i) {
      const auto next = static_cast<uint32_t>(numbers_.size());
      names.push_back(
          numbers_.try_emplace(ir::fold_name(image.types.text(TypeId(i))), next).first->second);
    }
  }

  uint32_t areas_pair(TypeId from, TypeId to) {
    const auto [found, fresh] = areas_.try_emplace({from.index, to.index}, kNone);
    if (!fresh) return found->second;
    Pair pair = named(from, to);
    structure(pair, from, to, 0);
    add_moved(pair, from, to);
    pair.no_more = lost_kinds(from, to);
    return areas_[{from.index, to.index}] = put(std::move(pair));
  }

  // What references may be declared to lead to, beside the type itself.
  static std::vector<uint32_t> kinds_of(const ir::TypeTable& types,
                                        const std::vector<uint32_t>& names, TypeId id) {
    std::vector<uint32_t> out;
    for (const TypeId one : types[id].interfaces) out.push_back(names[one.index]);
    for (uint32_t depth = 0; depth < base::kMaxNesting; ++depth) {
      id = types[id].kind == ir::Kind::kFunctionBlock ? types[id].base : TypeId();
      if (!id.valid()) break;
      out.push_back(names[id.index]);
    }
    return out;
  }

  // Of those that the new version still has.
  std::vector<uint32_t> lost_kinds(TypeId from, TypeId to) const {
    std::vector<uint32_t> lost = kinds_of(old_.types, out_.old_names_, from);
    const std::vector<uint32_t> now = kinds_of(new_.types, out_.new_names_, to);
    const auto is_among = [](const std::vector<uint32_t>& names, uint32_t name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    std::erase_if(lost, [&](uint32_t name) {
      return name == out_.new_names_[to.index] || is_among(now, name) ||
             !is_among(out_.new_names_, name);
    });
    return lost;
  }

  void add_moved(Pair& pair, TypeId from, TypeId to) {
    const std::vector<MovedPart> moves =
        back_ ? moved_parts(new_, to, old_, from) : moved_parts(old_, from, new_, to);
    const std::vector<ir::Reach> reaches =
        moves.empty() ? std::vector<ir::Reach>() : ir::area_reaches(new_.types, new_.layouts, to);
    for (const MovedPart& move : moves) {
      // What stays at its place is still what references mean, there and on the way back.
      if (!move.leaves) continue;
      const PartPlace& source = back_ ? move.to : move.from;
      const PartPlace& target = back_ ? move.from : move.to;
      pair.moved.push_back({source.at, old_.layouts[source.type].size, target.at,
                            value(source.type, target.type, 1), ir::reach_at(reaches, target.at)});
      pair.same = false;
    }
  }

  uint32_t value(TypeId from, TypeId to, uint32_t depth) {
    const auto known = values_.find({from.index, to.index});
    if (known != values_.end()) return known->second;
    Pair pair = named(from, to);
    const bool structures = has_own_parts(old_.types, from) && has_own_parts(new_.types, to);
    const ir::Type& old_type = old_.types[from];
    const ir::Type& new_type = new_.types[to];
    if (depth < base::kMaxTypeDepth && structures) {
      structure(pair, from, to, depth);
    } else if (depth < base::kMaxTypeDepth && old_type.kind == ir::Kind::kArray &&
               new_type.kind == ir::Kind::kArray && old_type.dims.size() == new_type.dims.size()) {
      array(pair, old_type, new_type, depth);
    } else {
      leaf(pair, from, to);
    }
    return values_[{from.index, to.index}] = put(std::move(pair));
  }

  Pair named(TypeId from, TypeId to) const {
    Pair pair;
    pair.old_name = out_.old_names_[from.index];
    pair.new_name = out_.new_names_[to.index];
    pair.old_size = old_.layouts[from].size;
    pair.new_size = new_.layouts[to].size;
    return pair;
  }

  uint32_t put(Pair pair) {
    out_.pairs_.push_back(std::move(pair));
    return static_cast<uint32_t>(out_.pairs_.size() - 1);
  }

  void leaf(Pair& pair, TypeId from, TypeId to) const {
    if (old_.types.is_instance(from) || new_.types.is_instance(to)) {
      pair.kept = old_.types.is_instance(from) && new_.types.is_instance(to) &&
                  same_instance_type(old_, from, new_, to);
    } else if (old_.types.overlaps(from) || new_.types.overlaps(to)) {
      pair.kept = ir::same_value_type(old_.types, old_.layouts, from, new_.types, new_.layouts, to);
    } else {
      pair.kept = pair.old_name == pair.new_name ||
                  classify(old_.types, from, new_.types, to) == Conversion::kSame;
    }
    pair.same = pair.kept && pair.old_size == pair.new_size;
  }

  void array(Pair& pair, const ir::Type& from, const ir::Type& to, uint32_t depth) {
    pair.kind = Kind::kArray;
    pair.element = value(from.base, to.base, depth + 1);
    for (size_t i = 0; i < from.dims.size(); ++i) {
      pair.dims.push_back(
          {from.dims[i].low, to.dims[i].low, from.dims[i].count(), to.dims[i].count()});
    }
    const Pair& element = out_.pairs_[pair.element];
    pair.same = element.same && from.dims == to.dims && element.old_size == element.new_size;
  }

  void structure(Pair& pair, TypeId from, TypeId to, uint32_t depth) {
    pair.kind = Kind::kStructure;
    pair.same = true;
    const ir::Type& old_type = old_.types[from];
    const ir::Type& new_type = new_.types[to];
    const auto names = members_by_name(new_type);
    for (uint32_t i = 0; i < old_type.members.size(); ++i) {
      const ir::Member& member = old_type.members[i];
      if (member.section == ir::Section::kInOut) continue;  // no handle names a slot
      Part part{old_.layouts[from].member_offsets[i], old_.layouts[member.type].size, 0, kNone, {}};
      const auto twin = names.find(ir::fold_name(member.name));
      if (twin != names.end() && new_type.members[twin->second].section != ir::Section::kInOut) {
        part.to = new_.layouts[to].member_offsets[twin->second];
        part.pair = value(member.type, new_type.members[twin->second].type, depth + 1);
        part.reach = {part.to, part.to + out_.pairs_[part.pair].new_size, false};
      }
      pair.same =
          pair.same && part.pair != kNone && part.to == part.begin && out_.pairs_[part.pair].same;
      pair.parts.push_back(part);
    }
    std::sort(pair.parts.begin(), pair.parts.end(),
              [](const Part& a, const Part& b) { return a.begin < b.begin; });
  }

  using Key = std::pair<uint32_t, uint32_t>;
  PlaceMoves& out_;
  const ir::Image& old_;
  const ir::Image& new_;
  bool back_;
  std::unordered_map<std::string, uint32_t> numbers_;
  std::map<Key, uint32_t> areas_;
  std::map<Key, uint32_t> values_;
};

PlaceMoves::PlaceMoves(const ir::Image& old_image, const ir::Image& new_image, Way way) {
  Maker(*this, old_image, new_image, way).run();
}

const PlaceMoves::Part* PlaceMoves::moved_at(const Pair& area, uint32_t offset) {
  for (const Part& part : area.moved) {
    if (offset >= part.begin && offset - part.begin < part.size) return &part;
  }
  return nullptr;
}

Target PlaceMoves::target_in_old(const ir::Image& image, TypeId reference) const {
  return target_of(image, old_names_, reference);
}

Target PlaceMoves::target_in_new(const ir::Image& image, TypeId reference) const {
  return target_of(image, new_names_, reference);
}

bool PlaceMoves::element_of(const Pair& array, uint64_t number, uint64_t& out) {
  uint64_t stride = 1;
  out = 0;
  for (size_t i = array.dims.size(); i-- > 0;) {
    const Bounds& dim = array.dims[i];
    const int64_t index = dim.old_low + static_cast<int64_t>(number % dim.old_count);
    number /= dim.old_count;
    if (index < dim.new_low) return false;
    const auto place = static_cast<uint64_t>(index - dim.new_low);
    if (place >= dim.new_count) return false;
    out += place * stride;
    stride *= dim.new_count;
  }
  return number == 0;
}

const PlaceMoves::Part* PlaceMoves::part_at(const Pair& structure, uint32_t offset) const {
  const auto behind = std::partition_point(structure.parts.begin(), structure.parts.end(),
                                           [&](const Part& part) { return part.begin <= offset; });
  if (behind == structure.parts.begin()) return nullptr;
  const Part& part = *(behind - 1);
  return offset - part.begin < part.size ? &part : nullptr;
}

// The old variable that holds the offset, with its place in the new version.
const PlaceMoves::Part* PlaceMoves::variable_at(const Pair& area, uint32_t offset) const {
  const Part* const part = part_at(area, offset);
  if (part == nullptr || part->pair != kNone) return part;
  const Part* const moved = moved_at(area, offset);
  const bool whole = moved != nullptr && moved->begin == part->begin && moved->size == part->size;
  return whole ? moved : part;
}

// Does a reference to an element find the same bits in both versions?
bool PlaceMoves::reads_alike(uint32_t pair) const {
  uint32_t depth = 0;
  while (pairs_[pair].kind == Kind::kArray && depth++ < base::kMaxTypeDepth) {
    pair = pairs_[pair].element;
  }
  return pairs_[pair].kind != Kind::kLeaf || pairs_[pair].kept;
}

Followed PlaceMoves::follow_outside(const Area& area, uint64_t handle) const {
  const uint32_t offset = ir::handle_offset(handle);
  const uint64_t here = ir::make_handle(area.new_segment, offset);
  if (ir::handle_away(handle) == ir::kLost) return {ir::with_away(here, ir::kLost), false};
  const Part* const part = variable_at(pairs_[area.pair], ir::anchor_of(handle));
  if (part == nullptr) return {0, false};
  if (part->pair == kNone || !reads_alike(part->pair)) return {0, true};
  int64_t position = static_cast<int32_t>(offset - part->begin);
  if (position >= part->size) position += int64_t{pairs_[part->pair].new_size} - part->size;
  position += int64_t{part->to} - part->reach.begin;
  return {ir::handle_in(part->reach, area.new_segment, position), false};
}

Followed PlaceMoves::follow(uint64_t handle, Target target) const {
  const uint32_t segment = ir::handle_segment(handle);
  const uint32_t id = ir::segment_id(segment);
  if (id >= areas_.size() || areas_[id].old_segment != segment) return {handle, false};
  const Area& area = areas_[id];
  if (area.new_segment == 0) return {0, true};
  uint32_t rest = ir::handle_offset(handle);
  const int32_t away = ir::handle_away(handle);
  const bool instance = rest == 0 && (away == 0 ? target.instance : away == ir::kWhole);
  const std::vector<uint32_t>& lost = pairs_[area.pair].no_more;
  if (instance && target.instance &&
      std::find(lost.begin(), lost.end(), target.name) != lost.end()) {
    return {0, true};
  }
  if (pairs_[area.pair].same || instance) {
    return {ir::with_away(ir::make_handle(area.new_segment, rest), away), false};
  }
  if (away == ir::kWhole) {
    const Followed byte = follow(ir::handle_place(handle), target);
    return {byte.handle == 0 ? 0 : ir::with_away(byte.handle, away), byte.gone};
  }
  if (away != 0) return follow_outside(area, handle);
  uint32_t at = 0;  // in the new area
  uint32_t number = area.pair;
  uint32_t depth = 0;
  if (const Part* moved = moved_at(pairs_[number], rest)) {
    at = moved->to;
    rest -= moved->begin;
    number = moved->pair;
    depth = 1;
  }
  for (; depth <= base::kMaxTypeDepth + 1; ++depth) {
    const Pair& pair = pairs_[number];
    const bool whole = depth > 0 && rest == 0 && pair.old_name == target.name;
    if (whole && pair.new_name == target.name) {
      return {ir::make_handle(area.new_segment, at), false};
    }
    if (pair.kind == Kind::kLeaf) {
      if (!pair.kept || rest >= pair.old_size) return {0, true};
      return {ir::make_handle(area.new_segment, at + rest), false};
    }
    if (pair.kind == Kind::kArray) {
      const Pair& element = pairs_[pair.element];
      uint64_t place = 0;
      if (element.old_size == 0 || !element_of(pair, rest / element.old_size, place)) {
        return {0, true};
      }
      at += static_cast<uint32_t>(place * element.new_size);
      rest %= element.old_size;
      number = pair.element;
      continue;
    }
    const Part* part = part_at(pair, rest);
    if (part == nullptr || part->pair == kNone) return {0, part != nullptr};
    at += part->to;
    rest -= part->begin;
    number = part->pair;
  }
  return {0, true};
}

}  // namespace online_change
