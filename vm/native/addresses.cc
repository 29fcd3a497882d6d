// Addresses as the machine forms them: [base + index * scale + displacement]. What is constant of
// an index goes to the displacement; what does not change in a loop is added up in front of it.
#include <algorithm>

#include "vm/native/loops.h"

namespace vm::native {
namespace {

constexpr size_t kMostPlaces = 6;  // in front of one loop: registers are few
constexpr int64_t kMostDisplacement = int64_t{1} << 30;

class Places {
 public:
  explicit Places(Function& f) : f_(f) {}

  void run() {
    fold_constants();
    std::vector<bool> outer(f_.loops.size(), false);
    for (const Loop& l : f_.loops) {
      if (l.parent != kNone) outer[l.parent] = true;
    }
    for (size_t l = 0; l < f_.loops.size(); ++l) {
      if (!outer[l]) loop(f_.loops[l]);
    }
  }

 private:
  // In one stretch without loop heads: what an index is made of lives on to the access.
  void fold_constants() {
    Block stretch = 0;
    for (Block b = 0; b < f_.blocks.size(); ++b) {
      const BasicBlock& block = f_.blocks[b];
      if (block.head || block.resumes || (b > 0 && block.loop != f_.blocks[b - 1].loop))
        stretch = b;
      for (const uint32_t number : block.nodes) {
        Node& n = f_.nodes[number];
        if (n.op == Op::kLoad || n.op == Op::kStore) fold_constant(n.mem, stretch);
      }
    }
  }

  void fold_constant(Mem& mem, Block stretch) const {
    if (mem.index == kNone || mem.base == MemBase::kData) return;
    const Value& index = f_.values[mem.index];
    if (index.constant || index.node == kNone || index.block < stretch) return;
    const Node& sum = f_.nodes[index.node];
    if (sum.op != Op::kAdd || sum.width != 8 || !f_.values[sum.in[1]].constant) return;
    const auto by = static_cast<int64_t>(f_.values[sum.in[1]].bits);
    if (by < -kMostDisplacement || by > kMostDisplacement) return;
    const int64_t disp = mem.disp + by * mem.scale;
    if (disp < -kMostDisplacement || disp > kMostDisplacement) return;
    mem.disp = disp;
    mem.index = sum.in[0];
  }

  bool outside(Val v, const Loop& l) const {
    return f_.values[v].constant || f_.values[v].block < l.head;
  }

  void loop(const Loop& l) {
    made_.clear();
    for (Block b = l.head; b <= l.last; ++b) {
      for (const uint32_t number : f_.blocks[b].nodes) {
        const Op op = f_.nodes[number].op;
        if (op == Op::kLoad || op == Op::kStore) split(number, l);
      }
    }
  }

  // The index is a sum of something from before the loop and something from inside.
  void split(uint32_t number, const Loop& l) {
    const Mem mem = f_.nodes[number].mem;
    if (mem.index == kNone || mem.base == MemBase::kPointer || mem.scale != 1) return;
    const Value& index = f_.values[mem.index];
    if (index.constant || index.node == kNone || outside(mem.index, l)) return;
    const Node& sum = f_.nodes[index.node];
    if (sum.width != 8 || (sum.op != Op::kAdd && sum.op != Op::kAddShifted)) return;
    const uint8_t scales[2] = {1, sum.op == Op::kAdd ? uint8_t{1} : uint8_t(1u << sum.imm)};
    for (uint32_t i = 0; i < 2; ++i) {
      const Val fixed = sum.in[i];
      const Val moving = sum.in[1 - i];
      if (f_.values[fixed].constant || !outside(fixed, l) || outside(moving, l)) continue;
      Mem front{mem.base, scales[i], fixed, 0, kNone};
      // Offsets of data memory may be larger than a displacement.
      if (mem.base == MemBase::kData) front.disp = mem.disp;
      const Val place = place_of(front, l);
      if (place == kNone) return;
      const uint8_t scale = scales[1 - i];
      f_.nodes[number].mem = {MemBase::kPointer, scale, moving, mem.disp - front.disp, place};
      return;
    }
  }

  Val place_of(const Mem& mem, const Loop& l) {
    for (const Val v : made_) {
      const Mem& other = f_.nodes[f_.values[v].node].mem;
      if (other.base == mem.base && other.scale == mem.scale && other.index == mem.index &&
          other.disp == mem.disp) {
        return v;
      }
    }
    if (made_.size() == kMostPlaces) return kNone;
    const Block front = l.head - 1;
    Node node;
    node.op = Op::kPlace;
    node.width = 8;
    node.mem = mem;
    node.unit = f_.blocks[front].unit;
    node.result = static_cast<Val>(f_.values.size());
    const auto number = static_cast<uint32_t>(f_.nodes.size());
    f_.values.push_back({false, 8, false, 0, number, front});
    f_.nodes.push_back(node);
    f_.blocks[front].nodes.push_back(number);
    made_.push_back(node.result);
    return node.result;
  }

  Function& f_;
  std::vector<Val> made_;
};

}  // namespace

void split_addresses(Function& function) { Places(function).run(); }

bool sink_addresses(Function& f) {
  std::vector<bool> wanted(f.values.size(), false);
  const auto want = [&](Val v) {
    if (v != kNone) wanted[v] = true;
  };
  for (const BasicBlock& block : f.blocks) {
    for (const uint32_t number : block.nodes) {
      const Node& n = f.nodes[number];
      for (const Val v : n.in) want(v);
      want(n.mem.index);
      want(n.mem.pointer);
    }
    for (const Val v : block.end.in) want(v);
    for (const std::vector<Val>& args : block.end.args) {
      for (const Val v : args) want(v);
    }
    for (const Reload& reload : block.reloads) want(reload.value);
    for (const SlotValue& slot : block.dirty) want(slot.value);
  }
  Val none = kNone;
  for (Exit& exit : f.exits) {
    for (SlotValue& slot : exit.slots) {
      const Value& value = f.values[slot.value];
      if (wanted[slot.value] || value.constant || value.node == kNone) continue;
      const Node& made = f.nodes[value.node];
      if (made.op != Op::kAddr || made.mem.base != MemBase::kSelf) continue;
      slot.is_address = true;
      slot.address = made.mem;
      slot.value = made.mem.index;
      if (slot.value != kNone) continue;
      if (none == kNone) {
        none = static_cast<Val>(f.values.size());
        f.values.push_back({false, 8, true, 0, kNone, 0});
        wanted.push_back(true);
      }
      slot.value = none;
    }
  }
  return none != kNone || std::any_of(f.exits.begin(), f.exits.end(), [](const Exit& exit) {
           return std::any_of(exit.slots.begin(), exit.slots.end(),
                              [](const SlotValue& slot) { return slot.is_address; });
         });
}

}  // namespace vm::native
