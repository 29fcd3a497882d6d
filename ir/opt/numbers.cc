// Value numbering. Each value gets a number; values of one number are equal. Along blocks
// that have one way in, an operation on the same numbers, and a load of the same place without a
// write in between, is not done again.
//
// In bytecode a variable at a fixed place is an operand, so loading it again costs nothing while
// keeping it in a temporary does. Such loads only share a number; they are replaced inside one
// block, where no temporary is made, or by constants. What takes an instruction to reach (an index,
// an instance, a reference) is replaced by what was loaded before. Likewise a cheap operation
// whose result goes into a variable is done there, as fast as a move.
#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"
#include "ir/program/dominators.h"
#include "ir/program/eval_scalar.h"

namespace ir::opt {
namespace {

constexpr size_t kMaxKnown = 48;  // places that a block remembers; the oldest go
constexpr int kMaxWay = 12;       // blocks to look back for operations
constexpr uint32_t kNobody = 0xffffffffu;

struct Key {
  Op op = Op::kConst;
  Scalar scalar = Scalar::kBool;
  std::array<uint32_t, 3> operands{};
  uint64_t low = 0;
  uint64_t high = 0;
  friend bool operator==(const Key&, const Key&) = default;
};

uint64_t hash_of(const Key& key) {
  uint64_t hash = static_cast<uint64_t>(key.op) << 8 | static_cast<uint64_t>(key.scalar);
  const uint64_t both = uint64_t{key.operands[0]} << 32 | key.operands[1];
  for (const uint64_t part : {both, key.operands[2] ^ key.high, key.low}) {
    hash = (hash ^ part) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return hash;
}

struct Operation {
  Key key;
  ValueId value;
  uint32_t block = 0;
};

// The last value that was computed for each key, and where. Open addressing, of fixed size.
class Operations {
 public:
  explicit Operations(size_t most) : slots_(std::bit_ceil(2 * most + 1), kNobody) {
    rows_.reserve(most);
  }
  // The row of the key, until the next call; without a value when the key is new.
  Operation& at(const Key& key) {
    const size_t mask = slots_.size() - 1;
    for (size_t i = hash_of(key) & mask;; i = (i + 1) & mask) {
      if (slots_[i] != kNobody && rows_[slots_[i]].key != key) continue;
      if (slots_[i] != kNobody) return rows_[slots_[i]];
      slots_[i] = static_cast<uint32_t>(rows_.size());
      return rows_.emplace_back(Operation{key, {}, 0});
    }
  }

 private:
  std::vector<uint32_t> slots_;  // numbers of rows
  std::vector<Operation> rows_;
};

// Equal for places that are the same, whatever their indices are.
uint32_t hash_of(const Place& place) {
  uint32_t hash =
      static_cast<uint32_t>(place.base) << 16 ^ place.base_index ^ place.type.index << 8;
  for (const Step& step : place.steps) {
    hash = (hash << 7 ^ hash >> 25) + static_cast<uint32_t>(step.kind) + 4 * step.index;
  }
  return hash;
}

// Instructions that may have a key.
size_t count_operations(const Pou& pou) {
  size_t count = 0;
  for (const Block& block : pou.blocks) {
    for (const Inst& inst : block.insts) count += inst.result.valid() && inst.op != Op::kLoad;
  }
  return count;
}

// What is known of a place without looking at it.
struct PlaceNumbers {
  uint32_t hash = 0;
  uint32_t area = 0;  // places with different ones never meet; 0: may be anywhere
};

struct Known {
  PlaceNumbers numbers;  // of the place
  PlaceId place;
  ValueId value;
  bool stored = false;  // by a store; else loaded
  uint32_t block = 0;
};

// No floats: of two that are no numbers the first one comes out (ir/types/not_a_number.h).
bool commutes(Op op, Scalar scalar) {
  if (op == Op::kAdd || op == Op::kMul) return !is_float(scalar);
  return op == Op::kAnd || op == Op::kOr || op == Op::kXor || op == Op::kEq || op == Op::kNe;
}

class Numbers {
 public:
  Numbers(const Program& program, Pou& pou)
      : pou_(pou),
        facts_(program, pou),
        uses_(count_uses(pou)),
        goes_to_memory_(pou.values.size()),
        number_(pou.values.size()),
        same_(pou),
        operations_(count_operations(pou)),
        known_at_end_(pou.blocks.size()),
        before_(pou.blocks.size(), kNobody) {
    for (uint32_t v = 0; v < number_.size(); ++v) number_[v] = v;
    places_.reserve(pou.places.size());
    for (const Place& each : pou.places) places_.push_back({hash_of(each), area_of(each)});
  }

  bool run() {
    find_destinations();
    const Entries entries = count_entries(pou_);
    const auto follows = [&](uint32_t from, uint32_t to) {
      return entries.count[to] == 1 && !is_handler_entry(from, to);
    };
    for (const uint32_t b : reverse_post_order(pou_)) {
      block_ = b;
      known_.clear();
      if (const uint32_t from = entries.from[b]; b != 0 && follows(from, b)) {
        before_[b] = from;
        known_ = known_at_end_[from];
      }
      for (const Inst& inst : pou_.blocks[b].insts) look_at(inst);
      const Targets& targets = pou_.blocks[b].insts.back().targets;
      const bool wanted = std::any_of(targets.begin(), targets.end(), [&](const Target& target) {
        return follows(b, target.block.index);
      });
      if (wanted) known_at_end_[b] = known_;
    }
    if (same_.empty()) return false;
    // Repeated operations that could trap go, too: they did not trap the first time.
    for (Block& block : pou_.blocks) {
      std::erase_if(block.insts, [this](const Inst& inst) {
        return inst.result.valid() && same_(inst.result) != inst.result;
      });
    }
    same_.apply(pou_);
    return true;
  }

 private:
  bool is_handler_entry(uint32_t from, uint32_t to) const {
    const Inst& end = pou_.blocks[from].insts.back();
    return end.op == Op::kTry && end.targets[1].block.index == to;
  }

  // The area of a place that begins with a member of the own instance or of the globals, and stays
  // there: such places meet only when that member is the same.
  static uint32_t area_of(const Place& place) {
    const bool base = place.base == PlaceBase::kSelf || place.base == PlaceBase::kGlobal;
    const bool apart = base && !place.steps.empty() && place.steps[0].kind == StepKind::kMember &&
                       std::all_of(place.steps.begin(), place.steps.end(), [](const Step& step) {
                         return step.kind == StepKind::kMember || step.kind == StepKind::kIndex;
                       });
    if (!apart) return 0;
    return 2 * place.steps[0].index + (place.base == PlaceBase::kSelf ? 2 : 3);
  }

  // What is stored there is not what is read after it while the variable is forced: such stores
  // are gone then, and everything else stays (docs/adr/0026-forced-versions.md). Of places in the
  // frame only what in-outs lead to can be forced.
  static bool can_be_forced(const Place& place) {
    return place.base != PlaceBase::kLocal ||
           std::any_of(place.steps.begin(), place.steps.end(), [](const Step& step) {
             return step.kind == StepKind::kDeref || step.kind == StepKind::kEnter;
           });
  }

  // Values that are computed right where they are wanted: stored, or passed to a parameter.
  void find_destinations() {
    for (const Block& block : pou_.blocks) {
      for (const Inst& inst : block.insts) {
        if (inst.op == Op::kStore && is_static(pou_.places[inst.place.index], facts_)) {
          goes_to_memory_[inst.operands[0].index] = true;
        }
        for (const Target& target : inst.targets) {
          for (const ValueId arg : target.args) goes_to_memory_[arg.index] = true;
        }
      }
    }
  }

  void look_at(const Inst& inst) {
    if (inst.op == Op::kConst) return number_constant(inst);
    if (inst.op == Op::kLoad) return load(inst);
    if (inst.op == Op::kStore) return store(inst);
    if (inst.op == Op::kCopy || inst.op == Op::kInit) return forget(inst.place);
    if (inst.op == Op::kCallNative) native(inst);
    if (is_call(inst.op)) {
      std::erase_if(known_, [this](const Known& known) {
        return calls_may_change(place(known.place), facts_);
      });
    }
    if (is_scalar_operation(inst.op) || inst.op == Op::kSizeOf || is_pure_native(inst)) {
      operation(inst);
    }
  }

  const Place& place(PlaceId id) const { return pou_.places[id.index]; }
  uint32_t number(ValueId value) const { return number_[value.index]; }

  void number_constant(const Inst& inst) {
    Key key{Op::kConst, inst.scalar, {}, *facts_.constants[inst.result], 0};
    Operation& row = operations_.at(key);
    if (!row.value.valid()) row.value = inst.result;
    number_[inst.result.index] = row.value.index;
  }

  // --- operations -------------------------------------------------------------------

  void operation(const Inst& inst) {
    if (inst.operands.size() > 3) return;
    Key key{inst.op,
            inst.scalar,
            {},
            static_cast<uint64_t>(inst.low),
            static_cast<uint64_t>(inst.high)};
    for (size_t i = 0; i < inst.operands.size(); ++i) key.operands[i] = number(inst.operands[i]);
    if (commutes(inst.op, inst.scalar) && key.operands[0] > key.operands[1]) {
      std::swap(key.operands[0], key.operands[1]);
    }
    if (inst.op == Op::kSizeOf) key.low = inst.type.index;
    if (inst.op == Op::kCallNative) key.low = uint64_t{inst.native} << 8 | inst.operands.size();
    // A conversion's meaning depends on what it converts from.
    if (!inst.operands.empty()) {
      key.high ^= static_cast<uint64_t>(pou_.values[inst.operands[0].index].scalar) << 56;
    }
    Operation& row = operations_.at(key);
    if (!row.value.valid() || !leads_here(row.block)) {
      row.value = inst.result;
      row.block = block_;
      return;
    }
    const ValueId leader = row.value;
    number_[inst.result.index] = number(leader);
    if (pays(inst, leader)) replace(inst.result, leader);
  }

  bool leads_here(uint32_t block) const {
    uint32_t at = block_;
    for (int back = 0; back < kMaxWay && at != kNobody; ++back) {
      if (at == block) return true;
      at = before_[at];
    }
    return false;
  }

  static bool is_expensive(const Inst& inst) {
    switch (inst.op) {
      case Op::kDiv:
      case Op::kMod:
      case Op::kSqrt:
      case Op::kCallNative:
      case Op::kCheckRange:
      case Op::kCheckStep:
      case Op::kRound:
      case Op::kTrunc:
        return true;
      default:
        return false;
    }
  }

  // Does it take fewer instructions to keep `leader` than to compute it again?
  bool pays(const Inst& inst, ValueId leader) const {
    if (is_expensive(inst)) return true;
    // NOT becomes a part of what uses it.
    if (inst.op == Op::kNot && inst.scalar == Scalar::kBool) return false;
    if (uses_[leader.index] > 1) return true;
    return !goes_to_memory_[leader.index] && !goes_to_memory_[inst.result.index];
  }

  void replace(ValueId value, ValueId by) {
    same_.replace(value, by);
    uses_[by.index] += uses_[value.index];
    goes_to_memory_[by.index] = goes_to_memory_[by.index] || goes_to_memory_[value.index];
  }

  // --- memory -----------------------------------------------------------------------

  std::optional<int64_t> index_of(const Step& step) const {
    return step.value.valid() ? facts_.constant_index(step.value) : step.constant_index;
  }

  bool same_step(const Step& a, const Step& b) const {
    if (a.kind != b.kind || a.index != b.index) return false;
    if (a.kind != StepKind::kIndex) return true;
    if (a.value.valid() && b.value.valid() && number(a.value) == number(b.value)) return true;
    const std::optional<int64_t> left = index_of(a);
    return left && left == index_of(b);
  }

  bool same_place(const Place& a, const Place& b) const {
    const bool root = a.base == b.base && a.base_index == b.base_index && a.pou == b.pou &&
                      a.constant == b.constant && a.base_type == b.base_type && a.type == b.type &&
                      a.value.valid() == b.value.valid() && a.steps.size() == b.steps.size();
    if (!root || (a.value.valid() && number(a.value) != number(b.value))) return false;
    for (size_t i = 0; i < a.steps.size(); ++i) {
      if (!same_step(a.steps[i], b.steps[i])) return false;
    }
    return true;
  }

  void load(const Inst& inst) {
    if (inst.scalar == Scalar::kAddr) return;
    const PlaceNumbers numbers = places_[inst.place.index];
    for (Known& known : known_) {
      if (known.numbers.hash != numbers.hash || !same_place(place(known.place), place(inst.place)))
        continue;
      if (pou_.values[known.value.index].scalar != inst.scalar) return;
      const bool here = known.block == block_;
      const bool fixed = is_static(place(inst.place), facts_);
      if (known.stored && can_be_forced(place(inst.place))) {
        known = {numbers, inst.place, inst.result, false, block_};
        return;
      }
      number_[inst.result.index] = number(known.value);
      const bool pays = facts_.constants.known(known.value) ||
                        (fixed ? here && !known.stored : here || !known.stored);
      if (pays) return replace(inst.result, known.value);
      known = {numbers, inst.place, inst.result, false, block_};
      return;
    }
    remember({numbers, inst.place, inst.result, false, block_});
  }

  void remember(const Known& known) {
    if (known_.size() >= kMaxKnown) known_.erase(known_.begin(), known_.begin() + kMaxKnown / 4);
    known_.push_back(known);
  }

  void store(const Inst& inst) {
    const Place& written = place(inst.place);
    if (inst.scalar == Scalar::kAddr) {
      // Another target: places behind in-outs are others now.
      if (written.base != PlaceBase::kArg) known_.clear();
      return;
    }
    forget(inst.place);
    remember({places_[inst.place.index], inst.place, inst.operands[0], true, block_});
  }

  void forget(PlaceId written) {
    const uint32_t area = places_[written.index].area;
    std::erase_if(known_, [&](const Known& known) {
      const bool apart = area != 0 && known.numbers.area != 0 && known.numbers.area != area;
      return !apart && may_alias(place(known.place), place(written), facts_);
    });
  }

  // A native function uses the next frame, and writes into the string that it is given.
  void native(const Inst& inst) {
    const bool strings = !is_pure_native(inst);
    std::erase_if(known_, [&](const Known& known) {
      const Place& at = place(known.place);
      if (at.base == PlaceBase::kArg) return true;
      return strings &&
             (calls_may_change(at, facts_) || (at.base == PlaceBase::kLocal && !at.steps.empty()));
    });
  }

  Pou& pou_;
  Facts facts_;
  std::vector<uint32_t> uses_;
  std::vector<bool> goes_to_memory_;
  std::vector<uint32_t> number_;
  Replacements same_;
  Operations operations_;
  std::vector<Known> known_;                      // at the instruction at hand
  std::vector<std::vector<Known>> known_at_end_;  // of blocks that others follow
  std::vector<uint32_t> before_;                  // the block that leads here, or kNobody
  std::vector<PlaceNumbers> places_;
  uint32_t block_ = 0;
};

}  // namespace

bool number_values(const Program& program, Pou& pou) { return Numbers(program, pou).run(); }

}  // namespace ir::opt
