// Operands to where an operation wants them.
#include "vm/native/allocator.h"

namespace vm::native {
namespace {

constexpr uint32_t kFar = 24;  // positions: a value this far from its next use may stay in memory

}  // namespace

Place Allocator::fixed_operand(Val v, uint32_t reg, const Demands& demands) {
  std::array<Val, kMostRegisters>& regs = regs_[0];
  const Place place{Place::kRegister, false, false, reg, 0};
  const bool lives_on = !is_constant(v) && next_use(v, position_ + 1) != kNone;
  const bool destroyed =
      (demands.clobbers >> reg & 1) != 0 || demands.result == static_cast<int>(reg);
  if (reg_[v] == static_cast<int8_t>(reg) && !(lives_on && destroyed)) return place;
  if (regs[reg] != kNone && regs[reg] != v) {
    // Whoever is there moves on.
    const Val other = regs[reg];
    const bool wanted = next_use(other, position_) != kNone;
    uint32_t to = kNone;
    for (uint32_t r = 0; r < count_[0] && to == kNone; ++r) {
      const bool fixed = (demands.clobbers >> r & 1) != 0 || demands.wants(r);
      if (regs[r] == kNone && !fixed) to = r;
    }
    if (wanted && to != kNone) {
      move({Place::kRegister, false, false, to, 0}, place, 8);
      put(other, to);
    } else {
      evict(false, reg);
    }
  }
  if (lives_on && destroyed) {
    if (reg_[v] == static_cast<int8_t>(reg)) {
      // The value itself moves away, the copy stays.
      uint32_t to = kNone;
      for (uint32_t r = 0; r < count_[0] && to == kNone; ++r) {
        if (regs[r] == kNone && !(demands.clobbers >> r & 1) && !demands.wants(r)) to = r;
      }
      if (to != kNone) {
        move({Place::kRegister, false, false, to, 0}, place, 8);
        put(v, to);
      } else {
        evict(false, reg);
      }
    } else {
      move(place, place_of(v), f_.values[v].width);
    }
    regs[reg] = kCopy;
    return place;
  }
  move(place, place_of(v), f_.values[v].width);
  put(v, reg);
  return place;
}

Place Allocator::operand(const Node& n, uint32_t i, uint32_t forbidden) {
  const Val v = n.in[i];
  if (reg_[v] < 0 && t_.takes_memory(f_, n, i)) {
    const Place memory = memory_of(v);
    const bool whole =
        memory.kind == Place::kSpill ||
        (memory.kind == Place::kHome && (!f_.variables[memory.number].boolean || memory.clean ||
                                         n.op == Op::kAndNot || n.op == Op::kOrNot));
    const uint32_t next = next_use(v, position_ + 1);
    if (whole && (next == kNone || next > position_ + kFar)) return memory;
  }
  const bool floats = floating(v);
  if (reg_[v] >= 0 && !floats && (forbidden >> reg_[v] & 1) != 0) {
    const Place from = in_register(v);
    const uint32_t reg = take_register(false, forbidden);
    move({Place::kRegister, false, false, reg, 0}, from, 8);
    put(v, reg);
  }
  ensure(v, forbidden);
  return in_register(v);
}

// All at once into their registers; what lives on leaves those that the call loses, which are free
// then.
void Allocator::call_operands(const Node& n, const Demands& demands, Step& step) {
  const uint32_t lost[2] = {demands.clobbers, demands.clobbers_floats};
  for (uint32_t kind = 0; kind < 2; ++kind) {
    for (uint32_t r = 0; r < count_[kind]; ++r) {
      const Val v = regs_[kind][r];
      if ((lost[kind] >> r & 1) == 0 || v == kNone || next_use(v, position_ + 1) == kNone) continue;
      uint32_t to = kNone;
      for (uint32_t k = 0; k < count_[kind] && to == kNone && random_ == 0; ++k) {
        if (regs_[kind][k] == kNone && (lost[kind] >> k & 1) == 0) to = k;
      }
      if (to != kNone && !is_constant(v)) {
        move({Place::kRegister, kind == 1, false, to, 0}, in_register(v), 8);
        put(v, to);
      } else if (memory_of(v).kind == Place::kNowhere) {
        move({Place::kSpill, kind == 1, false, spill_slot(v), 0}, in_register(v), 8);
        saved_[v] = 1;
      }
    }
  }
  std::vector<Move> moves;
  for (uint32_t i = 0; i < 4; ++i) {
    if (n.in[i] == kNone) continue;
    const Place from = place_of(n.in[i]);
    if (from.kind == Place::kNowhere) return fail("an argument is nowhere");
    step.in[i] = {Place::kRegister, false, false, static_cast<uint32_t>(demands.in[i]), 0};
    moves.push_back({step.in[i], from, f_.values[n.in[i]].width});
  }
  for (const Move& m : in_sequence(std::move(moves), kAside)) {
    Step made;
    made.move = m;
    steps_->push_back(made);
  }
  for (uint32_t kind = 0; kind < 2; ++kind) {
    for (uint32_t r = 0; r < count_[kind]; ++r) {
      if ((lost[kind] >> r & 1) != 0 && regs_[kind][r] != kNone) free_register(regs_[kind][r]);
    }
  }
}

void Allocator::operands(const Node& n, const Demands& demands, Step& step) {
  uint32_t locked[2] = {demands.clobbers, 0};
  bool has_fixed = false;
  for (uint32_t i = 0; i < 4; ++i) {
    if (demands.in[i] < 0 || n.in[i] == kNone) continue;
    has_fixed = true;
    step.in[i] = fixed_operand(n.in[i], static_cast<uint32_t>(demands.in[i]), demands);
    locked[0] |= 1u << demands.in[i];
  }
  if (!has_fixed && !demands.clobbers_all) locked[0] = 0;
  // What is in registers already must not be pushed out by the others.
  uint32_t held[2] = {0, 0};
  const auto hold = [&](Val v) {
    if (v != kNone && reg_[v] >= 0) held[floating(v)] |= 1u << reg_[v];
  };
  for (const Val v : n.in) hold(v);
  if (n.mem.index != kNone) hold(n.mem.index);
  if (n.mem.pointer != kNone) hold(n.mem.pointer);
  for (uint32_t i = 0; i < 4; ++i) {
    const Val v = n.in[i];
    if (v == kNone || demands.in[i] >= 0) continue;
    bool same_as_fixed = false;
    for (uint32_t k = 0; k < 4; ++k) {
      if (demands.in[k] < 0 || n.in[k] != v) continue;
      step.in[i] = step.in[k];
      same_as_fixed = true;
    }
    if (same_as_fixed) continue;
    if (is_constant(v) && t_.takes_constant(f_, n, i)) {
      step.in[i] = memory_of(v);
      continue;
    }
    const bool floats = floating(v);
    const bool misplaced = !floats && reg_[v] >= 0 && (locked[0] >> reg_[v] & 1) != 0;
    if (reg_[v] >= 0 && !misplaced) {
      step.in[i] = in_register(v);
      continue;
    }
    if (misplaced) {
      step.in[i] = operand(n, i, locked[0] | held[0]);
    } else {
      const uint32_t keep = locked[floats] | held[floats];
      if (floats) {
        // operand() locks integers; floats are locked here
        const Place memory = memory_of(v);
        const uint32_t next = next_use(v, position_ + 1);
        if (t_.takes_memory(f_, n, i) &&
            (memory.kind == Place::kSpill || memory.kind == Place::kHome) &&
            (next == kNone || next > position_ + kFar)) {
          step.in[i] = memory;
        } else {
          ensure(v, keep);
          step.in[i] = in_register(v);
        }
      } else {
        step.in[i] = operand(n, i, keep);
      }
    }
    hold(v);
  }
  const auto part_of_address = [&](Val v, Place& place) {
    if (v == kNone) return;
    if (reg_[v] >= 0 && (locked[0] >> reg_[v] & 1) != 0) {
      const Place from = in_register(v);
      const uint32_t reg = take_register(false, locked[0] | held[0]);
      move({Place::kRegister, false, false, reg, 0}, from, 8);
      put(v, reg);
    }
    ensure(v, locked[0] | held[0]);
    hold(v);
    place = in_register(v);
  };
  part_of_address(n.mem.index, step.index);
  part_of_address(n.mem.pointer, step.pointer);
}

}  // namespace vm::native
