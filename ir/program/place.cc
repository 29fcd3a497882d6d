#include "ir/program/place.h"

namespace ir {
namespace {

base::Error bad_place(std::string text) { return {base::Refusal::kInternal, std::move(text)}; }

base::Result<PlaceState> local_base(const Pou& pou, uint32_t index) {
  if (index >= pou.locals.size()) {
    return bad_place("local " + std::to_string(index) + " of " + pou.name + " does not exist");
  }
  const Local& local = pou.locals[index];
  return PlaceState{local.type, false, local.kind == LocalKind::kInOut, 0};
}

base::Result<PlaceState> member_step(const TypeTable& types, const PlaceState& from,
                                     uint32_t index) {
  const bool is_struct = is_structure(types[from.type].kind);
  if (!types.has_members(from.type) || (!is_struct && !from.entered)) {
    return bad_place("member of " + types.text(from.type) + ", which has none or was not entered");
  }
  const std::vector<Member>& members = types[from.type].members;
  if (index >= members.size()) {
    return bad_place("member " + std::to_string(index) + " of " + types.text(from.type) +
                     " does not exist");
  }
  const Member& member = members[index];
  return PlaceState{member.type, false, member.section == Section::kInOut, 0};
}

base::Result<PlaceState> index_step(const TypeTable& types, const PlaceState& from,
                                    const Step& step) {
  const Type& array = types[from.type];
  if (array.kind != Kind::kArray || from.dimensions >= array.dims.size()) {
    return bad_place("index of " + types.text(from.type) + ", which is no array");
  }
  const Dimension& dim = array.dims[from.dimensions];
  if (!step.value.valid() && (step.constant_index < dim.low || step.constant_index > dim.high)) {
    return bad_place("index " + std::to_string(step.constant_index) + " is outside " +
                     types.text(from.type));
  }
  const bool last = from.dimensions + 1 == array.dims.size();
  return last ? PlaceState{array.base, false, false, 0}
              : PlaceState{from.type, false, false, from.dimensions + 1};
}

}  // namespace

base::Result<PlaceState> place_base(const Program& program, const Pou& pou, const Place& place) {
  switch (place.base) {
    case PlaceBase::kLocal:
      return local_base(pou, place.base_index);
    case PlaceBase::kSelf:
      if (pou.kind == PouKind::kFunction || !program.types.is_instance(pou.self)) {
        return bad_place(pou.name + " has no instance of its own");
      }
      return PlaceState{pou.self, true, false, 0};
    case PlaceBase::kGlobal:
      return PlaceState{program.globals, true, false, 0};
    case PlaceBase::kArg:
      if (place.pou.index >= program.pous.size() ||
          !has_parameters(program.pous[place.pou.index].kind)) {
        return bad_place("argument of something that is no function");
      }
      return local_base(program.pous[place.pou.index], place.base_index);
    case PlaceBase::kConst:
      if (!program.constants.contains(place.constant)) {
        return bad_place("constant " + std::to_string(place.constant.index) + " does not exist");
      }
      return PlaceState{place.base_type, false, false, 0};
    case PlaceBase::kPointee:
    case PlaceBase::kTarget:
      return PlaceState{place.base_type, false, false, 0};
  }
  return bad_place("place without a base");
}

base::Result<PlaceState> place_step(const TypeTable& types, const PlaceState& from,
                                    const Step& step) {
  if (!types.contains(from.type)) {
    return bad_place("place of a type that does not exist");
  }
  if (from.slot != (step.kind == StepKind::kDeref)) {
    return bad_place(from.slot ? "in-out slot is used without following it"
                               : "only an in-out slot can be followed");
  }
  switch (step.kind) {
    case StepKind::kMember:
      return member_step(types, from, step.index);
    case StepKind::kIndex:
      return index_step(types, from, step);
    case StepKind::kEnter:
      if (!types.is_instance(from.type) || from.entered) {
        return bad_place("entering " + types.text(from.type) + ", which is no instance slot");
      }
      return PlaceState{from.type, true, false, 0};
    case StepKind::kDeref:
      return PlaceState{from.type, false, false, 0};
  }
  return bad_place("unknown step");
}

base::Result<PlaceState> check_place(const Program& program, const Pou& pou, const Place& place) {
  base::Result<PlaceState> state = place_base(program, pou, place);
  if (state.ok() && place.base_type != state->type) {
    return bad_place("the place's base has another type than the place says");
  }
  for (const Step& step : place.steps) {
    if (!state.ok()) {
      return state;
    }
    state = place_step(program.types, *state, step);
  }
  if (state.ok() && !program.types.contains(state->type)) {
    return bad_place("place of a type that does not exist");
  }
  if (state.ok() && place.type != state->type) {
    return bad_place("the place is " + program.types.text(state->type) + ", but says " +
                     program.types.text(place.type));
  }
  return state;
}

}  // namespace ir
