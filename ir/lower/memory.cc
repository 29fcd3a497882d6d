// Loads through addresses, stores, copies, initial values, addresses and strings.
#include "ir/lower/opcodes.h"
#include "ir/lower/select.h"

namespace ir::codegen {

void Selector::load_into(const Location& at, Class cls, Operand dest) {
  emit(load_opcode(cls), dest, at.addr, Operand::immediate(offset_of(at)));
}

void Selector::select_store(const Inst& inst) {
  const Place& place = pou_.places[inst.place.index];
  flush_writes(inst, place);
  if (inst.scalar == Scalar::kAddr) return bind_reference(inst);
  const Class cls = class_of(inst.scalar);
  if (const Operand fixed = fixed_operand(inst.place, cls); !fixed.none()) {
    return assign(fixed, inst.operands[0]);
  }
  const Location at = locate(place);
  if (!at.behind_addr) return assign(fix_operand(inst.place, at, cls), inst.operands[0]);
  store_operand(at, cls, use(inst.operands[0]));
}

void Selector::store_operand(const Location& at, Class cls, Operand source) {
  if (!at.behind_addr) return move(cls, operand_of(at, cls), source);
  emit(store_opcode(cls), at.addr, source, Operand::immediate(offset_of(at)));
}

// Stores an address into an in-out slot.
void Selector::bind_reference(const Inst& inst) {
  const Location at = locate(pou_.places[inst.place.index]);
  if (at.behind_addr) {
    emit(Opcode::ST_REF_AT, at.addr, use(inst.operands[0]), Operand::immediate(offset_of(at)));
    return forget_references();
  }
  if (at.place.root == PlaceRoot::kSlot && at.place.steps.empty()) {
    return assign(operand_of(at, Class::kA), inst.operands[0]);
  }
  fail(base::Refusal::kTooMany, "an in-out of the POU itself cannot be bound from inside");
}

// --- addresses --------------------------------------------------------------------

void Selector::address_into(const Location& at, Operand dest) {
  const Region region = at.place.result;
  if (region.dim != 0 || types().is_instance(region.type)) {
    // The address of an instance is that of its area.
    Location inside = at;
    step_enter(inside);
    return move(Class::kA, dest, inside.addr);
  }
  if (at.behind_handle) {
    Location resolved = at;
    return resolve(resolved, dest);
  }
  const uint32_t type = tables_.region(region);
  if (!at.behind_addr) return emit(Opcode::LEA, dest, field_of(at), {}, extension_of(at), type);
  if (at.place.steps.empty()) return move(Class::kA, dest, at.addr);
  emit(Opcode::LEA_AT, dest, at.addr, {}, offset_of(at), type);
}

Operand Selector::address_of(const Location& at) {
  const Region region = at.place.result;
  if (at.behind_addr && at.place.steps.empty() && region == at.place.region) return at.addr;
  const Operand dest = new_register(Class::kA, region, false);
  address_into(at, dest);
  return dest;
}

void Selector::compute_address(const Inst& inst, Operand dest) {
  address_into(locate(pou_.places[inst.place.index]), dest);
}

// --- strings ----------------------------------------------------------------------

void Selector::string_into(const Location& at, TypeId type, Operand dest) {
  const bool wide = types()[type].kind == Kind::kWstring;
  const uint32_t capacity = types()[type].capacity;
  if (at.behind_handle) {
    return emit(wide ? Opcode::RESOLVE_W : Opcode::RESOLVE_S, dest, at.handle, {}, capacity,
                offset_of(at));
  }
  if (at.behind_addr) {
    return emit(wide ? Opcode::WSTR_AT : Opcode::STR_AT, dest, at.addr, {}, offset_of(at),
                capacity);
  }
  emit(wide ? Opcode::WSTR : Opcode::STR, dest, field_of(at), {}, extension_of(at), capacity);
}

Operand Selector::string_of(const Location& at, TypeId type) {
  const bool wide = types()[type].kind == Kind::kWstring;
  const Operand dest = new_register(wide ? Class::kW : Class::kS, {}, true);
  string_into(at, type, dest);
  return dest;
}

void Selector::compute_string(const Inst& inst, Operand dest) {
  const Place& place = pou_.places[inst.place.index];
  string_into(locate(place), place.type, dest);
}

// --- whole values ------------------------------------------------------------------

void Selector::copy_value(const Location& to, TypeId to_type, const Location& from,
                          TypeId from_type) {
  const Kind kind = types()[to_type].kind;
  if (kind == Kind::kString || kind == Kind::kWstring) {
    const Operand dest = string_of(to, to_type);
    const Operand source = string_of(from, from_type);
    return emit(kind == Kind::kString ? Opcode::SCOPY : Opcode::WCOPY, dest, source);
  }
  copy_whole(to, to_type, from);
}

void Selector::copy_whole(const Location& to, TypeId type, const Location& from) {
  const Operand dest = address_of(to);
  const Operand source = address_of(from);
  emit(Opcode::COPY, dest, source, {}, tables_.region({type, 0}));
}

void Selector::select_copy(const Inst& inst) {
  const Place& to = pou_.places[inst.place.index];
  const Place& from = pou_.places[inst.place2.index];
  flush_writes(inst, to);
  const Location source = locate(from);
  const Location dest = locate(to);
  if (!types().is_scalar(to.type)) return copy_value(dest, to.type, source, from.type);
  const Class cls = class_of(types().scalar(to.type));
  if (!source.behind_addr && source.base != Base::kConst) {
    return store_operand(dest, cls, operand_of(source, cls));
  }
  const Operand loaded = new_register(cls, {}, true);
  if (source.behind_addr) {
    load_into(source, cls, loaded);
  } else {
    const uint64_t bits = constant_scalar(from).value_or(default_bits(from.type));
    move(cls, loaded, Operand::constant(tables_.scalar(cls, bits)));
  }
  store_operand(dest, cls, loaded);
}

// Initial value of a scalar type: its own, or that of the type it is made from.
uint64_t Selector::default_bits(TypeId id) const {
  for (;;) {
    const Type& type = types()[id];
    if (type.init.valid()) return program_.constants[type.init].bits;
    if (type.kind != Kind::kEnum && type.kind != Kind::kSubrange) return 0;
    id = type.base;
  }
}

// Invalid constant: that of the type.
Location Selector::initial_value(TypeId type, ConstId constant) {
  Location initial;
  initial.base = Base::kConst;
  initial.constant = constant;
  initial.constant_type = type;
  initial.place.result = {type, 0};
  return initial;
}

void Selector::select_init(const Inst& inst) {
  const Place& place = pou_.places[inst.place.index];
  flush_writes(inst, place);
  const Location at = locate(place);
  if (types().is_scalar(place.type)) {
    const Class cls = class_of(types().scalar(place.type));
    const uint64_t bits =
        inst.constant.valid() ? program_.constants[inst.constant].bits : default_bits(place.type);
    return store_operand(at, cls, Operand::constant(tables_.scalar(cls, bits)));
  }
  const Location initial = initial_value(place.type, inst.constant);
  // A pointer sees what is behind the end of a text, so nothing of an earlier call is left there.
  if (place.base == PlaceBase::kLocal && values_.local_escapes(place.base_index)) {
    return copy_whole(at, place.type, initial);
  }
  copy_value(at, place.type, initial, place.type);
}

}  // namespace ir::codegen
