// Places behind handles, and handles of places.
#include "base/check.h"
#include "ir/lower/opcodes.h"
#include "ir/lower/select.h"
#include "ir/types/parts.h"

namespace ir::codegen {
namespace {

bool is_string(const TypeTable& types, TypeId type) {
  return types[type].kind == Kind::kString || types[type].kind == Kind::kWstring;
}

// Members and elements only: the handle can be moved there unresolved.
bool only_moves(const Place& place) {
  for (const Step& step : place.steps) {
    if (step.kind == StepKind::kEnter || step.kind == StepKind::kDeref) return false;
  }
  return true;
}

}  // namespace

// The handle and what the steps add to it, nothing checked but indices.
Location Selector::unresolved(const Place& place) {
  Location at = root_of(place);
  walk(at, place, 0);
  return at;
}

// What is resolved is the part that the place names; where instances are, the whole target. A
// string stays unresolved, because its capacity depends on what is there. An address holds for
// the rest of the block: what a handle names cannot go away before the POU returns.
Location Selector::locate_target(const Place& place) {
  const bool whole = holds_instance(types(), place.base_type);
  if (!whole && is_string(types(), place.type)) return unresolved(place);
  const size_t covered = whole ? 0 : place.steps.size();
  Location at;
  size_t next = whole ? resume_from_cache(at, place) : 0;
  if (next == 0) {
    const std::string key = prefix_key(place, covered);
    if (const CachedAddress* const known = find_address(key)) {
      consume(place.value);
      for (size_t i = 0; i < covered; ++i) {
        const Step& step = place.steps[i];
        if (step.value.valid() && !values_.is_constant(step.value)) consume(step.value);
      }
      behind(at, known->addr, known->region);
    } else {
      at = whole ? root_of(place) : unresolved(place);
      resolve(at, new_register(Class::kA, at.place.result, false));
      keep_address(key, {at.addr, at.place.region, false});
    }
    next = covered;
  }
  walk(at, place, next);
  return at;
}

void Selector::resolve(Location& at, Operand dest) {
  const Region region = at.place.result;
  base::check(region.dim == 0, "a place ends at a whole value");
  emit(Opcode::RESOLVE, dest, at.handle, {}, tables_.region(region), offset_of(at));
  behind(at, dest, region);
}

void Selector::index_handle(Location& at, Operand index, Scalar scalar, uint32_t bound,
                            Region element) {
  if (scalar_size(scalar) < 8) {
    const Operand wide = new_register(Class::k64, {}, true);
    emit(extend_opcode(scalar, is_signed(scalar) ? Scalar::kI64 : Scalar::kU64), wide, index);
    index = wide;
  }
  const Operand handle = new_register(Class::k64, {}, false);
  const Opcode op = scalar == Scalar::kU64 ? Opcode::HANDLE_INDEX_U64 : Opcode::HANDLE_INDEX_I64;
  emit(op, handle, index, at.handle, bound, offset_of(at));
  at.handle = handle;
  at.place = {};
  at.place.root = PlaceRoot::kRegion;
  at.place.region = at.place.result = element;
}

void Selector::compute_handle(const Inst& inst, Operand dest) {
  const Place& place = pou_.places[inst.place.index];
  const bool instance = types().is_instance(place.type);
  if (place.base == PlaceBase::kTarget && only_moves(place) && (!instance || place.steps.empty())) {
    const Location at = unresolved(place);
    if (at.place.steps.empty()) return move(Class::k64, dest, at.handle);
    return emit(Opcode::HANDLE_STEP, dest, at.handle, {}, offset_of(at));
  }
  const Location at = locate(place);
  const bool self = place.base == PlaceBase::kSelf && place.steps.empty();
  if (instance && !self) return instance_handle_into(at, dest);
  handle_into(at, dest);
}

void Selector::handle_into(const Location& at, Operand dest) {
  if (at.behind_handle) return emit(Opcode::HANDLE_STEP, dest, at.handle, {}, offset_of(at));
  if (at.behind_addr) return emit(Opcode::HANDLE_AT, dest, at.addr, {}, offset_of(at));
  emit(Opcode::HANDLE, dest, field_of(at), {}, extension_of(at));
}

// The handle of an instance: from the ID in its slot, unless its area is known already.
void Selector::instance_handle_into(const Location& at, Operand dest) {
  const Region slot = at.place.result;
  if (at.behind_addr && at.place.steps.empty() && slot.dim == 0 && at.place.region == slot) {
    return handle_into(at, dest);
  }
  if (at.behind_addr) {
    return emit(Opcode::HANDLE_INST_AT, dest, at.addr, Operand::immediate(offset_of(at)));
  }
  emit(Opcode::HANDLE_INST, dest, field_of(at));
}

}  // namespace ir::codegen
