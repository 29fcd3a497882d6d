// What an operation computes anew in every turn of a loop, though nothing that it reads changes
// there, is computed once, in front of the loop. Only what cannot trap: the loop may make no turn.
//
// Between two turns other tasks may run, so what is read is private to the activation: values from
// in front of the loop, constants, and locals that nobody stores to inside. A loop that more than
// one way leads into has no place in front of it, for a new block would lie where the order of
// blocks, which says what is a back edge, does not expect it.
#include <algorithm>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"
#include "ir/program/dominators.h"

namespace ir::opt {
namespace {

constexpr uint32_t kNoBlock = 0xffffffffu;

class Loops {
 public:
  Loops(const Program& program, Pou& pou)
      : pou_(pou), facts_(program, pou), dominators_(pou), before_(pou.blocks.size()) {}

  bool run() {
    find_ways();
    if (latches_.empty()) return false;
    find_definitions();
    inside_.assign(pou_.blocks.size(), kNoBlock);
    stored_.assign(pou_.locals.size(), kNoBlock);
    // Inner loops first: what is in front of one is inside the next.
    const std::vector<uint32_t>& order = dominators_.order();
    for (size_t i = order.size(); i-- > 0;) {
      if (!latches_[order[i]].empty()) look_at(order[i]);
    }
    return changed_;
  }

 private:
  struct Definition {
    Op op = Op::kReturn;  // kReturn: a parameter of the block
    uint32_t block = 0;
    PlaceId place;
  };

  void find_ways() {
    for (const uint32_t b : dominators_.order()) {
      for (const Target& target : pou_.blocks[b].insts.back().targets) {
        before_[target.block.index].push_back(b);
        if (!dominators_.dominates(target.block.index, b)) continue;
        latches_.resize(pou_.blocks.size());
        latches_[target.block.index].push_back(b);
      }
    }
  }

  void find_definitions() {
    definitions_.resize(pou_.values.size());
    wanted_.resize(pou_.values.size());
    for (uint32_t b = 0; b < pou_.blocks.size(); ++b) {
      for (const ValueId param : pou_.blocks[b].params) definitions_[param.index].block = b;
      for (const Inst& inst : pou_.blocks[b].insts) {
        if (inst.result.valid()) definitions_[inst.result.index] = {inst.op, b, inst.place};
        find_wanted(inst);
      }
    }
  }

  // A value that is only stored, passed to a block or branched on is computed by the instruction
  // that does that, or is the branch: to keep it saves nothing.
  void find_wanted(const Inst& inst) {
    const auto want = [this](ValueId value) { wanted_[value.index] = true; };
    for (const PlaceId id : {inst.place, inst.place2}) {
      if (id.valid()) for_each_value(pou_.places[id.index], want);
    }
    const bool stored = inst.op == Op::kStore && is_static(pou_.places[inst.place.index], facts_);
    if (stored || !inst.targets.empty()) return;
    for (const ValueId operand : inst.operands) want(operand);
  }

  void look_at(uint32_t head) {
    collect(head);
    front_ = kNoBlock;
    for (const uint32_t from : before_[head]) {
      if (is_inside(from)) continue;
      const bool alone = front_ == kNoBlock && pou_.blocks[from].insts.back().targets.size() == 1;
      if (!alone) return;
      front_ = from;
    }
    if (front_ == kNoBlock) return;
    find_stored();
    for (const uint32_t b : body_) {
      std::vector<Inst>& insts = pou_.blocks[b].insts;
      const size_t stay = take_out(insts);
      insts.resize(stay);
    }
  }

  // The blocks of the loop, in an order in which values are made before they are used.
  void collect(uint32_t head) {
    head_ = head;
    body_ = {head};
    inside_[head] = head;
    for (const uint32_t latch : latches_[head]) add(latch);
    for (size_t i = 1; i < body_.size(); ++i) {
      for (const uint32_t from : before_[body_[i]]) add(from);
    }
    std::sort(body_.begin(), body_.end(), [this](uint32_t a, uint32_t b) {
      return dominators_.position(a) < dominators_.position(b);
    });
  }

  void add(uint32_t block) {
    if (inside_[block] == head_) return;
    inside_[block] = head_;
    body_.push_back(block);
  }

  bool is_inside(uint32_t block) const { return inside_[block] == head_; }

  void find_stored() {
    for (const uint32_t b : body_) {
      for (const Inst& inst : pou_.blocks[b].insts) {
        if (inst.op == Op::kLoad) continue;
        for (const PlaceId id : {inst.place, inst.place2}) {
          if (!id.valid() || pou_.places[id.index].base != PlaceBase::kLocal) continue;
          stored_[pou_.places[id.index].base_index] = head_;
        }
      }
    }
  }

  // Takes out what does not change in the loop. Instructions that stay come first, in their order;
  // returns how many they are.
  size_t take_out(std::vector<Inst>& insts) {
    size_t stay = 0;
    for (size_t i = 0; i < insts.size(); ++i) {
      if (is_invariant(insts[i])) {
        move_to_front(std::move(insts[i]));
      } else {
        if (stay != i) insts[stay] = std::move(insts[i]);
        ++stay;
      }
    }
    return stay;
  }

  bool is_invariant(const Inst& inst) const {
    const bool candidate = inst.result.valid() && inst.op != Op::kConst && inst.op != Op::kNot &&
                           wanted_[inst.result.index] && is_pure(inst, facts_.constants);
    return candidate && std::all_of(inst.operands.begin(), inst.operands.end(),
                                    [this](ValueId value) { return is_steady(value); });
  }

  bool is_steady(ValueId value) const {
    const Definition& definition = definitions_[value.index];
    if (!is_inside(definition.block) || definition.op == Op::kConst) return true;
    return definition.op == Op::kLoad && is_steady_local(pou_.places[definition.place.index]);
  }

  bool is_steady_local(const Place& place) const {
    const bool fixed = std::all_of(place.steps.begin(), place.steps.end(), [](const Step& step) {
      return step.kind == StepKind::kMember ||
             (step.kind == StepKind::kIndex && !step.value.valid());
    });
    return place.base == PlaceBase::kLocal && fixed && !facts_.local_escapes(place.base_index) &&
           stored_[place.base_index] != head_;
  }

  void move_to_front(Inst inst) {
    std::vector<Inst>& insts = pou_.blocks[front_].insts;
    inst.line = insts.back().line;
    for (ValueId& operand : inst.operands) operand = in_front(operand, inst.line);
    definitions_[inst.result.index].block = front_;
    insts.insert(insts.end() - 1, std::move(inst));
    changed_ = true;
  }

  // The equal value in front of the loop. Constants and loads of locals are operands of bytecode:
  // to make them again costs nothing.
  ValueId in_front(ValueId value, uint32_t line) {
    const Definition definition = definitions_[value.index];
    if (!is_inside(definition.block)) return value;
    const Scalar scalar = pou_.values[value.index].scalar;
    const ValueId copy = new_value(pou_, scalar);
    Inst inst;
    if (definition.op == Op::kConst) {
      const uint64_t bits = *facts_.constants[value];
      inst = constant_inst(scalar, copy, bits, line);
      facts_.constants.set(copy, bits);
    } else {
      inst.op = Op::kLoad;
      inst.scalar = scalar;
      inst.result = copy;
      inst.place = definition.place;
      inst.line = line;
    }
    definitions_.push_back({definition.op, front_, definition.place});
    wanted_.push_back(true);
    std::vector<Inst>& insts = pou_.blocks[front_].insts;
    insts.insert(insts.end() - 1, std::move(inst));
    return copy;
  }

  Pou& pou_;
  Facts facts_;
  const Dominators dominators_;
  std::vector<std::vector<uint32_t>> before_;   // by block: blocks that lead to it
  std::vector<std::vector<uint32_t>> latches_;  // by head; empty: there is no loop
  std::vector<Definition> definitions_;         // by value
  std::vector<bool> wanted_;                    // by value
  // The head of the loop at hand.
  uint32_t head_ = 0;
  uint32_t front_ = kNoBlock;  // the block in front of it
  std::vector<uint32_t> body_;
  std::vector<uint32_t> inside_;  // by block: head_ when it is in the loop
  std::vector<uint32_t> stored_;  // by local: head_ when it may change in the loop
  bool changed_ = false;
};

// A circle of blocks has a way to a block of no higher number, however they are numbered.
bool goes_back(const Pou& pou) {
  for (uint32_t b = 0; b < pou.blocks.size(); ++b) {
    for (const Target& target : pou.blocks[b].insts.back().targets) {
      if (target.block.index <= b) return true;
    }
  }
  return false;
}

}  // namespace

bool hoist_invariants(const Program& program, Pou& pou) {
  return goes_back(pou) && Loops(program, pou).run();
}

}  // namespace ir::opt
