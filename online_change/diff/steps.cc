#include "online_change/diff/steps.h"

namespace online_change {

bool is_step(const ir::Image& image, ir::TypeId type) {
  return image.types[type].kind == ir::Kind::kStruct && image.types[type].name == "__SFC_STEP";
}

int32_t step_taken_over(const ir::Image& old_image, ir::TypeId old_type, const ir::Image& new_image,
                        ir::TypeId new_type, const ir::Member& member) {
  if (!member.old_name.valid() || !is_step(new_image, member.type)) return -1;
  const std::string& rule = new_image.types.old_name(member.old_name);
  const int32_t twin = old_image.types.find_member(old_type, member.name);
  const int32_t gone = old_image.types.find_member(old_type, rule);
  if (twin < 0 || gone < 0 || new_image.types.find_member(new_type, rule) >= 0) return -1;
  const std::vector<ir::Member>& members = old_image.types[old_type].members;
  const ir::Member& before = members[static_cast<size_t>(twin)];
  const ir::Member& taken = members[static_cast<size_t>(gone)];
  if (!is_step(old_image, before.type) || !is_step(old_image, taken.type)) return -1;
  const bool applied =
      before.old_name.valid() && ir::same_name(old_image.types.old_name(before.old_name), rule);
  return applied ? -1 : gone;
}

int32_t taker_of_step(const ir::Image& old_image, ir::TypeId old_type, const ir::Image& new_image,
                      ir::TypeId new_type, uint32_t number) {
  if (!is_step(old_image, old_image.types[old_type].members[number].type)) return -1;
  const std::vector<ir::Member>& members = new_image.types[new_type].members;
  for (size_t i = 0; i < members.size(); ++i) {
    if (step_taken_over(old_image, old_type, new_image, new_type, members[i]) ==
        static_cast<int32_t>(number)) {
      return static_cast<int32_t>(i);
    }
  }
  return -1;
}

}  // namespace online_change
