#include "vm/load/write_targets.h"

#include <algorithm>

namespace vm {
namespace {

void surround(const ir::Image& image, Target& target, ir::TypeId type, uint64_t offset) {
  target.around.push_back({type, offset});
  const ir::Type& row = image.types[type];
  if (row.kind == ir::Kind::kArray) {
    const uint64_t element = image.layouts[row.base].size;
    if (element != 0 && !image.types.is_instance(row.base)) {
      surround(image, target, row.base, offset % element);
    }
    return;
  }
  const bool outermost = target.around.size() == 1;
  if (!image.types.has_members(type) || (!outermost && image.types.is_instance(type))) return;
  if (image.types.overlaps(type)) {
    target.overlaid = true;
    return;
  }
  const ir::TypeLayout& layout = image.layouts[type];
  for (size_t i = 0; i < row.members.size(); ++i) {
    const uint64_t begin = layout.member_offsets[i];
    if (offset < begin || offset >= begin + image.layouts[row.members[i].type].size) continue;
    return surround(image, target, row.members[i].type, offset - begin);
  }
}

Target target_of(const ir::Image& image, const std::vector<uint32_t>& areas,
                 const Variable& variable) {
  Target target;
  target.begin = variable.data;
  target.end = uint64_t{variable.data} + variable.size;
  target.type = variable.type;
  const auto behind =
      std::upper_bound(areas.begin(), areas.end(), variable.data,
                       [&](uint32_t at, uint32_t id) { return at < image.instances[id].data; });
  if (behind != areas.begin()) target.owner = *(behind - 1);
  const ir::Instance& owner = image.instances[target.owner];
  const uint64_t offset = target.begin - owner.data;
  const ir::TypeLayout& layout = image.layouts[owner.type];
  const std::vector<ir::Member>& members = image.types[owner.type].members;
  for (size_t i = 0; i < members.size(); ++i) {
    const uint64_t begin = layout.member_offsets[i];
    const uint64_t end = begin + image.layouts[members[i].type].size;
    if (offset < begin || offset >= end) continue;
    target.member_begin = owner.data + begin;
    target.member_end = owner.data + end;
  }
  surround(image, target, owner.type, offset);
  return target;
}

}  // namespace

std::vector<Target> targets_of(const ir::Image& image, std::span<const Variable> variables) {
  std::vector<uint32_t> areas;  // by place
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    if (id == 0 || image.instances[id].live) areas.push_back(id);
  }
  std::sort(areas.begin(), areas.end(), [&](uint32_t a, uint32_t b) {
    return image.instances[a].data < image.instances[b].data;
  });
  std::vector<Target> targets;
  for (const Variable& variable : variables) targets.push_back(target_of(image, areas, variable));
  return targets;
}

}  // namespace vm
