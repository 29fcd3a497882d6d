// One instruction after the other.
#include "vm/native/build.h"
#include "vm/native/ranges.h"

namespace vm::native {

using ir::Opcode;

void Builder::unit(uint32_t number) {
  unit_ = number;
  u_ = facts_.unit(number);
  x_ = facts_.extension(number);
  const Opcode op = u_.opcode();
  const Recipe& recipe = recipe_of(op);
  switch (recipe.shape) {
    case Shape::kMove:
      return write_a(read_b());
    case Shape::kBinary:
    case Shape::kUnary:
    case Shape::kCompare:
    case Shape::kExtreme:
    case Shape::kAbsolute:
    case Shape::kChoose:
    case Shape::kToBool:
      return arithmetic(recipe);
    case Shape::kDivide:
      return divide(recipe);
    case Shape::kShift:
      return shift(recipe);
    case Shape::kExtend:
    case Shape::kSame:
    case Shape::kFromInteger:
      return convert(recipe);
    case Shape::kToInteger:
      return to_integer(recipe);
    case Shape::kCheckRange:
      return check_range(recipe);
    case Shape::kCheckStep:
      return exit_if(Cond::kEq, recipe.width, read_b(), zero());
    case Shape::kLoadAt:
      return load_at(recipe);
    case Shape::kStoreAt:
      return store_at(recipe);
    case Shape::kLoadFar:
      return write_a(read_field(u_.base_b(), u_.bc(), ir::opcode_row(op).a.cls));
    case Shape::kStoreFar:
      return write_field(u_.base_b(), u_.bc(), ir::opcode_row(op).a.cls, read_a());
    case Shape::kIndex:
      return index(recipe, false);
    case Shape::kIndexPlace:
      return index(recipe, true);
    case Shape::kSpecial:
      return special();
    case Shape::kHelper:
      break;
  }
  if (const Fork* const fork = facts_.fork(block_)) {
    if (op == Opcode::JMP || is_switch(op)) return this->fork(*fork);
  }
  if (op == Opcode::JT || op == Opcode::JF) {
    End& end = f_.blocks[block_].end;
    end.in[0] = read_a();
    end.in[1] = zero();
    end.kind = EndKind::kBranch;
    end.cond = op == Opcode::JT ? Cond::kNe : Cond::kEq;
    end.target[0] = facts_.block_at(facts_.jump_target(number));
    end.target[1] = block_ + 1;
    ended_ = true;
  } else if (op == Opcode::JMP) {
    end_with_jump(facts_.block_at(facts_.jump_target(number)));
  } else if (op == Opcode::LOOP) {
    pass_back(block_, facts_.block_at(facts_.jump_target(number)));
  } else if (op == Opcode::RET) {
    for (const uint32_t v : facts_.results()) store_slot(v);
    store_deferred();
    f_.blocks[block_].end.kind = EndKind::kReturn;
    f_.blocks[block_].end.exit = exit_here(false);
    ended_ = true;
  } else if (op == Opcode::NATIVE) {
    native();
  } else if (op == Opcode::SCOPY || op == Opcode::WCOPY) {
    copy_text();
  } else if (op == Opcode::COPY) {
    copy();
  } else if (ir::opcode_row(op).ends) {
    leave();
  } else if (op != Opcode::HANDLE || !handle()) {
    helper();
  }
}

void Builder::fork(const Fork& fork) {
  const Opcode op = u_.opcode();
  if (is_switch(op)) {
    const auto width = static_cast<uint8_t>(ir::class_size(ir::opcode_row(op).b.cls));
    const auto low = static_cast<uint64_t>(int64_t{static_cast<int32_t>(x_.x())});
    switched_.value = read_b();
    switched_.width = width;
    if (low != 0) {
      switched_.value = int_op(Op::kSub, width, switched_.value, constant(low, width, false));
    }
  }
  End& end = f_.blocks[block_].end;
  end.kind = fork.below == kNone ? EndKind::kUnreachable : EndKind::kBranch;
  ended_ = true;
  if (fork.below == kNone) return;
  if (fork.below == fork.above) return end_with_jump(fork.below);
  end.cond = Cond::kLtU;
  end.width = switched_.width;
  end.in[0] = switched_.value;
  end.in[1] = constant(fork.edge, switched_.width, false);
  end.target[0] = fork.below;
  end.target[1] = fork.above;
}

void Builder::leave() {
  End& end = f_.blocks[block_].end;
  end.kind = EndKind::kExit;
  end.exit = exit_here(true);
  ended_ = true;
}

void Builder::arithmetic(const Recipe& recipe) {
  const Val b = read_b();
  Node made = node(recipe.op, recipe.width, b);
  made.from = recipe.from;
  made.cond = recipe.cond;
  switch (recipe.shape) {
    case Shape::kBinary:
    case Shape::kCompare:
      made.in[1] = read_c();
      break;
    case Shape::kToBool:
      made.cond = Cond::kNe;
      made.in[1] = zero();
      break;
    case Shape::kExtreme: {  // c cond b ? c : b
      const Val c = read_c();
      made.in[0] = c;
      made.in[1] = b;
      made.in[2] = c;
      made.in[3] = b;
      break;
    }
    case Shape::kAbsolute:
      made.op = Op::kSelectCmp;
      made.from = recipe.width;
      made.cond = Cond::kLtS;
      made.in[0] = int_op(Op::kNeg, recipe.width, b);
      made.in[1] = b;
      made.in[2] = b;
      made.in[3] = zero();
      break;
    case Shape::kChoose:
      made.in[1] = read_c();
      made.in[2] = read_a();
      break;
    default:
      break;
  }
  write_a(value_of(made, recipe.floating));
}

void Builder::shift(const Recipe& recipe) {
  Val left = read_b();
  const Val count = read_c();
  const unsigned width_bits = 8u * recipe.width;
  const bool rotates = recipe.op == Op::kRol || recipe.op == Op::kRor;
  if (is_constant(count)) {
    const uint64_t n = bits(count) & 0xffffffffu;
    if (rotates && n % width_bits == 0) return write_a(left);
    if (n == 0) return write_a(left);
    if (!rotates && n >= width_bits) return write_a(constant(0, recipe.width, false));
  }
  if (rotates && recipe.width < 4 && !is_constant(count)) return helper();
  if (recipe.op == Op::kShr && recipe.width < 4) left = extended(left, recipe.width, false);
  if (is_constant(count)) {
    const Val n = constant((bits(count) & 0xffffffffu) % width_bits, 4, false);
    return write_a(int_op(recipe.op, recipe.width, left, n));
  }
  write_a(int_op(recipe.op, recipe.width, left, count));
}

void Builder::convert(const Recipe& recipe) {
  const Val b = read_b();
  if (recipe.shape == Shape::kSame) {
    // Four bytes are zero-extended wherever they are.
    return write_a(recipe.width == 4 ? extended(b, 4, false) : b);
  }
  if (recipe.shape == Shape::kExtend) {
    if (is_constant(b)) {
      return write_a(
          constant(bits(extended(b, recipe.from, recipe.is_signed)), recipe.width, false));
    }
    const Val wide = extended(b, recipe.from, recipe.is_signed);
    return write_a(recipe.width == 4 && recipe.is_signed ? extended(wide, 4, false) : wide);
  }
  Node made = node(Op::kIntToFloat, recipe.width);
  const bool as_it_is = recipe.is_signed && recipe.from >= 4;
  made.in[0] = as_it_is ? b : extended(b, recipe.from, recipe.is_signed);
  made.from = as_it_is ? recipe.from : 8;
  write_a(value_of(made, true));
}

void Builder::to_integer(const Recipe& recipe) {
  Node made = node(Op::kFloatToInt, 8, read_b());
  made.from = recipe.from;
  made.imm = recipe.towards_zero ? 1 : 0;
  const Val wide = value_of(made, false);
  Node check = node(Op::kExitIf, 8, wide);
  if (recipe.width == 8) {
    // The smallest number may be meant, or stand for none: the interpreter knows.
    check.in[1] = constant(uint64_t{1} << 63, 8, false);
    check.cond = Cond::kEq;
    check.exit = exit_here(true);
    append(check);
    return write_a(wide);
  }
  const unsigned width_bits = 8u * recipe.width;
  const int64_t low = recipe.is_signed ? -(int64_t{1} << (width_bits - 1)) : 0;
  const int64_t high =
      recipe.is_signed ? (int64_t{1} << (width_bits - 1)) - 1 : (int64_t{1} << width_bits) - 1;
  const Val shifted = int_op(Op::kSub, 8, wide, constant(static_cast<uint64_t>(low), 8, false));
  exit_if(Cond::kGtU, 8, shifted, constant(static_cast<uint64_t>(high - low), 8, false));
  write_a(recipe.width == 4 ? extended(wide, 4, false) : wide);
}

void Builder::check_range(const Recipe& recipe) {
  const ir::Range& range = facts_.image().ranges[u_.c];
  const Val wide = extended(read_b(), recipe.from, recipe.is_signed);
  if (recipe.from == 8 && !recipe.is_signed) exit_if(Cond::kLtS, 8, wide, zero());
  exit_if(Cond::kLtS, 8, wide, constant(static_cast<uint64_t>(range.low), 8, false));
  exit_if(Cond::kGtS, 8, wide, constant(static_cast<uint64_t>(range.high), 8, false));
}

void Builder::index(const Recipe& recipe, bool of_place) {
  // The pool lies at one of two places, as the generation says.
  if (of_place && u_.base_c() == ir::Base::kConst) return helper();
  const ir::LinkedBound& bound = facts_.image().bounds[x_.x()];
  const Val wide = extended(read_b(), recipe.from, recipe.is_signed);
  if (recipe.from == 8 && !recipe.is_signed) exit_if(Cond::kLtS, 8, wide, zero());
  const Val steps = int_op(Op::kSub, 8, wide, constant(static_cast<uint64_t>(bound.low), 8, false));
  exit_if(Cond::kGeU, 8, steps, constant(bound.count, 8, false));
  Mem mem;
  if (of_place) {
    mem = place(u_.base_c(), x_.y());
  } else {
    mem = behind(read_c(), x_.y());
    if (mem.index != kNone && mem.base == MemBase::kData && mem.scale == 1) {
      // base + steps * stride is one address, what is constant stays apart
      Node sum = node(Op::kAdd, 8, mem.index);
      sum.in[1] = int_op(Op::kMul, 8, steps, constant(bound.stride, 8, false));
      mem.index = value_of(sum, false);
      return write_a(address_of(mem));
    }
    if (mem.index != kNone) {
      const Val scaled = int_op(Op::kMul, 8, mem.index, constant(mem.scale, 8, false));
      mem.index =
          int_op(Op::kAdd, 8, scaled, int_op(Op::kMul, 8, steps, constant(bound.stride, 8, false)));
      mem.scale = 1;
      return write_a(address_of(mem));
    }
  }
  const bool direct =
      bound.stride == 1 || bound.stride == 2 || bound.stride == 4 || bound.stride == 8;
  if (is_constant(steps)) {
    mem.disp += static_cast<int64_t>(bits(steps) * bound.stride);
    return write_a(address_of(mem));
  }
  mem.index = direct ? steps : int_op(Op::kMul, 8, steps, constant(bound.stride, 8, false));
  mem.scale = direct ? static_cast<uint8_t>(bound.stride) : uint8_t{1};
  write_a(address_of(mem));
}

void Builder::load_at(const Recipe& recipe) {
  const Mem mem = behind(read_b(), u_.c);
  const bool boolean = ir::opcode_row(u_.opcode()).a.cls == ir::Class::kB && !facts_.clean_bools();
  write_a(load(mem, recipe.width, recipe.floating, boolean));
}

void Builder::store_at(const Recipe& recipe) {
  const Val value = read_b();
  Node made = node(Op::kStore, recipe.width, value);
  made.mem = behind(read_a(), u_.c);
  append(made);
  kill_memory();
  const bool boolean = ir::opcode_row(u_.opcode()).b.cls == ir::Class::kB && !facts_.clean_bools();
  remember(made.mem, made.width, value, boolean);
}

// By the interpreter's own handler.
void Builder::helper() {
  store_deferred();
  for (const Access& access : accesses_of(u_)) {
    const uint32_t v = access.reads ? facts_.variable(access) : kNone;
    if (v != kNone && f_.variables[v].slot) store_slot(v);
  }
  append(node(Op::kHelper, 0));
  if (facts_.writes_memory(unit_)) kill_memory();
  for (const Access& access : accesses_of(u_)) {
    if (!access.writes) continue;
    const uint32_t v = facts_.variable(access);
    now_.value[v] = kNone;
    now_.dirty[v] = 0;
    f_.nodes.back().variable = v;
    for (const uint32_t other : f_.overlaps[v]) now_.value[other] = kNone;
  }
  ++version_;
}

}  // namespace vm::native
