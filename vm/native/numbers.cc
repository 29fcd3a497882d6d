// Operations that a block in front has done already: their values serve again, and questions are
// asked once. Only within a stretch without calls and loop heads, where values live in registers.
#include <algorithm>
#include <bit>

#include "vm/native/build.h"
#include "vm/native/loops.h"

namespace vm::native {

bool is_operation(const Node& n) {
  switch (n.op) {
    case Op::kConst:
    case Op::kStore:
    case Op::kTaskTime:
    case Op::kReach:
    case Op::kAdvanceTime:
    case Op::kNative:
    case Op::kHelper:
    case Op::kCall:
    case Op::kEnter:
      return false;
    case Op::kLoad:
      return n.immutable;
    default:
      return true;
  }
}

namespace {

constexpr uint32_t kMostHops = 64;
constexpr size_t kMostOperands = 8;  // of one operation

struct Doing {
  uint64_t hash = 0;
  uint32_t node = 0;
  Block block = 0;
  uint32_t earlier = kNone;  // with the same place in the table
};

class Numbers {
 public:
  explicit Numbers(Function& f)
      : f_(f), dominator_(f.blocks.size(), kNone), instead_(f.values.size(), kNone) {
    // A variable's value at a loop stays its own: another task may change one of two variables that
    // hold the same.
    held_.assign(f.values.size(), false);
    for (const BasicBlock& block : f.blocks) {
      for (const Reload& reload : block.reloads) held_[reload.value] = true;
      for (const SlotValue& slot : block.dirty) held_[slot.value] = true;
    }
  }

  void run() {
    if (f_.blocks.empty()) return;
    newest_.assign(std::bit_ceil(f_.nodes.size() + 1), kNone);
    find_dominators();
    for (Block b = 0; b < f_.blocks.size(); ++b) block(b);
    if (!any_) return;
    rename();
  }

 private:
  Val now(Val v) const { return v == kNone || instead_[v] == kNone ? v : instead_[v]; }

  // Blocks come in an order in which all ways but those back to a loop lead on.
  void find_dominators() {
    for (Block b = 0; b < f_.blocks.size(); ++b) {
      const End& end = f_.blocks[b].end;
      if (end.kind == EndKind::kLoop) continue;
      for (const Block to : end.target) {
        if (to != kNone) dominator_[to] = dominator_[to] == kNone ? b : common(dominator_[to], b);
      }
    }
  }
  Block common(Block a, Block b) const {
    while (a != b && a != kNone && b != kNone) {
      Block& later = a > b ? a : b;
      later = dominator_[later];
    }
    return a == kNone || b == kNone ? kNone : a;
  }
  // Looks so far only, as long chains of branches would make it quadratic.
  bool dominates(Block a, Block b) const {
    for (uint32_t hops = 0; hops < kMostHops && b != kNone && b > a; ++hops) b = dominator_[b];
    return b == a;
  }

  void block(Block b) {
    const BasicBlock& at = f_.blocks[b];
    if (at.head || at.resumes || b == 0 || at.loop != f_.blocks[b - 1].loop) forget();
    std::erase_if(f_.blocks[b].nodes, [&](uint32_t number) {
      Node& n = f_.nodes[number];
      for (Val& v : n.in) v = now(v);
      n.mem.index = now(n.mem.index);
      n.mem.pointer = now(n.mem.pointer);
      if (n.op == Op::kCall) forget();
      if (!is_operation(n) || (n.result != kNone && held_[n.result])) return false;
      const uint64_t hash = hash_of(n, 0);
      const uint32_t before = find(n, hash, b);
      if (before == kNone) {
        uint32_t& newest = newest_[(hash >> 32 ^ hash) & (newest_.size() - 1)];
        done_.push_back({hash, number, b, newest});
        newest = static_cast<uint32_t>(done_.size() - 1);
        return false;
      }
      if (n.result != kNone) instead_[n.result] = f_.nodes[before].result;
      n.dead = any_ = true;
      return true;
    });
  }

  void forget() { first_ = static_cast<uint32_t>(done_.size()); }

  // The node that did the same in front; kNone: none did.
  uint32_t find(const Node& n, uint64_t hash, Block b) const {
    size_t places = 0;
    uint32_t at = newest_[(hash >> 32 ^ hash) & (newest_.size() - 1)];
    for (; at != kNone && at >= first_ && places < kMostOperands; at = done_[at].earlier) {
      if (done_[at].hash != hash) continue;
      ++places;
      if (same(f_.nodes[done_[at].node], n) && dominates(done_[at].block, b)) return done_[at].node;
    }
    return kNone;
  }

  void rename() {
    for (BasicBlock& block : f_.blocks) {
      for (const uint32_t number : block.nodes) {
        Node& n = f_.nodes[number];
        for (Val& v : n.in) v = now(v);
        n.mem.index = now(n.mem.index);
        n.mem.pointer = now(n.mem.pointer);
      }
      for (Val& v : block.end.in) v = now(v);
      for (std::vector<Val>& args : block.end.args) {
        for (Val& v : args) v = now(v);
      }
    }
    for (Exit& exit : f_.exits) {
      for (SlotValue& slot : exit.slots) slot.value = now(slot.value);
    }
  }

  Function& f_;
  std::vector<Block> dominator_;  // the nearest; kNone: none
  std::vector<Val> instead_;      // by value
  std::vector<bool> held_;        // by value: a variable's at a loop
  std::vector<Doing> done_;
  uint32_t first_ = 0;            // in `done_`; what is in front is forgotten
  std::vector<uint32_t> newest_;  // in `done_`, by hash
  bool any_ = false;
};

}  // namespace

void number_again(Function& function) { Numbers(function).run(); }

}  // namespace vm::native
