// Members of FunctionEmitter but for calls, which are in function_calls_impl.h.
#pragma once

#include "vm/native/function_calls_impl.h"

namespace vm::native {

#define CONTEXT(member) context(offsetof(Context, member))

// --- places -------------------------------------------------------------------------

template <class Self, class Registers>
uint8_t FunctionEmitter<Self, Registers>::base_register(const Mem& mem,
                                                        const Place& pointer) const {
  switch (mem.base) {
    case MemBase::kFrame:
      return Registers::kFrame;
    case MemBase::kSelf:
      return Registers::kSelf;
    case MemBase::kPointer:
      return integer_register(pointer);
    case MemBase::kData:
      break;
  }
  return Registers::kData;
}

template <class Self, class Registers>
auto FunctionEmitter<Self, Registers>::variable(uint32_t number) const -> Address {
  const Variable& v = f_.variables[number];
  return self().address({v.base, 1, kNone, static_cast<int64_t>(v.offset)}, {});
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::load_place(uint8_t to, const Place& from) {
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
      if (v.boolean && !from.clean) return self().load_bool(to, variable(from.number));
      return a_.load(to, variable(from.number), v.width);
    }
    case Place::kNowhere:
      break;
  }
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::load_float(uint8_t to, const Place& from, uint8_t width) {
  switch (from.kind) {
    case Place::kRegister:
      if (!from.floating) return a_.bits_to_float(to, integer_register(from), 8);
      return a_.float_move(to, float_register(from));
    case Place::kSpill:
      return a_.float_load(to, spill(from.number), 8);
    case Place::kConstant:
      return self().float_constant(to, from.bits, width == 4 ? 4 : 8);
    case Place::kHome:
      return a_.float_load(to, variable(from.number), f_.variables[from.number].width);
    case Place::kNowhere:
      break;
  }
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::store_place(const Address& to, const Place& from,
                                                   uint8_t width) {
  if (from.kind == Place::kRegister) {
    if (from.floating) return a_.float_store(to, float_register(from), width);
    return a_.store(to, integer_register(from), width);
  }
  load_place(Registers::kScratch, from);
  a_.store(to, Registers::kScratch, width);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::moves(const std::vector<Move>& all) {
  for (const Move& m : all) move(m);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::move(const Move& m) {
  if (m.to.kind == Place::kSpill) return store_place(spill(m.to.number), m.from, 8);
  if (m.to.floating) return load_float(float_register(m.to), m.from, m.width);
  load_place(integer_register(m.to), m.from);
}

// --- blocks -------------------------------------------------------------------------

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::function() {
  entries_ = {};
  entries_.behind_call.assign(f_.calls.size(), 0);
  exits_.assign(f_.exits.size(), kNone);
  blocks_.clear();
  edges_.clear();
  table_stubs_.clear();
  stops_.clear();
  call_stubs_.clear();
  inlined_.clear();
  for (size_t i = 0; i < f_.blocks.size(); ++i) blocks_.push_back(a_.label());
  for (size_t i = 0; i < f_.inlined.size(); ++i) inlined_.push_back(a_.label());
  leave_ = a_.label();
  entries_.begin = a_.here();
  self().enter_frame();
  for (Block b = 0; b < f_.blocks.size(); ++b) block(b);
  stubs();
  entries_of_loops();
  entries_after_calls();
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::entries_of_loops() {
  for (Block b = 0; b < f_.blocks.size(); ++b) {
    if (!f_.blocks[b].resumes) continue;
    entries_.heads.push_back({b, a_.here()});
    self().enter_frame();
    moves(places_.blocks[b].resume);
    a_.jump(blocks_[b]);
  }
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::entries_after_calls() {
  for (size_t c = 0; c < f_.calls.size(); ++c) {
    if (f_.calls[c].inlined) continue;
    const Label to = entries_.behind_call[c];
    entries_.behind_call[c] = a_.here();
    self().enter_frame();
    a_.jump(to);
  }
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::block(Block b) {
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

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::end(Block b) {
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
      self().jump_if_exposed(exit_label(e.exit));
      self().leave_frame();
      return a_.ret();
  }
}

// The way that is not the next block, or needs moves, is jumped to.
template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::branch(Block b) {
  const End& e = f_.blocks[b].end;
  const AllocatedBlock& places = places_.blocks[b];
  const uint32_t through = e.target[0] == next_block(f_, b) ? 0 : 1;
  const uint32_t other = 1 - through;
  self().jump_when(e, places.in, other == 0, label_of({b, other}));
  moves(places.edges[through]);
  if (e.target[through] != next_block(f_, b)) a_.jump(blocks_[e.target[through]]);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::loop_end(Block b) {
  using Condition = typename Registers::Condition;
  const End& e = f_.blocks[b].end;
  const std::vector<Move>& edge = places_.blocks[b].edges[0];
  if (e.exit != kNone) {
    const Label out = exit_label(e.exit);
    self().take_fuel(1);
    if (edge.empty() && !only_asks(e.target[0])) {
      a_.jump_if(Condition::kNotEqual, blocks_[e.target[0]]);
      return a_.jump(out);
    }
    a_.jump_if(Condition::kEqual, out);
  }
  moves(edge);
  again(b, e.target[0]);
}

template <class Self, class Registers>
bool FunctionEmitter<Self, Registers>::only_asks(Block head) const {
  const End& e = f_.blocks[head].end;
  const AllocatedBlock& places = places_.blocks[head];
  return places.steps.empty() && e.kind == EndKind::kBranch && e.compare == Op::kCompare &&
         places.edges[0].empty() && places.edges[1].empty() &&
         (e.target[0] == head + 1 || e.target[1] == head + 1);
}

// The next turn. A head that does nothing but ask is asked here.
template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::again(Block from, Block head) {
  if (!only_asks(head)) return a_.jump(blocks_[head]);
  const End& e = f_.blocks[head].end;
  const bool yes_goes_on = e.target[0] == head + 1;
  self().jump_when(e, places_.blocks[head].in, yes_goes_on, blocks_[head + 1]);
  const Block out = e.target[yes_goes_on ? 1 : 0];
  if (out != from + 1) a_.jump(blocks_[out]);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::take_turns(Block b) {
  const End& e = f_.blocks[b].end;
  self().take_fuel(e.fuel);
  edges_.push_back({a_.label(), b, 1});
  a_.jump_if(Registers::Condition::kBelowOrEqual, edges_.back().label);
  moves(places_.blocks[b].edges[0]);
  if (e.target[0] != next_block(f_, b)) a_.jump(blocks_[e.target[0]]);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::give_back(uint32_t fuel) {
  if (fuel != 0) self().add(Registers::kFuel, fuel);
}

template <class Self, class Registers>
Label FunctionEmitter<Self, Registers>::label_of(const JumpTable::Way& way) {
  if (places_.blocks[way.block].edges[way.target].empty()) {
    return blocks_[f_.blocks[way.block].end.target[way.target]];
  }
  edges_.push_back({a_.label(), way.block, way.target});
  return edges_.back().label;
}

// The table of distances stands after the code.
template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::jump_by_table(Block b, const JumpTable& table) {
  TableStub stub{a_.label(), {}};
  for (size_t i = 0; i < table.ways.size(); ++i) {
    const bool same = i != 0 && table.ways[i] == table.ways[i - 1];
    stub.entries.push_back(same ? stub.entries.back() : label_of(table.ways[i]));
  }
  const Place limit{Place::kConstant, false, false, 0, table.ways.size()};
  const Place& value = places_.blocks[b].in[0];
  const uint8_t width = f_.blocks[b].end.width;
  self().jump_if(width, Cond::kGeU, value, limit, label_of(table.otherwise));
  self().jump_through(stub.label, integer_register(value), width);
  table_stubs_.push_back(std::move(stub));
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::tables() {
  for (const TableStub& table : table_stubs_) {
    a_.bind(table.label);
    for (const Label entry : table.entries) a_.table_entry(table.label, entry);
  }
}

// --- what is seldom, after everything else ------------------------------------------

template <class Self, class Registers>
Label FunctionEmitter<Self, Registers>::exit_label(uint32_t exit) {
  if (exits_[exit] == kNone) exits_[exit] = a_.label();
  return exits_[exit];
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::stubs() {
  for (const EdgeStub& edge : edges_) {
    const End& e = f_.blocks[edge.block].end;
    a_.bind(edge.label);
    give_back(e.fuel);
    moves(places_.blocks[edge.block].edges[edge.target]);
    a_.jump(blocks_[e.target[edge.target]]);
  }
  for (uint32_t exit = 0; exit < f_.exits.size(); ++exit) exit_stub(exit);
  for (const StopStub& stop : stops_) {
    a_.bind(stop.label);
    a_.move_imm(Registers::kScratch, stop.unit);
    a_.jump(leave_);
  }
  for (const CallStub& stub : call_stubs_) {
    a_.bind(stub.label);
    store_slots(stub.exit, f_.exits[stub.exit].slots.size());
    a_.move_imm(Registers::kFuel, 1);
    leave_at(pou_.side->units.get() + stub.side);
  }
  self().own_stubs();
  for (uint32_t i = 0; i < inlined_.size(); ++i) {
    if (f_.inlined[i].leaves) activation(i);
  }
  leave_at_unit_in_scratch();
  tables();
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::exit_stub(uint32_t exit) {
  if (exits_[exit] == kNone) return;
  a_.bind(exits_[exit]);
  const Exit& e = f_.exits[exit];
  if (e.inlined != kNone) return inlined_exit(exit);
  store_slots(exit, e.slots.size());
  if (e.fuel) a_.move_imm(Registers::kFuel, 1);
  give_back(e.fuel_back);
  a_.move_imm(Registers::kScratch, e.unit);
  a_.jump(leave_);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::store_slots(uint32_t exit, size_t count) {
  for (size_t i = 0; i < count; ++i) store_slot(f_.exits[exit].slots[i], places_.exits[exit][i]);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::store_slot(const SlotValue& slot, const Place& place) {
  constexpr Place kInScratch{Place::kRegister, false, false, Registers::kIntegerCount, 0};
  const Address to = self().address({slot.base, 1, kNone, int64_t{slot.offset}}, {});
  if (slot.site != kNoSite) {
    load_place(Registers::kScratch, place);
    return self().store_handle(to, slot.site);
  }
  if (!slot.is_address) return store_place(to, place, slot.width);
  if (slot.address.index != kNone) load_place(Registers::kScratch, place);
  self().address_to_data(Registers::kScratch, self().address(slot.address, kInScratch));
  a_.store(to, Registers::kScratch, slot.width);
}

// The interpreter goes on at this unit.
template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::leave_at(const ir::Unit* unit) {
  a_.move_imm(Registers::kScratch, reinterpret_cast<uintptr_t>(unit));
  a_.store(CONTEXT(pc), Registers::kScratch, 8);
  self().store_word(CONTEXT(pou), pou_.number);
  a_.jump_long(shared_.leave);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::leave_at_unit_in_scratch() {
  a_.bind(leave_);
  self().unit_address(Registers::kScratch, pou_.units, Registers::kScratch);
  a_.store(CONTEXT(pc), Registers::kScratch, 8);
  self().store_word(CONTEXT(pou), pou_.number);
  a_.jump_long(shared_.leave);
}

#undef CONTEXT

}  // namespace vm::native
