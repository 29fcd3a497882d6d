#include "ir/lower/alias.h"

#include <algorithm>

namespace ir::codegen {
namespace {

bool follows_reference(const Place& place) {
  if (place.base == PlaceBase::kPointee || place.base == PlaceBase::kTarget) return true;
  return std::any_of(place.steps.begin(), place.steps.end(),
                     [](const Step& step) { return step.kind == StepKind::kDeref; });
}

bool enters(const Place& place) {
  return std::any_of(place.steps.begin(), place.steps.end(),
                     [](const Step& step) { return step.kind == StepKind::kEnter; });
}

bool is_private(const Place& place, const Values& values) {
  return place.base == PlaceBase::kConst ||
         (place.base == PlaceBase::kLocal && !follows_reference(place) &&
          !values.local_escapes(place.base_index));
}

bool same_root(const Place& a, const Place& b) {
  return a.base == b.base && a.base_index == b.base_index && a.pou == b.pou &&
         a.constant == b.constant;
}

bool is_constant_step(const Step& step, const Values& values) {
  return !step.value.valid() || values.is_constant(step.value);
}

int64_t index_of(const Step& step, const Values& values) {
  return step.value.valid() ? static_cast<int64_t>(values.constant_bits(step.value))
                            : step.constant_index;
}

// From one root: apart as soon as members or constant indices differ.
// Members of a union always meet.
bool steps_may_meet(const Place& a, const Place& b, const Values& values) {
  const TypeTable& types = values.types();
  TypeId at = a.base_type;
  uint32_t dims = 0;
  const size_t common = std::min(a.steps.size(), b.steps.size());
  for (size_t i = 0; i < common; ++i) {
    const Step& left = a.steps[i];
    const Step& right = b.steps[i];
    if (left.kind != right.kind || types.overlaps(at)) return true;
    if (left.kind == StepKind::kMember && left.index != right.index) return false;
    if (left.kind == StepKind::kIndex && is_constant_step(left, values) &&
        is_constant_step(right, values) && index_of(left, values) != index_of(right, values)) {
      return false;
    }
    if (left.kind == StepKind::kMember) at = types[at].members[left.index].type;
    if (left.kind == StepKind::kIndex && ++dims == types[at].dims.size()) {
      at = types[at].base;
      dims = 0;
    }
  }
  return true;
}

}  // namespace

bool may_alias(const Place& a, const Place& b, const Values& values) {
  const bool a_private = is_private(a, values);
  if (a_private != is_private(b, values)) return false;
  if (a_private) return same_root(a, b) && steps_may_meet(a, b, values);
  if (follows_reference(a) || follows_reference(b)) return true;
  if (same_root(a, b)) return steps_may_meet(a, b, values);
  // Argument frames of different callees are the same memory.
  if (a.base == PlaceBase::kArg && b.base == PlaceBase::kArg) return a.pou != b.pou;
  // An instance among the globals may be the one whose code this is.
  const bool a_global = a.base == PlaceBase::kGlobal && enters(a);
  const bool b_global = b.base == PlaceBase::kGlobal && enters(b);
  return (a_global && b.base == PlaceBase::kSelf) || (b_global && a.base == PlaceBase::kSelf);
}

bool calls_may_change(const Place& place, const Values& values) {
  return !is_private(place, values);
}

bool is_static(const Place& place, const Values& values) {
  if (place.base == PlaceBase::kPointee || place.base == PlaceBase::kTarget) return false;
  return std::all_of(place.steps.begin(), place.steps.end(), [&](const Step& step) {
    return step.kind == StepKind::kMember ||
           (step.kind == StepKind::kIndex && is_constant_step(step, values));
  });
}

}  // namespace ir::codegen
