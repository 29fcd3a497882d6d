#include "vm/native/ranges.h"

#include <algorithm>

namespace vm::native {
namespace {

constexpr uint32_t kDeepest = 12;
constexpr uint32_t kMostSteps = 300;  // for one question

bool contains(Range outer, Range inner) {
  return outer.low <= inner.low && inner.high <= outer.high;
}

}  // namespace

Range whole(uint8_t width) {
  if (width == 8) return {};
  const int64_t limit = int64_t{1} << (8 * width - 1);
  return {-limit, limit - 1};
}

int64_t as_signed(uint64_t bits, uint8_t width) {
  const unsigned shift = 64 - 8u * width;
  return static_cast<int64_t>(bits << shift) >> shift;
}

Ranges::Ranges(const Function& f) : f_(f) {
  first_way_.assign(f.blocks.size() + 1, 0);
  loop_at_.assign(f.blocks.size(), kNone);
  for (uint32_t l = 0; l < f.loops.size(); ++l) loop_at_[f.loops[l].head] = l;
  for (const BasicBlock& block : f.blocks) {
    for (const Block to : block.end.target) {
      if (to != kNone) ++first_way_[to + 1];
    }
  }
  for (Block b = 0; b < f.blocks.size(); ++b) first_way_[b + 1] += first_way_[b];
  ways_in_.resize(first_way_.back());
  std::vector<uint32_t> fill(first_way_.begin(), first_way_.end() - 1);
  for (Block b = 0; b < f.blocks.size(); ++b) {
    const End& end = f.blocks[b].end;
    for (uint32_t i = 0; i < 2; ++i) {
      if (end.target[i] != kNone) ways_in_[fill[end.target[i]]++] = {b, i};
    }
  }
}

void Ranges::clear() {
  used_.clear();
  open_.reset();
  several_ = false;
  steps_ = 0;
}

Range Ranges::of(Val v, Block at, uint32_t depth) {
  const Value& value = f_.values[v];
  if (value.constant) {
    const int64_t number = as_signed(value.bits, value.width);
    return {number, number};
  }
  const Range all = whole(value.width);
  if (++steps_ > kMostSteps || depth > kDeepest || value.floating || crosses(v, at)) return all;
  if (value.node == kNone) return parameter(v, at, depth);
  const Node& n = f_.nodes[value.node];
  switch (n.op) {
    case Op::kSext: {
      if (n.from != f_.values[n.in[0]].width) return whole(n.from);
      return of(n.in[0], at, depth + 1);
    }
    case Op::kZext: {
      const Range from =
          n.from == f_.values[n.in[0]].width ? of(n.in[0], at, depth + 1) : whole(n.from);
      if (from.low >= 0) return from;
      return n.from == 8 ? all : Range{0, (int64_t{1} << (8 * n.from)) - 1};
    }
    case Op::kAdd:
    case Op::kSub:
      return sum(n, at, depth);
    case Op::kMul:
      return product(n, at, depth);
    case Op::kAnd: {
      if (!f_.values[n.in[1]].constant) return all;
      const int64_t mask = as_signed(f_.values[n.in[1]].bits, n.width);
      return mask >= 0 ? Range{0, mask} : all;
    }
    case Op::kShr: {
      const Value& count = f_.values[n.in[1]];
      if (!count.constant || count.bits == 0 || count.bits >= 8u * n.width) return all;
      return {0, static_cast<int64_t>(~uint64_t{0} >> (64 - 8 * n.width + count.bits))};
    }
    case Op::kCompare:
    case Op::kFCompare:
      return {0, 1};
    case Op::kNotBool: {
      const Range from = of(n.in[0], at, depth + 1);
      return from.low >= 0 && from.high <= 1 ? from : all;
    }
    case Op::kLoad:
      return n.boolean ? Range{0, 1} : all;
    default:
      return all;
  }
}

bool Ranges::crosses(Val v, Block at) const {
  for (uint32_t l = f_.blocks[at].loop; l != kNone; l = f_.loops[l].parent) {
    if (f_.values[v].block + 1 < f_.loops[l].head) return true;
  }
  return false;
}

Range Ranges::sum(const Node& n, Block at, uint32_t depth) {
  const Range all = whole(n.width);
  const Range a = of(n.in[0], at, depth + 1);
  Range b = of(n.in[1], at, depth + 1);
  if (!contains(all, a) || !contains(all, b)) return all;
  Range out;
  const bool minus = n.op == Op::kSub;
  const bool wraps = minus ? __builtin_sub_overflow(a.low, b.high, &out.low) ||
                                 __builtin_sub_overflow(a.high, b.low, &out.high)
                           : __builtin_add_overflow(a.low, b.low, &out.low) ||
                                 __builtin_add_overflow(a.high, b.high, &out.high);
  return wraps || !contains(all, out) ? all : out;
}

Range Ranges::product(const Node& n, Block at, uint32_t depth) {
  const Range all = whole(n.width);
  const Range a = of(n.in[0], at, depth + 1);
  const Range b = of(n.in[1], at, depth + 1);
  Range out;
  if (!contains(all, a) || a.low < 0 || b.low < 0 ||
      __builtin_mul_overflow(a.high, b.high, &out.high)) {
    return all;
  }
  out.low = 0;
  return contains(all, out) ? out : all;
}

Range Ranges::parameter(Val v, Block at, uint32_t depth) {
  const Block block = f_.values[v].block;
  const Range all = whole(f_.values[v].width);
  const std::vector<Val>& params = f_.blocks[block].params;
  const auto index =
      static_cast<size_t>(std::find(params.begin(), params.end(), v) - params.begin());
  if (index == params.size()) return all;
  if (f_.blocks[block].resumes) return all;  // what an interrupted execution brings
  if (!f_.blocks[block].head) return join(block, index, depth);
  const Loop* const loop = loop_at(block);
  if (loop == nullptr || at <= block || at > loop->last) return all;
  std::optional<int64_t> step;
  Range first{INT64_MAX, INT64_MIN};
  for (const auto& [from, target] : ways_in(block)) {
    const Val arg = f_.blocks[from].end.args[target][index];
    if (f_.blocks[from].end.kind != EndKind::kLoop) {
      // Through the block in front: what was before, or what the loop itself had made.
      Range r = before(from, arg, depth);
      if (!contains(all, r)) r = all;  // its low bytes are another number
      first = {std::min(first.low, r.low), std::max(first.high, r.high)};
      continue;
    }
    const Value& next = f_.values[arg];
    if (next.constant || next.node == kNone) return all;
    const Node& n = f_.nodes[next.node];
    if (n.op != Op::kAdd || n.in[0] != v || !f_.values[n.in[1]].constant) return all;
    const int64_t by = as_signed(f_.values[n.in[1]].bits, n.width);
    if (by == 0 || n.width != f_.values[v].width || (step && *step != by)) return all;
    step = by;
  }
  if (!step) return all;
  const bool up = *step > 0;
  Range out = first;
  int64_t& start = up ? out.low : out.high;
  int64_t& limit = up ? out.high : out.low;
  const std::optional<Limit> known = limit_of(*loop, v, up);
  if (!known) return all;
  const bool is_open = start == (up ? all.low : all.high);
  if (known->variable == kNone) {
    limit = known->number;
    if (is_open) close({v, !up, limit}, start);
  } else {
    if (is_open || !close({v, up, start}, limit)) return all;
    int64_t bound;
    if (__builtin_add_overflow(limit, known->number, &bound)) return all;
    used_.push_back({block - 1, known->variable, !up, bound});
  }
  int64_t beyond;
  if (__builtin_add_overflow(limit, *step, &beyond)) return all;
  if (beyond < all.low || beyond > all.high) return all;
  if (out.low > out.high) return all;
  for (const auto& [from, target] : ways_in(block)) {
    if (f_.blocks[from].end.kind == EndKind::kLoop) continue;
    used_.push_back(
        {from, f_.blocks[from].end.args[target][index], *step > 0, *step > 0 ? out.low : out.high});
  }
  return out;
}

bool Ranges::close(const Open& open, int64_t& end) {
  if (guess_ && guess_->first == open) {
    end = guess_->second;
    return true;
  }
  several_ |= open_ && !(*open_ == open);
  open_ = open;
  return false;
}

Range Ranges::join(Block block, size_t index, uint32_t depth) {
  const Range all = whole(f_.values[f_.blocks[block].params[index]].width);
  Range out{INT64_MAX, INT64_MIN};
  for (const auto& [from, target] : ways_in(block)) {
    Range r = of(f_.blocks[from].end.args[target][index], from, depth + 4);
    if (!contains(all, r)) r = all;
    out = {std::min(out.low, r.low), std::max(out.high, r.high)};
  }
  return out;
}

Range Ranges::before(Block front, Val arg, uint32_t depth) {
  const std::vector<Val>& params = f_.blocks[front].params;
  const auto at = std::find(params.begin(), params.end(), arg);
  if (!f_.blocks[front].resumes || at == params.end()) return of(arg, front, depth + 1);
  return join(front, static_cast<size_t>(at - params.begin()), depth);
}

const Loop* Ranges::loop_at(Block head) const {
  return loop_at_[head] == kNone ? nullptr : &f_.loops[loop_at_[head]];
}

std::optional<Ranges::Limit> Ranges::limit_of(const Loop& loop, Val v, bool upwards) const {
  const End& end = f_.blocks[loop.head].end;
  if (end.kind != EndKind::kBranch || end.compare != Op::kCompare) return std::nullopt;
  const Value& counter = f_.values[v];
  if (end.in[0] != v || end.width != counter.width) return std::nullopt;
  const Value& last = f_.values[end.in[1]];
  if (!last.constant && (last.block >= loop.head || last.width != end.width)) return std::nullopt;
  const int64_t bound = last.constant ? as_signed(last.bits, end.width) : 0;
  const Val variable = last.constant ? kNone : end.in[1];
  const bool out_if = end.target[0] > loop.last && end.target[1] <= loop.last;
  const bool out_else = end.target[1] > loop.last && end.target[0] <= loop.last;
  if (!out_if && !out_else) return std::nullopt;
  const Cond stays = out_if ? negated(end.cond) : end.cond;
  const bool strictly = stays == (upwards ? Cond::kLtS : Cond::kGtS);
  if (!strictly && stays != (upwards ? Cond::kLeS : Cond::kGeS)) return std::nullopt;
  const int64_t step = !strictly ? 0 : upwards ? 1 : -1;
  if (variable != kNone) return Limit{variable, step};
  int64_t number;
  if (__builtin_sub_overflow(bound, step, &number)) return std::nullopt;
  return Limit{kNone, number};
}

}  // namespace vm::native
