// Which numbers a value can be, as far as its making says.
#include <algorithm>
#include <optional>

#include "vm/native/loops.h"

namespace vm::native {
namespace {

constexpr uint32_t kDeepest = 12;
constexpr uint32_t kMostSteps = 300;  // for one question

struct Range {
  int64_t low = INT64_MIN;
  int64_t high = INT64_MAX;
};

Range whole(uint8_t width) {
  if (width == 8) return {};
  const int64_t limit = int64_t{1} << (8 * width - 1);
  return {-limit, limit - 1};
}
bool contains(Range outer, Range inner) {
  return outer.low <= inner.low && inner.high <= outer.high;
}
int64_t as_signed(uint64_t bits, uint8_t width) {
  const unsigned shift = 64 - 8u * width;
  return static_cast<int64_t>(bits << shift) >> shift;
}

// What a counter must be where its loop begins, whoever wrote it.
struct Assumption {
  Block front = 0;
  Val counter = kNone;
  bool at_least = false;
  int64_t bound = 0;
  friend bool operator==(const Assumption&, const Assumption&) = default;
};

class Ranges {
 public:
  explicit Ranges(const Function& f) : f_(f) {
    ways_in_.resize(f.blocks.size());
    loop_at_.assign(f.blocks.size(), kNone);
    for (uint32_t l = 0; l < f.loops.size(); ++l) loop_at_[f.loops[l].head] = l;
    for (Block b = 0; b < f.blocks.size(); ++b) {
      const End& end = f.blocks[b].end;
      for (uint32_t i = 0; i < 2; ++i) {
        if (end.target[i] != kNone) ways_in_[end.target[i]].push_back({b, i});
      }
    }
  }

  // What the answers since the last clear() rely on.
  const std::vector<Assumption>& used() const { return used_; }
  void clear() {
    used_.clear();
    steps_ = 0;
  }

  // As a signed number of its width, where `at` is executed.
  Range of(Val v, Block at, uint32_t depth = 0) {
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

 private:
  // Into a loop where an interrupted execution may go on: then memory says what it is, and another
  // task may have written there.
  bool crosses(Val v, Block at) const {
    for (uint32_t l = f_.blocks[at].loop; l != kNone; l = f_.loops[l].parent) {
      if (f_.values[v].block + 1 < f_.loops[l].head) return true;
    }
    return false;
  }

  Range sum(const Node& n, Block at, uint32_t depth) {
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

  Range product(const Node& n, Block at, uint32_t depth) {
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

  // A loop's counter: from what comes in, by steps of one direction, as long as the head goes on.
  Range parameter(Val v, Block at, uint32_t depth) {
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
    for (const auto& [from, target] : ways_in_[block]) {
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
    const std::optional<int64_t> limit = limit_of(*loop, v, *step > 0);
    if (!limit) return all;
    Range out;
    int64_t beyond;
    if (__builtin_add_overflow(*limit, *step, &beyond)) return all;
    if (beyond < all.low || beyond > all.high) return all;
    if (*step > 0) {
      out = {first.low, *limit};
    } else {
      out = {*limit, first.high};
    }
    if (out.low > out.high) return all;
    for (const auto& [from, target] : ways_in_[block]) {
      if (f_.blocks[from].end.kind == EndKind::kLoop) continue;
      used_.push_back({from, f_.blocks[from].end.args[target][index], *step > 0,
                       *step > 0 ? out.low : out.high});
    }
    return out;
  }

  Range join(Block block, size_t index, uint32_t depth) {
    const Range all = whole(f_.values[f_.blocks[block].params[index]].width);
    Range out{INT64_MAX, INT64_MIN};
    for (const auto& [from, target] : ways_in_[block]) {
      Range r = of(f_.blocks[from].end.args[target][index], from, depth + 4);
      if (!contains(all, r)) r = all;
      out = {std::min(out.low, r.low), std::max(out.high, r.high)};
    }
    return out;
  }

  // Values that come in through the block in front of a loop. An execution that goes on there has
  // the counter's own values, which the same bounds hold.
  Range before(Block front, Val arg, uint32_t depth) {
    const std::vector<Val>& params = f_.blocks[front].params;
    const auto at = std::find(params.begin(), params.end(), arg);
    if (!f_.blocks[front].resumes || at == params.end()) return of(arg, front, depth + 1);
    return join(front, static_cast<size_t>(at - params.begin()), depth);
  }

  const Loop* loop_at(Block head) const {
    return loop_at_[head] == kNone ? nullptr : &f_.loops[loop_at_[head]];
  }

  // The last number with which the head goes on.
  std::optional<int64_t> limit_of(const Loop& loop, Val v, bool upwards) const {
    const End& end = f_.blocks[loop.head].end;
    if (end.kind != EndKind::kBranch || end.compare != Op::kCompare) return std::nullopt;
    const Value& counter = f_.values[v];
    if (end.in[0] != v || !f_.values[end.in[1]].constant || end.width != counter.width) {
      return std::nullopt;
    }
    const int64_t bound = as_signed(f_.values[end.in[1]].bits, end.width);
    const bool out_if = end.target[0] > loop.last && end.target[1] <= loop.last;
    const bool out_else = end.target[1] > loop.last && end.target[0] <= loop.last;
    if (!out_if && !out_else) return std::nullopt;
    const Cond stays = out_if ? negated(end.cond) : end.cond;
    if (upwards && stays == Cond::kLeS) return bound;
    if (upwards && stays == Cond::kLtS && bound != INT64_MIN) return bound - 1;
    if (!upwards && stays == Cond::kGeS) return bound;
    if (!upwards && stays == Cond::kGtS && bound != INT64_MAX) return bound + 1;
    return std::nullopt;
  }

  const Function& f_;
  std::vector<std::vector<std::pair<Block, uint32_t>>> ways_in_;
  std::vector<Assumption> used_;
  std::vector<uint32_t> loop_at_;  // by head; kNone: no head
  uint32_t steps_ = 0;
};

// Is the answer always no?
bool never(Cond cond, Range a, int64_t b) {
  switch (cond) {
    case Cond::kGeU:
      return b >= 0 && a.low >= 0 && a.high < b;
    case Cond::kGtU:
      return b >= 0 && a.low >= 0 && a.high <= b;
    case Cond::kLtS:
      return a.low >= b;
    case Cond::kGtS:
      return a.high <= b;
    case Cond::kEq:
      return b < a.low || b > a.high;
    default:
      return false;
  }
}

void check_in_front(Function& f, const Assumption& a) {
  if (f.values[a.counter].constant) return;
  Node check;
  check.op = Op::kExitIf;
  check.width = f.values[a.counter].width;
  check.cond = a.at_least ? Cond::kLtS : Cond::kGtS;
  check.in[0] = a.counter;
  check.in[1] = static_cast<Val>(f.values.size());
  f.values.push_back({false, check.width, true, static_cast<uint64_t>(a.bound), kNone, 0});
  check.unit = f.blocks[a.front].unit;
  check.exit = static_cast<uint32_t>(f.exits.size());
  Exit exit;
  exit.unit = f.blocks[a.front].unit;
  exit.slots = f.blocks[a.front].dirty;
  f.exits.push_back(std::move(exit));
  f.blocks[a.front].nodes.push_back(static_cast<uint32_t>(f.nodes.size()));
  f.nodes.push_back(check);
}

}  // namespace

void drop_proven_checks(Function& f) {
  Ranges ranges(f);
  std::vector<Assumption> assumed;
  for (Block b = 0; b < f.blocks.size(); ++b) {
    for (const uint32_t number : f.blocks[b].nodes) {
      Node& n = f.nodes[number];
      if (n.op != Op::kExitIf || !f.values[n.in[1]].constant) continue;
      if (f.values[n.in[0]].width != n.width) continue;
      const int64_t bound = as_signed(f.values[n.in[1]].bits, n.width);
      ranges.clear();
      if (!never(n.cond, ranges.of(n.in[0], b), bound)) continue;
      n.dead = true;
      for (const Assumption& a : ranges.used()) {
        if (std::find(assumed.begin(), assumed.end(), a) == assumed.end()) assumed.push_back(a);
      }
    }
    std::erase_if(f.blocks[b].nodes, [&](uint32_t number) { return f.nodes[number].dead; });
  }
  for (const Assumption& a : assumed) check_in_front(f, a);
}

}  // namespace vm::native
