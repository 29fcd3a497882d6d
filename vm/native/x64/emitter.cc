#include "vm/native/x64/emitter.h"

#include "vm/exec/context.h"

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
    : pou_(pou),
      f_(*pou.function),
      places_(*pou.places),
      shared_(shared),
      a_(assembler),
      has_and_not_(!pou.plain && has_and_not()),
      tables_(f_, places_, pou.table_ways) {
  // The stack is a multiple of 16 below the return address.
  frame_bytes_ = static_cast<int32_t>(places_.spill_slots * 8);
  if (frame_bytes_ % 16 == 0) frame_bytes_ += 8;
  for (size_t i = 0; i < f_.blocks.size(); ++i) blocks_.push_back(a_.label());
  exits_.assign(f_.exits.size(), kNone);
  for (size_t i = 0; i < f_.inlined.size(); ++i) inlined_.push_back(a_.label());
  entries_.behind_call.assign(f_.calls.size(), 0);
}

uint8_t Emitter::integer_register(const Place& place) const {
  return place.number >= kIntegerCount ? kScratch : kIntegers[place.number];
}
uint8_t Emitter::float_register(const Place& place) const {
  return place.number >= kFloatCount ? kFloatScratch : static_cast<uint8_t>(place.number);
}
Address Emitter::spill(uint32_t slot) const {
  return {kRsp, 0xff, 1, true, static_cast<int32_t>(slot * 8)};
}
Address Emitter::variable(uint32_t number) const {
  const Variable& v = f_.variables[number];
  return address({v.base, 1, kNone, static_cast<int64_t>(v.offset)}, {});
}
Address Emitter::address(const Mem& mem, const Place& index, const Place& pointer) const {
  Address out;
  out.scale = mem.scale;
  if (mem.index != kNone) out.index = integer_register(index);
  out.disp = static_cast<int32_t>(mem.disp);
  switch (mem.base) {
    case MemBase::kFrame:
      out.base = kFrameRegister;
      break;
    case MemBase::kSelf:
      out.base = kSelfRegister;
      break;
    case MemBase::kPointer:
      out.base = integer_register(pointer);
      break;
    case MemBase::kData:
      out.base = kDataRegister;
      out.disp = static_cast<int32_t>(mem.disp - (int64_t{1} << 31));
      break;
  }
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

Entries Emitter::run() {
  expect_places(f_, places_);
  leave_ = a_.label();
  entries_.begin = a_.here();
  enter_frame();
  for (Block b = 0; b < f_.blocks.size(); ++b) block(b);
  stubs();
  for (Block b = 0; b < f_.blocks.size(); ++b) {
    if (!f_.blocks[b].resumes) continue;
    entries_.heads.push_back({b, a_.here()});
    enter_frame();
    moves(places_.blocks[b].resume);
    a_.jump(blocks_[b]);
  }
  for (size_t c = 0; c < f_.calls.size(); ++c) {
    if (f_.calls[c].inlined) continue;
    const Label to = entries_.behind_call[c];
    entries_.behind_call[c] = a_.here();
    enter_frame();
    a_.jump(to);
  }
  return std::move(entries_);
}

void Emitter::block(Block b) {
  a_.bind(blocks_[b]);
  for (const Step& step : places_.blocks[b].steps) {
    if (step.node == kNone) {
      move(step.move);
    } else {
      node(step);
    }
  }
  end(b);
}

void Emitter::end(Block b) {
  const End& e = f_.blocks[b].end;
  switch (e.kind) {
    case EndKind::kJump:
      moves(places_.blocks[b].edges[0]);
      if (e.target[0] != next_block(f_, b)) a_.jump(blocks_[e.target[0]]);
      return;
    case EndKind::kLoop:
      return loop_end(b);
    case EndKind::kBranch:
      if (const auto table = tables_.at(b)) return jump_by_table(b, *table);
      return branch(b);
    case EndKind::kTakeFuel:
      return take_turns(b);
    case EndKind::kUnreachable:
      return;
    case EndKind::kExit:
      return a_.jump(exit_label(e.exit));
    case EndKind::kReturn:
      a_.load(kRax, CONTEXT(call), 8);
      a_.alu(Alu::kCmp, kRax, Operand::of(CONTEXT(exposed)), 8);
      a_.jump_if(Condition::kEqual, exit_label(e.exit));
      leave_frame();
      return a_.ret();
  }
}

void Emitter::loop_end(Block b) {
  const End& e = f_.blocks[b].end;
  const std::vector<Move>& edge = places_.blocks[b].edges[0];
  if (e.exit == kNone) {
    moves(edge);
    return again(b, e.target[0]);
  }
  a_.alu_imm(Alu::kSub, Operand::of(kFuelRegister), 1, 8);
  const BasicBlock& head = f_.blocks[e.target[0]];
  if (edge.empty() &&
      (head.end.kind != EndKind::kBranch || !places_.blocks[e.target[0]].steps.empty())) {
    a_.jump_if(Condition::kNotEqual, blocks_[e.target[0]]);
    return a_.jump(exit_label(e.exit));
  }
  a_.jump_if(Condition::kEqual, exit_label(e.exit));
  moves(edge);
  again(b, e.target[0]);
}

void Emitter::take_turns(Block b) {
  const End& e = f_.blocks[b].end;
  a_.alu_imm(Alu::kSub, Operand::of(kFuelRegister), static_cast<int32_t>(e.fuel), 8);
  edges_.push_back({a_.label(), b, 1});
  a_.jump_if(Condition::kBelowOrEqual, edges_.back().label);
  moves(places_.blocks[b].edges[0]);
  if (e.target[0] != next_block(f_, b)) a_.jump(blocks_[e.target[0]]);
}

// The next turn. A head that does nothing but ask is asked here.
void Emitter::again(Block from, Block head) {
  const End& e = f_.blocks[head].end;
  const AllocatedBlock& places = places_.blocks[head];
  const bool asks = places.steps.empty() && e.kind == EndKind::kBranch &&
                    e.compare == Op::kCompare && places.edges[0].empty() && places.edges[1].empty();
  if (!asks) return a_.jump(blocks_[head]);
  // Execution goes on with the block after it.
  const bool yes_goes_on = e.target[0] == head + 1;
  if (!yes_goes_on && e.target[1] != head + 1) return a_.jump(blocks_[head]);
  const Block out = e.target[yes_goes_on ? 1 : 0];
  branch_integer(e, places.in, blocks_[e.target[0]], blocks_[e.target[1]], !yes_goes_on);
  if (out != from + 1) a_.jump(blocks_[out]);
}

// The way that is not the next block, or needs moves, is jumped to.
void Emitter::branch(Block b) {
  const End& e = f_.blocks[b].end;
  const AllocatedBlock& places = places_.blocks[b];
  Label to[2];
  for (uint32_t i = 0; i < 2; ++i) {
    to[i] = blocks_[e.target[i]];
    if (places.edges[i].empty()) continue;
    to[i] = a_.label();
    edges_.push_back({to[i], b, i});
  }
  const bool yes_is_next = e.target[0] == next_block(f_, b);
  if (e.compare == Op::kFCompare) {
    branch_float(e, places.in, to[0], to[1], yes_is_next);
  } else {
    branch_integer(e, places.in, to[0], to[1], yes_is_next);
  }
  // The way that falls through: its moves right here.
  const uint32_t through = yes_is_next ? 0 : 1;
  if (!places.edges[through].empty()) {
    for (size_t i = edges_.size(); i-- > 0;) {
      if (edges_[i].block != b || edges_[i].target != through) continue;
      a_.bind(edges_[i].label);
      edges_.erase(edges_.begin() + static_cast<ptrdiff_t>(i));
      break;
    }
    moves(places.edges[through]);
  }
  if (e.target[through] != next_block(f_, b)) a_.jump(blocks_[e.target[through]]);
}

void Emitter::branch_integer(const End& e, const Place in[2], Label yes, Label no,
                             bool yes_is_next) {
  if (in[0].kind != Place::kRegister) {
    a_.alu_imm(Alu::kCmp, operand(in[0]), field(in[1].bits, e.width), e.width);
  } else {
    compare(e.width, e.cond, in[0], in[1]);
  }
  if (yes_is_next) {
    a_.jump_if(condition_of(negated(e.cond)), no);
  } else {
    a_.jump_if(condition_of(e.cond), yes);
  }
}

void Emitter::branch_float(const End& e, const Place in[2], Label yes, Label no, bool yes_is_next) {
  if (e.cond == Cond::kLtS || e.cond == Cond::kLeS) {
    // b < c is c above b: false for what is no number
    a_.float_compare(float_register(in[1]), operand(in[0]), e.width);
    const bool strictly = e.cond == Cond::kLtS;
    if (yes_is_next) {
      a_.jump_if(strictly ? Condition::kBelowOrEqual : Condition::kBelow, no);
    } else {
      a_.jump_if(strictly ? Condition::kAbove : Condition::kAboveOrEqual, yes);
    }
    return;
  }
  a_.float_compare(float_register(in[0]), operand(in[1]), e.width);
  const bool equal = e.cond == Cond::kEq;
  const Label differs = equal ? no : yes;
  const Label same = equal ? yes : no;
  const bool same_is_next = equal == yes_is_next;
  if (same_is_next) {
    a_.jump_if(Condition::kParity, differs);
    a_.jump_if(Condition::kNotEqual, differs);
    return;
  }
  const Label skip = a_.label();
  a_.jump_if(Condition::kParity, skip);
  a_.jump_if(Condition::kEqual, same);
  a_.bind(skip);
}

void Emitter::moves(const std::vector<Move>& all) {
  for (const Move& m : all) move(m);
}

void Emitter::load_place(uint8_t to, const Place& from, uint8_t width) {
  switch (from.kind) {
    case Place::kRegister:
      if (from.floating) return a_.float_to_bits(to, float_register(from), 8);
      return a_.move(to, integer_register(from));
    case Place::kSpill:
      return a_.load(to, spill(from.number), 8);
    case Place::kConstant:
      return a_.move_imm(to, from.bits);
    case Place::kHome: {
      const Variable& v = f_.variables[from.number];
      if (v.boolean && !from.clean) {
        a_.move_imm(to, 0);
        a_.alu_imm(Alu::kCmp, Operand::of(variable(from.number)), 0, 1);
        return a_.set(Condition::kNotEqual, to);
      }
      return a_.load(to, variable(from.number), v.width);
    }
    case Place::kNowhere:
      break;
  }
  static_cast<void>(width);
}

void Emitter::load_float(uint8_t to, const Place& from, uint8_t width) {
  switch (from.kind) {
    case Place::kRegister:
      if (!from.floating) return a_.bits_to_float(to, integer_register(from), 8);
      return a_.float_move(to, float_register(from));
    case Place::kSpill:
      return a_.float_load(to, spill(from.number), 8);
    case Place::kConstant:
      if (from.bits == 0) return a_.float_logic(0x57, to, to);
      a_.move_imm(kScratch, from.bits);
      return a_.bits_to_float(to, kScratch, width == 4 ? 4 : 8);
    case Place::kHome:
      return a_.float_load(to, variable(from.number), f_.variables[from.number].width);
    case Place::kNowhere:
      break;
  }
}

void Emitter::move(const Move& m) {
  if (m.to.kind == Place::kSpill) return move_to_spill(m);
  if (m.to.floating) return load_float(float_register(m.to), m.from, m.width);
  load_place(integer_register(m.to), m.from, m.width);
}

void Emitter::move_to_spill(const Move& m) {
  const Address to = spill(m.to.number);
  if (m.from.kind == Place::kRegister) {
    if (m.from.floating) return a_.float_store(to, float_register(m.from), 8);
    return a_.store(to, integer_register(m.from), 8);
  }
  load_place(kScratch, m.from, m.width);
  a_.store(to, kScratch, 8);
}

Label Emitter::exit_label(uint32_t exit) {
  if (exits_[exit] == kNone) exits_[exit] = a_.label();
  return exits_[exit];
}

void Emitter::store_slot(const SlotValue& slot, const Place& place) {
  constexpr Place kInScratch{Place::kRegister, false, false, kIntegerCount, 0};
  const Address to = address({slot.base, 1, kNone, int64_t{slot.offset}}, {});
  if (slot.is_address) {
    if (slot.address.index != kNone) load_place(kScratch, place, 8);
    address_to_data(kScratch, address(slot.address, kInScratch));
    return a_.store(to, kScratch, slot.width);
  }
  if (place.kind == Place::kRegister) {
    if (place.floating) return a_.float_store(to, float_register(place), slot.width);
    return a_.store(to, integer_register(place), slot.width);
  }
  load_place(kScratch, place, slot.width);
  a_.store(to, kScratch, slot.width);
}

void Emitter::give_back(uint32_t fuel) {
  if (fuel == 0) return;
  a_.alu_imm(Alu::kAdd, Operand::of(kFuelRegister), static_cast<int32_t>(fuel), 8);
}

// What is seldom comes after everything else.
void Emitter::stubs() {
  for (const EdgeStub& edge : edges_) {
    const End& e = f_.blocks[edge.block].end;
    a_.bind(edge.label);
    give_back(e.fuel);
    moves(places_.blocks[edge.block].edges[edge.target]);
    a_.jump(blocks_[e.target[edge.target]]);
  }
  for (uint32_t exit = 0; exit < f_.exits.size(); ++exit) {
    if (exits_[exit] == kNone) continue;
    a_.bind(exits_[exit]);
    const Exit& e = f_.exits[exit];
    if (e.inlined != kNone) {
      inlined_exit(exit);
      continue;
    }
    for (size_t i = 0; i < e.slots.size(); ++i) store_slot(e.slots[i], places_.exits[exit][i]);
    if (e.fuel) a_.move_imm(kFuelRegister, 1);
    give_back(e.fuel_back);
    a_.move_imm(kScratch, e.unit);
    a_.jump(leave_);
  }
  for (const auto& [label, unit] : stops_) {
    a_.bind(label);
    a_.move_imm(kScratch, unit);
    a_.jump(leave_);
  }
  for (const auto& [label, side, exit] : call_stubs_) {
    a_.bind(label);
    const Exit& e = f_.exits[exit];
    for (size_t i = 0; i < e.slots.size(); ++i) store_slot(e.slots[i], places_.exits[exit][i]);
    a_.move_imm(kFuelRegister, 1);
    a_.move_imm(kScratch, reinterpret_cast<uintptr_t>(pou_.side->units.get() + side));
    a_.store(CONTEXT(pc), kScratch, 8);
    a_.store_imm(CONTEXT(pou), static_cast<int32_t>(pou_.number), 4);
    a_.jump(shared_.leave);
  }
  for (uint32_t i = 0; i < inlined_.size(); ++i) {
    if (f_.inlined[i].leaves) activation(i);
  }
  a_.bind(leave_);
  a_.shift(Shift::kShl, kScratch, 3, 8);
  a_.move_imm(kRax, reinterpret_cast<uintptr_t>(pou_.units));
  a_.alu(Alu::kAdd, kScratch, Operand::of(kRax), 8);
  a_.store(CONTEXT(pc), kScratch, 8);
  a_.store_imm(CONTEXT(pou), static_cast<int32_t>(pou_.number), 4);
  a_.jump(shared_.leave);
  tables();
}

}  // namespace vm::native::x64
