// What lies on top of each other, in two versions.
#include "online_change/diff/union_bytes.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "online_change/diff/member_names.h"

namespace online_change {
namespace {

using ByteRange = std::pair<uint64_t, uint64_t>;  // bytes: begin, end

// Of `ranges`, which are sorted by their begin: is each byte of `range` in one?
bool covers(const std::vector<ByteRange>& ranges, ByteRange range) {
  for (const ByteRange& other : ranges) {
    if (other.first > range.first) break;
    range.first = std::max(range.first, other.second);
  }
  return range.first >= range.second;
}

bool has_members(const ir::Image& image, ir::TypeId type, uint32_t member) {
  return image.types.has_members(image.types[type].members[member].type);
}

}  // namespace

std::vector<UnionView> union_views(const ir::Image& old_image, ir::TypeId old_type,
                                   const ir::Image& new_image, ir::TypeId new_type) {
  std::vector<UnionView> out;
  const MemberNames names(old_image.types[old_type]);
  const std::vector<ir::Member>& before = old_image.types[old_type].members;
  const std::vector<ir::Member>& after = new_image.types[new_type].members;
  for (uint32_t i = 0; i < after.size(); ++i) {
    const uint32_t twin = names.find(after[i]);
    if (twin == MemberNames::kNone) continue;
    const uint32_t from = old_image.layouts[old_type].member_offsets[twin];
    const uint32_t to = new_image.layouts[new_type].member_offsets[i];
    const bool same =
        from == to && ir::same_value_type(old_image.types, old_image.layouts, before[twin].type,
                                          new_image.types, new_image.layouts, after[i].type);
    out.push_back({twin, i, same});
  }
  return out;
}

bool keeps_union_bytes(const ir::Image& old_image, ir::TypeId old_type, const ir::Image& new_image,
                       ir::TypeId new_type) {
  if (!old_image.types.overlaps(old_type) || !new_image.types.overlaps(new_type)) return false;
  const auto range_of = [](const ir::Image& image, ir::TypeId type, uint32_t member) {
    const uint64_t begin = image.layouts[type].member_offsets[member];
    return ByteRange(begin, begin + image.layouts[image.types[type].members[member].type].size);
  };
  std::vector<ByteRange> kept;
  std::vector<ByteRange> changed;
  for (const UnionView& view : union_views(old_image, old_type, new_image, new_type)) {
    (view.same ? kept : changed).push_back(range_of(new_image, new_type, view.new_member));
    if (view.same) continue;
    if (has_members(old_image, old_type, view.old_member) ||
        has_members(new_image, new_type, view.new_member)) {
      return false;
    }
    changed.push_back(range_of(old_image, old_type, view.old_member));
  }
  std::sort(kept.begin(), kept.end());
  return !kept.empty() && std::all_of(changed.begin(), changed.end(),
                                      [&](const ByteRange& range) { return covers(kept, range); });
}

}  // namespace online_change
