#include "online_change/diff/areas.h"

#include <algorithm>

#include "base/limits.h"

namespace online_change {
namespace {

std::string index_text(const std::vector<ir::Dimension>& dims, uint64_t flat) {
  std::string text;
  for (size_t i = dims.size(); i-- > 0;) {
    auto index = static_cast<int64_t>(flat % dims[i].count()) + dims[i].low;
    flat /= dims[i].count();
    text = std::to_string(index) + (text.empty() ? "" : "," + text);
  }
  return "[" + text + "]";
}

}  // namespace

bool has_own_parts(const ir::TypeTable& types, ir::TypeId type) {
  return ir::is_structure(types[type].kind) && !types.overlaps(type);
}

uint32_t member_size(const ir::Image& image, const ir::Member& member) {
  if (member.section == ir::Section::kInOut) return 4;
  return image.layouts[member.type].size;
}

Areas::Areas(const ir::Image& image) : image_(image) {
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    if (image.instances[id].live) by_offset_.push_back(id);
  }
  std::sort(by_offset_.begin(), by_offset_.end(),
            [&](uint32_t a, uint32_t b) { return begin(a) < begin(b); });
}

uint32_t Areas::used(uint32_t id) const { return image_.layouts[image_.instances[id].type].used; }

uint32_t Areas::capacity(uint32_t id) const {
  const ir::TypeLayout& layout = image_.layouts[image_.instances[id].type];
  return std::max(layout.used, layout.area_capacity);
}

std::optional<uint32_t> Areas::instance_at(uint32_t offset) const {
  auto behind = std::partition_point(by_offset_.begin(), by_offset_.end(),
                                     [&](uint32_t id) { return begin(id) <= offset; });
  // Areas of size zero may share an offset with the one that follows.
  while (behind != by_offset_.begin()) {
    uint32_t id = *--behind;
    if (offset - begin(id) < capacity(id)) return id;
    if (capacity(id) != 0) return std::nullopt;
  }
  return std::nullopt;
}

const std::vector<Areas::Place>& Areas::places(ir::TypeId type) const {
  auto [found, added] = places_.try_emplace(type);
  if (!added) return found->second;
  const ir::TypeLayout& layout = image_.layouts[type];
  const std::vector<ir::Member>& members = image_.types[type].members;
  for (uint32_t i = 0; i < members.size(); ++i) {
    found->second.push_back({layout.member_offsets[i], member_size(image_, members[i]), i});
  }
  std::sort(found->second.begin(), found->second.end(),
            [](const Place& a, const Place& b) { return a.begin < b.begin; });
  return found->second;
}

bool Areas::owns(uint32_t offset, uint32_t size) const {
  uint64_t end = uint64_t{offset} + size;
  auto behind = std::partition_point(by_offset_.begin(), by_offset_.end(), [&](uint32_t id) {
    return uint64_t{begin(id)} + capacity(id) <= offset;
  });
  for (; behind != by_offset_.end() && begin(*behind) < end; ++behind) {
    uint64_t base = begin(*behind);
    const std::vector<Place>& list = places(image_.instances[*behind].type);
    auto first = std::partition_point(list.begin(), list.end(), [&](const Place& place) {
      return base + place.begin + place.size <= offset;
    });
    if (first != list.end() && base + first->begin < end) return true;
  }
  return false;
}

std::optional<Node> Areas::child_at(Node node, uint32_t offset, std::string* path) const {
  const ir::Type& type = image_.types[node.type];
  uint32_t relative = offset - node.begin;
  if (type.kind == ir::Kind::kArray) {
    uint32_t stride = image_.layouts[type.base].size;
    if (stride == 0 || relative / stride >= type.element_count()) return std::nullopt;
    if (path != nullptr) *path += index_text(type.dims, relative / stride);
    return Node{type.base, node.begin + relative / stride * stride, false};
  }
  if (!image_.types.has_members(node.type)) return std::nullopt;
  const std::vector<Place>& list = places(node.type);
  auto found = std::partition_point(list.begin(), list.end(), [&](const Place& place) {
    return uint64_t{place.begin} + place.size <= relative;
  });
  if (found == list.end() || found->begin > relative) return std::nullopt;
  const ir::Member& member = type.members[found->member];
  if (path != nullptr) *path += (path->empty() ? "" : ".") + member.name;
  return Node{member.type, node.begin + found->begin, member.section == ir::Section::kInOut};
}

std::optional<Node> Areas::descend(uint32_t offset, std::string* path) const {
  std::optional<uint32_t> id = instance_at(offset);
  if (!id) return std::nullopt;
  if (path != nullptr) *path = image_.instance_path(*id);
  std::optional<Node> node =
      child_at({image_.instances[*id].type, begin(*id), false}, offset, path);
  for (uint32_t depth = 0; node && depth < base::kMaxTypeDepth; ++depth) {
    ir::Kind kind = image_.types[node->type].kind;
    bool has_parts = kind == ir::Kind::kArray || has_own_parts(image_.types, node->type);
    if (!has_parts || node->in_out) return node;
    node = child_at(*node, offset, path);
  }
  return std::nullopt;
}

bool Areas::is_array_of(uint32_t offset, ir::TypeId element, uint32_t count) const {
  std::optional<uint32_t> id = instance_at(offset);
  if (!id) return false;
  std::optional<Node> node = Node{image_.instances[*id].type, begin(*id), false};
  for (uint32_t depth = 0; node && !node->in_out && depth < base::kMaxTypeDepth; ++depth) {
    const ir::Type& type = image_.types[node->type];
    if (type.kind == ir::Kind::kArray && type.base == element) {
      uint32_t stride = image_.layouts[element].size;
      uint32_t relative = offset - node->begin;
      return stride != 0 && relative % stride == 0 &&
             type.element_count() - std::min<uint64_t>(type.element_count(), relative / stride) >=
                 count;
    }
    // Another instance's slot ends the walk: its variables lie in an area of their own.
    if (depth > 0 && image_.types.is_instance(node->type)) return false;
    if (image_.types.overlaps(node->type)) return false;
    node = child_at(*node, offset);
  }
  return false;
}

std::string Areas::path_at(uint32_t offset) const {
  std::string path;
  return descend(offset, &path) ? path : "";
}

std::optional<Node> Areas::leaf_at(uint32_t offset) const { return descend(offset, nullptr); }

}  // namespace online_change
