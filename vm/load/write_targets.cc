#include "vm/load/write_targets.h"

#include <algorithm>
#include <numeric>

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

Target target_of(const ir::Image& image, uint32_t instance, const Variable& variable) {
  Target target;
  target.begin = variable.data;
  target.end = uint64_t{variable.data} + variable.size;
  target.type = variable.type;
  target.owner = instance;
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

// The instances in whose areas they lie; 0: the globals. One look at each instance: there may be
// many, and few variables.
std::vector<uint32_t> owners_of(const ir::Image& image, std::span<const Variable> variables) {
  std::vector<uint32_t> order(variables.size());  // by place
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return variables[a].data < variables[b].data; });
  const auto begin_of = [&](uint32_t id) { return image.instances[id].data; };
  const auto before = [&](uint32_t i, uint32_t at) { return variables[i].data < at; };
  // For each place in `order`: of the areas that begin in front of it, but behind the variable
  // before it, the last.
  std::vector<uint32_t> nearest(variables.size(), UINT32_MAX);
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    if (id != 0 && (!row.live || image.layouts[row.type].area_capacity == 0)) continue;
    const auto first = std::lower_bound(order.begin(), order.end(), row.data, before);
    if (first == order.end()) continue;
    uint32_t& known = nearest[static_cast<size_t>(first - order.begin())];
    if (known == UINT32_MAX || begin_of(known) < row.data) known = id;
  }
  std::vector<uint32_t> owners(variables.size(), 0);
  uint32_t last = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    if (nearest[i] != UINT32_MAX) last = nearest[i];
    owners[order[i]] = last;
  }
  return owners;
}

}  // namespace

std::vector<Target> targets_of(const ir::Image& image, std::span<const Variable> variables) {
  const std::vector<uint32_t> owners = owners_of(image, variables);
  std::vector<Target> targets;
  targets.reserve(variables.size());
  for (size_t i = 0; i < variables.size(); ++i) {
    targets.push_back(target_of(image, owners[i], variables[i]));
  }
  return targets;
}

}  // namespace vm
