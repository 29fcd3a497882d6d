#include "vm/native/forward.h"

#include <algorithm>
#include <cstddef>

namespace vm::native {
namespace {

constexpr size_t kMostKnown = 48;  // places at once

class Forwarder {
 public:
  explicit Forwarder(Function& f) : f_(f), same_(f.values.size(), kNone) {}

  void run() {
    const auto count = static_cast<Block>(f_.blocks.size());
    find_held();
    preds_.resize(count);
    ends_.resize(count);
    for (Block b = 0; b < count; ++b) {
      for (const Block to : f_.blocks[b].end.target) {
        if (to != kNone) preds_[to].push_back(b);
      }
    }
    for (Block b = 0; b < count; ++b) block(b);
    rename();
  }

 private:
  // A variable's value at a loop stays its own: another task may change one of two variables that
  // hold the same.
  void find_held() {
    held_.assign(f_.values.size(), false);
    for (const BasicBlock& block : f_.blocks) {
      for (const Reload& reload : block.reloads) held_[reload.value] = true;
      for (const SlotValue& slot : block.dirty) held_[slot.value] = true;
    }
  }

  // The area that a place lies in. An address that is computed may lead anywhere.
  struct Root {
    // kInside: an instance inside of this one, where the image says that it lies.
    enum Kind : uint8_t { kFrame, kSelf, kInside, kGlobals, kInstance, kAnywhere };
    Kind kind = kAnywhere;
    Val area = kNone;  // of kInstance
    bool part =
        false;  // kInstance: inside of another instance or of this one, so it is not this one
  };
  struct Known {
    Mem mem;
    Root root;
    uint8_t width = 0;
    bool normal = false;  // the value is 0 or 1, memory may be any byte
    Val value = kNone;
  };

  Val real(Val v) const {
    while (v != kNone && same_[v] != kNone) v = same_[v];
    return v;
  }
  const Node* maker(Val v) const {
    return v == kNone || f_.values[v].node == kNone ? nullptr : &f_.nodes[f_.values[v].node];
  }

  // An inlined body reaches its instance by a pointer, the caller by the address.
  Mem canonical(Mem mem) const {
    mem.index = real(mem.index);
    mem.pointer = real(mem.pointer);
    const Node* const enter = maker(mem.pointer);
    const bool enters = enter != nullptr && enter->op == Op::kEnter;
    if (mem.base == MemBase::kPointer && mem.index == kNone && enters) {
      if (enter->mem.inside) {
        const int64_t disp = mem.disp;
        mem = enter->mem;
        mem.index = real(mem.index);
        mem.disp += disp;
        return mem;
      }
      mem.base = MemBase::kData;
      mem.index = real(enter->in[1]);
      mem.scale = 1;
      mem.pointer = kNone;
    }
    return mem;
  }

  // `inside`: in an instance inside of that one, which may be this one.
  Root instance(Val area, bool inside) const {
    Root root;
    const Node* const made = maker(area);
    if (made == nullptr) return root;
    // What no code writes and no memory of the program holds: the place of an area.
    const bool of_handle =
        made->op == Op::kLoad && made->immutable && made->mem.base == MemBase::kPointer;
    if (made->op != Op::kInstance && !of_handle) return root;
    root.kind = Root::kInstance;
    root.area = area;
    if (of_handle) {
      root.part = made->imm == kOtherInstance && !inside;
      return root;
    }
    const Node* const id = maker(real(made->in[0]));
    root.part = id != nullptr && id->op == Op::kLoad && id->mem.base == MemBase::kSelf;
    return root;
  }
  Root root_of(const Mem& mem) const {
    switch (mem.base) {
      case MemBase::kFrame:
        return {Root::kFrame, kNone, false};
      case MemBase::kSelf:
        return {mem.inside ? Root::kInside : Root::kSelf, kNone, false};
      case MemBase::kPointer: {
        const Node* const enter = maker(mem.pointer);
        if (enter == nullptr || enter->op != Op::kEnter) return {};
        if (enter->mem.inside) return {Root::kInside, kNone, false};
        return instance(real(enter->in[1]), mem.inside);
      }
      case MemBase::kData:
        if (mem.index == kNone) return {Root::kGlobals, kNone, false};
        return mem.scale == 1 ? instance(mem.index, mem.inside) : Root();
    }
    return {};
  }

  static bool indexed(const Mem& mem, const Root& root) {
    const bool by_area = root.kind == Root::kInstance && mem.base == MemBase::kData;
    return mem.index != kNone && !by_area;
  }

  static bool may_overlap(const Mem& a, const Root& ra, uint8_t width, const Known& b) {
    const Root& rb = b.root;
    if (ra.kind == Root::kAnywhere || rb.kind == Root::kAnywhere) return true;
    if (ra.kind != rb.kind) {
      // Frames, the globals and instances lie apart; an instance may be this one.
      const bool self = ra.kind == Root::kSelf || rb.kind == Root::kSelf;
      const bool other = ra.kind == Root::kInstance || rb.kind == Root::kInstance;
      if (ra.kind == Root::kInside || rb.kind == Root::kInside) return other;
      return self && other && !(ra.kind == Root::kInstance ? ra.part : rb.part);
    }
    if (ra.kind == Root::kInside) {
      const bool comparable = a.base == b.mem.base && a.pointer == b.mem.pointer &&
                              a.index == b.mem.index &&
                              (a.index == kNone || a.scale == b.mem.scale);
      if (!comparable) return true;
      return a.disp < b.mem.disp + b.width && b.mem.disp < a.disp + width;
    }
    if (ra.area != rb.area || indexed(a, ra) || indexed(b.mem, rb)) return true;
    return a.disp < b.mem.disp + b.width && b.mem.disp < a.disp + width;
  }

  static bool same_place(const Mem& a, const Mem& b) {
    return a.base == b.base && a.index == b.index && a.pointer == b.pointer && a.disp == b.disp &&
           (a.index == kNone || a.scale == b.scale);
  }

  void block(Block b) {
    forget();
    BasicBlock& block = f_.blocks[b];
    if (!block.head && !block.resumes) meet(b);
    for (const uint32_t n : block.nodes) node(n);
    std::erase_if(block.nodes, [&](uint32_t n) { return f_.nodes[n].dead; });
    const bool asked = std::any_of(std::begin(block.end.target), std::end(block.end.target),
                                   [&](Block to) { return to != kNone && !f_.blocks[to].head; });
    if (asked) ends_[b].assign(known_.begin() + static_cast<std::ptrdiff_t>(oldest_), known_.end());
  }

  // What all ways bring.
  void meet(Block b) {
    const std::vector<Block>& preds = preds_[b];
    if (preds.empty()) return;
    for (const Block pred : preds) {
      if (pred >= b) return;
    }
    known_ = ends_[preds[0]];
    for (size_t i = 1; i < preds.size(); ++i) {
      const std::vector<Known>& other = ends_[preds[i]];
      std::erase_if(known_, [&](const Known& k) {
        const auto same = std::find_if(other.begin(), other.end(), [&](const Known& o) {
          return same_place(k.mem, o.mem) && k.width == o.width && k.value == o.value &&
                 k.normal == o.normal;
        });
        return same == other.end();
      });
    }
  }

  void drop_old() {
    known_.erase(known_.begin(), known_.begin() + static_cast<std::ptrdiff_t>(oldest_));
    oldest_ = 0;
  }

  void forget() {
    known_.clear();
    oldest_ = 0;
  }

  void add(const Known& known) {
    if (known_.size() - oldest_ == kMostKnown && ++oldest_ == kMostKnown) drop_old();
    known_.push_back(known);
  }

  void node(uint32_t number) {
    Node& n = f_.nodes[number];
    switch (n.op) {
      case Op::kLoad:
        return load(n);
      case Op::kStore: {
        const Mem mem = canonical(n.mem);
        const Root root = root_of(mem);
        const auto first = known_.begin() + static_cast<std::ptrdiff_t>(oldest_);
        known_.erase(
            std::remove_if(first, known_.end(),
                           [&](const Known& k) { return may_overlap(mem, root, n.width, k); }),
            known_.end());
        const Val value = real(n.in[0]);
        // A constant of floating point costs more than a load.
        const Value& v = f_.values[value];
        // Of a wider integer memory has the lower bytes. What is above them in a register is of no
        // meaning, but for four bytes, which have zeros there.
        const bool is_part = n.width < 4 && v.width > n.width && !v.floating && !v.constant;
        if (is_part || (v.width == n.width && !(v.constant && v.floating))) {
          add({mem, root, n.width, false, value});
        }
        return;
      }
      case Op::kCall:
      case Op::kHelper:
      case Op::kNative:
        return forget();
      case Op::kSelectCmp:
        return select(n);
      default:
        return;
    }
  }

  // Arguments that are constants decide limits.
  void select(Node& n) {
    const Value& a = f_.values[real(n.in[2])];
    const Value& b = f_.values[real(n.in[3])];
    if (!a.constant || !b.constant) return;
    const uint64_t mask = n.from == 8 ? ~uint64_t{0} : (uint64_t{1} << (8 * n.from)) - 1;
    const Val chosen = real(n.in[holds(n.cond, a.bits & mask, b.bits & mask, n.from) ? 0 : 1]);
    if (f_.values[chosen].width != n.width || held_[n.result]) return;
    same_[n.result] = chosen;
    n.dead = true;
  }

  void load(Node& n) {
    const Mem mem = canonical(n.mem);
    for (size_t i = oldest_; i < known_.size(); ++i) {
      const Known& k = known_[i];
      if (held_[n.result]) break;
      if (!same_place(k.mem, mem) || k.width != n.width || n.boolean != k.normal) continue;
      if (f_.values[k.value].floating != f_.values[n.result].floating) continue;
      same_[n.result] = k.value;
      n.dead = true;
      return;
    }
    add({mem, root_of(mem), n.width, n.boolean, n.result});
  }

  // As machines want them.
  bool swaps(const Val in[2]) const {
    return f_.values[in[0]].constant && !f_.values[in[1]].constant;
  }
  void compare_right(Val in[2], Cond& cond) const {
    if (!swaps(in)) return;
    std::swap(in[0], in[1]);
    cond = swapped(cond);
  }
  void constants_right(Node& n) const {
    switch (n.op) {
      case Op::kCompare:
      case Op::kExitIf:
        return compare_right(n.in, n.cond);
      case Op::kSelectCmp:
        return compare_right(n.in + 2, n.cond);
      case Op::kAdd:
      case Op::kMul:
      case Op::kAnd:
      case Op::kOr:
      case Op::kXor:
        if (swaps(n.in)) std::swap(n.in[0], n.in[1]);
        return;
      default:
        return;
    }
  }

  void rename() {
    const auto all = [&](auto& values) {
      for (Val& v : values) v = real(v);
    };
    for (Node& n : f_.nodes) {
      all(n.in);
      constants_right(n);
      n.mem.index = real(n.mem.index);
      n.mem.pointer = real(n.mem.pointer);
    }
    for (Exit& exit : f_.exits) {
      for (SlotValue& slot : exit.slots) slot.value = real(slot.value);
    }
    for (BasicBlock& block : f_.blocks) {
      all(block.end.in);
      End& end = block.end;
      if (end.kind == EndKind::kBranch && end.compare == Op::kCompare) {
        compare_right(end.in, end.cond);
      }
      for (std::vector<Val>& args : block.end.args) all(args);
    }
  }

  Function& f_;
  std::vector<Val> same_;   // by value: what it is instead
  std::vector<bool> held_;  // by value: a variable's at a loop
  std::vector<std::vector<Block>> preds_;
  std::vector<Known> known_;
  size_t oldest_ = 0;  // in `known_`; what is in front is forgotten
  std::vector<std::vector<Known>> ends_;
};

}  // namespace

// What variables hold is known already.
void forward_memory(Function& function) {
  const bool reads = std::any_of(function.nodes.begin(), function.nodes.end(), [](const Node& n) {
    return n.op == Op::kLoad && !n.dead && n.variable == kNone;
  });
  if (reads) Forwarder(function).run();
}

}  // namespace vm::native
