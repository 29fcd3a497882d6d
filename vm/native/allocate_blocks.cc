// Where ways meet: what a block finds in registers, and the moves that bring it there.
#include <algorithm>

#include "vm/native/allocator.h"

namespace vm::native {
namespace {

constexpr uint32_t kFreeInLoops = 2;  // registers for what the body computes
constexpr uint32_t kFarAway = 24;     // a use: what memory holds stays there until then
}  // namespace

bool Allocator::lives_into(Block block, Val v, const std::vector<Val>& params) const {
  if (is_constant(v)) return true;
  const std::span<const Val> live = uses_.live_in(block);
  return std::binary_search(live.begin(), live.end(), v) ||
         std::find(params.begin(), params.end(), v) != params.end();
}

void Allocator::restore(const Snapshot& snapshot, Block block) {
  clear_state();
  const std::vector<Val>& params = f_.blocks[block].params;
  for (const Held& held : snapshot) {
    const Val v = held.v;
    if (next_use(v, position_) == kNone || !lives_into(block, v, params)) continue;
    add_live(v);
    if (held.reg >= 0) put(v, static_cast<uint32_t>(held.reg));
    saved_[v] = held.saved ? 1 : 0;
    clean_[v] = held.clean ? 1 : 0;
    home_[v] = kNone;
    if (held.home != kNone && holder_[held.home] == kNone) {
      home_[v] = held.home;
      holder_[held.home] = v;
    }
  }
}

void Allocator::begin(Block block) {
  const std::span<const Pred> preds = this->preds(block);
  const bool head = f_.blocks[block].head;
  if (preds.size() == 1 && !head && f_.blocks[block].params.empty() && !f_.blocks[block].resumes) {
    restore(ends_[preds[0].block], block);
  } else if (!preds.empty() || head || f_.blocks[block].resumes) {
    meet(block);
  } else {
    clear_state();
  }
  for (const Pred& pred : preds) {
    if (--users_[pred.block] == 0) Snapshot().swap(ends_[pred.block]);
  }
}

void Allocator::stamp(const Snapshot& snapshot) {
  ++stamp_;
  stamped_ = &snapshot;
  for (uint32_t i = 0; i < snapshot.size(); ++i) {
    stamp_of_[snapshot[i].v] = stamp_;
    stamp_index_[snapshot[i].v] = i;
  }
}

const Allocator::Held* Allocator::stamped(Val v) const {
  return stamp_of_[v] == stamp_ ? &(*stamped_)[stamp_index_[v]] : nullptr;
}

// Values that every way brings, and the parameters.
void Allocator::meet(Block block) {
  const std::span<const Pred> preds = this->preds(block);
  const BasicBlock& b = f_.blocks[block];
  clear_state();
  Snapshot state;
  if (!preds.empty()) {
    for (const Held& held : ends_[preds.back().block]) {
      if (next_use(held.v, position_) == kNone) continue;
      if (lives_into(block, held.v, {})) state.push_back(held);
    }
    for (size_t i = 0; i + 1 < preds.size(); ++i) {
      stamp(ends_[preds[i].block]);
      std::erase_if(state, [&](Held& held) {
        const Held* const other = stamped(held.v);
        if (other == nullptr) return true;
        held.saved &= other->saved;
        held.clean &= other->clean;
        if (held.home != other->home) held.home = kNone;
        return false;
      });
    }
  }
  if (b.head) {
    choose_for_loop(block, state);
  }
  if (b.resumes) keep_homes_of_reloads(b, state);
  for (Held& held : state) {
    // What is in memory on one way must be so on all.
    const bool has_memory = held.saved || held.home != kNone || is_constant(held.v);
    if (held.reg < 0 && !has_memory) {
      held.slot = spill_slot(held.v);
      held.saved = true;
    }
    if (held.slot == kNone && held.saved) held.slot = slot_[held.v];
  }
  place_parameters(block, state);
  for (const Pred& pred : preds) {
    out_.blocks[pred.block].edges[pred.target] =
        edge(pred.block, pred.target, ends_[pred.block], state);
  }
  if (b.resumes) out_.blocks[block].resume = resume_moves(block, state);
  if (b.head) heads_[block] = state;
  restore(state, block);
}

// An interrupted execution finds a value in the variables that hold it here, and nowhere else.
void Allocator::keep_homes_of_reloads(const BasicBlock& block, Snapshot& state) {
  for (Held& held : state) {
    if (held.home == kNone) continue;
    uint32_t holders = 0;
    bool own = false;
    for (const Reload& reload : block.reloads) {
      if (reload.value != held.v) continue;
      ++holders;
      own |= reload.variable == held.home;
    }
    if (holders != 1 || !own) held.home = kNone;
  }
}

// A loop keeps in registers what its body uses, the nearest first.
void Allocator::choose_for_loop(Block block, Snapshot& state) {
  uint32_t loop = f_.blocks[block].loop;
  while (loop != kNone && f_.loops[loop].head != block) loop = f_.loops[loop].parent;
  if (loop == kNone) return;
  const Loop& l = f_.loops[loop];
  const uint32_t last = uses_.loop_end(loop);
  for (Held& held : state) {
    const bool changes =
        held.home != kNone &&
        (l.kills_all || std::binary_search(l.modified.begin(), l.modified.end(), held.home));
    if (changes) held.home = kNone;
  }
  for (const Val v : uses_.constants()) {
    if (next_use(v, position_) >= last) continue;
    const bool there =
        std::any_of(state.begin(), state.end(), [&](const Held& h) { return h.v == v; });
    if (!there) state.push_back({v, -1, false, false, kNone, kNone});
  }
  std::sort(state.begin(), state.end(), [&](const Held& x, const Held& y) {
    const uint32_t a = next_use(x.v, position_);
    const uint32_t b = next_use(y.v, position_);
    return a != b ? a < b : x.v < y.v;
  });
  // Parameters come first: they change in every turn.
  uint32_t wanted[2] = {0, 0};
  for (const Val p : f_.blocks[block].params) {
    if (next_use(p, position_) < last) ++wanted[floating(p)];
  }
  uint32_t taken[2] = {0, 0};
  for (uint32_t kind = 0; kind < 2; ++kind) {
    taken[kind] = std::min(wanted[kind], count_[kind] - std::min(count_[kind], kFreeInLoops));
  }
  uint32_t used[2] = {0, 0};
  std::vector<Held*> without;
  for (Held& held : state) {
    const bool fl = floating(held.v);
    const bool in_loop = next_use(held.v, position_) < last;
    const uint32_t room = count_[fl] - std::min(count_[fl], kFreeInLoops);
    if (!in_loop || taken[fl] >= room) {
      held.reg = -1;
      continue;
    }
    ++taken[fl];
    if (held.reg >= 0) {
      used[fl] |= 1u << held.reg;
    } else {
      without.push_back(&held);
    }
  }
  for (Held* held : without) {
    const bool fl = floating(held->v);
    for (uint32_t r = 0; r < count_[fl]; ++r) {
      if (used[fl] >> r & 1) continue;
      used[fl] |= 1u << r;
      held->reg = static_cast<int8_t>(r);
      break;
    }
  }
  std::erase_if(state, [&](const Held& h) { return h.reg < 0 && is_constant(h.v); });
}

// The variable whose memory holds a parameter on every way here; kNone: none does.
uint32_t Allocator::home_of_parameter(Val p, const Snapshot& state) const {
  const uint32_t home = f_.values[p].home;
  if (home == kNone) return kNone;
  const bool taken =
      std::any_of(state.begin(), state.end(), [&](const Held& held) { return held.home == home; });
  return taken ? kNone : home;
}

// In the register of an argument that ends here, or in any other.
void Allocator::place_parameters(Block block, Snapshot& state) {
  uint32_t used[2] = {0, 0};
  for (const Held& held : state) {
    if (held.reg >= 0) used[floating(held.v)] |= 1u << held.reg;
  }
  const std::vector<Val>& params = f_.blocks[block].params;
  uint32_t placed[2] = {0, 0};
  for (size_t i = 0; i < params.size(); ++i) {
    const Val p = params[i];
    if (next_use(p, position_) == kNone) continue;
    const bool fl = floating(p);
    const uint32_t room =
        f_.blocks[block].head ? count_[fl] - std::min(count_[fl], kFreeInLoops) : count_[fl];
    const uint32_t home = home_of_parameter(p, state);
    const bool waits = home != kNone && next_use(p, position_) > position_ + kFarAway;
    int reg = -1;
    if (placed[fl] < room && !waits) {
      for (const Pred& pred : preds(block)) {
        const Val arg = f_.blocks[pred.block].end.args[pred.target][i];
        for (const Held& held : ends_[pred.block]) {
          if (held.v != arg || held.reg < 0 || floating(held.v) != fl) continue;
          if ((used[fl] >> held.reg & 1) == 0) reg = held.reg;
        }
        if (reg >= 0) break;
      }
      for (uint32_t r = 0; r < count_[fl] && reg < 0; ++r) {
        if ((used[fl] >> r & 1) == 0) reg = static_cast<int>(r);
      }
    }
    Held held{p, static_cast<int8_t>(reg), false, false, home, kNone};
    held.clean = home != kNone && !f_.variables[home].boolean;
    if (reg >= 0) {
      used[fl] |= 1u << reg;
      ++placed[fl];
    } else if (home == kNone) {
      held.slot = spill_slot(p);
      held.saved = true;
    }
    parameter_[p] = static_cast<int8_t>(reg);
    state.push_back(held);
  }
}

std::vector<Move> Allocator::edge(Block from, uint32_t target, const Snapshot& have,
                                  const Snapshot& want) {
  const Block to = f_.blocks[from].end.target[target];
  const std::vector<Val>& params = f_.blocks[to].params;
  const std::vector<Val>& args = f_.blocks[from].end.args[target];
  stamp(have);
  std::vector<Move> moves;
  moves.reserve(want.size());
  for (const Held& held : want) {
    Val source = held.v;
    bool param = false;
    if (f_.values[held.v].node == kNone && !is_constant(held.v) && f_.values[held.v].block == to) {
      const auto at = std::find(params.begin(), params.end(), held.v);
      if (at != params.end()) {
        source = args[static_cast<size_t>(at - params.begin())];
        param = true;
      }
    }
    Place origin;
    const Held* const there = stamped(source);
    if (is_constant(source) && (there == nullptr || there->reg < 0)) {
      origin = {Place::kConstant, floating(source), false, 0, f_.values[source].bits};
    } else if (there != nullptr) {
      origin = place_of(*there);
    }
    if (origin.kind == Place::kNowhere) {
      fail("a value is nowhere where ways meet");
      return {};
    }
    const uint8_t width = f_.values[source].width;
    if (held.reg >= 0) {
      const Place reg{Place::kRegister, floating(held.v), false, static_cast<uint32_t>(held.reg),
                      0};
      moves.push_back({reg, origin, width});
    }
    const bool stored = !param && there != nullptr && there->saved;
    if (held.saved && !stored && !is_constant(held.v)) {
      moves.push_back({{Place::kSpill, floating(held.v), false, held.slot, 0}, origin, width});
    }
  }
  return in_sequence(std::move(moves), kAside);
}

// The interpreter stopped here and everything is in memory again.
std::vector<Move> Allocator::resume_moves(Block head, const Snapshot& state) {
  std::vector<Move> moves;
  for (const Held& held : state) {
    Place origin;
    if (is_constant(held.v)) {
      origin = {Place::kConstant, floating(held.v), false, 0, f_.values[held.v].bits};
    }
    for (const Reload& reload : f_.blocks[head].reloads) {
      if (reload.value != held.v) continue;
      origin = {Place::kHome, floating(held.v), false, reload.variable, 0};
    }
    if (origin.kind == Place::kNowhere) {
      fail("a loop begins with a value that no variable holds");
      return {};
    }
    const uint8_t width = f_.values[held.v].width;
    if (held.reg >= 0) {
      moves.push_back(
          {{Place::kRegister, floating(held.v), false, static_cast<uint32_t>(held.reg), 0},
           origin,
           width});
    }
    if (held.saved && !is_constant(held.v)) {
      moves.push_back({{Place::kSpill, floating(held.v), false, held.slot, 0}, origin, width});
    }
  }
  return moves;
}

}  // namespace vm::native
