// Loads that an instruction of the machine does itself.
#include <algorithm>

#include "vm/native/allocate.h"

namespace vm::native {
namespace {

class Folder {
 public:
  Folder(Function& f, const Target& target)
      : f_(f), target_(target), uses_(f.values.size(), 0), at_(f.values.size(), kNone) {}

  void run() {
    count();
    for (BasicBlock& block : f_.blocks) {
      uint32_t barrier = 0;  // nothing in front of it may be read after it
      for (uint32_t i = 0; i < block.nodes.size(); ++i) {
        Node& n = f_.nodes[block.nodes[i]];
        if (n.op == Op::kLoad) at_[n.result] = i;
        const bool writes = n.op == Op::kStore || n.op == Op::kNative || n.op == Op::kHelper ||
                            n.op == Op::kCall || n.op == Op::kEnter;
        if (writes) barrier = i + 1;
        const int operand = target_.folds(n);
        if (operand >= 0) fold(n, static_cast<uint32_t>(operand), barrier);
      }
      std::erase_if(block.nodes, [&](uint32_t n) { return f_.nodes[n].dead; });
      for (const uint32_t n : block.nodes) {
        if (f_.nodes[n].result != kNone) at_[f_.nodes[n].result] = kNone;
      }
    }
  }

 private:
  void use(Val v) {
    if (v != kNone) ++uses_[v];
  }
  void count() {
    for (const Node& n : f_.nodes) {
      if (n.dead) continue;
      for (const Val v : n.in) use(v);
      use(n.mem.index);
      use(n.mem.pointer);
    }
    for (const Exit& exit : f_.exits) {
      for (const SlotValue& slot : exit.slots) use(slot.value);
    }
    for (const BasicBlock& block : f_.blocks) {
      for (const Reload& reload : block.reloads) use(reload.value);
      for (const SlotValue& slot : block.dirty) use(slot.value);
      for (const Val v : block.end.in) use(v);
      for (const std::vector<Val>& args : block.end.args) {
        for (const Val v : args) use(v);
      }
    }
  }

  // A variable's load waits by itself until somebody wants it.
  bool is_folded(Val v, uint8_t width, uint32_t barrier) const {
    if (v == kNone || f_.values[v].constant || uses_[v] != 1 || at_[v] == kNone) return false;
    const Node& load = f_.nodes[f_.values[v].node];
    return at_[v] >= barrier && load.variable == kNone && !load.boolean && load.width == width;
  }

  void fold(Node& n, uint32_t operand, uint32_t barrier) {
    const uint8_t width = n.op == Op::kSext || n.op == Op::kZext ? n.from : n.width;
    const bool swaps = n.op == Op::kAdd || n.op == Op::kAnd || n.op == Op::kOr ||
                       n.op == Op::kXor || n.op == Op::kMul;
    if (swaps && !is_folded(n.in[1], width, barrier) && is_folded(n.in[0], width, barrier) &&
        !f_.values[n.in[1]].constant) {
      std::swap(n.in[0], n.in[1]);
    }
    if (!is_folded(n.in[operand], width, barrier)) return;
    Node& load = f_.nodes[f_.values[n.in[operand]].node];
    load.dead = true;
    n.mem = load.mem;
    n.folded = static_cast<uint8_t>(operand);
    n.in[operand] = kNone;
  }

  Function& f_;
  const Target& target_;
  std::vector<uint32_t> uses_;
  std::vector<uint32_t> at_;  // by value of a load: its place in the block
};

}  // namespace

void fold_loads(Function& function, const Target& target) { Folder(function, target).run(); }

}  // namespace vm::native
