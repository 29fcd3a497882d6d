#include "vm/native/arm64/emitter.h"

#include "vm/native/arm64/immediates.h"
#include "vm/native/function_emitter_impl.h"

namespace vm::native::arm64 {

#define CONTEXT(member) context(offsetof(Context, member))

Condition condition_of(Cond cond) {
  constexpr Condition kOf[] = {
      Condition::kEqual,   Condition::kNotEqual,       Condition::kLess,  Condition::kLessOrEqual,
      Condition::kGreater, Condition::kGreaterOrEqual, Condition::kBelow, Condition::kBelowOrEqual,
      Condition::kAbove,   Condition::kAboveOrEqual,   Condition::kEqual, Condition::kNotEqual};
  return kOf[static_cast<size_t>(cond)];
}

Emitter::Emitter(const PouCode& pou, const Shared& shared, Assembler& assembler)
    : FunctionEmitter(pou, shared, assembler) {
  // The spill slots and the return address, a multiple of 16.
  frame_bytes_ = static_cast<int32_t>((places_.spill_slots + 2) / 2 * 16);
}

// Once more with long branches when the short ones do not reach.
Entries Emitter::run() {
  expect_places(f_, places_);
  const Assembler::Mark begin = a_.mark();
  function();
  if (!a_.reaches(begin)) {
    a_.rewind(begin);
    nan_stubs_.clear();
    a_.set_long(true);
    function();
    a_.set_long(false);
  }
  return std::move(entries());
}

Address Emitter::address(const Mem& mem, const Place& index, const Place& pointer) const {
  const uint8_t base = base_register(mem, pointer);
  if (mem.index == kNone) return Registers::at(base, mem.disp);
  return Registers::indexed(base, integer_register(index), mem.scale, mem.disp);
}

void Emitter::enter_frame() {
  a_.add_imm(kSp, kSp, -frame_bytes_, 8);
  a_.store({kSp, 0xff, 0, true, frame_bytes_ - 8}, kLink, 8);
}
void Emitter::leave_frame() {
  a_.load(kLink, {kSp, 0xff, 0, true, frame_bytes_ - 8}, 8);
  a_.add_imm(kSp, kSp, frame_bytes_, 8);
}

void Emitter::take_fuel(uint32_t turns) { a_.decrement(Registers::kFuel, turns); }
void Emitter::add(uint8_t to, int64_t value) { a_.add_imm(to, to, value, 8); }
void Emitter::add_register(uint8_t to, uint8_t from) { a_.alu(Alu::kAdd, to, to, from, 8); }

// --- jumps --------------------------------------------------------------------------

void Emitter::jump_if_exposed(Label exit) {
  a_.load(kScratch, CONTEXT(call), 8);
  a_.load(kAddressScratch, CONTEXT(exposed), 8);
  a_.alu(Alu::kSubFlags, kZero, kScratch, kAddressScratch, 8);
  a_.jump_if(Condition::kEqual, exit);
}

void Emitter::jump_unless_running(Label to) {
  a_.load(kScratch, CONTEXT(running), 1);
  a_.jump_if_zero(true, kScratch, 4, to);
}

void Emitter::jump_when(const End& e, const Place in[2], bool when, Label to) {
  if (e.compare != Op::kFCompare) {
    return jump_if(e.width, when ? e.cond : negated(e.cond), in[0], in[1], to);
  }
  a_.float_compare(float_register(in[0]), float_register(in[1]), e.width);
  const Condition yes = float_condition_of(e.cond);
  a_.jump_if(when ? yes : inverted(yes), to);
}

void Emitter::jump_if(uint8_t width, Cond cond, const Place& a, const Place& b, Label to) {
  const bool with_zero = b.kind == Place::kConstant && b.bits == 0 && width >= 4;
  if (with_zero && (cond == Cond::kEq || cond == Cond::kNe)) {
    return a_.jump_if_zero(cond == Cond::kEq, integer_register(a), width, to);
  }
  ask(width, cond, a, b);
  a_.jump_if(condition_of(cond), to);
}

void Emitter::jump_through(Label table, uint8_t value, uint8_t width) {
  a_.zero_extend(kScratch, value, width);
  a_.address_of(kAddressScratch, table);
  a_.load(kScratch, {kAddressScratch, kScratch, 2, true, 0}, 4);
  a_.alu(Alu::kSub, kScratch, kAddressScratch, kScratch, 8);
  a_.jump_to(kScratch);
}

// --- values -------------------------------------------------------------------------

void Emitter::load_bool(uint8_t to, const Address& from) {
  a_.load(to, from, 1);
  a_.compare_imm(to, 0, 4);
  a_.set(Condition::kNotEqual, to);
}

void Emitter::float_constant(uint8_t to, uint64_t bits, uint8_t width) {
  if (bits == 0) return a_.float_zero(to);
  if (const auto small = float_immediate(bits, width)) return a_.float_imm(to, *small, width);
  a_.move_imm(kScratch, bits);
  a_.bits_to_float(to, kScratch, width);
}

void Emitter::store_word(const Address& to, uint32_t value) {
  if (value != 0) a_.move_imm(kScratch, value);
  a_.store(to, value != 0 ? kScratch : kZero, 4);
}

void Emitter::address_to_data(uint8_t to, const Address& at) {
  a_.address(kScratch, at, 8);
  a_.alu(Alu::kSub, to, kScratch, Registers::kData, 4);
}

void Emitter::place_in_data(uint8_t to, uint8_t place) {
  a_.alu(Alu::kAdd, to, Registers::kData, place, 8);
}

void Emitter::data_memory(uint8_t to) { a_.move(to, Registers::kData); }

void Emitter::unit_address(uint8_t to, const ir::Unit* units, uint8_t number) {
  static_assert(sizeof(ir::Unit) == 8);
  a_.move_imm(Registers::kId, reinterpret_cast<uintptr_t>(units));
  a_.alu(Alu::kAdd, to, Registers::kId, number, 8, 3);
}

}  // namespace vm::native::arm64
