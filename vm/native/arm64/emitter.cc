#include "vm/native/arm64/emitter.h"

#include "vm/exec/context.h"
#include "vm/native/arm64/immediates.h"

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
    : pou_(pou),
      f_(*pou.function),
      places_(*pou.places),
      shared_(shared),
      a_(assembler),
      tables_(f_, places_, pou.table_ways) {
  // The spill slots and the return address, a multiple of 16.
  frame_bytes_ = static_cast<int32_t>((places_.spill_slots + 2) / 2 * 16);
}

uint8_t Emitter::integer_register(const Place& place) const {
  return place.number >= kIntegerCount ? kScratch : kIntegers[place.number];
}
uint8_t Emitter::float_register(const Place& place) const {
  return place.number >= kFloatCount ? kFloatScratch : static_cast<uint8_t>(place.number);
}
Address Emitter::spill(uint32_t slot) const { return {kSp, 0xff, 0, true, int64_t{slot} * 8}; }
Address Emitter::context(size_t offset) const {
  return {kContextRegister, 0xff, 0, true, static_cast<int64_t>(offset)};
}
Address Emitter::variable(uint32_t number) const {
  const Variable& v = f_.variables[number];
  return address({v.base, 1, kNone, static_cast<int64_t>(v.offset)}, {});
}
Address Emitter::address(const Mem& mem, const Place& index, const Place& pointer) const {
  Address out;
  out.disp = mem.disp;
  if (mem.index != kNone) {
    out.index = integer_register(index);
    out.shift = static_cast<uint8_t>(mem.scale == 8 ? 3 : mem.scale / 2);
  }
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
      break;
  }
  return out;
}
void Emitter::store_word(const Address& to, uint32_t value) {
  if (value != 0) a_.move_imm(kScratch, value);
  a_.store(to, value != 0 ? kScratch : kZero, 4);
}

void Emitter::enter_frame() {
  a_.add_imm(kSp, kSp, -frame_bytes_, 8);
  a_.store({kSp, 0xff, 0, true, frame_bytes_ - 8}, kLink, 8);
}
void Emitter::leave_frame() {
  a_.load(kLink, {kSp, 0xff, 0, true, frame_bytes_ - 8}, 8);
  a_.add_imm(kSp, kSp, frame_bytes_, 8);
}

// Once more with long branches when the short ones do not reach.
Entries Emitter::run() {
  expect_places(f_, places_);
  const Assembler::Mark begin = a_.mark();
  function();
  if (!a_.reaches(begin)) {
    a_.rewind(begin);
    a_.set_long(true);
    function();
    a_.set_long(false);
  }
  return std::move(entries_);
}

void Emitter::function() {
  entries_ = {};
  entries_.behind_call.assign(f_.calls.size(), 0);
  exits_.assign(f_.exits.size(), kNone);
  blocks_.clear();
  edges_.clear();
  table_stubs_.clear();
  stops_.clear();
  call_stubs_.clear();
  nan_stubs_.clear();
  inlined_.clear();
  for (size_t i = 0; i < f_.blocks.size(); ++i) blocks_.push_back(a_.label());
  for (size_t i = 0; i < f_.inlined.size(); ++i) inlined_.push_back(a_.label());
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
      a_.load(kScratch, CONTEXT(call), 8);
      a_.load(kAddressScratch, CONTEXT(exposed), 8);
      a_.alu(Alu::kSubFlags, kZero, kScratch, kAddressScratch, 8);
      a_.jump_if(Condition::kEqual, exit_label(e.exit));
      leave_frame();
      return a_.ret();
  }
}

void Emitter::loop_end(Block b) {
  const End& e = f_.blocks[b].end;
  const std::vector<Move>& edge = places_.blocks[b].edges[0];
  if (e.exit != kNone) {
    const Label out = exit_label(e.exit);
    a_.decrement(kFuelRegister, 1);
    if (edge.empty() && !only_asks(e.target[0])) {
      a_.jump_if(Condition::kNotEqual, blocks_[e.target[0]]);
      return a_.jump(out);
    }
    a_.jump_if(Condition::kEqual, out);
  }
  moves(edge);
  again(e.target[0]);
}

// The next turn. A head that does nothing but ask is asked here.
void Emitter::again(Block head) {
  if (!only_asks(head)) return a_.jump(blocks_[head]);
  const End& e = f_.blocks[head].end;
  const AllocatedBlock& places = places_.blocks[head];
  const bool yes_goes_on = e.target[0] == head + 1;
  jump_if(e.width, yes_goes_on ? e.cond : negated(e.cond), places.in[0], places.in[1],
          blocks_[head + 1]);
  a_.jump(blocks_[e.target[yes_goes_on ? 1 : 0]]);
}

void Emitter::take_turns(Block b) {
  const End& e = f_.blocks[b].end;
  a_.decrement(kFuelRegister, e.fuel);
  edges_.push_back({a_.label(), b, 1});
  a_.jump_if(Condition::kBelowOrEqual, edges_.back().label);
  moves(places_.blocks[b].edges[0]);
  if (e.target[0] != next_block(f_, b)) a_.jump(blocks_[e.target[0]]);
}

void Emitter::give_back(uint32_t fuel) {
  if (fuel != 0) a_.add_imm(kFuelRegister, kFuelRegister, fuel, 8);
}

bool Emitter::only_asks(Block head) const {
  const End& e = f_.blocks[head].end;
  const AllocatedBlock& places = places_.blocks[head];
  return places.steps.empty() && e.kind == EndKind::kBranch && e.compare == Op::kCompare &&
         places.edges[0].empty() && places.edges[1].empty() &&
         (e.target[0] == head + 1 || e.target[1] == head + 1);
}

// The way that is not the next block, or needs moves, is jumped to.
void Emitter::branch(Block b) {
  const End& e = f_.blocks[b].end;
  const AllocatedBlock& places = places_.blocks[b];
  const uint32_t through = e.target[0] == next_block(f_, b) ? 0 : 1;
  const uint32_t other = 1 - through;
  Label to = blocks_[e.target[other]];
  if (!places.edges[other].empty()) {
    to = a_.label();
    edges_.push_back({to, b, other});
  }
  if (e.compare == Op::kFCompare) {
    a_.float_compare(float_register(places.in[0]), float_register(places.in[1]), e.width);
    const Condition condition = float_condition_of(e.cond);
    a_.jump_if(other == 0 ? condition : inverted(condition), to);
  } else {
    jump_if(e.width, other == 0 ? e.cond : negated(e.cond), places.in[0], places.in[1], to);
  }
  moves(places.edges[through]);
  if (e.target[through] != next_block(f_, b)) a_.jump(blocks_[e.target[through]]);
}

void Emitter::moves(const std::vector<Move>& all) {
  for (const Move& m : all) move(m);
}

void Emitter::load_bool(uint8_t to, const Address& from) {
  a_.load(to, from, 1);
  a_.compare_imm(to, 0, 4);
  a_.set(Condition::kNotEqual, to);
}

void Emitter::load_place(uint8_t to, const Place& from) {
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
      if (v.boolean && !from.clean) return load_bool(to, variable(from.number));
      return a_.load(to, variable(from.number), v.width);
    }
    case Place::kNowhere:
      break;
  }
}

void Emitter::load_float(uint8_t to, const Place& from, uint8_t width) {
  switch (from.kind) {
    case Place::kRegister:
      if (!from.floating) return a_.bits_to_float(to, integer_register(from), 8);
      return a_.float_move(to, float_register(from));
    case Place::kSpill:
      return a_.float_load(to, spill(from.number), 8);
    case Place::kConstant:
      if (from.bits == 0) return a_.float_zero(to);
      if (const auto small = float_immediate(from.bits, width == 4 ? 4 : 8)) {
        return a_.float_imm(to, *small, width == 4 ? 4 : 8);
      }
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
  load_place(integer_register(m.to), m.from);
}

void Emitter::move_to_spill(const Move& m) {
  const Address to = spill(m.to.number);
  if (m.from.kind == Place::kRegister) {
    if (m.from.floating) return a_.float_store(to, float_register(m.from), 8);
    return a_.store(to, integer_register(m.from), 8);
  }
  load_place(kScratch, m.from);
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
    if (slot.address.index != kNone) load_place(kScratch, place);
    a_.address(kScratch, address(slot.address, kInScratch), 8);
    a_.alu(Alu::kSub, kScratch, kScratch, kDataRegister, 4);
    return a_.store(to, kScratch, slot.width);
  }
  if (place.kind == Place::kRegister) {
    if (place.floating) return a_.float_store(to, float_register(place), slot.width);
    return a_.store(to, integer_register(place), slot.width);
  }
  load_place(kScratch, place);
  a_.store(to, kScratch, slot.width);
}

// The interpreter goes on at a side unit.
void Emitter::leave_at_side(uint32_t side) {
  a_.move_imm(kScratch, reinterpret_cast<uintptr_t>(pou_.side->units.get() + side));
  a_.store(CONTEXT(pc), kScratch, 8);
  store_word(CONTEXT(pou), pou_.number);
  a_.jump_long(shared_.leave);
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
    leave_at_side(side);
  }
  nan_stubs();
  for (uint32_t i = 0; i < inlined_.size(); ++i) {
    if (f_.inlined[i].leaves) activation(i);
  }
  a_.bind(leave_);
  static_assert(sizeof(ir::Unit) == 8);
  a_.move_imm(0, reinterpret_cast<uintptr_t>(pou_.units));
  a_.alu(Alu::kAdd, kScratch, 0, kScratch, 8, 3);
  a_.store(CONTEXT(pc), kScratch, 8);
  store_word(CONTEXT(pou), pou_.number);
  a_.jump_long(shared_.leave);
  tables();
}

}  // namespace vm::native::arm64
