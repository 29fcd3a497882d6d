#include "ir/program/alias.h"

#include <algorithm>

namespace ir {
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

bool is_private(const Place& place, const AliasFacts& facts) {
  return place.base == PlaceBase::kConst ||
         (place.base == PlaceBase::kLocal && !follows_reference(place) &&
          !facts.local_escapes(place.base_index));
}

bool same_root(const Place& a, const Place& b) {
  return a.base == b.base && a.base_index == b.base_index && a.pou == b.pou &&
         a.constant == b.constant;
}

// nullopt: known at run time only.
std::optional<int64_t> index_of(const Step& step, const AliasFacts& facts) {
  return step.value.valid() ? facts.constant_index(step.value) : step.constant_index;
}

// From one root: apart as soon as members or constant indices differ.
// Members of a union always meet.
bool steps_may_meet(const Place& a, const Place& b, const AliasFacts& facts) {
  const TypeTable& types = facts.types();
  TypeId at = a.base_type;
  uint32_t dims = 0;
  const size_t common = std::min(a.steps.size(), b.steps.size());
  for (size_t i = 0; i < common; ++i) {
    const Step& left = a.steps[i];
    const Step& right = b.steps[i];
    if (left.kind != right.kind || types.overlaps(at)) return true;
    if (left.kind == StepKind::kMember && left.index != right.index) return false;
    if (left.kind == StepKind::kIndex) {
      const std::optional<int64_t> l = index_of(left, facts);
      const std::optional<int64_t> r = index_of(right, facts);
      if (l && r && *l != *r) return false;
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

bool may_alias(const Place& a, const Place& b, const AliasFacts& facts) {
  const bool a_private = is_private(a, facts);
  if (a_private != is_private(b, facts)) return false;
  if (a_private) return same_root(a, b) && steps_may_meet(a, b, facts);
  if (follows_reference(a) || follows_reference(b)) return true;
  if (same_root(a, b)) return steps_may_meet(a, b, facts);
  // Argument frames of different callees are the same memory.
  if (a.base == PlaceBase::kArg && b.base == PlaceBase::kArg) return a.pou != b.pou;
  // An instance among the globals may be the one whose code this is.
  const bool a_global = a.base == PlaceBase::kGlobal && enters(a);
  const bool b_global = b.base == PlaceBase::kGlobal && enters(b);
  return (a_global && b.base == PlaceBase::kSelf) || (b_global && a.base == PlaceBase::kSelf);
}

bool calls_may_change(const Place& place, const AliasFacts& facts) {
  return !is_private(place, facts);
}

bool is_static(const Place& place, const AliasFacts& facts) {
  if (place.base == PlaceBase::kPointee || place.base == PlaceBase::kTarget) return false;
  TypeId at = place.base_type;
  uint32_t dim = 0;
  for (const Step& step : place.steps) {
    const Type& type = facts.types()[at];
    if (step.kind == StepKind::kMember) {
      at = type.members[step.index].type;
    } else if (step.kind == StepKind::kIndex) {
      const std::optional<int64_t> index = index_of(step, facts);
      const Dimension& bounds = type.dims[dim];
      if (!index || *index < bounds.low || *index > bounds.high) return false;
      if (++dim < type.dims.size()) continue;
      at = type.base;
      dim = 0;
    } else {
      return false;
    }
  }
  return true;
}

std::optional<uint32_t> local_of_address(const Inst& inst, const Pou& pou) {
  const Place& place = pou.places[inst.place.index];
  const bool behind = !place.steps.empty() && place.steps[0].kind == StepKind::kDeref;
  if (place.base != PlaceBase::kLocal || behind) return std::nullopt;
  return place.base_index;
}

}  // namespace ir
