// Values without uses, and what only they used. Loads go when they cannot trap. Of the locals that
// came with bodies of functions, those go that nothing names any more.
#include <algorithm>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"

namespace ir::opt {
namespace {

class Dead {
 public:
  Dead(const Program& program, Pou& pou)
      : pou_(pou), facts_(program, pou), uses_(count_uses(pou)), places_(pou.values.size()) {}

  // A value without uses releases what it used, so backwards and with a list of what is left.
  bool run() {
    for (uint32_t b = 0; b < pou_.blocks.size(); ++b) {
      for (uint32_t i = 0; i < pou_.blocks[b].insts.size(); ++i) {
        const ValueId result = pou_.blocks[b].insts[i].result;
        if (!result.valid()) continue;
        places_[result.index] = {b, i};
        if (uses_[result.index] == 0) unused_.push_back(result);
      }
    }
    while (!unused_.empty()) {
      const At at = places_[unused_.back().index];
      unused_.pop_back();
      Inst& inst = pou_.blocks[at.block].insts[at.index];
      if (removable(inst)) release(inst);
    }
    if (!removed_) return false;
    for (Block& block : pou_.blocks) {
      std::erase_if(block.insts, [](const Inst& inst) { return inst.op == kGone; });
    }
    return true;
  }

 private:
  static constexpr uint32_t kParam = 0xffffffffu;
  struct At {
    uint32_t block = 0;
    uint32_t index = kParam;  // no instruction makes it
  };
  // Until it is erased; a value of no operation.
  static constexpr Op kGone = static_cast<Op>(0xff);

  bool removable(const Inst& inst) const {
    switch (inst.op) {
      case Op::kLoad:
        return inst.scalar != Scalar::kAddr && is_static(pou_.places[inst.place.index], facts_);
      case Op::kAddress:
      case Op::kString:
        return is_static(pou_.places[inst.place.index], facts_);
      case Op::kSizeOf:
      case Op::kTaskTime:
      case Op::kMoveHandle:
        return true;
      case Op::kCallNative:
        return is_pure_native(inst);
      default:
        return is_pure(inst, facts_.constants);
    }
  }

  void release(Inst& inst) {
    const auto drop = [this](ValueId value) {
      if (--uses_[value.index] == 0 && places_[value.index].index != kParam) {
        unused_.push_back(value);
      }
    };
    for_each_operand(inst, drop);
    if (inst.place.valid()) for_each_value(pou_.places[inst.place.index], drop);
    inst.op = kGone;
    removed_ = true;
  }

  Pou& pou_;
  Facts facts_;
  std::vector<uint32_t> uses_;
  std::vector<At> places_;  // of definitions
  std::vector<ValueId> unused_;
  bool removed_ = false;
};

void remove_unused_locals(Pou& pou) {
  const auto came_later = [](const Local& local) {
    return local.name.find('.') != std::string::npos;
  };
  if (std::none_of(pou.locals.begin(), pou.locals.end(), came_later)) return;
  std::vector<bool> used(pou.locals.size());
  for (const Block& block : pou.blocks) {
    for (const Inst& inst : block.insts) {
      for (const PlaceId id : {inst.place, inst.place2}) {
        if (!id.valid()) continue;
        const Place& place = pou.places[id.index];
        if (place.base == PlaceBase::kLocal) used[place.base_index] = true;
      }
    }
  }
  std::vector<uint32_t> number(pou.locals.size());
  std::vector<Local> kept;
  for (size_t i = 0; i < pou.locals.size(); ++i) {
    number[i] = static_cast<uint32_t>(kept.size());
    if (used[i] || !came_later(pou.locals[i])) kept.push_back(std::move(pou.locals[i]));
  }
  pou.locals = std::move(kept);
  for (Place& place : pou.places) {
    if (place.base == PlaceBase::kLocal) place.base_index = number[place.base_index];
  }
}

}  // namespace

bool remove_dead(const Program& program, Pou& pou) {
  const bool removed = Dead(program, pou).run();
  remove_unused_locals(pou);
  return removed;
}

}  // namespace ir::opt
