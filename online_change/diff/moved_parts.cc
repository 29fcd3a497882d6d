#include "online_change/diff/moved_parts.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <unordered_map>

#include "base/limits.h"
#include "ir/types/old_names.h"
#include "online_change/diff/areas.h"
#include "online_change/diff/value_conversion.h"

namespace online_change {
namespace {

using ir::TypeId;

bool has_parts(std::string_view name) { return name.find_first_of(".[") != std::string_view::npos; }

// Finds places of an area by their paths.
class Places {
 public:
  Places(const ir::Image& image, TypeId area) : image_(image), area_(area) {}

  // A path begins with a variable, whose own name may have dots (`List.x`): the longest that there
  // is. `before`: also by the name that it had.
  std::optional<PartPlace> find(std::string_view path, bool before) {
    for (size_t end = path.size(); end != 0 && end != std::string_view::npos;
         end = path.find_last_of(".[", end - 1)) {
      const std::optional<uint32_t> number = member(area_, path.substr(0, end), before);
      if (number) return inside(*number, path.substr(end), before);
    }
    return std::nullopt;
  }

 private:
  std::optional<uint32_t> member(TypeId type, std::string_view name, bool before) {
    auto [found, fresh] = members_.try_emplace(type.index);
    if (fresh) {
      const std::vector<ir::Member>& all = image_.types[type].members;
      for (uint32_t i = 0; i < all.size(); ++i)
        found->second.emplace(ir::fold_name(all[i].name), i);
      for (uint32_t i = 0; i < all.size() && before; ++i) {
        if (!all[i].old_name.valid()) continue;
        found->second.emplace(ir::fold_name(image_.types.old_name(all[i].old_name)), i);
      }
    }
    const auto row = found->second.find(ir::fold_name(name));
    if (row == found->second.end()) return std::nullopt;
    return row->second;
  }

  bool enter(PartPlace& place, uint32_t number) const {
    const ir::Member& member = image_.types[place.type].members[number];
    if (!ir::is_listed(member) || member.constant) return false;
    place.path += "." + member.name;
    place.at += image_.layouts[place.type].member_offsets[number];
    place.type = member.type;
    return true;
  }

  std::optional<PartPlace> inside(uint32_t variable, std::string_view rest, bool before) {
    PartPlace place{"", 0, area_};
    if (!enter(place, variable)) return std::nullopt;
    while (!rest.empty()) {
      const bool index = rest[0] == '[';
      const size_t end =
          index ? rest.find(']') : std::min(rest.find_first_of(".[", 1), rest.size());
      if (end == std::string_view::npos) return std::nullopt;
      const std::string_view piece = rest.substr(1, end - 1);
      rest.remove_prefix(index ? end + 1 : end);
      if (index) {
        if (!element(place, piece)) return std::nullopt;
        continue;
      }
      if (!has_own_parts(image_.types, place.type)) return std::nullopt;
      const std::optional<uint32_t> number = member(place.type, piece, before);
      if (!number || !enter(place, *number)) return std::nullopt;
    }
    if (holds_instances(place.type, 0)) return std::nullopt;
    return place;
  }

  bool element(PartPlace& place, std::string_view indices) const {
    const ir::Type& array = image_.types[place.type];
    if (array.kind != ir::Kind::kArray) return false;
    uint64_t flat = 0;
    std::string text;
    for (size_t d = 0; d < array.dims.size(); ++d) {
      const size_t comma = std::min(indices.find(','), indices.size());
      int64_t index = 0;
      const char* const end = indices.data() + comma;
      const auto read = std::from_chars(indices.data(), end, index);
      const ir::Dimension& dim = array.dims[d];
      if (read.ec != std::errc() || read.ptr != end) return false;
      if (index < dim.low || index > dim.high) return false;
      flat = flat * dim.count() + static_cast<uint64_t>(index - dim.low);
      text += (d == 0 ? "" : ",") + std::to_string(index);
      if ((comma == indices.size()) != (d + 1 == array.dims.size())) return false;
      indices.remove_prefix(std::min(comma + 1, indices.size()));
    }
    place.path += "[" + text + "]";
    place.at += static_cast<uint32_t>(flat * image_.layouts[array.base].size);
    place.type = array.base;
    return true;
  }

  bool holds_instances(TypeId id, uint32_t depth) {
    const ir::Type& type = image_.types[id];
    if (image_.types.is_instance(id) || depth > base::kMaxNesting) return true;
    if (type.kind == ir::Kind::kArray) return holds_instances(type.base, depth + 1);
    const auto known = holds_.find(id.index);
    if (known != holds_.end()) return known->second;
    const bool holds = std::any_of(
        type.members.begin(), type.members.end(),
        [&](const ir::Member& member) { return holds_instances(member.type, depth + 1); });
    holds_.emplace(id.index, holds);
    return holds;
  }

  const ir::Image& image_;
  TypeId area_;
  std::unordered_map<uint32_t, std::unordered_map<std::string, uint32_t>> members_;
  std::unordered_map<uint32_t, bool> holds_;
};

// Does A14 know a way?
bool converts(const ir::Image& from, TypeId old_type, const ir::Image& to, TypeId new_type,
              uint32_t depth) {
  if (depth > base::kMaxNesting) return false;
  const ir::Type& a = from.types[old_type];
  const ir::Type& b = to.types[new_type];
  if (from.types.overlaps(old_type) || to.types.overlaps(new_type)) {
    return ir::same_value_type(from.types, from.layouts, old_type, to.types, to.layouts, new_type);
  }
  if (ir::is_structure(a.kind) && ir::is_structure(b.kind)) return true;
  if (a.kind == ir::Kind::kArray && b.kind == ir::Kind::kArray) {
    return a.dims.size() == b.dims.size() && converts(from, a.base, to, b.base, depth + 1);
  }
  return classify(from.types, old_type, to.types, new_type) != Conversion::kNone;
}

class PartFinder {
 public:
  PartFinder(const ir::Image& old_image, TypeId old_area, const ir::Image& new_image,
             TypeId new_area)
      : old_image_(old_image),
        new_image_(new_image),
        source_(old_image, old_area),
        old_(old_image, old_area),
        new_(new_image, new_area) {}

  void add(const std::string& place, const std::vector<std::string_view>& old_names, bool parts) {
    const std::optional<PartPlace> to = new_.find(place, false);
    if (!to || old_.find(place, false) || is_taken(*to)) return;
    for (std::string_view name : old_names) {
      if (!parts && !has_parts(name)) continue;  // a rename
      const std::optional<PartPlace> from = source_.find(name, true);
      if (!from) continue;
      if (converts(old_image_, from->type, new_image_, to->type, 0)) {
        out_.push_back({*from, *to, !new_.find(from->path.substr(1), false)});
      }
      return;
    }
  }
  std::vector<MovedPart> take() { return std::move(out_); }

 private:
  // The first of two rules for one place counts, also where one is for a part of it.
  bool is_taken(const PartPlace& to) const {
    return std::any_of(out_.begin(), out_.end(), [&](const MovedPart& move) {
      const uint64_t begin = move.to.at;
      const uint64_t end = begin + new_image_.layouts[move.to.type].size;
      return to.at < end && begin < uint64_t{to.at} + new_image_.layouts[to.type].size;
    });
  }

  const ir::Image& old_image_;
  const ir::Image& new_image_;
  Places source_;
  Places old_;
  Places new_;
  std::vector<MovedPart> out_;
};

// "[0..9,3]" and "[4,3]", without the first bracket. Both begin after their last one then.
bool index_covers(std::string_view& row, std::string_view& path) {
  const size_t row_end = row.find(']');
  const size_t path_end = path.find(']');
  if (row_end == std::string_view::npos || path_end == std::string_view::npos) return false;
  std::string_view ranges = row.substr(0, row_end);
  std::string_view indices = path.substr(0, path_end);
  row.remove_prefix(row_end + 1);
  path.remove_prefix(path_end + 1);
  const auto number = [](std::string_view text) {
    int64_t value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
  };
  while (!ranges.empty() && !indices.empty()) {
    const std::string_view range = ranges.substr(0, ranges.find(','));
    const std::string_view index = indices.substr(0, indices.find(','));
    const size_t dots = range.find("..");
    const int64_t low = number(range.substr(0, dots));
    const int64_t high = dots == std::string_view::npos ? low : number(range.substr(dots + 2));
    if (number(index) < low || number(index) > high) return false;
    ranges.remove_prefix(std::min(range.size() + 1, ranges.size()));
    indices.remove_prefix(std::min(index.size() + 1, indices.size()));
  }
  return ranges.empty() && indices.empty();
}

}  // namespace

std::vector<MovedPart> moved_parts(const ir::Image& old_image, TypeId old_area,
                                   const ir::Image& new_image, TypeId new_area) {
  PartFinder finder(old_image, old_area, new_image, new_area);
  for (const ir::Member& member : new_image.types[new_area].members) {
    if (!member.old_name.valid() || !new_image.types.knows(member.old_name)) continue;
    const std::string& rule = new_image.types.old_name(member.old_name);
    if (rule.find_first_of(".[;") == std::string::npos) continue;
    finder.add(member.name, ir::old_names_of(rule), false);
    for (const ir::PartRule& part : ir::part_rules_of(rule)) {
      finder.add(member.name + std::string(part.part), part.old_names, true);
    }
  }
  return finder.take();
}

bool covers(const std::string& row, const std::string& path) {
  std::string_view a = row;
  std::string_view b = path;
  while (!a.empty()) {
    if (b.empty() || a[0] != b[0]) return false;
    const bool index = a[0] == '[';
    a.remove_prefix(1);
    b.remove_prefix(1);
    if (index && !index_covers(a, b)) return false;
  }
  return b.empty() || b[0] == '.' || b[0] == '[';
}

}  // namespace online_change
