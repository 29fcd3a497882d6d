#include "online_change/diff/instance_match.h"

#include <string>
#include <unordered_map>

#include "online_change/diff/type_diff.h"

namespace online_change {
namespace {

std::vector<uint32_t> parents_first(const ir::Image& image) {
  std::vector<std::vector<uint32_t>> children(image.instances.size());
  std::vector<uint32_t> order;
  if (image.instances.empty()) return order;
  for (uint32_t id = 1; id < image.instances.size(); ++id) {
    const ir::Instance& instance = image.instances[id];
    if (instance.live && instance.parent < children.size()) {
      children[instance.parent].push_back(id);
    }
  }
  order.push_back(0);
  for (size_t i = 0; i < order.size(); ++i) {
    const std::vector<uint32_t>& below = children[order[i]];
    order.insert(order.end(), below.begin(), below.end());
  }
  return order;
}

// A program and a global function block may share a name; their keys differ.
std::string key_of(const ir::Image& image, uint32_t parent, const ir::Instance& instance) {
  bool program = image.types[instance.type].kind == ir::Kind::kProgram;
  return std::to_string(parent) + (program ? "p" : ".") + ir::fold_name(instance.name);
}

class Matcher {
 public:
  Matcher(const ir::Image& old_image, const ir::Image& new_image)
      : old_(old_image), new_(new_image) {}

  InstanceMatch run() {
    match_.old_order = parents_first(old_);
    match_.new_order = parents_first(new_);
    match_.old_of_new.assign(new_.instances.size(), kNoInstance);
    match_.new_of_old.assign(old_.instances.size(), kNoInstance);
    match_.retyped_from.assign(new_.instances.size(), kNoInstance);
    if (match_.old_order.empty() || match_.new_order.empty()) return std::move(match_);
    link(0, 0);
    for (size_t i = 1; i < match_.new_order.size(); ++i) match_one(match_.new_order[i]);
    return std::move(match_);
  }

 private:
  void link(uint32_t old_id, uint32_t new_id) {
    match_.old_of_new[new_id] = old_id;
    match_.new_of_old[old_id] = new_id;
  }

  void match_one(uint32_t id) {
    const ir::Instance& instance = new_.instances[id];
    uint32_t old_parent = match_.old_of_new[instance.parent];
    if (old_parent == kNoInstance) return;
    uint32_t twin = is_same_path(id, old_parent, instance) ? id : find(old_parent, instance);
    if (twin == kNoInstance || match_.new_of_old[twin] != kNoInstance) return;
    if (same_instance_type(old_, old_.instances[twin].type, new_, instance.type)) {
      link(twin, id);
    } else {
      match_.retyped_from[id] = twin;
    }
  }

  bool is_same_path(uint32_t id, uint32_t old_parent, const ir::Instance& instance) const {
    if (id >= old_.instances.size()) return false;
    const ir::Instance& old_instance = old_.instances[id];
    return old_instance.live && old_instance.parent == old_parent &&
           old_.types[old_instance.type].kind == new_.types[instance.type].kind &&
           ir::same_name(old_instance.name, instance.name);
  }

  uint32_t find(uint32_t old_parent, const ir::Instance& instance) {
    if (by_path_.empty()) {
      for (uint32_t id : match_.old_order) {
        if (id == 0) continue;
        by_path_.emplace(key_of(old_, old_.instances[id].parent, old_.instances[id]), id);
      }
    }
    auto found = by_path_.find(key_of(new_, old_parent, instance));
    return found == by_path_.end() ? kNoInstance : found->second;
  }

  const ir::Image& old_;
  const ir::Image& new_;
  InstanceMatch match_;
  std::unordered_map<std::string, uint32_t> by_path_;
};

}  // namespace

InstanceMatch match_instances(const ir::Image& old_image, const ir::Image& new_image) {
  return Matcher(old_image, new_image).run();
}

}  // namespace online_change
