// Checks that always pass: their questions, and what must be asked in front of a loop for them.
#include <algorithm>

#include "vm/native/loops.h"
#include "vm/native/ranges.h"

namespace vm::native {
namespace {

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

// By loop: which of its blocks every whole turn goes through. By block: such a loop, or kNone.
std::vector<uint32_t> loops_of_every_turn(const Function& f) {
  std::vector<uint32_t> out(f.blocks.size(), kNone);
  for (uint32_t l = 0; l < f.loops.size(); ++l) {
    for (const Block b : every_turn(f, f.loops[l])) out[b] = l;
  }
  return out;
}

bool holds(const Function& f, const Assumption& a) {
  const Value& value = f.values[a.counter];
  if (!value.constant) return true;
  const int64_t number = as_signed(value.bits, value.width);
  return a.at_least ? number >= a.bound : number <= a.bound;
}

// A counter with an open end: is there a bound for its first or last number with which the check is
// never answered yes? A check of every turn would fail in the first or last one beyond that bound,
// so the assumption is none that a loop without traps breaks.
bool is_guessed(const Function& f, Ranges& ranges, const Node& n, Block b, int64_t bound,
                uint32_t loop) {
  const auto open = ranges.open();
  if (!open || loop == kNone || f.values[open->counter].block != f.loops[loop].head) return false;
  const bool of_both = n.cond == Cond::kGeU || n.cond == Cond::kGtU;
  if (!of_both && n.cond != (open->above ? Cond::kGtS : Cond::kLtS)) return false;
  if (of_both && bound <= 0) return false;
  const auto ask = [&](int64_t guess) {
    ranges.clear();
    ranges.guess(std::pair(*open, guess));
    const Range range = ranges.of(n.in[0], b);
    ranges.guess(std::nullopt);
    return range;
  };
  const Range nearest = ask(open->known);
  int64_t slack;
  if (open->above) {
    const int64_t most = n.cond == Cond::kGeU ? bound - 1 : bound;
    if (__builtin_sub_overflow(most, nearest.high, &slack) || slack < 0) return false;
  } else {
    const int64_t least = of_both ? 0 : bound;
    if (__builtin_sub_overflow(nearest.low, least, &slack) || slack < 0) return false;
    slack = -slack;
  }
  int64_t guess;
  if (__builtin_add_overflow(open->known, slack, &guess)) return false;
  const Range type = whole(f.values[open->counter].width);
  if (guess < type.low || guess > type.high || !never(n.cond, ask(guess), bound)) return false;
  return std::all_of(ranges.used().begin(), ranges.used().end(),
                     [&](const Assumption& a) { return holds(f, a); });
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
  const std::vector<uint32_t> sure = loops_of_every_turn(f);
  for (Block b = 0; b < f.blocks.size(); ++b) {
    for (const uint32_t number : f.blocks[b].nodes) {
      Node& n = f.nodes[number];
      if (n.op != Op::kExitIf || !f.values[n.in[1]].constant) continue;
      if (f.values[n.in[0]].width != n.width) continue;
      const int64_t bound = as_signed(f.values[n.in[1]].bits, n.width);
      ranges.clear();
      if (!never(n.cond, ranges.of(n.in[0], b), bound) &&
          !is_guessed(f, ranges, n, b, bound, sure[b])) {
        continue;
      }
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
