#include "ir/bytecode/verify_code.h"

namespace ir::verification {

// Everything but control flow. Reads come before writes.
bool CodeVerifier::special(const OpcodeRow& row) {
  switch (u_.opcode()) {
    case Opcode::MOV_A:
    case Opcode::MOV_S:
    case Opcode::MOV_W: {
      const auto source = read_pointer(u_.b, row.b.cls);
      return source && write_pointer(u_.a, row.a.cls, *source);
    }
    case Opcode::LEA:
    case Opcode::LEA_AT:
      return check_lea();
    case Opcode::LD_REF:
      return check_reference_load(true);
    case Opcode::LD_REF_AT:
      return check_reference_load(false);
    case Opcode::ST_REF_AT:
      return check_reference_store();
    case Opcode::COPY:
      return check_copy();
    case Opcode::STR:
      return check_string(true, Class::kS);
    case Opcode::STR_AT:
      return check_string(false, Class::kS);
    case Opcode::WSTR:
      return check_string(true, Class::kW);
    case Opcode::WSTR_AT:
      return check_string(false, Class::kW);
    case Opcode::SCOPY:
      return check_string_copy(Class::kS);
    case Opcode::WCOPY:
      return check_string_copy(Class::kW);
    case Opcode::INST:
    case Opcode::INST_AT: {
      const TypeId type = instance_slot(u_.opcode() == Opcode::INST);
      return type.valid() && write_pointer(u_.a, Class::kA, {{type, 0}, false, 0});
    }
    case Opcode::HANDLE:
      return check_handle() && near_operand(row.a, u_.base_a(), u_.a, true);
    case Opcode::HANDLE_AT: {
      const auto base = read_pointer(u_.b, Class::kA);
      return base && (base->outgoing == 0 || next_has_no_handle()) &&
             near_operand(row.a, u_.base_a(), u_.a, true);
    }
    case Opcode::HANDLE_INST:
    case Opcode::HANDLE_INST_AT:
      return instance_slot(u_.opcode() == Opcode::HANDLE_INST).valid() &&
             near_operand(row.a, u_.base_a(), u_.a, true);
    case Opcode::RESOLVE:
      return check_resolve();
    case Opcode::RESOLVE_S:
    case Opcode::RESOLVE_W:
      return near_operand(row.b, u_.base_b(), u_.b, false) &&
             write_pointer(u_.a, row.a.cls, {{}, false, 0});
    case Opcode::CALL:
      return check_call();
    case Opcode::CALL_INST:
      return check_call_instance(true);
    case Opcode::CALL_INST_AT:
      return check_call_instance(false);
    case Opcode::CALL_REF:
      return check_call_reference();
    case Opcode::CALL_OWN:
      return check_call_own();
    case Opcode::CALL_METHOD:
    case Opcode::CALL_METHOD_AT:
      return check_call_method(u_.opcode() == Opcode::CALL_METHOD);
    case Opcode::CALL_METHOD_REF:
      return check_call_method_reference();
    case Opcode::CALL_VIRTUAL:
      return check_call_virtual();
    case Opcode::IS_TYPE:
      return check_is_type();
    case Opcode::NATIVE:
      return check_native();
    default:
      break;
  }
  const bool of_handle = row.a.cls == Class::k64;
  if (row.x.kind == FieldKind::kBounds && of_handle && !check_bounds(extension_.x())) return false;
  if (row.x.kind == FieldKind::kBounds && !of_handle)
    return check_index(row.y.kind == FieldKind::kPlace32);
  if (row.b.kind == FieldKind::kBc32) {
    const bool store = row.a.kind == FieldKind::kFrameRead;
    return near_operand(row.a, u_.base_a(), u_.a, !store) &&
           scalar_access({u_.base_b(), u_.bc()}, row.a.cls, store);
  }
  if (row.c.kind == FieldKind::kOffset16) {
    return row.a.cls == Class::kA && !row.a.writes() ? check_store(row.b) : check_load(row.a);
  }
  if (row.c.kind == FieldKind::kRange) {
    if (u_.c >= image_.ranges.size()) {
      return fail(Refusal::kBadReference, "there is no range " + std::to_string(u_.c));
    }
    facts_.ranges_end = std::max(facts_.ranges_end, u_.c + 1u);
  }
  if (row.a.kind == FieldKind::kTrap && u_.a >= kTrapCount) {
    return fail(Refusal::kBadReference, "there is no trap " + std::to_string(u_.a));
  }
  if (row.ends && !end_of_arguments("a trap")) return false;
  const auto reads = [&](const Field& f, Base base, uint32_t offset) {
    return !f.is_near() || !f.reads() || near_operand(f, base, offset, false);
  };
  if (!reads(row.b, u_.base_b(), u_.b) || !reads(row.c, u_.base_c(), u_.c) ||
      !reads(row.a, u_.base_a(), u_.a)) {
    return false;
  }
  return !row.a.writes() || near_operand(row.a, u_.base_a(), u_.a, true);
}

// Reading or writing through a pointer into the next frame uses that place there.
bool CodeVerifier::use(const Pointer& pointer, bool write) {
  if (write && pointer.read_only) {
    return fail(Refusal::kBadReference, "an input or a constant is written");
  }
  if (pointer.outgoing == 0) return true;
  const Outgoing& way = ways_[pointer.outgoing - 1];
  return (!write && is_result(way)) || put(way);
}

bool CodeVerifier::check_lea() {
  const Region region = region_of_field(extension_.y());
  if (!context_.valid(region)) return fail(Refusal::kBadReference, "there is no such type");
  if (u_.opcode() == Opcode::LEA) {
    const auto pointer = point_to({u_.base_b(), extension_.x()}, region);
    return pointer && write_pointer(u_.a, Class::kA, *pointer);
  }
  const auto base = read_pointer(u_.b, Class::kA);
  if (!base) return false;
  const auto flags = context_.regions.find(base->region, extension_.x(), region);
  if (!flags) {
    return fail(Refusal::kBadReference, "there is no " + image_.types.text(region.type) +
                                            " at offset " + std::to_string(extension_.x()));
  }
  const bool read_only = base->read_only || flags->constant || flags->input;
  return write_pointer(u_.a, Class::kA, {region, read_only, base->outgoing});
}

bool CodeVerifier::check_bounds(uint32_t number) {
  if (number >= image_.bounds.size()) {
    return fail(Refusal::kBadReference, "there are no bounds " + std::to_string(number));
  }
  facts_.bounds_end = std::max(facts_.bounds_end, number + 1);
  return true;
}

bool CodeVerifier::check_index(bool from_place) {
  const OpcodeRow& row = opcode_row(u_.opcode());
  if (!near_operand(row.b, u_.base_b(), u_.b, false)) return false;
  if (!check_bounds(extension_.x())) return false;
  const Region array = image_.bounds[extension_.x()].from;
  Pointer element;
  if (from_place) {
    const auto found = point_to({u_.base_c(), extension_.y()}, array);
    if (!found) return false;
    element = *found;
  } else {
    const auto base = read_pointer(u_.c, Class::kA);
    if (!base) return false;
    const auto flags = context_.regions.find(base->region, extension_.y(), array);
    if (!flags) {
      return fail(Refusal::kBadReference,
                  "there is no array of these bounds at offset " + std::to_string(extension_.y()));
    }
    element = {array, base->read_only || flags->constant || flags->input, base->outgoing};
  }
  element.region = indexed_region(image_.types, array);
  return write_pointer(u_.a, Class::kA, element);
}

bool CodeVerifier::check_load(const Field& dest) {
  const auto base = read_pointer(u_.b, Class::kA);
  return base && use(*base, false) && leaf_access(base->region, u_.c, dest.cls, false, "such") &&
         near_operand(dest, u_.base_a(), u_.a, true);
}

bool CodeVerifier::check_store(const Field& source) {
  const auto base = read_pointer(u_.a, Class::kA);
  return base && near_operand(source, u_.base_b(), u_.b, false) && use(*base, true) &&
         leaf_access(base->region, u_.c, source.cls, true, "such");
}

bool CodeVerifier::next_has_no_handle() {
  return fail(Refusal::kBadReference, "a handle of something in the next frame");
}

// A local that gets a handle can be written as bytes from anywhere, so it holds neither an
// address nor a string reference, and it has a value.
bool CodeVerifier::check_handle() {
  const uint32_t offset = extension_.x();
  if (u_.base_b() == Base::kConst) return fail(Refusal::kBadReference, "a constant has no handle");
  if (u_.base_b() == Base::kFrame) {
    if (offset >= pou_.frame_size) return next_has_no_handle();
    const uint32_t slot = slot_at(offset);
    const bool good =
        slot != kNone && (pou_.slots[slot].aggregate || pou_.slots[slot].cls < Class::kA);
    if (!good) return fail(Refusal::kBadReferenceSlot, "no variable at " + std::to_string(offset));
    if (!pou_.slots[slot].aggregate && !is_written(slot)) {
      return fail(Refusal::kReadBeforeWrite, "the local has no value yet");
    }
    return true;
  }
  Place place{u_.base_b(), offset};
  const std::optional<Region> root = root_region(place);
  if (!root) return false;
  return place.offset <= context_.regions.size(*root) ||
         fail(Refusal::kBadReference, "no variable at " + std::to_string(offset));
}

// What is behind a handle is checked when the instruction runs; here only that the type exists.
bool CodeVerifier::check_resolve() {
  const Region region = region_of_field(extension_.x());
  if (!context_.valid(region) || region.dim != 0 ||
      image_.types[region.type].kind == Kind::kGlobals) {
    return fail(Refusal::kBadReference, "there is no such type");
  }
  return near_operand(opcode_row(u_.opcode()).b, u_.base_b(), u_.b, false) &&
         write_pointer(u_.a, Class::kA, {region, false, 0});
}

bool CodeVerifier::check_copy() {
  const Region region = region_of_field(extension_.x());
  const auto to = read_pointer(u_.a, Class::kA);
  const auto from = read_pointer(u_.b, Class::kA);
  if (!to || !from) return false;
  if (!context_.valid(region)) return fail(Refusal::kBadReference, "there is no such type");
  const bool plain =
      !context_.facts[region.type.index].has_slots && !image_.types.has_members(region.type);
  const bool structure =
      is_structure(image_.types[region.type].kind) && !context_.facts[region.type.index].has_slots;
  if (!plain && !structure) return fail(Refusal::kBadReferenceSlot, "an instance is copied");
  if (!context_.regions.same(to->region, region) || !context_.regions.same(from->region, region)) {
    return fail(Refusal::kBadTyping, "both are not of type " + image_.types.text(region.type));
  }
  return use(*from, false) && use(*to, true);
}

bool CodeVerifier::check_string(bool from_place, Class cls) {
  const uint32_t capacity = extension_.y();
  if (from_place) {
    const auto pointer = point_to_string({u_.base_b(), extension_.x()}, cls, capacity);
    return pointer && write_pointer(u_.a, cls, *pointer);
  }
  const auto base = read_pointer(u_.b, Class::kA);
  if (!base) return false;
  const auto leaf = string_at(base->region, extension_.x(), cls, capacity);
  if (!leaf) {
    return fail(Refusal::kBadReference, "no string of capacity " + std::to_string(capacity) +
                                            " at offset " + std::to_string(extension_.x()));
  }
  const bool read_only = base->read_only || leaf->constant || leaf->input;
  return write_pointer(u_.a, cls, {{}, read_only, base->outgoing});
}

bool CodeVerifier::check_string_copy(Class cls) {
  const auto to = read_pointer(u_.a, cls);
  const auto from = read_pointer(u_.b, cls);
  return to && from && use(*from, false) && use(*to, true);
}

// An in-out of the POU itself, or of an instance that an addr points to. What it is
// bound to is never a constant: binding checks that.
bool CodeVerifier::check_reference_load(bool from_place) {
  Region region;
  uint32_t offset = 0;
  if (from_place) {
    Place place{u_.base_b(), u_.bc()};
    if (place.base != Base::kSelf) {
      return fail(Refusal::kBadReferenceSlot, "an in-out slot lies among the POU's own variables");
    }
    const std::optional<Region> root = root_region(place);
    if (!root) return false;
    region = *root;
    offset = place.offset;
  } else {
    const auto base = read_pointer(u_.b, Class::kA);
    if (!base || !use(*base, false)) return false;
    region = base->region;
    offset = u_.c;
  }
  const auto leaf = context_.regions.leaf_at(region, offset);
  if (!leaf || leaf->kind != LeafKind::kInOutSlot || leaf->begin != offset) {
    return fail(Refusal::kBadReferenceSlot, "no in-out at offset " + std::to_string(offset));
  }
  return write_pointer(u_.a, Class::kA, {{leaf->type, 0}, false, 0});
}

bool CodeVerifier::check_reference_store() {
  const auto base = read_pointer(u_.a, Class::kA);
  const auto target = read_pointer(u_.b, Class::kA);
  if (!base || !target || !use(*base, true)) return false;
  const auto leaf = context_.regions.leaf_at(base->region, u_.c);
  if (!leaf || leaf->kind != LeafKind::kInOutSlot || leaf->begin != u_.c) {
    return fail(Refusal::kBadReferenceSlot, "no in-out at offset " + std::to_string(u_.c));
  }
  if (!context_.regions.same(target->region, {leaf->type, 0})) {
    return fail(Refusal::kBadTyping, "the in-out is for " + image_.types.text(leaf->type) +
                                         ", not for " + image_.types.text(target->region.type));
  }
  if (target->read_only || target->outgoing != 0) {
    return fail(Refusal::kBadReference, "an in-out is bound to an input or a constant");
  }
  return true;
}

// The type of the instance slot that b and c name; invalid after a failure.
TypeId CodeVerifier::instance_slot(bool from_place) {
  Region region;
  uint32_t offset = 0;
  if (from_place) {
    Place place{u_.base_b(), u_.bc()};
    if (place.base == Base::kFrame || place.base == Base::kConst) {
      fail(Refusal::kBadReferenceSlot, "instances live in no frame and are no constants");
      return {};
    }
    const std::optional<Region> root = root_region(place);
    if (!root) return {};
    region = *root;
    offset = place.offset;
  } else {
    const auto base = read_pointer(u_.b, Class::kA);
    if (!base || !use(*base, false)) return {};
    region = base->region;
    offset = u_.c;
  }
  const auto leaf = context_.regions.leaf_at(region, offset);
  if (!leaf || leaf->kind != LeafKind::kInstanceSlot || leaf->begin != offset) {
    fail(Refusal::kBadReferenceSlot, "no instance at offset " + std::to_string(offset));
    return {};
  }
  return leaf->type;
}

}  // namespace ir::verification
