// Handles behind a loop and in its exits; and the question of its head, which is a counter's.
#include <algorithm>

#include "ir/types/handle.h"
#include "vm/native/walk.h"

namespace vm::native {
namespace {

constexpr uint64_t kOrder = uint64_t{1} << 31;  // offsets are in order with this bit the other way

}  // namespace

void Walk::count() {
  End& end = f_.blocks[loop_.head].end;
  if (end.kind != EndKind::kBranch || end.compare != Op::kCompare || end.width != 8) return;
  for (uint32_t i = 0; i < 2; ++i) {
    const Cond cond = i == 0 ? end.cond : swapped(end.cond);
    const bool strict = cond == Cond::kLtU || cond == Cond::kGeU;
    if (!strict && cond != Cond::kLeU && cond != Cond::kGtU) continue;
    const Walker* const w = asked(end.in[i]);
    const Val other = end.in[1 - i];
    if (w == nullptr || !to_front(other)) continue;
    // The place of the first byte in the order, from where the pointer is when the loop begins. So
    // it is right, too, for a pointer without a variable, which is 2^32 behind it.
    const Val now = in_front(Op::kXor, 8, w->begin, constant(kOrder, 8));
    const Val own = in_front(Op::kSub, 8, now, w->distance);
    Val more = in_front(Op::kSub, 8, other, own);
    if (!strict) more = in_front(Op::kAdd, 8, more, constant(1, 8));
    Node limit;
    limit.op = Op::kSelectCmp;
    limit.width = limit.from = 8;
    limit.cond = strict ? Cond::kGtS : Cond::kGeS;
    limit.in[0] = more;
    limit.in[1] = in_front(Op::kSub, 8, own, own);
    limit.in[2] = other;
    limit.in[3] = own;
    end.in[1] = in_front(Op::kAnd, 8, in_front(limit), constant(kSmall, 8));
    end.in[0] = distance_.at(w->handle);
    end.cond = cond == Cond::kLtU || cond == Cond::kLeU ? Cond::kLtS : Cond::kGeS;
    return;
  }
}

bool Walk::to_front(Val v) {
  if (v == kNone || !is_inside(v)) return true;
  const uint32_t number = f_.values[v].node;
  if (number == kNone) return false;
  const Node n = f_.nodes[number];
  if (!is_movable(n) || n.exit != kNone || walker(v) != nullptr) return false;
  if (!to_front(n.mem.index) || !to_front(n.mem.pointer)) return false;
  for (const Val in : n.in) {
    if (!to_front(in)) return false;
  }
  std::erase(f_.blocks[f_.values[v].block].nodes, number);
  f_.blocks[front_].nodes.push_back(number);
  f_.values[v].block = front_;
  return true;
}

const Walk::Walker* Walk::asked(Val v) const {
  if (f_.values[v].constant || f_.values[v].node == kNone) return nullptr;
  const Node& order = f_.nodes[f_.values[v].node];
  if (order.op != Op::kXor || f_.values[order.in[0]].node == kNone) return nullptr;
  if (!f_.values[order.in[1]].constant || f_.values[order.in[1]].bits != kOrder) return nullptr;
  const Node& place = f_.nodes[f_.values[order.in[0]].node];
  for (const Walker& w : walkers_) {
    const bool is_it = place.op == Op::kAdd && place.in[1] == w.named && w.param != kNone;
    if (is_it && place.in[0] == distance_.at(w.handle)) return &w;
  }
  return nullptr;
}

void Walk::slots() {
  for (Block b = loop_.head; b <= loop_.last; ++b) {
    for (const uint32_t n : f_.blocks[b].nodes) slots(f_.nodes[n].exit);
    slots(f_.blocks[b].end.exit);
  }
}

void Walk::slots(uint32_t exit) {
  if (exit == kNone) return;
  for (SlotValue& slot : f_.exits[exit].slots) {
    const Walker* const w = walker(slot.value);
    if (w == nullptr || slot.site != kNoSite || !is_inside(slot.value)) continue;
    slot.site = w->site;
    slot.value = distance_.at(slot.value);
  }
}

void Walk::behind(Renames& renames) {
  Block out = kNone;
  for (Block b = loop_.head; b <= loop_.last; ++b) {
    for (const Block to : f_.blocks[b].end.target) {
      if (to == kNone || (to >= loop_.head && to <= loop_.last)) continue;
      if (out != kNone && out != to) return;
      out = to;
    }
  }
  if (out == kNone || out < loop_.head || f_.blocks[out].resumes || has_other_way(out)) return;
  unit_ = f_.blocks[out].unit;
  for (uint32_t i = 0; i < f_.blocks[out].params.size(); ++i) param_behind(out, i);
  for (const Val handle : handles_) {
    const bool inside = is_inside(handle) && f_.values[handle].block <= loop_.last;
    if (!inside || steps_.find(handle) != nullptr) continue;
    const auto renamed = static_cast<Val>(f_.values.size());
    f_.values.push_back({false, 8, false, 0, kNone, out});
    Node n;
    n.op = Op::kHandleAt;
    n.width = 8;
    n.in[0] = distance_.at(handle);
    n.site = walker(handle)->site;
    n.result = renamed;
    f_.values[renamed].node = made(n, out);
    std::vector<uint32_t>& nodes = f_.blocks[out].nodes;
    nodes.insert(nodes.begin(), f_.values[renamed].node);
    renames[handle] = {renamed, loop_.head, loop_.last};
  }
}

bool Walk::has_other_way(Block out) const {
  return std::any_of(ways_[out].begin(), ways_[out].end(), [&](const auto& way) {
    return way.first < loop_.head || way.first > loop_.last;
  });
}

void Walk::param_behind(Block out, uint32_t param) {
  const auto each = [&](auto visit) {
    for (const auto& [from, way] : ways_[out]) visit(f_.blocks[from].end.args[way][param]);
  };
  uint32_t one = kNone;
  bool same = true;
  each([&](Val v) {
    const uint32_t* const found = walker_.find(v);
    const bool walks = found != nullptr && *found != kNone && is_inside(v);
    if (one == kNone && walks) one = *found;
    same &= walks && *found == one;
  });
  if (!same || one == kNone) return;
  walker_[f_.blocks[out].params[param]] = one;
  new_param(out, param);
  each([&](Val& v) { v = distance_.at(v); });
}

}  // namespace vm::native
