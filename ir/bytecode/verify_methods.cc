// Calls of methods and of bases: the callee runs on the own instance, on one whose slot has a
// type that fits, or on what the machine finds behind a handle.
#include "ir/bytecode/call_needs.h"
#include "ir/bytecode/verify_code.h"

namespace ir::verification {

bool CodeVerifier::is_method(uint32_t pou) const {
  return pou < image_.pous.size() && image_.pous[pou].unit_count != 0 &&
         image_.pous[pou].kind == PouKind::kMethod;
}

// What an interface declares runs on nothing: it only says how arguments lie.
bool CodeVerifier::runs_on(uint32_t pou, TypeId type) const {
  const TypeId self = image_.pous[pou].self;
  return image_.types.is_instance(self) && image_.types.is_a(type, self);
}

bool CodeVerifier::check_call_own() {
  const bool body = u_.c < image_.pous.size() && image_.pous[u_.c].unit_count != 0 &&
                    is_body(image_.pous[u_.c].kind);
  if (!pou_.self.valid() || (!body && !is_method(u_.c)) || !runs_on(u_.c, pou_.self)) {
    return fail(Refusal::kBadCall, "the own instance has no POU " + std::to_string(u_.c));
  }
  if (!check_frame() || !pass_arguments(u_.c)) return false;
  facts_.callees.push_back(u_.c);
  return true;
}

bool CodeVerifier::check_call_method(bool from_place) {
  const uint32_t callee = extension_.x();
  const TypeId type = instance_slot(from_place);
  if (!type.valid()) return false;
  if (!is_method(callee) || !runs_on(callee, type)) {
    return fail(Refusal::kBadCall,
                "`" + image_.types.text(type) + "` has no method " + std::to_string(callee));
  }
  if (!check_frame() || !pass_arguments(callee)) return false;
  facts_.callees.push_back(callee);
  return true;
}

bool CodeVerifier::check_call_method_reference() {
  const uint32_t callee = extension_.x();
  if (!near_operand(opcode_row(u_.opcode()).b, u_.base_b(), u_.b, false)) return false;
  if (!is_method(callee) || !image_.types.is_instance(image_.pous[callee].self)) {
    return fail(Refusal::kBadCall, "there is no method " + std::to_string(callee));
  }
  if (!check_frame() || !pass_arguments(callee)) return false;
  facts_.callees.push_back(callee);
  return true;
}

bool CodeVerifier::check_call_virtual() {
  const uint32_t prototype = extension_.x();
  if (!near_operand(opcode_row(u_.opcode()).b, u_.base_b(), u_.b, false)) return false;
  if (!is_method(prototype)) {
    return fail(Refusal::kBadCall, "there is no method " + std::to_string(prototype));
  }
  if (!check_frame() || !pass_arguments(prototype)) return false;
  facts_.callees.push_back(DynamicCalls(image_).any_target(prototype));
  return true;
}

bool CodeVerifier::check_is_type() {
  const OpcodeRow& row = opcode_row(u_.opcode());
  const Region region = region_of_field(extension_.x());
  const bool known =
      image_.types.contains(region.type) && region.dim == 0 &&
      (image_.types.is_instance(region.type) || image_.types[region.type].kind == Kind::kInterface);
  if (!known) return fail(Refusal::kBadReference, "there is no such block and no such interface");
  return near_operand(row.b, u_.base_b(), u_.b, false) &&
         near_operand(row.a, u_.base_a(), u_.a, true);
}

}  // namespace ir::verification
