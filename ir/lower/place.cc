// Places become symbolic offsets from a fixed root, or from an address that was
// computed for the steps that no offset can express.
#include <cstring>

#include "ir/lower/opcodes.h"
#include "ir/lower/select.h"

namespace ir::codegen {
namespace {

bool needs_address(const Step& step, const Values& values) {
  return step.kind == StepKind::kEnter || step.kind == StepKind::kDeref ||
         (step.kind == StepKind::kIndex && step.value.valid() && !values.is_constant(step.value));
}

void append(ObjectPlace& place, Step step, Region result) {
  place.steps.push_back(step);
  place.result = result;
}

Step constant_step(StepKind kind, uint32_t index, int64_t constant_index) {
  Step step;
  step.kind = kind;
  step.index = index;
  step.constant_index = constant_index;
  return step;
}

// An element of an array of function blocks is an ID slot, not the instance: it
// stays a region of the array.
Region element_region(const TypeTable& types, Region array) {
  const Type& type = types[array.type];
  const auto dim = static_cast<uint8_t>(array.dim + 1);
  const bool whole = dim == type.dims.size() && !types.is_instance(type.base);
  return whole ? Region{type.base, 0} : Region{array.type, dim};
}

}  // namespace

void Selector::behind(Location& at, Operand addr, Region region) const {
  at.behind_addr = true;
  at.behind_handle = false;
  at.addr = addr;
  at.base = Base::kFrame;
  at.place = {};
  at.place.root = PlaceRoot::kRegion;
  at.place.region = region;
  at.place.result = region;
}

Location Selector::root_of(const Place& place) {
  Location at;
  at.place.result = {place.base_type, 0};
  switch (place.base) {
    case PlaceBase::kSelf:
      at.base = Base::kSelf;
      at.place.root = PlaceRoot::kSelf;
      break;
    case PlaceBase::kGlobal:
      at.base = Base::kGlobal;
      at.place.root = PlaceRoot::kGlobal;
      break;
    case PlaceBase::kLocal:
      at.place.root = PlaceRoot::kSlot;
      at.place.slot = place.base_index;
      break;
    case PlaceBase::kArg: {
      const Pou& callee = program_.pous[place.pou.index];
      const Local& param = callee.locals[place.base_index];
      const bool in_out = param.kind == LocalKind::kInOut;
      const bool aggregate = !in_out && !types().is_scalar(param.type);
      Class cls = in_out ? Class::kA : Class::kB;
      if (!in_out && !aggregate) cls = class_of(types().scalar(param.type));
      at.place.root = PlaceRoot::kSlot;
      at.place.slot = tables_.argument_slot(tables_.callee(callee.name), place.base_index, cls,
                                            aggregate, {param.type, 0});
      break;
    }
    case PlaceBase::kConst:
      at.base = Base::kConst;
      at.constant = place.constant;
      at.constant_type = place.base_type;
      break;
    case PlaceBase::kTarget:
      at.behind_handle = true;
      at.handle = use(place.value);
      at.place.root = PlaceRoot::kRegion;
      at.place.region = at.place.result;
      break;
    case PlaceBase::kPointee:
      behind(at, use(place.value), {place.base_type, 0});
      break;
  }
  return at;
}

// A constant has no places inside: its address comes first.
static bool is_bare_constant(const Location& at) {
  return !at.behind_addr && at.base == Base::kConst;
}

Location Selector::locate(const Place& place) {
  if (place.base == PlaceBase::kTarget) return locate_target(place);
  Location at;
  size_t next = resume_from_cache(at, place);
  if (next == 0) at = root_of(place);
  walk(at, place, next);
  return at;
}

void Selector::walk(Location& at, const Place& place, size_t next) {
  for (; next < place.steps.size(); ++next) {
    const Step& step = place.steps[next];
    if (is_bare_constant(at) && !needs_address(step, values_)) {
      behind(at, address_of(at), at.place.result);
    }
    switch (step.kind) {
      case StepKind::kMember: {
        const Type& type = types()[at.place.result.type];
        append(at.place, constant_step(StepKind::kMember, step.index, 0),
               {type.members[step.index].type, 0});
        break;
      }
      case StepKind::kIndex:
        step_index(at, place, next);
        break;
      case StepKind::kEnter:
        step_enter(at);
        break;
      case StepKind::kDeref:
        step_dereference(at);
        break;
    }
    if (needs_address(step, values_) && !at.behind_handle) remember(place, next + 1, at);
  }
}

// A constant index outside its bounds is left to the check at run time.
void Selector::step_index(Location& at, const Place& place, size_t number) {
  const Step& step = place.steps[number];
  const Region array = at.place.result;
  const Dimension& dimension = types()[array.type].dims[array.dim];
  const bool constant = !step.value.valid() || values_.is_constant(step.value);
  int64_t index = step.constant_index;
  if (step.value.valid() && constant)
    index = static_cast<int64_t>(values_.constant_bits(step.value));
  if (constant && index >= dimension.low && index <= dimension.high) {
    append(at.place, constant_step(StepKind::kIndex, 0, index), element_region(types(), array));
    return;
  }
  const std::string name = place_name(place, number);
  if (constant) {
    const uint32_t pooled = tables_.scalar(Class::k64, static_cast<uint64_t>(index));
    step_dynamic_index(at, Operand::constant(pooled), Scalar::kI64, name);
  } else {
    step_dynamic_index(at, use(step.value), pou_.values[step.value.index].scalar, name);
  }
}

void Selector::step_dynamic_index(Location& at, Operand index, Scalar index_scalar,
                                  const std::string& name) {
  const Region array = at.place.result;
  const Region element = element_region(types(), array);
  const uint32_t bound = tables_.bound(array.type, array.dim, name);
  if (at.behind_handle) return index_handle(at, index, index_scalar, bound, element);
  const Operand addr = new_register(Class::kA, element, false);
  if (at.behind_addr) {
    emit(index_opcode(index_scalar), addr, index, at.addr, bound, offset_of(at));
  } else {
    emit(index_place_opcode(index_scalar), addr, index, field_of(at), bound, extension_of(at));
  }
  behind(at, addr, element);
}

void Selector::step_enter(Location& at) {
  const Region slot = at.place.result;
  const TypeId instance = slot.dim != 0 ? types()[slot.type].base : slot.type;
  // What an in-out of a function block points to is the instance itself.
  if (at.behind_addr && at.place.steps.empty() && at.place.region == Region{instance, 0}) return;
  const Operand addr = new_register(Class::kA, {instance, 0}, false);
  if (at.behind_addr) {
    emit(Opcode::INST_AT, addr, at.addr, Operand::immediate(offset_of(at)));
  } else {
    emit(Opcode::INST, addr, field_of(at));
  }
  behind(at, addr, {instance, 0});
}

void Selector::step_dereference(Location& at) {
  const Region target = at.place.result;
  if (!at.behind_addr && at.place.root == PlaceRoot::kSlot && at.place.steps.empty()) {
    const uint32_t slot = at.place.slot;
    const bool named = slot < local_registers_.size() && local_registers_[slot] != kNoNumber;
    behind(at, named ? Operand::reg(local_registers_[slot]) : Operand::slot(slot), target);
    return;
  }
  const Operand addr = new_register(Class::kA, target, false);
  if (at.behind_addr) {
    emit(Opcode::LD_REF_AT, addr, at.addr, Operand::immediate(offset_of(at)));
  } else {
    emit(Opcode::LD_REF, addr, field_of(at));
  }
  behind(at, addr, target);
}

// --- addresses computed earlier in this block ----------------------------------

const std::string& Selector::prefix_key(const Place& place, size_t steps) {
  prefix_key_.clear();
  const auto add = [this](auto part) {
    char bytes[sizeof part];
    std::memcpy(bytes, &part, sizeof part);
    prefix_key_.append(bytes, sizeof part);
  };
  add(place.base);
  add(place.base_index);
  add(place.pou.index);
  add(place.value.valid() ? values_.root(place.value).index : kNoNumber);
  add(place.constant.index);
  add(place.base_type.index);  // one handle may stand for pointers to several types
  for (size_t i = 0; i < steps; ++i) {
    const Step& step = place.steps[i];
    const bool constant = step.value.valid() && values_.is_constant(step.value);
    add(step.kind);
    add(step.index);
    add(step.value.valid() && !constant ? values_.root(step.value).index : kNoNumber);
    add(constant ? static_cast<int64_t>(values_.constant_bits(step.value)) : step.constant_index);
  }
  return prefix_key_;
}

const Selector::CachedAddress* Selector::find_address(const std::string& key) const {
  const uint32_t number = addresses_.numbers.find(key);
  if (number == base::ByteTable::kNone || !addresses_.rows[number].known) return nullptr;
  return &addresses_.rows[number];
}

void Selector::keep_address(const std::string& key, const CachedAddress& address) {
  const uint32_t next = static_cast<uint32_t>(addresses_.rows.size());
  const uint32_t number = addresses_.numbers.add(key, next);
  if (number == next) addresses_.rows.emplace_back();
  addresses_.rows[number] = address;
}

// Number of steps that an earlier address already covers.
size_t Selector::resume_from_cache(Location& at, const Place& place) {
  for (size_t steps = place.steps.size(); steps > 0; --steps) {
    if (!needs_address(place.steps[steps - 1], values_)) continue;
    const CachedAddress* const found = find_address(prefix_key(place, steps));
    if (found == nullptr) continue;
    if (place.value.valid()) consume(place.value);
    for (size_t i = 0; i < steps; ++i) {
      const Step& step = place.steps[i];
      if (step.value.valid() && !values_.is_constant(step.value)) consume(step.value);
    }
    behind(at, found->addr, found->region);
    return steps;
  }
  return 0;
}

void Selector::remember(const Place& place, size_t steps, const Location& at) {
  bool by_reference = false;
  for (size_t i = 0; i < steps; ++i) by_reference |= place.steps[i].kind == StepKind::kDeref;
  keep_address(prefix_key(place, steps), {at.addr, at.place.region, by_reference});
}

// --- fields of instructions ------------------------------------------------------

// The operand for a BASE or BC32 field.
Operand Selector::field_of(const Location& at) {
  if (at.base == Base::kConst) return Operand::constant(extension_of(at));
  return Operand::place(at.base, offset_of(at));
}

uint32_t Selector::extension_of(const Location& at) {
  if (at.base == Base::kConst) return tables_.initial_value(at.constant_type, at.constant);
  return offset_of(at);
}

// A near operand for the scalar at a fixed place.
Operand Selector::operand_of(const Location& at, Class cls) {
  base::check(at.base != Base::kConst, "scalar constants are folded");
  if (at.place.root != PlaceRoot::kSlot || !at.place.steps.empty()) {
    return Operand::place(at.base, offset_of(at));
  }
  const uint32_t slot = at.place.slot;
  const bool named = slot < local_registers_.size() && local_registers_[slot] != kNoNumber;
  base::check(object_.slots[slot].cls == cls, "a slot is used by its own class");
  return named ? Operand::reg(local_registers_[slot]) : Operand::slot(slot);
}

Operand Selector::fix_operand(PlaceId place, const Location& at, Class cls) {
  const Operand operand = operand_of(at, cls);
  if (!at.behind_handle) fixed_[place.index] = {operand, cls};
  return operand;
}

}  // namespace ir::codegen
