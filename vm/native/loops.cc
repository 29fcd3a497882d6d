#include "vm/native/loops.h"

#include <algorithm>

namespace vm::native {
namespace {

constexpr uint32_t kMostHoistedValues = 10;  // values in front of one loop: registers are few

class Hoister {
 public:
  explicit Hoister(Function& f) : f_(f) {}

  void run() {
    // Only out of innermost loops: what lives through an inner loop must be in a variable, or an
    // execution that goes on there would not find it.
    std::vector<bool> has_inner(f_.loops.size(), false);
    for (const Loop& l : f_.loops) {
      if (l.parent != kNone) has_inner[l.parent] = true;
    }
    for (size_t l = 0; l < f_.loops.size(); ++l) {
      if (!has_inner[l]) loop(f_.loops[l]);
    }
  }

 private:
  bool outside(Val v, const Loop& loop) const {
    return v == kNone || f_.values[v].constant || f_.values[v].block < loop.head;
  }

  void loop(const Loop& l) {
    // After a call nothing but memory is left.
    for (Block b = l.head; b <= l.last; ++b) {
      for (const uint32_t number : f_.blocks[b].nodes) {
        if (f_.nodes[number].op == Op::kCall) return;
      }
    }
    const Block front = l.head - 1;
    const std::vector<Block> sure = every_turn(f_, l);
    uint32_t values = 0;
    for (Block b = l.head; b <= l.last; ++b) {
      const bool is_sure = std::find(sure.begin(), sure.end(), b) != sure.end();
      std::vector<uint32_t>& nodes = f_.blocks[b].nodes;
      std::erase_if(nodes, [&](uint32_t number) {
        Node& n = f_.nodes[number];
        if (!is_movable(n) || !outside(n.mem.index, l) || !outside(n.mem.pointer, l)) return false;
        for (const Val v : n.in) {
          if (!outside(v, l)) return false;
        }
        const bool checks = n.exit != kNone;
        if (checks && f_.exits[n.exit].inlined != kNone) return false;
        if (checks && !is_sure) return false;
        if (n.result != kNone && ++values > kMostHoistedValues) return false;
        if (checks) n.exit = exit_at(front);
        if (n.result != kNone) f_.values[n.result].block = front;
        f_.blocks[front].nodes.push_back(number);
        return true;
      });
    }
  }

  uint32_t exit_at(Block front) {
    Exit exit;
    exit.unit = f_.blocks[front].unit;
    exit.slots = f_.blocks[front].dirty;
    f_.exits.push_back(std::move(exit));
    return static_cast<uint32_t>(f_.exits.size() - 1);
  }

  Function& f_;
};

}  // namespace

bool is_movable(const Node& n) {
  // A check of the divisor stands before; an index may not have been checked where the loop is not
  // entered.
  const bool divides =
      n.op == Op::kDivS || n.op == Op::kDivU || n.op == Op::kModS || n.op == Op::kModU;
  const bool indexed = n.op == Op::kLoad && n.mem.index != kNone;
  return is_operation(n) && !divides && !indexed;
}

std::vector<Block> every_turn(const Function& f, const Loop& loop) {
  std::vector<Block> out;
  std::vector<uint32_t> ways(loop.last - loop.head + 1, 0);
  for (Block b = loop.head; b <= loop.last; ++b) {
    for (const Block to : f.blocks[b].end.target) {
      if (to != kNone && to > b && to <= loop.last) ++ways[to - loop.head];
    }
  }
  Block at = loop.head;
  while (true) {
    out.push_back(at);
    Block next = kNone;
    uint32_t inside = 0;
    for (const Block to : f.blocks[at].end.target) {
      if (to == kNone || to <= at || to > loop.last) continue;
      ++inside;
      next = to;
    }
    if (inside != 1 || ways[next - loop.head] != 1) return out;
    at = next;
  }
}

void insert_preheaders(Function& f) {
  if (f.loops.empty()) return;
  const auto count = static_cast<Block>(f.blocks.size());
  std::vector<Block> place(count);  // of the old block
  Block next = 0;
  for (Block b = 0; b < count; ++b) {
    if (f.blocks[b].head) ++next;
    place[b] = next++;
  }
  std::vector<BasicBlock> blocks(next);
  for (Value& value : f.values) value.block = place[value.block];
  for (Block b = 0; b < count; ++b) {
    BasicBlock& old = f.blocks[b];
    for (Block& to : old.end.target) {
      if (to == kNone) continue;
      const bool into = old.end.kind != EndKind::kLoop && f.blocks[to].head;
      to = place[to] - (into ? 1 : 0);
    }
    if (old.head) {
      BasicBlock& front = blocks[place[b] - 1];
      front.unit = old.unit;
      front.resumes = true;
      front.loop = f.loops[old.loop].parent;
      front.end.kind = EndKind::kJump;
      front.end.target[0] = place[b];
      front.reloads = std::move(old.reloads);
      front.dirty = std::move(old.dirty);
      for (const Val param : old.params) {
        const auto own = static_cast<Val>(f.values.size());
        Value value = f.values[param];
        value.block = place[b] - 1;
        f.values.push_back(value);
        front.params.push_back(own);
        front.end.args[0].push_back(own);
        for (Reload& reload : front.reloads) {
          if (reload.value == param) reload.value = own;
        }
        for (SlotValue& slot : front.dirty) {
          if (slot.value == param) slot.value = own;
        }
      }
      old.reloads.clear();
      old.dirty.clear();
    }
  }
  for (Block b = 0; b < count; ++b) blocks[place[b]] = std::move(f.blocks[b]);
  f.blocks = std::move(blocks);
  for (Loop& loop : f.loops) {
    loop.head = place[loop.head];
    loop.last = place[loop.last];
  }
}

void hoist(Function& function) { Hoister(function).run(); }

}  // namespace vm::native
