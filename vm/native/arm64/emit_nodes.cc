// One operation after the other.
#include <bit>

#include "vm/exec/context.h"
#include "vm/native/arm64/emitter.h"
#include "vm/native/arm64/immediates.h"

namespace vm::native::arm64 {

#define CONTEXT(member) context(offsetof(Context, member))

namespace {

uint8_t at_least_four(uint8_t width) { return width < 4 ? uint8_t{4} : width; }

Alu alu_of(Op op) {
  if (op == Op::kAdd) return Alu::kAdd;
  if (op == Op::kSub) return Alu::kSub;
  if (op == Op::kAnd) return Alu::kAnd;
  return op == Op::kOr ? Alu::kOr : Alu::kXor;
}

Logical logical_of(Alu op) {
  if (op == Alu::kAnd) return Logical::kAnd;
  return op == Alu::kOr ? Logical::kOr : Logical::kXor;
}

}  // namespace

void Emitter::add_shifted(const Node& n, const Step& step) {
  a_.alu(Alu::kAdd, integer_register(step.result), integer_register(step.in[0]),
         integer_register(step.in[1]), 8, static_cast<uint8_t>(n.imm));
}

void Emitter::unary(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  const uint8_t from = integer_register(step.in[0]);
  if (n.op == Op::kSext) return a_.sign_extend(to, from, n.from);
  if (n.op == Op::kZext) return a_.zero_extend(to, from, n.from);
  if (n.op == Op::kNotBool) {
    return a_.logical(Logical::kXor, to, from, *logical_immediate(1, 4), 4);
  }
  a_.alu(n.op == Op::kNeg ? Alu::kSub : Alu::kOrNot, to, kZero, from, at_least_four(n.width));
}

void Emitter::compare(const Node& n, const Step& step) {
  ask(n.width, n.cond, step.in[0], step.in[1]);
  a_.set(condition_of(n.cond), integer_register(step.result));
}

void Emitter::exit_if(const Node& n, const Step& step, Label exit) {
  jump_if(n.width, n.cond, step.in[0], step.in[1], exit);
}

// to := a op b, where b may be a constant.
void Emitter::three(const Node& n, const Step& step) {
  const Alu op = alu_of(n.op);
  const uint8_t to = integer_register(step.result);
  const uint8_t a = integer_register(step.in[0]);
  const Place& b = step.in[1];
  const uint8_t width = at_least_four(n.width);
  if (b.kind != Place::kConstant) return a_.alu(op, to, a, integer_register(b), width);
  if (op == Alu::kAdd || op == Alu::kSub) {
    const int64_t value = sign_extended(b.bits, n.width);
    return a_.add_imm(to, a, op == Alu::kAdd ? value : -value, width);
  }
  a_.logical(logical_of(op), to, a, *logical_immediate_of(b.bits, n.width), width);
}

void Emitter::multiply(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  const uint8_t a = integer_register(step.in[0]);
  const uint8_t width = at_least_four(n.width);
  const Place& b = step.in[1];
  if (b.kind != Place::kConstant) return a_.multiply(to, a, integer_register(b), width);
  const auto power = static_cast<uint32_t>(std::countr_zero(b.bits));
  if (power >= 8u * width) return a_.move_imm(to, 0);
  a_.shift_left(to, a, power, width);
}

void Emitter::multiply_high(const Node& n, const Step& step) {
  a_.multiply_high(integer_register(step.result), integer_register(step.in[0]),
                   integer_register(step.in[1]), n.op == Op::kMulHighS);
}

// BOOL: a AND NOT b, a OR NOT b
void Emitter::bool_not(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  const uint8_t a = integer_register(step.in[0]);
  const Alu op = n.op == Op::kAndNot ? Alu::kAnd : Alu::kOr;
  const Place& b = step.in[1];
  if (b.kind == Place::kConstant) {
    const bool neutral = (op == Alu::kAnd) == ((b.bits & 1) == 0);
    if (neutral) return a_.move(to, a);
    return a_.move_imm(to, op == Alu::kAnd ? 0 : 1);
  }
  if (op == Alu::kAnd) return a_.alu(Alu::kAndNot, to, a, integer_register(b), 4);
  a_.logical(Logical::kXor, kScratch, integer_register(b), *logical_immediate(1, 4), 4);
  a_.alu(op, to, a, kScratch, 4);
}

void Emitter::shift_by_constant(const Node& n, uint8_t to, uint8_t from, uint32_t count) {
  const uint32_t bits = 8u * n.width;
  if (count >= bits) return a_.move_imm(to, 0);
  const uint8_t width = at_least_four(n.width);
  if (n.op == Op::kShl) return a_.shift_left(to, from, count, width);
  const Field field = n.op == Op::kShr ? Field::kUnsigned : Field::kSigned;
  a_.field(field, to, from, count, bits - 1, width);
}

void Emitter::rotate_by_constant(const Node& n, uint8_t to, uint8_t from, uint32_t count) {
  const uint32_t bits = 8u * n.width;
  const uint32_t right = (n.op == Op::kRor ? count : bits - count % bits) % bits;
  if (n.width >= 4) return a_.rotate_right(to, from, right, n.width);
  if (right == 0) return a_.move(to, from);
  a_.field(Field::kUnsigned, kScratch, from, right, bits - 1, 4);
  // The low bits become the upper ones.
  a_.field(Field::kInsert, kScratch, from, 32 - (bits - right), right - 1, 4);
  a_.move(to, kScratch);
}

void Emitter::shift(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  const uint8_t from = integer_register(step.in[0]);
  const uint8_t width = at_least_four(n.width);
  const bool rotates = n.op == Op::kRol || n.op == Op::kRor;
  if (step.in[1].kind == Place::kConstant) {
    const auto count = static_cast<uint32_t>(step.in[1].bits);
    return rotates ? rotate_by_constant(n, to, from, count) : shift_by_constant(n, to, from, count);
  }
  const uint8_t count = integer_register(step.in[1]);
  if (n.op == Op::kRor) return a_.binary(Binary::kRor, to, from, count, width);
  if (n.op == Op::kRol) {
    a_.alu(Alu::kSub, kScratch, kZero, count, 4);
    return a_.binary(Binary::kRor, to, from, kScratch, width);
  }
  Binary op = Binary::kShl;
  if (n.op == Op::kShr) op = Binary::kShr;
  if (n.op == Op::kSar) op = Binary::kSar;
  // The machine takes the count modulo its width; here everything is shifted out.
  a_.binary(op, kScratch, from, count, width);
  a_.compare_imm(count, 8 * n.width, 4);
  a_.select(Condition::kBelow, to, kScratch, kZero);
}

// The most negative number by -1 wraps.
void Emitter::divide(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  const uint8_t a = integer_register(step.in[0]);
  const uint8_t b = integer_register(step.in[1]);
  const Binary op = n.op == Op::kDivS || n.op == Op::kModS ? Binary::kDivS : Binary::kDivU;
  if (n.op == Op::kDivS || n.op == Op::kDivU) return a_.binary(op, to, a, b, n.width);
  a_.binary(op, kScratch, a, b, n.width);
  a_.multiply_subtract(to, kScratch, b, a, n.width);
}

// Values of 1 and 2 bytes are extended first.
void Emitter::ask(uint8_t width, Cond cond, const Place& a, const Place& b) {
  const uint8_t left = integer_register(a);
  const bool constant = b.kind == Place::kConstant;
  if (cond == Cond::kNoBit || cond == Cond::kAnyBit) return ask_bits(width, left, b);
  if (width >= 4) {
    if (constant) return a_.compare_imm(left, compared_constant(b.bits, width, cond), width);
    return a_.alu(Alu::kSubFlags, kZero, left, integer_register(b), width);
  }
  if (constant && b.bits == 0 && (cond == Cond::kEq || cond == Cond::kNe)) {
    const uint64_t mask = (uint64_t{1} << (8 * width)) - 1;
    return a_.logical(Logical::kAndFlags, kZero, left, *logical_immediate(mask, 4), 4);
  }
  if (is_signed(cond)) {
    a_.sign_extend(kScratch, left, width);
  } else {
    a_.zero_extend(kScratch, left, width);
  }
  if (constant) return a_.compare_imm(kScratch, compared_constant(b.bits, width, cond), 4);
  a_.compare_extended(kScratch, integer_register(b), width, is_signed(cond));
}

// Whatever lies above 1 or 2 bytes does not count.
void Emitter::ask_bits(uint8_t width, uint8_t left, const Place& b) {
  if (b.kind == Place::kConstant) {
    const uint64_t mask = width == 8 ? b.bits : b.bits & ((uint64_t{1} << (8 * width)) - 1);
    return a_.logical(Logical::kAndFlags, kZero, left,
                      *logical_immediate(mask, at_least_four(width)), at_least_four(width));
  }
  if (width >= 4) return a_.alu(Alu::kAndFlags, kZero, left, integer_register(b), width);
  a_.zero_extend(kScratch, left, width);
  a_.alu(Alu::kAndFlags, kZero, kScratch, integer_register(b), 4);
}

void Emitter::ask_bool(uint8_t reg) {
  a_.logical(Logical::kAndFlags, kZero, reg, *logical_immediate(0xff, 4), 4);
}

void Emitter::select(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  if (n.op == Op::kSelectCmp) {
    ask(n.from, n.cond, step.in[2], step.in[3]);
    return a_.select(condition_of(n.cond), to, integer_register(step.in[0]),
                     integer_register(step.in[1]));
  }
  ask_bool(integer_register(step.in[0]));
  a_.select(Condition::kNotEqual, to, integer_register(step.in[1]), integer_register(step.in[2]));
}

void Emitter::load(const Node& n, const Step& step) {
  const Address from = address(n.mem, step.index, step.pointer);
  if (step.result.floating) return a_.float_load(float_register(step.result), from, n.width);
  const uint8_t to = integer_register(step.result);
  if (n.boolean) return load_bool(to, from);
  a_.load(to, from, n.width);
}

void Emitter::store(const Node& n, const Step& step) {
  const Address to = address(n.mem, step.index, step.pointer);
  const Place& value = step.in[0];
  if (value.kind == Place::kConstant) return a_.store(to, kZero, n.width);
  if (value.floating) return a_.float_store(to, float_register(value), n.width);
  a_.store(to, integer_register(value), n.width);
}

// Offsets in data memory are the difference of two addresses.
void Emitter::data_address(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  Address at = address(n.mem, step.index, step.pointer);
  if (n.mem.base == MemBase::kData) {
    at.has_base = false;
    return a_.address(to, at, 4);
  }
  address_to_data(to, at);
}

// A row without data is free.
void Emitter::instance(const Node& n, const Step& step) {
  const uint8_t id = integer_register(step.in[0]);
  const Label none = exit_label(n.exit);
  a_.load(kScratch, CONTEXT(instance_count), 4);
  a_.alu(Alu::kSubFlags, kZero, id, kScratch, 4);
  a_.jump_if(Condition::kAboveOrEqual, none);
  a_.load(kScratch, CONTEXT(instances), 8);
  static_assert(sizeof(InstanceEntry) == 8);
  a_.load(kScratch, {kScratch, id, 3, true, offsetof(InstanceEntry, data)}, 4);
  a_.jump_if_zero(true, kScratch, 4, none);
  a_.move(integer_register(step.result), kScratch);
}

void Emitter::pool(const Step& step) {
  a_.load(kScratch, CONTEXT(consts), 8);
  a_.alu(Alu::kSub, integer_register(step.result), kScratch, Registers::kData, 4);
}

}  // namespace vm::native::arm64
