#include "online_change/diff/steps.h"

#include "ir/types/old_names.h"

namespace online_change {

bool is_step(const ir::Image& image, ir::TypeId type) {
  return image.types[type].kind == ir::Kind::kStruct && image.types[type].name == "__SFC_STEP";
}

int32_t step_taken_over(const ir::Image& old_image, ir::TypeId old_type, const ir::Image& new_image,
                        ir::TypeId new_type, const ir::Member& member) {
  if (!member.old_name.valid() || !is_step(new_image, member.type)) return -1;
  const int32_t twin = old_image.types.find_member(old_type, member.name);
  std::string_view rule;
  int32_t gone = -1;
  for (std::string_view name : ir::old_names_of(new_image.types.old_name(member.old_name))) {
    rule = name;
    gone = old_image.types.find_member(old_type, rule);
    if (gone >= 0) break;
  }
  if (twin < 0 || gone < 0 || new_image.types.find_member(new_type, rule) >= 0) return -1;
  const std::vector<ir::Member>& members = old_image.types[old_type].members;
  const ir::Member& before = members[static_cast<size_t>(twin)];
  const ir::Member& taken = members[static_cast<size_t>(gone)];
  if (!is_step(old_image, before.type) || !is_step(old_image, taken.type)) return -1;
  const bool applied = before.old_name.valid() &&
                       ir::gives_old_name(old_image.types.old_name(before.old_name), rule);
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
