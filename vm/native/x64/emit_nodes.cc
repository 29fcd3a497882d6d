// One operation after the other.
#include <algorithm>

#include "vm/exec/context.h"
#include "vm/native/x64/emitter.h"

namespace vm::native::x64 {

#define CONTEXT(member) context(offsetof(Context, member))

namespace {

uint8_t at_least_four(uint8_t width) { return width < 4 ? uint8_t{4} : width; }

Alu alu_of(Op op) {
  if (op == Op::kAdd) return Alu::kAdd;
  if (op == Op::kSub) return Alu::kSub;
  if (op == Op::kAnd) return Alu::kAnd;
  return op == Op::kOr ? Alu::kOr : Alu::kXor;
}

}  // namespace

void Emitter::add_shifted(const Node& n, const Step& step) {
  a_.address(integer_register(step.result),
             {integer_register(step.in[0]), integer_register(step.in[1]),
              static_cast<uint8_t>(1 << n.imm), true, 0},
             8);
}

void Emitter::unary(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  if (n.op == Op::kSext) return a_.load_signed(to, operand(n, step, 0), n.from);
  if (n.op == Op::kZext) return a_.zero_extend(to, operand(n, step, 0), n.from);
  a_.move(to, integer_register(step.in[0]));
  if (n.op == Op::kNotBool) return a_.alu_imm(Alu::kXor, Operand::of(to), 1, 4);
  if (n.op == Op::kNeg) return a_.negate(to, at_least_four(n.width));
  a_.complement(to, at_least_four(n.width));
}

void Emitter::exit_if(const Node& n, const Step& step, Label exit) {
  ask(n, step);
  a_.jump_if(condition_of(n.cond), exit);
}

// to := a op b, where b may be a constant or in memory.
void Emitter::three(const Node& n, const Step& step) {
  const Alu op = alu_of(n.op);
  const uint8_t to = integer_register(step.result);
  const uint8_t a = integer_register(step.in[0]);
  const Place& b = step.in[1];
  const uint8_t width = at_least_four(n.width);
  if (b.kind == Place::kConstant) {
    if (op == Alu::kAdd && to != a) {
      return a_.address(to, {a, 0xff, 1, true, field(b.bits, n.width)}, width);
    }
    a_.move(to, a);
    return a_.alu_imm(op, Operand::of(to), field(b.bits, n.width), width);
  }
  const Operand right = operand(n, step, 1);
  // Memory is read as wide as it is.
  const uint8_t wide = right.memory ? n.width : width;
  if (right.memory || right.reg != to || to == a) {
    if (op == Alu::kAdd && !right.memory && to != a) {
      return a_.address(to, {a, right.reg, 1, true, 0}, width);
    }
    a_.move(to, a);
    return a_.alu(op, to, right, wide);
  }
  if (op != Alu::kSub) return a_.alu(op, to, Operand::of(a), width);
  a_.move(kScratch, a);
  a_.alu(op, kScratch, right, width);
  a_.move(to, kScratch);
}

void Emitter::multiply(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  const uint8_t a = integer_register(step.in[0]);
  const uint8_t width = at_least_four(n.width);
  const Place& b = step.in[1];
  if (b.kind == Place::kConstant) {
    // An address is there two cycles earlier.
    if (b.bits == 3 || b.bits == 5 || b.bits == 9) {
      return a_.address(to, {a, a, static_cast<uint8_t>(b.bits - 1), true, 0}, width);
    }
    return a_.multiply_imm(to, Operand::of(a), field(b.bits, n.width), width);
  }
  const Operand right = operand(n, step, 1);
  if (!right.memory && right.reg == to) return a_.multiply(to, Operand::of(a), width);
  a_.move(to, a);
  a_.multiply(to, right, width);
}

// BOOL: a AND NOT b, a OR NOT b
void Emitter::bool_not(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  const uint8_t a = integer_register(step.in[0]);
  const Alu op = n.op == Op::kAndNot ? Alu::kAnd : Alu::kOr;
  const Place& b = step.in[1];
  if (b.kind == Place::kConstant) {
    a_.move(to, a);
    return a_.alu_imm(op, Operand::of(to), static_cast<int32_t>((b.bits & 1) ^ 1), 4);
  }
  const bool any_byte = b.kind == Place::kHome && !b.clean;
  if (op == Alu::kAnd && !any_byte && has_and_not_) {
    if (b.kind == Place::kRegister) return a_.and_not(to, integer_register(b), a);
    load_place(kScratch, b);
    return a_.and_not(to, kScratch, a);
  }
  if (any_byte) {
    a_.move_imm(kScratch, 0);
    a_.alu_imm(Alu::kCmp, operand(b), 0, 1);
    a_.set(Condition::kEqual, kScratch);
  } else {
    load_place(kScratch, b);
    a_.alu_imm(Alu::kXor, Operand::of(kScratch), 1, 4);
  }
  if (to == a) return a_.alu(op, to, Operand::of(kScratch), 4);
  a_.alu(op, kScratch, Operand::of(a), 4);
  a_.move(to, kScratch);
}

void Emitter::shift(const Node& n, const Step& step) {
  Shift op = Shift::kShl;
  if (n.op == Op::kShr) op = Shift::kShr;
  if (n.op == Op::kSar) op = Shift::kSar;
  if (n.op == Op::kRol) op = Shift::kRol;
  if (n.op == Op::kRor) op = Shift::kRor;
  const bool rotates = n.op == Op::kRol || n.op == Op::kRor;
  const uint8_t to = integer_register(step.result);
  a_.move(to, integer_register(step.in[0]));
  // The machine takes the count modulo its width; here everything is shifted out.
  if (step.in[1].kind == Place::kConstant) {
    const uint64_t count = step.in[1].bits & 0xffffffffu;
    if (!rotates && count >= 8u * n.width) return a_.move_imm(to, 0);
    const uint8_t width = rotates ? n.width : at_least_four(n.width);
    return a_.shift(op, to, static_cast<uint8_t>(count % (8u * n.width)), width);
  }
  a_.shift_cl(op, to, at_least_four(n.width));
  if (rotates) return;
  a_.alu_imm(Alu::kCmp, Operand::of(kRcx), 8 * n.width, 4);
  a_.alu(static_cast<Alu>(3), kScratch, Operand::of(kScratch), 8);  // sbb: all ones if below
  a_.alu(Alu::kAnd, to, Operand::of(kScratch), 8);
}

// rdx:rax by a register. The most negative number by -1 faults in the machine and wraps here.
void Emitter::divide(const Node& n, const Step& step) {
  const uint8_t by = integer_register(step.in[1]);
  const bool is_signed = n.op == Op::kDivS || n.op == Op::kModS;
  if (!is_signed) {
    a_.move_imm(kRdx, 0);
    return a_.divide(by, false, n.width);
  }
  const Value& divisor = f_.values[n.in[1]];
  const uint64_t minus_one = n.width == 8 ? ~uint64_t{0} : 0xffffffffu;
  const bool constant = divisor.constant && divisor.bits != minus_one;
  const Label normal = a_.label();
  const Label done = a_.label();
  if (!constant) {
    a_.alu_imm(Alu::kCmp, Operand::of(by), -1, n.width);
    a_.jump_if(Condition::kNotEqual, normal);
    a_.negate(kRax, n.width);
    a_.move_imm(kRdx, 0);
    a_.jump(done);
    a_.bind(normal);
  }
  a_.sign_into_rdx(n.width);
  a_.divide(by, true, n.width);
  a_.bind(done);
}

// rdx:rax := rax by a register.
void Emitter::multiply_high(const Node& n, const Step& step) {
  a_.multiply_wide(integer_register(step.in[1]), n.op == Op::kMulHighS);
}

// Only the low byte is set: unless the rest is known, the machine waits for its old value.
void Emitter::clear_for_set(uint8_t to, const Step& step) {
  const auto is_in = [&](const Place& place) {
    return place.kind == Place::kRegister && !place.floating && integer_register(place) == to;
  };
  const bool read =
      is_in(step.in[0]) || is_in(step.in[1]) || is_in(step.index) || is_in(step.pointer);
  if (!read) a_.move_imm(to, 0);
}

void Emitter::compare(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  clear_for_set(to, step);
  ask(n, step);
  a_.set(condition_of(n.cond), to);
}

void Emitter::ask(const Node& n, const Step& step) {
  if (n.folded == 0xff) return ask(n.width, n.cond, step.in[0], step.in[1]);
  a_.alu(Alu::kCmp, integer_register(step.in[0]), operand(n, step, 1), n.width);
}

void Emitter::ask(uint8_t width, Cond cond, const Place& a, const Place& b) {
  const uint8_t left = integer_register(a);
  if (cond == Cond::kNoBit || cond == Cond::kAnyBit) return ask_bits(width, left, b);
  if (b.kind == Place::kConstant) {
    if (b.bits == 0) return a_.test(left, left, width);
    return a_.alu_imm(Alu::kCmp, Operand::of(left), field(b.bits, width), width);
  }
  a_.alu(Alu::kCmp, left, operand(b), width);
}

void Emitter::ask_bits(uint8_t width, uint8_t left, const Place& b) {
  if (b.kind != Place::kConstant) return a_.test(left, integer_register(b), width);
  const uint64_t mask = width == 8 ? b.bits : b.bits & ((uint64_t{1} << (8 * width)) - 1);
  if (mask <= 0xff) return a_.test_imm(left, field(mask, 1), 1);
  a_.test_imm(left, static_cast<int32_t>(mask),
              mask <= 0xffffffffu && mask >> 31 == 0 ? 4 : at_least_four(width));
}

void Emitter::select(const Node& n, const Step& step) {
  const bool compares = n.op == Op::kSelectCmp;
  const uint8_t to = integer_register(step.result);
  const uint8_t yes = integer_register(step.in[compares ? 0 : 1]);
  const uint8_t no = integer_register(step.in[compares ? 1 : 2]);
  Condition condition = Condition::kNotEqual;
  if (compares) {
    ask(n.from, n.cond, step.in[2], step.in[3]);
    condition = condition_of(n.cond);
  } else {
    const uint8_t question = integer_register(step.in[0]);
    a_.test(question, question, 1);
  }
  if (to == yes) return a_.move_if(inverted(condition), to, no);
  a_.move(to, no);
  a_.move_if(condition, to, yes);
}

void Emitter::load(const Node& n, const Step& step) {
  const Address from = address(n.mem, step.index, step.pointer);
  if (step.result.floating) return a_.float_load(float_register(step.result), from, n.width);
  const uint8_t to = integer_register(step.result);
  if (!n.boolean) return a_.load(to, from, n.width);
  clear_for_set(to, step);
  a_.alu_imm(Alu::kCmp, Operand::of(from), 0, 1);
  a_.set(Condition::kNotEqual, to);
}

void Emitter::store(const Node& n, const Step& step) {
  const Address to = address(n.mem, step.index, step.pointer);
  const Place& value = step.in[0];
  if (value.kind == Place::kRegister) {
    if (value.floating) return a_.float_store(to, float_register(value), n.width);
    return a_.store(to, integer_register(value), n.width);
  }
  const auto wide = static_cast<int64_t>(value.bits);
  if (n.width < 8 || (wide >= INT32_MIN && wide <= INT32_MAX)) {
    return a_.store_imm(to, field(value.bits, n.width), n.width);
  }
  a_.move_imm(kScratch, value.bits);
  a_.store(to, kScratch, 8);
}

// Offsets in data memory are the difference of two addresses.
void Emitter::data_address(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  Address at = address(n.mem, step.index, step.pointer);
  if (n.mem.base == MemBase::kData) {
    at.has_base = false;
    at.disp = static_cast<int32_t>(static_cast<uint32_t>(n.mem.disp));
    if (at.index != 0xff && at.scale == 1) {
      at.base = at.index;
      at.index = 0xff;
      at.has_base = true;
    }
    return a_.address(to, at, 4);
  }
  address_to_data(to, at);
}

// A row without data is free.
void Emitter::instance(const Node& n, const Step& step) {
  const uint8_t id = integer_register(step.in[0]);
  const Label none = exit_label(n.exit);
  a_.alu(Alu::kCmp, id, Operand::of(CONTEXT(instance_count)), 4);
  a_.jump_if(Condition::kAboveOrEqual, none);
  a_.load(kScratch, CONTEXT(instances), 8);
  static_assert(sizeof(InstanceEntry) == 8);
  // What an exit stores must be there still.
  const std::vector<Place>& kept = places_.exits[n.exit];
  const bool at_once = std::none_of(kept.begin(), kept.end(), [&](const Place& place) {
    return place.kind == Place::kRegister && place.number == step.result.number;
  });
  const uint8_t to = at_once ? integer_register(step.result) : kScratch;
  a_.load(to, {kScratch, id, 8, true, offsetof(InstanceEntry, data)}, 4);
  a_.test(to, to, 4);
  a_.jump_if(Condition::kEqual, none);
  a_.move(integer_register(step.result), to);
}

void Emitter::pool(const Step& step) {
  const uint8_t to = integer_register(step.result);
  a_.load(to, CONTEXT(consts), 8);
  a_.alu(Alu::kSub, to, Operand::of(Registers::kData), 4);
  a_.alu_imm(Alu::kAdd, Operand::of(to), INT32_MIN, 4);
}

}  // namespace vm::native::x64
