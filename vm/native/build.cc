#include "vm/native/build.h"

#include <algorithm>

namespace vm::native {
namespace {

constexpr size_t kMostHoisted = 24;     // loads in front of one loop
constexpr size_t kManyVariables = 512;  // of one POU
constexpr uint32_t kLately = 1024;      // units

bool has(const std::vector<uint32_t>& sorted, uint32_t v) {
  return std::binary_search(sorted.begin(), sorted.end(), v);
}

}  // namespace

Builder::Builder(const Facts& facts) : facts_(facts) {
  f_.variables = facts.variables();
  const size_t units = facts.blocks().empty() ? 0 : facts.blocks().back().behind;
  f_.nodes.reserve(units);
  f_.values.reserve(units);
  f_.overlaps = facts.overlaps();
  f_.loops = facts.loops();
  f_.blocks.resize(facts.blocks().size());
  ends_.resize(f_.blocks.size());
  users_.resize(f_.blocks.size(), 0);
  named_at_.resize(f_.variables.size(), 0);
  parameters_.resize(f_.blocks.size());
  for (Block b = 0; b < f_.blocks.size(); ++b) {
    f_.blocks[b].unit = facts.blocks()[b].first;
    f_.blocks[b].loop = facts.loop_of(b);
  }
  for (const Loop& loop : f_.loops) f_.blocks[loop.head].head = true;
}

void Builder::find_preds() {
  first_pred_.assign(f_.blocks.size() + 1, 0);
  const auto each_way = [&](auto visit) {
    for (Block b = 0; b < f_.blocks.size(); ++b) {
      Block next[2];
      uint32_t count = 0;
      facts_.successors(b, next, count);
      for (uint32_t i = 0; i < count; ++i) {
        if (next[i] > b) visit(next[i], Pred{b, i});
      }
    }
  };
  each_way([&](Block to, Pred pred) {
    ++first_pred_[to + 1];
    ++users_[pred.block];
  });
  for (Block b = 0; b < f_.blocks.size(); ++b) first_pred_[b + 1] += first_pred_[b];
  preds_.resize(first_pred_.back());
  std::vector<uint32_t> fill(first_pred_.begin(), first_pred_.end() - 1);
  each_way([&](Block to, Pred pred) { preds_[fill[to]++] = pred; });
}

Function Builder::run() {
  find_preds();
  for (Block b = 0; b < f_.blocks.size(); ++b) {
    begin(b);
    const UnitRange range = facts_.blocks()[b];
    ended_ = false;
    f_.blocks[b].nodes.reserve(f_.blocks[b].nodes.size() + range.behind - range.first);
    for (uint32_t i = range.first; i < range.behind && !ended_; i = facts_.next(i)) unit(i);
    if (!ended_) end_with_jump(b + 1);
    finish(b);
  }
  simplify(f_);
  return std::move(f_);
}

void Builder::begin(Block block) {
  block_ = block;
  const size_t count = f_.variables.size();
  const std::span<const Pred> preds = this->preds(block);
  const bool head = f_.blocks[block].head;
  if (block == 0 && !head) {
    now_.value.assign(count, kNone);
    now_.dirty.assign(count, 0);
    forget_everything();
    return;
  }
  if (preds.size() == 1 && !head) {
    // Values of the only way here hold on.
    const Block pred = preds[0].block;
    if (pred + 1 != block) forget_everything();
    if (users_[pred] == 1) {
      now_ = std::move(ends_[pred]);
    } else {
      now_ = ends_[pred];
    }
    release(pred);
    store_behind(f_.blocks[pred].loop);
    return;
  }
  forget_everything();
  if (head) {
    now_.value.assign(count, kNone);  // the entry may be a head: nothing comes before it
    now_.dirty.assign(count, 0);
    for (uint32_t l = 0; l < f_.loops.size(); ++l) {
      if (f_.loops[l].head == block) enter_loop(block, l);
    }
  } else {
    now_.value.assign(count, kNone);
    now_.dirty.assign(count, 0);
    merge(block);
    for (const Pred& pred : preds) store_behind(f_.blocks[pred.block].loop);
  }
  for (const Pred& pred : preds) release(pred.block);
}

void Builder::release(Block pred) {
  if (--users_[pred] == 0) ends_[pred] = State();
}

// The value of a variable where `pred` ends, loaded there if need be.
Val Builder::at_end_of(Block pred, uint32_t variable) {
  Val& value = ends_[pred].value[variable];
  if (value != kNone) return value;
  const Variable& v = f_.variables[variable];
  Node node;
  node.op = Op::kLoad;
  node.width = v.width;
  node.boolean = v.boolean;
  node.mem = {v.base, 1, kNone, static_cast<int64_t>(v.offset)};
  node.variable = variable;
  node.result = static_cast<Val>(f_.values.size());
  f_.values.push_back(
      {v.floating, v.width, false, 0, static_cast<uint32_t>(f_.nodes.size()), pred});
  epoch_of_.push_back(0);
  f_.blocks[pred].nodes.push_back(static_cast<uint32_t>(f_.nodes.size()));
  f_.nodes.push_back(node);
  return value = node.result;
}

void Builder::make_parameter(Block block, uint32_t variable) {
  const Variable& v = f_.variables[variable];
  const Val param = static_cast<Val>(f_.values.size());
  f_.values.push_back({v.floating, v.width, false, 0, kNone, block});
  epoch_of_.push_back(0);
  f_.blocks[block].params.push_back(param);
  parameters_[block].push_back(variable);
  for (const Pred& pred : preds(block)) {
    f_.blocks[pred.block].end.args[pred.target].push_back(at_end_of(pred.block, variable));
  }
  now_.value[variable] = param;
  now_.dirty[variable] = f_.variables[variable].slot ? 1 : 0;
}

// The one value that all ways bring; kNone: none or several.
Val Builder::merged(Block block, uint32_t variable) {
  Val one = kNone;
  bool first = true;
  for (const Pred& pred : preds(block)) {
    const Val value = ends_[pred.block].value[variable];
    if (first) one = value;
    if (value != one) return kNone;
    first = false;
  }
  return one;
}

// Of many variables only those that were named lately live on where ways meet, or the work at each
// such block would grow with all of them.
bool Builder::is_long_ago(uint32_t variable) const {
  if (f_.variables.size() < kManyVariables) return false;
  return named_at_[variable] + kLately < facts_.blocks()[block_].first;
}

void Builder::merge(Block block) {
  for (uint32_t v = 0; v < f_.variables.size(); ++v) {
    bool all = true;
    bool any = false;
    uint8_t dirty = 0;
    for (const Pred& pred : preds(block)) {
      const bool has_value = ends_[pred.block].value[v] != kNone;
      all &= has_value;
      any |= has_value;
      dirty |= ends_[pred.block].dirty[v];
    }
    // What is dirty and no slot must get to memory, whether something reads it or not.
    const bool wanted = facts_.live_in(block, v) || (dirty != 0 && !f_.variables[v].slot);
    if (!wanted || !any) continue;
    if (!all && dirty == 0) continue;  // memory is right on every way
    if (dirty == 0 && is_long_ago(v)) continue;
    const Val one = merged(block, v);
    if (one == kNone) {
      make_parameter(block, v);
      const bool right = dirty == 0 && !f_.variables[v].slot && !f_.variables[v].deferred;
      if (right) f_.values[now_.value[v]].home = v;
      now_.dirty[v] |= dirty;
      continue;
    }
    now_.value[v] = one;
    now_.dirty[v] = dirty;
  }
}

// Where a loop begins, what it changes becomes parameters; what it only reads is loaded before.
void Builder::enter_loop(Block block, uint32_t loop) {
  const Loop& l = f_.loops[loop];
  const bool calls = facts_.has_call(loop);
  const std::vector<uint32_t>& reads = facts_.reads(loop);
  size_t hoisted = 0;
  for (uint32_t v = 0; v < f_.variables.size(); ++v) {
    if (!facts_.live_in(block, v)) continue;
    const bool slot = f_.variables[v].slot;
    if (calls) {
      // Calls want every slot in memory, so it is there from the start.
      for (const Pred& pred : preds(block)) {
        State& end = ends_[pred.block];
        if (!slot || end.dirty[v] == 0) continue;
        Node store;
        store.op = Op::kStore;
        store.width = f_.variables[v].width;
        store.in[0] = end.value[v];
        store.mem = {MemBase::kFrame, 1, kNone, static_cast<int64_t>(f_.variables[v].offset)};
        store.variable = v;
        f_.blocks[pred.block].nodes.push_back(static_cast<uint32_t>(f_.nodes.size()));
        f_.nodes.push_back(store);
        end.dirty[v] = 0;
      }
      continue;
    }
    const bool modified = has(l.modified, v);
    const bool read = has(reads, v);
    if (preds(block).empty()) continue;
    if (slot) {
      if (!read && !modified && merged(block, v) == kNone) {
        bool dirty = false;
        for (const Pred& pred : preds(block)) dirty |= ends_[pred.block].dirty[v] != 0;
        if (!dirty) continue;
      }
    } else {
      // What only a loop around this one reads lives on through it.
      if (!read && (modified || merged(block, v) == kNone)) continue;
      // Something that no field names may change it.
      if (modified && facts_.killed_in(loop, v)) continue;
      bool known = true;
      for (const Pred& pred : preds(block)) known &= ends_[pred.block].value[v] != kNone;
      if (!known && ++hoisted > kMostHoisted) continue;
    }
    if (modified) {
      make_parameter(block, v);
      if (std::ranges::binary_search(facts_.deferred(loop), v)) now_.dirty[v] = 1;
      continue;
    }
    uint8_t dirty = 0;
    for (const Pred& pred : preds(block)) {
      at_end_of(pred.block, v);
      dirty |= ends_[pred.block].dirty[v];
    }
    const Val one = merged(block, v);
    if (one == kNone) {
      make_parameter(block, v);
    } else {
      now_.value[v] = one;
      now_.dirty[v] = dirty;
    }
  }
  forget_shared();
  // How all of that is found again when the interpreter stopped here.
  // Of two variables with one value the wider one has all of it.
  std::unordered_map<Val, uint8_t> widest;
  for (uint32_t v = 0; v < f_.variables.size(); ++v) {
    if (now_.value[v] == kNone) continue;
    uint8_t& width = widest[now_.value[v]];
    width = std::max(width, f_.variables[v].width);
  }
  for (uint32_t v = 0; v < f_.variables.size(); ++v) {
    if (now_.value[v] == kNone) continue;
    if (f_.variables[v].width == widest[now_.value[v]]) {
      f_.blocks[block].reloads.push_back({v, now_.value[v]});
    }
    if (now_.dirty[v] == 0 || !f_.variables[v].slot) continue;
    f_.blocks[block].dirty.push_back(
        {f_.variables[v].offset, f_.variables[v].width, now_.value[v]});
  }
}

// While an execution is interrupted, another task may write a variable that is not the frame's:
// what else had its value keeps it.
void Builder::forget_shared() {
  std::unordered_map<Val, uint32_t> holders;
  for (const Val v : now_.value) {
    if (v != kNone && !is_constant(v)) ++holders[v];
  }
  std::vector<uint32_t> parameters = parameters_[block_];
  std::sort(parameters.begin(), parameters.end());
  for (uint32_t v = 0; v < f_.variables.size(); ++v) {
    Val& value = now_.value[v];
    if (value == kNone || f_.variables[v].slot) continue;
    const bool parameter = has(parameters, v);
    if (is_constant(value) || (!parameter && holders[value] > 1)) value = kNone;
  }
}

// After a loop its variables are in memory again.
void Builder::store_behind(uint32_t loop) {
  if (loop == kNone || f_.blocks[block_].loop == loop) return;
  for (const uint32_t v : facts_.deferred(loop)) store_slot(v);
}

// The next loop begins with everything in memory.
void Builder::store_before_loop(Block block) {
  Block next[2];
  uint32_t count = 0;
  facts_.successors(block, next, count);
  for (uint32_t i = 0; i < count; ++i) {
    if (next[i] > block && f_.blocks[next[i]].head) store_deferred();
  }
}

void Builder::finish(Block block) {
  store_before_loop(block);
  if (users_[block] != 0) ends_[block] = std::move(now_);  // what begins next has its own
}

void Builder::end_with_jump(Block target) {
  End& end = f_.blocks[block_].end;
  end.kind = EndKind::kJump;
  end.target[0] = target;
  ended_ = true;
}

// The values that the head's parameters take in the next turn, and what an interruption stores.
void Builder::pass_back(Block block, Block head) {
  Exit exit;
  exit.unit = unit_;
  exit.fuel = true;
  // Back to a loop around this one: that begins with everything in memory.
  if (f_.blocks[block].loop != facts_.loop_of(head)) store_deferred();
  std::vector<Val> args;
  for (const uint32_t v : parameters_[head]) args.push_back(read(v));
  // What the loop only writes has no parameter.
  for (const uint32_t v : deferred()) {
    if (std::ranges::find(parameters_[head], v) == parameters_[head].end()) store_slot(v);
  }
  const bool in_memory = preds(head).empty() || facts_.has_call(facts_.loop_of(head));
  if (in_memory) {
    for (uint32_t v = 0; v < f_.variables.size(); ++v) {
      if (now_.dirty[v] != 0 && facts_.live_in(head, v)) store_slot(v);
    }
  }
  for (uint32_t v = 0; v < f_.variables.size(); ++v) {
    const Variable& variable = f_.variables[v];
    if (now_.dirty[v] == 0 || (variable.slot && !facts_.live_in(head, v))) continue;
    exit.slots.push_back({variable.offset, variable.width, now_.value[v], variable.base});
  }
  End& end = f_.blocks[block].end;
  end.kind = EndKind::kLoop;
  end.target[0] = head;
  end.args[0] = std::move(args);
  end.exit = static_cast<uint32_t>(f_.exits.size());
  f_.exits.push_back(std::move(exit));
  ended_ = true;
}

}  // namespace vm::native
