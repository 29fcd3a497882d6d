#include <algorithm>

#include "vm/native/allocator.h"

namespace vm::native {

uint32_t Allocator::next_use(Val v, uint32_t from) {
  if (from != 0) uses_.advance(v, from - 1);
  const uint32_t next = uses_.next(v);
  if (next == kNone || next <= block_end_ || is_constant(v)) return next;
  return live_out_[v] == block_stamp_ ? next : kNone;
}

void Allocator::find_live_out(Block block) {
  ++block_stamp_;
  block_end_ = uses_.end_of(block);
  for (const Block to : f_.blocks[block].end.target) {
    if (to == kNone) continue;
    for (const Val v : uses_.live_in(to)) live_out_[v] = block_stamp_;
  }
}

void Allocator::add_live(Val v) {
  if (live_at_[v] != kNone) return;
  live_at_[v] = static_cast<uint32_t>(live_.size());
  live_.push_back(v);
}

// The value is used no more: its register is free, and its spill slot when no other way uses it.
void Allocator::remove_live(Val v) {
  free_register(v);
  if (uses_.next(v) == kNone) {
    if (slot_[v] != kNone) free_slots_.push_back(slot_[v]);
    slot_[v] = kNone;
  }
  saved_[v] = 0;
  if (home_[v] != kNone && holder_[home_[v]] == v) holder_[home_[v]] = kNone;
  home_[v] = kNone;
  if (live_at_[v] == kNone) return;
  const Val last = live_.back();
  live_[live_at_[v]] = last;
  live_at_[last] = live_at_[v];
  live_.pop_back();
  live_at_[v] = kNone;
}

void Allocator::clear_state() {
  for (const Val v : live_) {
    reg_[v] = -1;
    saved_[v] = 0;
    if (home_[v] != kNone && holder_[home_[v]] == v) holder_[home_[v]] = kNone;
    home_[v] = kNone;
    live_at_[v] = kNone;
  }
  live_.clear();
  regs_[0].fill(kNone);
  regs_[1].fill(kNone);
}

Place Allocator::memory_of(Val v) const {
  const Value& value = f_.values[v];
  if (value.constant) return {Place::kConstant, value.floating, false, 0, value.bits};
  if (saved_[v] != 0) return {Place::kSpill, value.floating, false, slot_[v], 0};
  if (home_[v] != kNone) return {Place::kHome, value.floating, clean_[v] != 0, home_[v], 0};
  return {};
}

Place Allocator::place_of(Val v) const { return reg_[v] >= 0 ? in_register(v) : memory_of(v); }

Place Allocator::place_of(const Held& held) const {
  const Value& value = f_.values[held.v];
  if (held.reg >= 0) {
    return {Place::kRegister, value.floating, false, static_cast<uint32_t>(held.reg), 0};
  }
  if (value.constant) return {Place::kConstant, value.floating, false, 0, value.bits};
  if (held.saved) return {Place::kSpill, value.floating, false, held.slot, 0};
  if (held.home != kNone) return {Place::kHome, value.floating, held.clean, held.home, 0};
  return {};
}

uint32_t Allocator::spill_slot(Val v) {
  if (slot_[v] != kNone) return slot_[v];
  if (free_slots_.empty()) {
    slot_[v] = out_.spill_slots++;
  } else {
    slot_[v] = free_slots_.back();
    free_slots_.pop_back();
  }
  return slot_[v];
}

void Allocator::put(Val v, uint32_t reg) {
  free_register(v);
  regs_[floating(v)][reg] = v;
  reg_[v] = static_cast<int8_t>(reg);
  add_live(v);
}

void Allocator::free_register(Val v) {
  if (reg_[v] < 0) return;
  regs_[floating(v)][static_cast<size_t>(reg_[v])] = kNone;
  reg_[v] = -1;
}

void Allocator::move(Place to, Place from, uint8_t width) {
  if (from.kind == Place::kNowhere) return fail("a value is nowhere");
  Step step;
  step.move = {to, from, width};
  steps_->push_back(step);
}

void Allocator::evict(bool floats, uint32_t reg) {
  const Val v = regs_[floats][reg];
  if (v == kNone) return;
  if (memory_of(v).kind == Place::kNowhere && next_use(v, position_) != kNone) {
    const Place slot{Place::kSpill, floats, false, spill_slot(v), 0};
    move(slot, in_register(v), 8);
    saved_[v] = 1;
  }
  free_register(v);
}

// A free register, else that of the value whose next use is farthest.
uint32_t Allocator::take_register(bool floats, uint32_t locked, int hint) {
  std::array<Val, kMostRegisters>& regs = regs_[floats];
  const uint32_t count = count_[floats];
  if (random_ != 0) {
    random_ = random_ * 6364136223846793005u + 1442695040888963407u;
    const auto start = static_cast<uint32_t>(random_ >> 33) % count;
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t r = (start + i) % count;
      if (locked >> r & 1) continue;
      evict(floats, r);
      return r;
    }
    fail("no register is left");
    return 0;
  }
  if (hint >= 0 && regs[static_cast<size_t>(hint)] == kNone && !(locked >> hint & 1)) {
    return static_cast<uint32_t>(hint);
  }
  uint32_t best = kNone;
  uint32_t best_use = 0;
  for (uint32_t r = 0; r < count; ++r) {
    if (locked >> r & 1) continue;
    if (regs[r] == kNone) return r;
    uint32_t use = next_use(regs[r], position_);
    // What memory has already costs no store.
    if (use != kNone && memory_of(regs[r]).kind != Place::kNowhere) use += 8;
    if (best == kNone || use > best_use) {
      best = r;
      best_use = use;
    }
  }
  if (best == kNone) {
    fail("no register is left");
    return 0;
  }
  evict(floats, best);
  return best;
}

uint32_t Allocator::ensure(Val v, uint32_t locked) {
  if (reg_[v] >= 0) return static_cast<uint32_t>(reg_[v]);
  const Place from = memory_of(v);
  const uint32_t reg = take_register(floating(v), locked);
  move({Place::kRegister, floating(v), false, reg, 0}, from, f_.values[v].width);
  put(v, reg);
  return reg;
}

}  // namespace vm::native
