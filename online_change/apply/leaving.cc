#include "online_change/apply/leaving.h"

#include <algorithm>

#include "online_change/diff/instance_match.h"

namespace online_change {
namespace {

bool has_stamp(const ir::Image& image, uint32_t id) {
  const std::vector<ir::Member>& members = image.types[image.instances[id].type].members;
  return std::any_of(members.begin(), members.end(), [](const ir::Member& member) {
    return member.section == ir::Section::kStamp;
  });
}

}  // namespace

Leaving find_leaving(const ir::Image& old_image, const ir::Image& new_image) {
  Leaving out;
  if (!has_stamp(old_image, 0) && !has_stamp(new_image, 0)) return out;
  const InstanceMatch match = match_instances(old_image, new_image);
  for (uint32_t id : match.old_order) {
    if (match.new_of_old[id] == kNoInstance && has_stamp(old_image, id)) {
      out.at_switch.push_back(id);
    }
  }
  for (uint32_t id : match.new_order) {
    if (match.old_of_new[id] == kNoInstance && has_stamp(new_image, id)) {
      out.at_undo.push_back(id);
    }
  }
  return out;
}

}  // namespace online_change
