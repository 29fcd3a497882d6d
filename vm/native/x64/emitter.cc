#include "vm/native/x64/emitter.h"

#include "vm/native/function_emitter_impl.h"

namespace vm::native::x64 {

#define CONTEXT(member) context(offsetof(Context, member))

Condition condition_of(Cond cond) {
  constexpr Condition kOf[] = {
      Condition::kEqual,   Condition::kNotEqual,       Condition::kLess,  Condition::kLessOrEqual,
      Condition::kGreater, Condition::kGreaterOrEqual, Condition::kBelow, Condition::kBelowOrEqual,
      Condition::kAbove,   Condition::kAboveOrEqual,   Condition::kEqual, Condition::kNotEqual};
  return kOf[static_cast<size_t>(cond)];
}

Emitter::Emitter(const PouCode& pou, const Shared& shared, Assembler& assembler)
    : FunctionEmitter(pou, shared, assembler), has_and_not_(!pou.plain && has_and_not()) {
  // The stack is a multiple of 16 below the return address.
  frame_bytes_ = static_cast<int32_t>(places_.spill_slots * 8);
  if (frame_bytes_ % 16 == 0) frame_bytes_ += 8;
}

Entries Emitter::run() {
  expect_places(f_, places_);
  function();
  return std::move(entries());
}

Address Emitter::address(const Mem& mem, const Place& index, const Place& pointer) const {
  Address out;
  out.base = base_register(mem, pointer);
  out.scale = mem.scale;
  if (mem.index != kNone) out.index = integer_register(index);
  const int64_t from = mem.base == MemBase::kData ? int64_t{1} << 31 : 0;
  out.disp = static_cast<int32_t>(mem.disp - from);
  return out;
}
Operand Emitter::operand(const Place& place) const {
  if (place.kind == Place::kSpill) return Operand::of(spill(place.number));
  if (place.kind == Place::kHome) return Operand::of(variable(place.number));
  return Operand::of(place.floating ? float_register(place) : integer_register(place));
}
Operand Emitter::operand(const Node& n, const Step& step, uint32_t number) const {
  if (n.folded == number) return Operand::of(address(n.mem, step.index, step.pointer));
  return operand(step.in[number]);
}

void Emitter::enter_frame() { a_.alu_imm(Alu::kSub, Operand::of(kRsp), frame_bytes_, 8); }
void Emitter::leave_frame() { a_.alu_imm(Alu::kAdd, Operand::of(kRsp), frame_bytes_, 8); }

void Emitter::take_fuel(uint32_t turns) {
  a_.alu_imm(Alu::kSub, Operand::of(Registers::kFuel), static_cast<int32_t>(turns), 8);
}
void Emitter::add(uint8_t to, int64_t value) {
  if (value >= 0) return a_.alu_imm(Alu::kAdd, Operand::of(to), static_cast<int32_t>(value), 8);
  a_.alu_imm(Alu::kSub, Operand::of(to), static_cast<int32_t>(-value), 8);
}
void Emitter::add_register(uint8_t to, uint8_t from) {
  a_.alu(Alu::kAdd, to, Operand::of(from), 8);
}

// --- jumps --------------------------------------------------------------------------

void Emitter::jump_if_exposed(Label exit) {
  a_.load(kRax, CONTEXT(call), 8);
  a_.alu(Alu::kCmp, kRax, Operand::of(CONTEXT(exposed)), 8);
  a_.jump_if(Condition::kEqual, exit);
}

void Emitter::jump_unless_running(Label to) {
  a_.alu_imm(Alu::kCmp, Operand::of(CONTEXT(running)), 0, 1);
  a_.jump_if(Condition::kEqual, to);
}

void Emitter::jump_when(const End& e, const Place in[2], bool when, Label to) {
  if (e.compare == Op::kFCompare) return jump_when_float(e, in, when, to);
  jump_if(e.width, when ? e.cond : negated(e.cond), in[0], in[1], to);
}

void Emitter::jump_if(uint8_t width, Cond cond, const Place& a, const Place& b, Label to) {
  if (a.kind != Place::kRegister) {
    a_.alu_imm(Alu::kCmp, operand(a), field(b.bits, width), width);
  } else {
    ask(width, cond, a, b);
  }
  a_.jump_if(condition_of(cond), to);
}

void Emitter::jump_when_float(const End& e, const Place in[2], bool when, Label to) {
  if (e.cond == Cond::kLtS || e.cond == Cond::kLeS) {
    // b < c is c above b: false for what is no number
    a_.float_compare(float_register(in[1]), operand(in[0]), e.width);
    const Condition yes = e.cond == Cond::kLtS ? Condition::kAbove : Condition::kAboveOrEqual;
    return a_.jump_if(when ? yes : inverted(yes), to);
  }
  a_.float_compare(float_register(in[0]), operand(in[1]), e.width);
  const bool when_equal = (e.cond == Cond::kEq) == when;
  if (!when_equal) {
    a_.jump_if(Condition::kParity, to);
    return a_.jump_if(Condition::kNotEqual, to);
  }
  const Label skip = a_.label();
  a_.jump_if(Condition::kParity, skip);
  a_.jump_if(Condition::kEqual, to);
  a_.bind(skip);
}

void Emitter::jump_through(Label table, uint8_t value, uint8_t width) {
  // A second scratch register: one that something else may need after the jump.
  const uint8_t at = value == kRax ? kRcx : kRax;
  a_.bits_to_float(kFloatScratch, at, 8);
  a_.zero_extend(kScratch, Operand::of(value), width);
  a_.address_of(at, table);
  a_.load_signed(kScratch, Operand::of(Address{at, kScratch, 4, true, 0}), 4);
  a_.alu(Alu::kAdd, kScratch, Operand::of(at), 8);
  a_.float_to_bits(at, kFloatScratch, 8);
  a_.jump_to(kScratch);
}

// --- values -------------------------------------------------------------------------

void Emitter::load_bool(uint8_t to, const Address& from) {
  a_.move_imm(to, 0);
  a_.alu_imm(Alu::kCmp, Operand::of(from), 0, 1);
  a_.set(Condition::kNotEqual, to);
}

void Emitter::float_constant(uint8_t to, uint64_t bits, uint8_t width) {
  if (bits == 0) return a_.float_logic(0x57, to, to);
  a_.move_imm(kScratch, bits);
  a_.bits_to_float(to, kScratch, width);
}

void Emitter::store_word(const Address& to, uint32_t value) {
  a_.store_imm(to, static_cast<int32_t>(value), 4);
}

// From an address of the machine.
void Emitter::address_to_data(uint8_t to, Address at) {
  at.disp = static_cast<int32_t>(static_cast<uint32_t>(at.disp) + (1u << 31));
  a_.address(to, at, 8);
  a_.alu(Alu::kSub, to, Operand::of(Registers::kData), 4);
}

void Emitter::place_in_data(uint8_t to, uint8_t place) {
  a_.address(to, {Registers::kData, place, 1, true, INT32_MIN}, 8);
}

void Emitter::data_memory(uint8_t to) {
  a_.address(to, {Registers::kData, 0xff, 1, true, INT32_MIN}, 8);
}

void Emitter::unit_address(uint8_t to, const ir::Unit* units, uint8_t number) {
  static_assert(sizeof(ir::Unit) == 8);
  a_.move_imm(kRax, reinterpret_cast<uintptr_t>(units));
  a_.address(to, {kRax, number, 8, true, 0}, 8);
}

}  // namespace vm::native::x64
