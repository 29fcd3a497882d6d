// What places say about themselves: their names, for traps, and the values of
// places inside constants.
#include "ir/lower/select.h"

namespace ir::codegen {
namespace {

// nullopt when an index is outside its bounds.
std::optional<uint64_t> flat_index(const Type& array, const Place& place, size_t first,
                                   const Values& values) {
  uint64_t flat = 0;
  for (size_t d = 0; d < array.dims.size(); ++d) {
    const Step& step = place.steps[first + d];
    const int64_t index = step.value.valid()
                              ? static_cast<int64_t>(values.constant_bits(step.value))
                              : step.constant_index;
    if (index < array.dims[d].low || index > array.dims[d].high) return std::nullopt;
    flat = flat * array.dims[d].count() + static_cast<uint64_t>(index - array.dims[d].low);
  }
  return flat;
}

ConstId element_of(const ConstTable& constants, ConstId value, uint64_t index) {
  ConstId found;
  for (const ConstElement& element : constants[value].elements) {
    if (index >= element.first && index - element.first < element.count) found = element.value;
  }
  return found;
}

}  // namespace

std::string Selector::place_name(const Place& place, size_t steps) const {
  std::string name;
  TypeId type = place.base_type;
  if (place.base == PlaceBase::kLocal) name = pou_.locals[place.base_index].name;
  if (place.base == PlaceBase::kArg) {
    name = program_.pous[place.pou.index].locals[place.base_index].name;
  }
  size_t dims = 0;
  for (size_t i = 0; i < steps; ++i) {
    const Step& step = place.steps[i];
    if (step.kind == StepKind::kMember) {
      const Member& member = types()[type].members[step.index];
      name += (name.empty() ? "" : ".") + member.name;
      type = member.type;
    } else if (step.kind == StepKind::kIndex) {
      name += step.value.valid() ? "[..]" : "[" + std::to_string(step.constant_index) + "]";
      if (++dims == types()[type].dims.size()) {
        type = types()[type].base;
        dims = 0;
      }
    }
  }
  return name;
}

// The scalar at a fixed place inside a constant; nullopt where a default decides.
std::optional<uint64_t> Selector::constant_scalar(const Place& place) const {
  ConstId value = place.constant;
  TypeId type = place.base_type;
  if (!value.valid() && place.steps.empty()) return default_bits(type);
  for (size_t i = 0; i < place.steps.size() && value.valid();) {
    const Type& at = types()[type];
    if (place.steps[i].kind == StepKind::kMember) {
      value = element_of(program_.constants, value, place.steps[i].index);
      type = at.members[place.steps[i].index].type;
      ++i;
      continue;
    }
    if (at.dims.empty() || i + at.dims.size() > place.steps.size()) return std::nullopt;
    const std::optional<uint64_t> flat = flat_index(at, place, i, values_);
    if (!flat) return std::nullopt;
    value = element_of(program_.constants, value, *flat);
    type = at.base;
    i += at.dims.size();
  }
  if (!value.valid()) return std::nullopt;
  return program_.constants[value].bits;
}

}  // namespace ir::codegen
