#include "vm/native/counted.h"

#include <algorithm>

#include "vm/native/ranges.h"

namespace vm::native {
namespace {

constexpr uint32_t kMostTurns = 8;
constexpr size_t kMostCounted = 96;  // of all turns together

bool is_copied(const Function& f, const Node& n) {
  switch (n.op) {
    case Op::kAdvanceTime:
    case Op::kNative:
    case Op::kHelper:
    case Op::kCall:
    case Op::kEnter:
      return false;
    default:
      return n.exit == kNone || f.exits[n.exit].inlined == kNone;
  }
}

// The blocks of one turn, when one way alone leads through them. False: there are several.
bool one_way(const Function& f, const Loop& loop, Counted& out) {
  const End& asks = f.blocks[loop.head].end;
  Block at = asks.target[asks.target[0] > loop.last ? 1 : 0];
  if (!f.blocks[at].params.empty()) return false;
  while (true) {
    const BasicBlock& block = f.blocks[at];
    out.nodes.insert(out.nodes.end(), block.nodes.begin(), block.nodes.end());
    if (at == loop.last) break;
    const Block next = block.end.target[0];
    if (block.end.kind != EndKind::kJump || next <= at || next > loop.last) return false;
    for (Block b = at + 1; b < next; ++b) {
      if (f.blocks[b].end.kind != EndKind::kUnreachable) return false;
    }
    const std::vector<Val>& params = f.blocks[next].params;
    for (size_t i = 0; i < params.size(); ++i) {
      out.same.push_back({params[i], block.end.args[0][i]});
    }
    at = next;
  }
  const End& end = f.blocks[loop.last].end;
  if (end.kind != EndKind::kLoop || end.target[0] != loop.head) return false;
  out.again = end.args[0];
  return true;
}

// What the counter is when the loop begins; none: that depends.
std::optional<int64_t> first_number(const Function& f, const Loop& loop, size_t param) {
  const Block front = loop.head - 1;
  const auto number = [&](Val v) -> std::optional<int64_t> {
    if (!f.values[v].constant) return std::nullopt;
    return as_signed(f.values[v].bits, f.values[v].width);
  };
  const Val arg = f.blocks[front].end.args[0][param];
  const std::vector<Val>& params = f.blocks[front].params;
  const auto at = std::find(params.begin(), params.end(), arg);
  if (at == params.end()) return number(arg);
  std::optional<int64_t> one;
  for (Block b = 0; b < front; ++b) {
    const End& end = f.blocks[b].end;
    for (uint32_t i = 0; i < 2; ++i) {
      if (end.target[i] != front) continue;
      const auto n = number(end.args[i][static_cast<size_t>(at - params.begin())]);
      if (!n || (one && *one != *n)) return std::nullopt;
      one = n;
    }
  }
  return one;
}

bool has_limit(const Value& limit, const Counted& c, uint32_t turns) {
  if (!limit.constant) return true;
  int64_t number;
  if (__builtin_add_overflow(as_signed(limit.bits, limit.width), limit_of_first(c, turns),
                             &number)) {
    return false;
  }
  const Range all = whole(limit.width);
  return number >= all.low && number <= all.high;
}

// How many turns at once: less of large ones, and of few.
uint32_t turns_of(const Function& f, const Loop& loop, const Counted& c, size_t param) {
  uint64_t all = 2 * kMostTurns;
  const auto first = first_number(f, loop, param);
  const Value& limit = f.values[c.limit];
  if (first && limit.constant) {
    const int64_t last = as_signed(limit.bits, limit.width);
    const bool up = c.step > 0;
    if (up ? *first > last : *first < last) return 0;
    const uint64_t way = up ? static_cast<uint64_t>(last) - static_cast<uint64_t>(*first)
                            : static_cast<uint64_t>(*first) - static_cast<uint64_t>(last);
    all = way / static_cast<uint64_t>(up ? c.step : -c.step);
    if (all < UINT64_MAX) ++all;
  }
  for (uint32_t turns = kMostTurns; turns > 1; turns /= 2) {
    if (turns * c.nodes.size() <= kMostCounted && 2 * turns <= all && has_limit(limit, c, turns)) {
      return turns;
    }
  }
  return 0;
}

}  // namespace

bool is_far_from_the_ends(const Function& f, Val v) {
  const Value& value = f.values[v];
  if (value.constant || value.node == kNone) return false;
  const Node& made = f.nodes[value.node];
  if (made.op != Op::kAnd || !f.values[made.in[1]].constant) return false;
  return f.values[made.in[1]].bits < uint64_t{1} << 62;
}

int64_t limit_of_first(const Counted& c, uint32_t turns) { return -c.step * (int64_t{turns} - 1); }

std::optional<Counted> counted(const Function& f, uint32_t number) {
  const Loop& loop = f.loops[number];
  const BasicBlock& head = f.blocks[loop.head];
  const End& e = head.end;
  if (!head.nodes.empty() || e.kind != EndKind::kBranch || e.compare != Op::kCompare) {
    return std::nullopt;
  }
  const bool out_if = e.target[0] > loop.last;
  if (out_if == (e.target[1] > loop.last)) return std::nullopt;
  const auto param = std::find(head.params.begin(), head.params.end(), e.in[0]);
  if (param == head.params.end() || f.values[e.in[0]].width != e.width) return std::nullopt;
  const Value& limit = f.values[e.in[1]];
  if (!limit.constant && (limit.block >= loop.head || limit.width != e.width)) return std::nullopt;
  if (e.width == 8 && !limit.constant && !is_far_from_the_ends(f, e.in[1])) return std::nullopt;
  Counted c;
  c.loop = number;
  if (!one_way(f, loop, c)) return std::nullopt;
  for (const uint32_t n : c.nodes) {
    if (!is_copied(f, f.nodes[n])) return std::nullopt;
  }
  const auto at = static_cast<size_t>(param - head.params.begin());
  const Value& next = f.values[c.again[at]];
  if (next.constant || next.node == kNone) return std::nullopt;
  const Node& sum = f.nodes[next.node];
  if (sum.op != Op::kAdd || sum.width != e.width || sum.in[0] != e.in[0]) return std::nullopt;
  if (!f.values[sum.in[1]].constant) return std::nullopt;
  c.counter = e.in[0];
  c.step = as_signed(f.values[sum.in[1]].bits, sum.width);
  c.limit = e.in[1];
  c.stays = out_if ? negated(e.cond) : e.cond;
  const bool up = c.stays == Cond::kLeS || c.stays == Cond::kLtS;
  const bool down = c.stays == Cond::kGeS || c.stays == Cond::kGtS;
  if (!(up && c.step > 0) && !(down && c.step < 0)) return std::nullopt;
  if (c.step > INT16_MAX || c.step < INT16_MIN) return std::nullopt;
  c.turns = turns_of(f, loop, c, at);
  if (c.turns == 0) return std::nullopt;
  return c;
}

}  // namespace vm::native
