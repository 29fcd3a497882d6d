// Calls of small functions become their bodies. A trap names its POU and line, so what
// may trap is never inlined; without loops and calls of its own, a body has no safe point either.
// The locals of the function become locals of the caller, one set for each call; what is left of
// them when the other passes are done is little.
//
// Whoever holds a body depends on it: the code is part of the caller's object, so a change of the
// function is a change of the caller's digest (docs/adr/0022-optimiser.md).
#include <algorithm>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"
#include "ir/program/dominators.h"

namespace ir::opt {
namespace {

constexpr uint32_t kMaxSize = 20;  // of a function: instructions, without loads and constants
constexpr size_t kMaxLocals = 16;
constexpr size_t kMaxBlocks = 12;
constexpr uint32_t kMaxGrowth = 4000;  // of a caller: instructions that it takes in

bool is_plain_place(const Place& place, const Facts& facts) {
  const bool base = place.base == PlaceBase::kLocal || place.base == PlaceBase::kGlobal;
  return base && is_static(place, facts);
}

// Instructions that a body adds; 0 when it cannot be taken in.
class Candidate {
 public:
  Candidate(const Program& program, const Pou& pou) : program_(program), pou_(pou) {}

  uint32_t size() const {
    if (pou_.kind != PouKind::kFunction || pou_.recursion_depth != 0) return 0;
    if (pou_.blocks.size() > kMaxBlocks || pou_.locals.size() > kMaxLocals) return 0;
    size_t all = 0;
    for (const Block& block : pou_.blocks) all += block.insts.size();
    if (all > 4 * kMaxSize || !has_plain_locals() || has_loop()) return 0;
    const Facts facts(program_, pou_);
    uint32_t size = 1;
    for (const Block& block : pou_.blocks) {
      for (const Inst& inst : block.insts) {
        if (!fits(inst, facts)) return 0;
        size += inst.op != Op::kConst && inst.op != Op::kLoad && inst.op != Op::kReturn;
      }
    }
    return size <= kMaxSize ? size : 0;
  }

 private:
  bool has_plain_locals() const {
    return std::all_of(pou_.locals.begin(), pou_.locals.end(), [this](const Local& local) {
      return local.kind != LocalKind::kInOut && program_.types.is_scalar(local.type);
    });
  }

  bool has_loop() const {
    std::vector<uint32_t> position(pou_.blocks.size());
    const std::vector<uint32_t> order = reverse_post_order(pou_);
    for (uint32_t i = 0; i < order.size(); ++i) position[order[i]] = i;
    for (const uint32_t b : order) {
      for (const Target& target : pou_.blocks[b].insts.back().targets) {
        if (position[target.block.index] <= position[b]) return true;
      }
    }
    return false;
  }

  bool fits(const Inst& inst, const Facts& facts) const {
    switch (inst.op) {
      case Op::kLoad:
      case Op::kStore:
        return inst.scalar != Scalar::kAddr && is_plain_place(pou_.places[inst.place.index], facts);
      case Op::kTaskTime:
      case Op::kSizeOf:
      case Op::kJump:
      case Op::kBranch:
      case Op::kSwitch:
      case Op::kReturn:
        return true;
      case Op::kCallNative:
        return is_pure_native(inst);
      default:
        return is_pure(inst, facts.constants);
    }
  }

  const Program& program_;
  const Pou& pou_;
};

class Inliner {
 public:
  Inliner(const Program& program, Pou& pou) : program_(program), pou_(pou) {}

  bool run() {
    find_candidates();
    if (sizes_.empty()) return false;
    keep_results_that_travel();
    const size_t blocks = pou_.blocks.size();
    for (size_t b = 0; b < blocks; ++b) take_in(static_cast<uint32_t>(b));
    return growth_ != 0;
  }

 private:
  struct Callee {
    PouId pou;
    uint32_t size;
  };

  uint32_t size_of(PouId callee) const {
    for (const Callee& row : sizes_) {
      if (row.pou == callee) return row.size;
    }
    return 0;
  }

  void find_candidates() {
    std::vector<bool> seen;
    for (const Block& block : pou_.blocks) {
      for (const Inst& inst : block.insts) {
        if (inst.op != Op::kCallFunction) continue;
        seen.resize(program_.pous.size());
        if (seen[inst.pou.index]) continue;
        seen[inst.pou.index] = true;
        const Pou& callee = program_.pous[inst.pou.index];
        const uint32_t size = &callee == &pou_ ? 0 : Candidate(program_, callee).size();
        if (size != 0) sizes_.push_back({inst.pou, size});
      }
    }
  }

  // A result that is read in another block than its call's stays in the next frame.
  void keep_results_that_travel() {
    for (const Block& block : pou_.blocks) {
      PouId last;
      for (const Inst& inst : block.insts) {
        if (inst.op == Op::kCallFunction) last = inst.pou;
        for (const PlaceId id : {inst.place, inst.place2}) {
          if (!id.valid() || inst.op == Op::kStore) continue;
          const Place& place = pou_.places[id.index];
          const bool read = inst.op == Op::kLoad || id == inst.place2;
          if (place.base != PlaceBase::kArg || !read || place.pou == last) continue;
          std::erase_if(sizes_, [&](const Callee& row) { return row.pou == place.pou; });
        }
      }
    }
  }

  void take_in(uint32_t number) {
    const std::vector<uint32_t> first_local = choose_calls(pou_.blocks[number]);
    if (first_local.empty()) return;
    std::vector<Inst> old = std::move(pou_.blocks[number].insts);
    pou_.blocks[number].insts.clear();
    at_ = number;
    // Locals of the call that the instruction's arguments are for, and of the last one.
    std::vector<uint32_t> next(old.size(), kNone);
    for (size_t i = old.size(); i-- > 1;) {
      next[i - 1] = takes_next_frame(old[i].op) ? first_local[i] : next[i];
    }
    uint32_t last = kNone;
    for (size_t i = 0; i < old.size(); ++i) {
      use_locals(old[i], next[i], last);
      if (takes_next_frame(old[i].op)) last = first_local[i];
      if (first_local[i] != kNone) {
        splice(program_.pous[old[i].pou.index], first_local[i], old[i].line);
      } else {
        pou_.blocks[at_].insts.push_back(std::move(old[i]));
      }
    }
  }

  // For each instruction the first local of the call that it is, kNone for others; empty when none
  // is taken in.
  std::vector<uint32_t> choose_calls(const Block& block) {
    std::vector<uint32_t> first_local;
    for (size_t i = 0; i < block.insts.size(); ++i) {
      const Inst& inst = block.insts[i];
      const uint32_t size = inst.op == Op::kCallFunction ? size_of(inst.pou) : 0;
      if (size == 0 || growth_ + size > kMaxGrowth) continue;
      growth_ += size;
      note(inst.pou);
      first_local.resize(block.insts.size(), kNone);
      first_local[i] = add_locals(program_.pous[inst.pou.index]);
    }
    return first_local;
  }

  // Callees come before their callers, so what they have taken in is known.
  void note(PouId callee) {
    const auto add = [&](PouId pou) {
      std::vector<PouId>& taken = pou_.taken_in;
      if (std::find(taken.begin(), taken.end(), pou) == taken.end()) taken.push_back(pou);
    };
    add(callee);
    for (const PouId pou : program_.pous[callee.index].taken_in) add(pou);
  }

  // A dot in the name: no source has one, so these locals can go when they are unused.
  uint32_t add_locals(const Pou& callee) {
    const uint32_t first = static_cast<uint32_t>(pou_.locals.size());
    for (const Local& local : callee.locals) {
      pou_.locals.push_back({callee.name + "." + local.name, local.type, LocalKind::kTemp});
    }
    return first;
  }

  static bool takes_next_frame(Op op) { return is_call(op) || op == Op::kCallNative; }

  void use_locals(Inst& inst, uint32_t next, uint32_t last) {
    const bool reads = inst.op == Op::kLoad;
    inst.place = with_locals(inst.place, reads ? last : next);
    inst.place2 = with_locals(inst.place2, last);
  }

  PlaceId with_locals(PlaceId id, uint32_t first_local) {
    if (!id.valid() || first_local == kNone) return id;
    if (pou_.places[id.index].base != PlaceBase::kArg) return id;
    Place place = pou_.places[id.index];
    place.base = PlaceBase::kLocal;
    place.base_index += first_local;
    place.pou = PouId();
    return add_place(std::move(place));
  }

  PlaceId add_place(Place place) {
    pou_.places.push_back(std::move(place));
    return PlaceId(static_cast<uint32_t>(pou_.places.size() - 1));
  }

  // The body goes to the end of block `at_`; with several blocks, what follows gets a block.
  void splice(const Pou& callee, uint32_t first_local, uint32_t line) {
    const uint32_t first_value = static_cast<uint32_t>(pou_.values.size());
    pou_.values.insert(pou_.values.end(), callee.values.begin(), callee.values.end());
    const bool straight = callee.blocks.size() == 1;
    const uint32_t first_block = static_cast<uint32_t>(pou_.blocks.size());
    const BlockId behind(first_block + static_cast<uint32_t>(callee.blocks.size()));
    if (!straight) {
      const BlockId handler = pou_.blocks[at_].handler;
      pou_.blocks[at_].insts.push_back(jump_to(BlockId(first_block), line));
      pou_.blocks.resize(behind.index + 1);
      for (uint32_t b = first_block; b <= behind.index; ++b) pou_.blocks[b].handler = handler;
    }
    for (size_t b = 0; b < callee.blocks.size(); ++b) {
      Block& to = pou_.blocks[straight ? at_ : first_block + b];
      for (const ValueId param : callee.blocks[b].params) {
        to.params.push_back(ValueId(param.index + first_value));
      }
      for (const Inst& inst : callee.blocks[b].insts) {
        if (inst.op == Op::kReturn) {
          if (!straight) to.insts.push_back(jump_to(behind, line));
          continue;
        }
        to.insts.push_back(moved(callee, inst, {first_local, first_value, first_block, line}));
      }
    }
    if (!straight) at_ = behind.index;
  }

  static Inst jump_to(BlockId block, uint32_t line) {
    Inst jump;
    jump.op = Op::kJump;
    jump.line = line;
    jump.targets.push_back({block, {}});
    return jump;
  }

  struct Offsets {
    uint32_t local;
    uint32_t value;
    uint32_t block;
    uint32_t line;
  };

  Inst moved(const Pou& callee, const Inst& from, const Offsets& by) {
    const auto move = [&by](ValueId& value) { value = ValueId(value.index + by.value); };
    Inst inst = from;
    inst.line = by.line;
    if (inst.result.valid()) move(inst.result);
    for_each_operand(inst, move);
    for (Target& target : inst.targets) target.block = BlockId(target.block.index + by.block);
    if (inst.place.valid()) {
      Place place = callee.places[inst.place.index];
      if (place.base == PlaceBase::kLocal) place.base_index += by.local;
      for_each_value(place, move);
      inst.place = add_place(std::move(place));
    }
    return inst;
  }

  static constexpr uint32_t kNone = 0xffffffffu;

  const Program& program_;
  Pou& pou_;
  std::vector<Callee> sizes_;
  uint32_t growth_ = 0;
  uint32_t at_ = 0;  // the block that is being filled
};

}  // namespace

bool inline_functions(const Program& program, Pou& pou) { return Inliner(program, pou).run(); }

uint32_t inlined_size(const Program& program, const Pou& pou) {
  return Candidate(program, pou).size();
}

}  // namespace ir::opt
