#include "ir/program/verify_memory.h"

#include "ir/program/shape.h"
#include "ir/types/parts.h"

namespace ir {

std::string MemoryVerifier::check(const Inst& inst) {
  reason_.clear();
  check_memory_inst(inst);
  return reason_;
}

bool MemoryVerifier::writable(ValueId value) const {
  const Place* place = pointee(value);
  return place == nullptr || place->base != PlaceBase::kConst;
}

// What `value` points to, where the instruction that made it is known.
const Place* MemoryVerifier::pointee(ValueId value) const {
  const Inst* definition = definitions_[value.index];
  const bool points = definition != nullptr &&
                      (definition->op == Op::kAddress || definition->op == Op::kString) &&
                      definition->place.index < pou_.places.size();
  return points ? &pou_.places[definition->place.index] : nullptr;
}

void MemoryVerifier::check_memory_inst(const Inst& inst) {
  const bool is_handle = inst.op == Op::kHandle;
  const std::optional<PlaceState> state = check_one_place(inst.place, is_handle);
  if (!state) {
    return;
  }
  if (is_handle) {
    return check_handle(inst, *state);
  }
  const bool reads = inst.op == Op::kLoad || inst.op == Op::kString || inst.op == Op::kAddress;
  require(reads || pou_.places[inst.place.index].base != PlaceBase::kConst,
          "a constant is written");
  require(!state->slot || inst.op == Op::kStore, "in-out slot is used without following it");
  if (reason_.empty()) {
    check_access(inst, *state);
  }
}

void MemoryVerifier::check_handle(const Inst& inst, const PlaceState& state) {
  const Place& place = pou_.places[inst.place.index];
  require(inst.scalar == Scalar::kU64, "a handle is u64");
  require(!state.slot, "in-out slot is used without following it");
  require(place.base != PlaceBase::kConst && place.base != PlaceBase::kArg,
          "a constant or an argument has no handle");
  require(!state.entered || program_.types.is_instance(state.type), "the globals have no handle");
}

void MemoryVerifier::check_access(const Inst& inst, const PlaceState& state) {
  const TypeTable& types = program_.types;
  const Kind kind = types[state.type].kind;
  switch (inst.op) {
    case Op::kLoad:
      require(types.is_scalar(state.type) && types.scalar(state.type) == inst.scalar,
              "load of another type than the place has");
      break;
    case Op::kStore:
      check_store(inst, state);
      break;
    case Op::kCopy:
      check_copy(inst, state);
      break;
    case Op::kInit:
      require(!holds_instance(types, state.type), "instances are not initialised by code");
      break;
    case Op::kAddress:
      require(inst.scalar == Scalar::kAddr, "an address is addr");
      break;
    case Op::kString:
      require((kind == Kind::kString && inst.scalar == Scalar::kStr) ||
                  (kind == Kind::kWstring && inst.scalar == Scalar::kWstr),
              "the place is no string of that kind");
      break;
    case Op::kCallMethod:
      require(types.is_a(state.type, program_.pous[inst.pou.index].self),
              "the instance has no such method");
      break;
    default:
      require(types.is_instance(state.type), "the place is no function block instance");
  }
}

void MemoryVerifier::check_store(const Inst& inst, const PlaceState& state) {
  const TypeTable& types = program_.types;
  require(pou_.values[inst.operands[0].index].scalar == inst.scalar, "operand of another type");
  if (!state.slot) {
    require(types.is_scalar(state.type) && types.scalar(state.type) == inst.scalar,
            "store of another type than the place has");
    return;
  }
  require(inst.scalar == Scalar::kAddr, "an in-out slot takes an address");
  const Place* target = pointee(inst.operands[0]);
  if (target != nullptr && types.contains(target->type)) {
    require(same_shape(types, target->type, state.type),
            "the in-out is bound to a place of another type");
  }
}

void MemoryVerifier::check_copy(const Inst& inst, const PlaceState& to) {
  const std::optional<PlaceState> from = check_one_place(inst.place2, false);
  if (!from) {
    return;
  }
  require(!from->slot, "in-out slot is used without following it");
  require(can_copy(program_.types, to.type, from->type), "copy between different types");
}

std::optional<PlaceState> MemoryVerifier::check_one_place(PlaceId id, bool may_be_entered) {
  if (id.index >= pou_.places.size()) {
    fail("it needs a place");
    return std::nullopt;
  }
  const Place& place = pou_.places[id.index];
  check_place_values(place);
  if (!reason_.empty()) {
    return std::nullopt;
  }
  base::Result<PlaceState> state = check_place(program_, pou_, place);
  if (!state.ok()) {
    fail(state.error().text);
    return std::nullopt;
  }
  require(state->dimensions == 0 && (may_be_entered || !state->entered),
          "the place ends inside an array or an instance");
  return *state;
}

void MemoryVerifier::check_place_values(const Place& place) {
  for (const Step& step : place.steps) {
    const bool known = !step.value.valid() || (step.value.index < pou_.values.size() &&
                                               is_integer(pou_.values[step.value.index].scalar));
    require(known, "an index is no integer value");
  }
  const TypeTable& types = program_.types;
  if (place.base == PlaceBase::kConst || place.base == PlaceBase::kPointee ||
      place.base == PlaceBase::kTarget) {
    require(types.contains(place.base_type), "place of a type that does not exist");
  }
  if (place.base == PlaceBase::kConst && reason_.empty()) {
    require(!holds_instance(types, place.base_type), "constant of an instance type");
  }
  if (place.base == PlaceBase::kTarget && reason_.empty()) {
    require(place.value.index < pou_.values.size() &&
                pou_.values[place.value.index].scalar == Scalar::kU64 &&
                types[place.base_type].kind != Kind::kGlobals,
            "the base is no handle of a variable");
  }
  if (place.base == PlaceBase::kPointee && reason_.empty()) {
    check_pointee(place);
  }
}

void MemoryVerifier::check_pointee(const Place& place) {
  if (place.value.index >= pou_.values.size() ||
      pou_.values[place.value.index].scalar != Scalar::kAddr) {
    return fail("the base is no address value");
  }
  const Place* target = pointee(place.value);
  if (target != nullptr && program_.types.contains(target->type)) {
    require(same_shape(program_.types, target->type, place.base_type),
            "the address is of another type than the place says");
  }
}

}  // namespace ir
