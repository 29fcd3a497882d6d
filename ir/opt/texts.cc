// Texts that functions make in temporaries. One that is only assigned is made where it goes to, and
// one that is only joined with another text is no text of its own: three are joined at once.
// Nothing of that shows: a temporary is at least as long as what the text goes to, and no text is
// written while a part of it is read.
#include <algorithm>
#include <unordered_map>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"
#include "ir/program/eval_scalar.h"
#include "stdlib/native/natives.h"

namespace ir::opt {
namespace {

using stdlib::NativeId;

constexpr Op kGone = static_cast<Op>(0xff);  // until it is erased
constexpr size_t kFarthest = 64;             // instructions from the making of a text to its use
constexpr uint32_t kLongestNumber = 20;

bool is(const Inst& inst, NativeId id) {
  return inst.op == Op::kCallNative && inst.native == static_cast<uint32_t>(id);
}
// A text is its result: it is written through the first operand.
bool makes_text(const Inst& inst) {
  return inst.op == Op::kCallNative && stdlib::native_row(inst.native).result == 'v';
}

class Texts {
 public:
  Texts(const Program& program, Pou& pou)
      : types_(program.types),
        pou_(pou),
        facts_(program, pou),
        uses_(count_uses(pou)),
        named_(pou.locals.size()) {
    for (const Block& block : pou.blocks) {
      for (const Inst& inst : block.insts) {
        for (const PlaceId id : {inst.place, inst.place2}) {
          if (!id.valid() || pou.places[id.index].base != PlaceBase::kLocal) continue;
          ++named_[pou.places[id.index].base_index];
        }
      }
    }
  }

  bool run() {
    for (Block& block : pou_.blocks) {
      insts_ = &block.insts;
      places_.clear();
      makers_.clear();
      destinations_.clear();
      for (size_t i = 0; i < block.insts.size(); ++i) look_at(i);
      if (changed_) finish(block);
    }
    return changed_;
  }

 private:
  struct Destination {
    size_t before = 0;
    Inst string;
  };

  void look_at(size_t i) {
    Inst& inst = (*insts_)[i];
    if (inst.op == Op::kString) places_[inst.result.index] = inst.place;
    if (inst.op == Op::kCopy) return assign(i);
    if (!makes_text(inst)) return;
    join(i);
    const std::optional<uint32_t> local = temporary(inst.operands[0]);
    if (local) makers_[*local] = i;
  }

  const Place* place_of(ValueId text) const {
    const auto found = places_.find(text.index);
    return found == places_.end() ? nullptr : &pou_.places[found->second.index];
  }

  // The temporary that is made and used once, as a whole.
  std::optional<uint32_t> temporary(const Place& place) const {
    if (place.base != PlaceBase::kLocal || !place.steps.empty()) return std::nullopt;
    const uint32_t local = place.base_index;
    const bool good = pou_.locals[local].kind == LocalKind::kTemp && named_[local] == 2 &&
                      !facts_.local_escapes(local);
    return good ? std::optional(local) : std::nullopt;
  }
  std::optional<uint32_t> temporary(ValueId text) const {
    const Place* const place = place_of(text);
    return place == nullptr || uses_[text.index] != 1 ? std::nullopt : temporary(*place);
  }

  // Where the text in `local` was made, when it may as well be made at `i`, in `to`.
  std::optional<size_t> maker(uint32_t local, size_t i, const Place& to) const {
    const auto found = makers_.find(local);
    if (found == makers_.end() || i - found->second > kFarthest) return std::nullopt;
    const size_t at = found->second;
    const Inst& made = (*insts_)[at];
    if (made.op == kGone) return std::nullopt;
    for (size_t k = 1; k < made.operands.size(); ++k) {
      const char letter = stdlib::native_row(made.native).arguments[k];
      if (letter != 'S' && letter != 'W') continue;
      const Place* const source = place_of(made.operands[k]);
      if (source == nullptr || may_alias(to, *source, facts_)) return std::nullopt;
      for (size_t n = at + 1; n < i; ++n) {
        if (may_write((*insts_)[n], *source)) return std::nullopt;
      }
    }
    for (size_t n = at + 1; n < i; ++n) {
      if (!is_quiet((*insts_)[n])) return std::nullopt;
    }
    return at;
  }

  // Nobody sees from it what a temporary holds.
  static bool is_quiet(const Inst& inst) {
    return inst.op == kGone || inst.op == Op::kConst || inst.op == Op::kLoad ||
           inst.op == Op::kString || inst.op == Op::kCallNative || is_scalar_operation(inst.op);
  }
  bool may_write(const Inst& inst, const Place& place) const {
    if (!makes_text(inst)) return false;
    const Place* const to = place_of(inst.operands[0]);
    return to == nullptr || may_alias(*to, place, facts_);
  }

  uint32_t capacity(const Place& place) const { return types_[place.type].capacity; }

  // May the text be too long for the temporary, and yet not for where it goes?
  bool is_cut(const Inst& made, const Place& temporary, const Place& to) const {
    if (capacity(temporary) >= capacity(to)) return false;
    const bool number = is(made, NativeId::kI64ToString) || is(made, NativeId::kU64ToString);
    if (number) return capacity(temporary) < kLongestNumber;
    if (!joins(made)) return true;
    uint64_t sum = 0;
    for (size_t k = 1; k < made.operands.size(); ++k) sum += capacity(*place_of(made.operands[k]));
    return sum > capacity(temporary);
  }
  static bool joins(const Inst& inst) {
    return is(inst, NativeId::kConcatS) || is(inst, NativeId::kConcatW) ||
           is(inst, NativeId::kConcat3S) || is(inst, NativeId::kConcat3W);
  }

  // CONCAT(a, b) and a third text, in front of it or after it.
  void join(size_t i) {
    Inst& inst = (*insts_)[i];
    const bool narrow = is(inst, NativeId::kConcatS);
    if (!narrow && !is(inst, NativeId::kConcatW)) return;
    const Place* const to = place_of(inst.operands[0]);
    if (to == nullptr) return;
    for (size_t k = 1; k <= 2; ++k) {
      const std::optional<uint32_t> local = temporary(inst.operands[k]);
      if (!local) continue;
      const std::optional<size_t> at = maker(*local, i, *to);
      if (!at || (*insts_)[*at].native != inst.native) continue;
      Inst& first = (*insts_)[*at];
      if (is_cut(first, *place_of(inst.operands[k]), *to)) continue;
      inst.operands.insert(inst.operands.begin() + static_cast<ptrdiff_t>(k) + 1,
                           first.operands[2]);
      inst.operands[k] = first.operands[1];
      inst.native = static_cast<uint32_t>(narrow ? NativeId::kConcat3S : NativeId::kConcat3W);
      first.op = kGone;
      changed_ = true;
      return;
    }
  }

  // The frame of the next call is none to write to: a native function has its arguments there.
  static bool is_plain(const Place& place) {
    const bool base = place.base == PlaceBase::kLocal || place.base == PlaceBase::kSelf ||
                      place.base == PlaceBase::kGlobal;
    return base && std::none_of(place.steps.begin(), place.steps.end(),
                                [](const Step& step) { return step.kind == StepKind::kDeref; });
  }

  void assign(size_t i) {
    Inst& inst = (*insts_)[i];
    const Place& to = pou_.places[inst.place.index];
    const Place& from = pou_.places[inst.place2.index];
    const Kind kind = types_[to.type].kind;
    if (kind != Kind::kString && kind != Kind::kWstring) return;
    if (!is_plain(to)) return;
    if (to.base == PlaceBase::kLocal && pou_.locals[to.base_index].kind == LocalKind::kInOut) {
      return;
    }
    const std::optional<uint32_t> local = temporary(from);
    const std::optional<size_t> at = local ? maker(*local, i, to) : std::nullopt;
    if (!at || is_cut((*insts_)[*at], from, to)) return;
    Inst string;
    string.op = Op::kString;
    string.scalar = kind == Kind::kString ? Scalar::kStr : Scalar::kWstr;
    string.place = inst.place;
    string.line = inst.line;
    string.result = new_value(pou_, string.scalar);
    Inst call = (*insts_)[*at];
    call.operands[0] = string.result;
    (*insts_)[*at].op = kGone;
    inst = std::move(call);
    destinations_.push_back({i, std::move(string)});
    changed_ = true;
  }

  void finish(Block& block) {
    std::vector<Inst> kept;
    auto next = destinations_.begin();
    for (size_t i = 0; i < block.insts.size(); ++i) {
      if (next != destinations_.end() && next->before == i)
        kept.push_back(std::move(next++->string));
      if (block.insts[i].op != kGone) kept.push_back(std::move(block.insts[i]));
    }
    block.insts = std::move(kept);
  }

  const TypeTable& types_;
  Pou& pou_;
  Facts facts_;
  std::vector<uint32_t> uses_;
  std::vector<uint32_t> named_;  // by local: how many instructions name it
  std::vector<Inst>* insts_ = nullptr;
  std::unordered_map<uint32_t, PlaceId> places_;  // of the block's texts, by value
  std::unordered_map<uint32_t, size_t> makers_;   // of the texts in temporaries
  std::vector<Destination> destinations_;
  bool changed_ = false;
};

}  // namespace

bool place_texts(const Program& program, Pou& pou) {
  const bool any = std::any_of(pou.blocks.begin(), pou.blocks.end(), [](const Block& block) {
    return std::any_of(block.insts.begin(), block.insts.end(), makes_text);
  });
  return any && Texts(program, pou).run();
}

}  // namespace ir::opt
