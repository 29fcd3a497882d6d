#include "ir/types/reach.h"

#include <algorithm>
#include <iterator>

#include "ir/types/natural_layout.h"

namespace ir {
namespace {

// From outside into the variable. One past the end is usual, and so is one element before the
// beginning, with the sizes of elementary types first of all.
constexpr uint32_t kBehind[] = {1, 4, 16, 64, 256, 1024};
constexpr uint32_t kBefore[] = {1, 2, 4, 8, 32, 128, 512};
static_assert(std::size(kBehind) == kWhole - 1 && std::size(kBefore) == -kLost - 1);

// The number from 1 on of the first distance that is at least `outside`, when all up to it find the
// variable from wherever they are needed; kLost otherwise. Monotonous in `outside`, so that no way
// in one direction leads through lost places to others.
int32_t step_for(uint64_t outside, uint64_t size, std::span<const uint32_t> distances) {
  uint32_t before = 0;
  for (size_t i = 0; i < distances.size(); ++i) {
    if (distances[i] - before > size) return kLost;
    if (distances[i] >= outside) return static_cast<int32_t>(i) + 1;
    before = distances[i];
  }
  return kLost;
}

int32_t away_at(int64_t position, uint32_t size) {
  if (position >= 0 && position < size) return 0;
  if (position < 0) {
    const int32_t step = step_for(static_cast<uint64_t>(-position), size, kBefore);
    return step == kLost ? kLost : -step;
  }
  return step_for(static_cast<uint64_t>(position) - size + 1, size, kBehind);
}

}  // namespace

std::vector<Reach> area_reaches(const TypeTable& types, const Layouts& layouts, TypeId type) {
  const std::vector<Member>& members = types[type].members;
  const TypeLayout& layout = layouts[type];
  std::vector<Reach> out;
  for (size_t i = 0; i < members.size() && i < layout.member_offsets.size(); ++i) {
    const bool slot = members[i].section == Section::kInOut;
    const uint32_t begin = layout.member_offsets[i];
    const uint32_t size = slot ? kSlotBytes : layouts[members[i].type].size;
    if (size != 0) out.push_back({begin, begin + size, false});
  }
  std::sort(out.begin(), out.end(), [](Reach a, Reach b) { return a.begin < b.begin; });
  return out;
}

uint32_t anchor_of(uint64_t handle) {
  const int32_t away = handle_away(handle);
  const uint32_t offset = handle_offset(handle);
  if (is_inside(handle) || away == kLost) return offset;
  return away > 0 ? offset - kBehind[away - 1] : offset + kBefore[-away - 1];
}

Reach reach_of(std::span<const Reach> sorted, uint32_t area_bytes, uint64_t handle) {
  const int32_t away = handle_away(handle);
  if (away == kLost) return {};
  return away == kWhole ? Reach{0, area_bytes, true} : reach_at(sorted, anchor_of(handle));
}

uint64_t handle_in(Reach reach, uint32_t segment, int64_t position) {
  const uint32_t offset = reach.begin + static_cast<uint32_t>(position);
  return with_away(make_handle(segment, offset), away_at(position, reach.size()));
}

uint64_t moved_from(Reach reach, uint64_t handle, uint32_t bytes) {
  if (bytes == 0 || handle_away(handle) == kWhole) return move_offset(handle, bytes);
  if (reach.size() == 0) return with_away(move_offset(handle, bytes), kLost);
  const int32_t outside = static_cast<int32_t>(handle_offset(handle) - anchor_of(handle));
  const int64_t inside = int64_t{anchor_of(handle)} - reach.begin;
  return handle_in(reach, handle_segment(handle), inside + outside + static_cast<int32_t>(bytes));
}

}  // namespace ir
