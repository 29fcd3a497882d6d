#include "vm/native/allocate.h"

#include <algorithm>

#include "vm/native/allocator.h"

namespace vm::native {
base::Result<Allocated> allocate(const Function& function, const Target& target,
                                 const AllocatorOptions& options) {
  return Allocator(function, target, options).run();
}

Allocator::Allocator(const Function& function, const Target& target,
                     const AllocatorOptions& options)
    : f_(function), t_(target), uses_(function, target), random_(options.spill_seed) {
  count_[0] = options.integers != 0 ? std::min(options.integers, target.integers) : target.integers;
  count_[1] = options.floats != 0 ? std::min(options.floats, target.floats) : target.floats;
  const size_t values = f_.values.size();
  reg_.assign(values, -1);
  saved_.assign(values, 0);
  clean_.assign(values, 0);
  slot_.assign(values, kNone);
  home_.assign(values, kNone);
  live_at_.assign(values, kNone);
  hint_.assign(values, kNone);
  parameter_.assign(values, -1);
  live_out_.assign(values, 0);
  stamp_of_.assign(values, 0);
  stamp_index_.assign(values, 0);
  holder_.assign(f_.variables.size(), kNone);
  regs_[0].fill(kNone);
  regs_[1].fill(kNone);
  out_.blocks.resize(f_.blocks.size());
  out_.exits.resize(f_.exits.size());
  first_pred_.assign(f_.blocks.size() + 1, 0);
  users_.assign(f_.blocks.size(), 0);
  ends_.resize(f_.blocks.size());
  heads_.resize(f_.blocks.size());
  for (Block b = 0; b < f_.blocks.size(); ++b) {
    const End& end = f_.blocks[b].end;
    if (end.kind == EndKind::kLoop) {
      const std::vector<Val>& params = f_.blocks[end.target[0]].params;
      for (size_t i = 0; i < params.size(); ++i) hint_[end.args[0][i]] = params[i];
      continue;
    }
    for (const Block to : end.target) {
      if (to == kNone) continue;
      ++first_pred_[to + 1];
      ++users_[b];
    }
  }
  for (Block b = 0; b < f_.blocks.size(); ++b) first_pred_[b + 1] += first_pred_[b];
  preds_.resize(first_pred_.back());
  std::vector<uint32_t> fill(first_pred_.begin(), first_pred_.end() - 1);
  for (Block b = 0; b < f_.blocks.size(); ++b) {
    const End& end = f_.blocks[b].end;
    if (end.kind == EndKind::kLoop) continue;
    for (uint32_t i = 0; i < 2; ++i) {
      if (end.target[i] != kNone) preds_[fill[end.target[i]]++] = {b, i};
    }
  }
}

base::Result<Allocated> Allocator::run() {
  for (Block b = 0; b < f_.blocks.size() && why_ == nullptr; ++b) {
    steps_ = &out_.blocks[b].steps;
    position_ = uses_.begin_of(b);
    find_live_out(b);
    steps_->reserve(f_.blocks[b].nodes.size());
    begin(b);
    for (const uint32_t n : f_.blocks[b].nodes) {
      ++position_;
      node(n);
    }
    position_ = uses_.end_of(b);
    end(b);
  }
  if (why_ != nullptr) return base::Error{base::Refusal::kTooLarge, why_};
  expect_places(f_, out_);
  return std::move(out_);
}

void Allocator::lose_home(uint32_t variable) {
  const Val v = holder_[variable];
  if (v == kNone) return;
  if (reg_[v] < 0 && saved_[v] == 0 && !is_constant(v) && next_use(v, position_) != kNone) {
    ensure(v, 0);
  }
  holder_[variable] = kNone;
  home_[v] = kNone;
}

// Before memory changes, what only it holds goes into registers.
void Allocator::lose_homes(const Node& n) {
  if (n.kills != kNone) {
    for (const uint32_t variable : f_.kills[n.kills]) lose_home(variable);
  }
  const bool writes = n.op == Op::kStore || n.op == Op::kHelper;
  if (!writes || n.variable == kNone) return;
  if (holder_[n.variable] != n.in[0]) lose_home(n.variable);
  for (const uint32_t other : f_.overlaps[n.variable]) lose_home(other);
}

void Allocator::take_home(Val v, uint32_t variable, bool clean) {
  if (is_constant(v) || home_[v] != kNone || holder_[variable] != kNone) return;
  // An exit stores the variables that are dirty, whatever their memory held for others.
  const bool dirty_once = f_.variables[variable].slot || f_.variables[variable].deferred;
  if (dirty_once && f_.variables[variable].written) return;
  if (f_.values[v].width != f_.variables[variable].width) return;
  if (floating(v) != f_.variables[variable].floating) return;
  home_[v] = variable;
  clean_[v] = clean ? 1 : 0;
  holder_[variable] = v;
}

void Allocator::record_exit(uint32_t exit) {
  if (exit == kNone) return;
  for (const SlotValue& slot : f_.exits[exit].slots) {
    Place place = place_of(slot.value);
    if (place.kind == Place::kNowhere) fail("an exit needs a value that is nowhere");
    out_.exits[exit].push_back(place);
  }
}

void Allocator::clobber(const Demands& demands) {
  for (uint32_t kind = 0; kind < 2; ++kind) {
    for (uint32_t r = 0; r < count_[kind]; ++r) {
      const bool lost = demands.clobbers_all || (kind == 0 && (demands.clobbers >> r & 1) != 0);
      const Val v = regs_[kind][r];
      if (!lost || v == kNone) continue;
      if (v == kCopy) {
        regs_[kind][r] = kNone;
        continue;
      }
      if (next_use(v, position_ + 1) == kNone) continue;  // dies here anyway
      uint32_t to = kNone;
      for (uint32_t k = 0; k < count_[kind] && to == kNone && !demands.clobbers_all; ++k) {
        const bool fixed =
            (demands.clobbers >> k & 1) != 0 || demands.result == static_cast<int>(k);
        if (regs_[kind][k] == kNone && !fixed) to = k;
      }
      if (to != kNone) {
        move({Place::kRegister, kind == 1, false, to, 0}, in_register(v), 8);
        put(v, to);
      } else {
        evict(kind == 1, r);
      }
    }
  }
}

void Allocator::result(const Node& n, const Demands& demands, Step& step) {
  const Val v = n.result;
  const bool floats = floating(v);
  uint32_t locked = 0;
  int share = -1;
  const auto look = [&](const Place& place, uint32_t bit, Val operand_value) {
    if (place.kind != Place::kRegister || place.floating != floats) return;
    const bool shares = (demands.shares >> bit & 1) != 0;
    if (!shares) {
      locked |= 1u << place.number;
      return;
    }
    const bool dies = operand_value == kCopy || next_use(operand_value, position_ + 1) == kNone;
    if (dies && share < 0) share = static_cast<int>(place.number);
  };
  for (uint32_t i = 0; i < 4; ++i) {
    if (n.in[i] != kNone) look(step.in[i], i, n.in[i]);
  }
  if (n.mem.index != kNone) look(step.index, 4, n.mem.index);
  if (n.mem.pointer != kNone) look(step.pointer, 5, n.mem.pointer);
  if (share >= 0 && (locked >> share & 1) != 0) share = -1;
  uint32_t reg;
  if (demands.result >= 0) {
    reg = static_cast<uint32_t>(demands.result);
    const Val there = regs_[floats][reg];
    if (there == kCopy) {
      regs_[floats][reg] = kNone;
    } else if (there != kNone) {
      if (next_use(there, position_ + 1) != kNone) {
        evict(floats, reg);
      } else {
        free_register(there);
      }
    }
  } else {
    const int hint = hint_[v] == kNone ? -1 : parameter_[hint_[v]];
    const bool hinted =
        hint >= 0 && (locked >> hint & 1) == 0 && regs_[floats][static_cast<size_t>(hint)] == kNone;
    if (share >= 0 && !hinted) {
      reg = static_cast<uint32_t>(share);
      const Val there = regs_[floats][reg];
      if (there != kNone) free_register(there);
    } else {
      reg = take_register(floats, locked, hint);
    }
  }
  put(v, reg);
  saved_[v] = 0;
  step.result = {Place::kRegister, floats, false, reg, 0};
}

// A variable is loaded when something wants it in a register, if ever.
bool Allocator::stays_in_memory(const Node& n) {
  const Val v = n.result;
  if (next_use(v, position_ + 1) == kNone) return true;
  take_home(v, n.variable, !n.boolean);
  if (home_[v] == kNone) return false;
  add_live(v);
  return true;
}

void Allocator::node(uint32_t number) {
  const Node& n = f_.nodes[number];
  const Demands demands = t_.demands(f_, n);
  Step step;
  step.node = number;
  if (n.op == Op::kLoad && n.variable != kNone && stays_in_memory(n)) return;
  lose_homes(n);
  if (n.op == Op::kNative) {
    call_operands(n, demands, step);
  } else {
    operands(n, demands, step);
    record_exit(n.exit);
    if (demands.clobbers != 0 || demands.clobbers_all) clobber(demands);
  }
  if (n.op == Op::kCall) {
    for (const Val v : live_) {
      if (!is_constant(v) && next_use(v, position_ + 1) != kNone)
        fail("a value lives across a call");
    }
  }
  if (n.result != kNone) result(n, demands, step);
  steps_->push_back(step);
  // Whatever dies here.
  const auto done = [&](Val v) {
    if (v != kNone && next_use(v, position_ + 1) == kNone) remove_live(v);
  };
  for (const Val v : n.in) done(v);
  done(n.mem.index);
  done(n.mem.pointer);
  if (n.exit != kNone) {
    for (const SlotValue& slot : f_.exits[n.exit].slots) done(slot.value);
  }
  if (demands.clobbers_all) {
    for (uint32_t kind = 0; kind < 2; ++kind) {
      for (uint32_t r = 0; r < count_[kind]; ++r) {
        const Val v = regs_[kind][r];
        if (v != kNone && v != kCopy) free_register(v);
        regs_[kind][r] = kNone;
      }
    }
  }
  for (Val& v : regs_[0]) {
    if (v == kCopy) v = kNone;
  }
  if (n.op == Op::kStore && n.variable != kNone && live_at_[n.in[0]] != kNone) {
    take_home(n.in[0], n.variable, true);
  }
  if (n.result != kNone && next_use(n.result, position_ + 1) == kNone) remove_live(n.result);
}

void Allocator::end(Block block) {
  const End& e = f_.blocks[block].end;
  // What the ways from here want, asked first: questions after this position forget it.
  wanted_.clear();
  for (const Val v : live_) {
    if (next_use(v, position_) != kNone) wanted_.push_back(v);
  }
  uint32_t locked[2] = {0, 0};
  for (uint32_t i = 0; i < 2; ++i) {
    if (e.in[i] != kNone && reg_[e.in[i]] >= 0) locked[floating(e.in[i])] |= 1u << reg_[e.in[i]];
  }
  for (uint32_t i = 0; i < 2; ++i) {
    const Val v = e.in[i];
    if (v == kNone) continue;
    if (is_constant(v) && t_.end_takes_constant(f_, e, i)) {
      out_.blocks[block].in[i] = memory_of(v);
      continue;
    }
    const Place memory = memory_of(v);
    const bool in_memory = reg_[v] < 0 && i == 0 && next_use(v, position_ + 1) == kNone &&
                           (memory.kind == Place::kHome || memory.kind == Place::kSpill);
    if (in_memory && t_.end_takes_memory(f_, e)) {
      out_.blocks[block].in[i] = memory;
      continue;
    }
    ensure(v, locked[floating(v)]);
    locked[floating(v)] |= 1u << reg_[v];
    out_.blocks[block].in[i] = in_register(v);
  }
  record_exit(e.exit);
  Snapshot now;
  if (e.kind == EndKind::kLoop || users_[block] != 0) now.reserve(wanted_.size());
  for (const Val v : wanted_) {
    now.push_back({v, reg_[v], saved_[v] != 0, clean_[v] != 0, home_[v], slot_[v]});
  }
  if (e.kind == EndKind::kLoop) {
    out_.blocks[block].edges[0] = edge(block, 0, now, heads_[e.target[0]]);
  }
  if (users_[block] != 0) ends_[block] = std::move(now);
  was_ = live_;
  for (const Val v : was_) {
    if (next_use(v, position_ + 1) == kNone) remove_live(v);
  }
}

}  // namespace vm::native
