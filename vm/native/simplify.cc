#include "vm/native/build.h"

namespace vm::native {
namespace {

class Simplifier {
 public:
  explicit Simplifier(Function& f) : f_(f), uses_(f.values.size(), 0) {}

  void run() {
    count();
    fuse();
    drop_dead();
  }
  void drop() {
    count();
    drop_dead();
  }

 private:
  void use(Val v) {
    if (v != kNone) ++uses_[v];
  }
  void count() {
    for (const BasicBlock& block : f_.blocks) {
      for (const uint32_t n : block.nodes) {
        each_operand(f_.nodes[n], [&](Val v) { use(v); });
        count_exit(f_.nodes[n].exit);
      }
      count_exit(block.end.exit);
      for (const Val v : block.end.in) use(v);
      for (const auto& args : block.end.args) {
        for (const Val v : args) use(v);
      }
    }
  }
  // An exit that nothing takes any more wants nothing.
  void count_exit(uint32_t exit) {
    if (exit == kNone) return;
    for (const SlotValue& slot : f_.exits[exit].slots) use(slot.value);
  }
  template <class Visit>
  static void each_operand(const Node& node, Visit visit) {
    for (const Val v : node.in) {
      if (v != kNone) visit(v);
    }
    if (node.mem.index != kNone) visit(node.mem.index);
    if (node.mem.pointer != kNone) visit(node.mem.pointer);
  }

  // The comparison that makes `v` for one user alone.
  Node* comparison(Val v, bool floats) {
    if (v == kNone || f_.values[v].node == kNone || uses_[v] != 1) return nullptr;
    Node& node = f_.nodes[f_.values[v].node];
    const bool fits = node.op == Op::kCompare || (floats && node.op == Op::kFCompare);
    return fits ? &node : nullptr;
  }

  void fuse() {
    for (Block b = 0; b < f_.blocks.size(); ++b) {
      End& end = f_.blocks[b].end;
      while (end.kind == EndKind::kBranch && end.compare == Op::kCompare && end.width == 1 &&
             (end.cond == Cond::kNe || end.cond == Cond::kEq) && fuse_end(b, end)) {
      }
      for (const uint32_t n : f_.blocks[b].nodes) {
        Node& node = f_.nodes[n];
        if (node.dead) continue;
        if (node.op == Op::kSelect) fuse_select(node, b);
        if (node.op == Op::kCompare || node.op == Op::kExitIf) {
          fuse_bits(b, node.width, node.cond, node.in);
        }
        if (node.op == Op::kSelectCmp) fuse_bits(b, node.from, node.cond, node.in + 2);
      }
      if (end.kind == EndKind::kBranch && end.compare == Op::kCompare) {
        fuse_bits(b, end.width, end.cond, end.in);
      }
    }
  }

  // (x AND y) = 0 is one question.
  void fuse_bits(Block b, uint8_t width, Cond& cond, Val in[2]) {
    if (cond != Cond::kEq && cond != Cond::kNe) return;
    const Value& value = f_.values[in[0]];
    if (!f_.values[in[1]].constant || f_.values[in[1]].bits != 0) return;
    if (value.node == kNone || value.block != b || uses_[in[0]] != 1) return;
    Node& both = f_.nodes[value.node];
    if (both.op != Op::kAnd || both.width != width) return;
    cond = cond == Cond::kEq ? Cond::kNoBit : Cond::kAnyBit;
    in[0] = both.in[0];
    in[1] = both.in[1];
    both.dead = true;
  }

  bool fuse_end(Block b, End& end) {
    const Val v = end.in[0];
    if (!f_.values[end.in[1]].constant || f_.values[end.in[1]].bits != 0) return false;
    if (v == kNone || f_.values[v].node == kNone || f_.values[v].block != b) return false;
    Node& made = f_.nodes[f_.values[v].node];
    if (made.op == Op::kNotBool) {
      // Another user may need it too.
      ++uses_[made.in[0]];
      --uses_[v];
      end.in[0] = made.in[0];
      end.cond = negated(end.cond);
      return true;
    }
    Node* const compare = comparison(v, true);
    if (compare == nullptr) return false;
    if (compare->op == Op::kFCompare && end.cond == Cond::kEq) {
      std::swap(end.target[0], end.target[1]);
      std::swap(end.args[0], end.args[1]);
    }
    end.cond = compare->op == Op::kCompare && end.cond == Cond::kEq ? negated(compare->cond)
                                                                    : compare->cond;
    end.compare = compare->op;
    end.width = compare->width;
    end.in[0] = compare->in[0];
    end.in[1] = compare->in[1];
    compare->dead = true;
    return true;
  }

  void fuse_select(Node& node, Block b) {
    if (f_.values[node.in[0]].block != b) return;
    Node* const compare = comparison(node.in[0], false);
    if (compare == nullptr) return;
    const Val yes = node.in[1];
    const Val no = node.in[2];
    node.op = Op::kSelectCmp;
    node.cond = compare->cond;
    node.from = compare->width;
    node.in[0] = yes;
    node.in[1] = no;
    node.in[2] = compare->in[0];
    node.in[3] = compare->in[1];
    compare->dead = true;
  }

  static bool is_pure(const Node& node) {
    return node.op != Op::kStore && node.op != Op::kExitIf && node.op != Op::kInstance &&
           node.op != Op::kResolve && node.op != Op::kAdvanceTime && node.op != Op::kNative &&
           node.op != Op::kHelper && node.op != Op::kCall && node.op != Op::kEnter;
  }

  void drop_dead() {
    std::vector<uint32_t> work;
    for (const BasicBlock& block : f_.blocks) {
      for (const uint32_t n : block.nodes) {
        const Node& node = f_.nodes[n];
        if (!node.dead && is_pure(node) && uses_[node.result] == 0) work.push_back(n);
      }
    }
    while (!work.empty()) {
      Node& node = f_.nodes[work.back()];
      work.pop_back();
      if (node.dead) continue;
      node.dead = true;
      each_operand(node, [&](Val v) {
        if (--uses_[v] != 0 || f_.values[v].node == kNone) return;
        if (is_pure(f_.nodes[f_.values[v].node])) work.push_back(f_.values[v].node);
      });
    }
    for (BasicBlock& block : f_.blocks) {
      std::erase_if(block.nodes, [&](uint32_t n) { return f_.nodes[n].dead; });
    }
  }

  Function& f_;
  std::vector<uint32_t> uses_;
};

}  // namespace

Cond negated(Cond cond) {
  constexpr Cond kOf[] = {Cond::kNe,  Cond::kEq,  Cond::kGeS,    Cond::kGtS,
                          Cond::kLeS, Cond::kLtS, Cond::kGeU,    Cond::kGtU,
                          Cond::kLeU, Cond::kLtU, Cond::kAnyBit, Cond::kNoBit};
  return kOf[static_cast<size_t>(cond)];
}
Cond swapped(Cond cond) {
  constexpr Cond kOf[] = {Cond::kEq,  Cond::kNe,  Cond::kGtS,   Cond::kGeS,
                          Cond::kLtS, Cond::kLeS, Cond::kGtU,   Cond::kGeU,
                          Cond::kLtU, Cond::kLeU, Cond::kNoBit, Cond::kAnyBit};
  return kOf[static_cast<size_t>(cond)];
}

bool holds(Cond cond, uint64_t a, uint64_t b, uint8_t width) {
  const unsigned above = 64 - 8u * width;
  const auto sa = static_cast<int64_t>(a << above) >> above;
  const auto sb = static_cast<int64_t>(b << above) >> above;
  switch (cond) {
    case Cond::kEq:
      return a == b;
    case Cond::kNe:
      return a != b;
    case Cond::kLtS:
      return sa < sb;
    case Cond::kLeS:
      return sa <= sb;
    case Cond::kGtS:
      return sa > sb;
    case Cond::kGeS:
      return sa >= sb;
    case Cond::kLtU:
      return a < b;
    case Cond::kLeU:
      return a <= b;
    case Cond::kGtU:
      return a > b;
    case Cond::kGeU:
      return a >= b;
    case Cond::kNoBit:
      return (a & b) == 0;
    case Cond::kAnyBit:
      return (a & b) != 0;
  }
  return false;
}

void simplify(Function& function) { Simplifier(function).run(); }
void drop_unused(Function& function) { Simplifier(function).drop(); }

}  // namespace vm::native
