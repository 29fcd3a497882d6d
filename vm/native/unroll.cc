#include "vm/native/unroll.h"

#include <algorithm>
#include <list>

#include "vm/native/ranges.h"
#include "vm/native/turn_steps.h"

namespace vm::native {
namespace {

// Before its turns: the head, two questions for each check that is asked once, what takes fuel.
uint32_t blocks_in_front(const TurnSteps& steps) {
  return 2 + 2 * static_cast<uint32_t>(steps.asked_once().size());
}

// The turns of one loop, in the block `turns_`.
class Turns {
 public:
  Turns(Function& f, const Counted& c, const TurnSteps& steps, Constants& constants, Block head)
      : f_(f),
        c_(c),
        steps_(steps),
        constants_(constants),
        head_(head),
        turns_(head + blocks_in_front(steps)) {
    const Loop& old = f.loops[c.loop];
    for (const Val param : f.blocks[old.head].params) {
      Value value = f.values[param];
      value.block = head;
      f.blocks[head].params.push_back(static_cast<Val>(f.values.size()));
      copy_[param] = static_cast<Val>(f.values.size());
      if (steps.of(param) != 0) base_[param] = copy_[param];
      f.values.push_back(value);
    }
    limit();
    questions();
    const Block loop_head = old.head;
    for (uint32_t turn = 0; turn < c.turns; ++turn) {
      for (const uint32_t n : c.nodes) node(n, turn);
      std::vector<Val> next;
      for (const Val v : c.again) next.push_back(now(real(v)));
      const std::vector<Val>& params = f.blocks[loop_head].params;
      for (size_t i = 0; i < params.size(); ++i) copy_[params[i]] = next[i];
      if (turn + 1 == c.turns) f.blocks[turns_].end.args[0] = std::move(next);
    }
  }

 private:
  Val real(Val v) const { return steps_.real(v); }
  Val now(Val v) const {
    const Val* const found = copy_.find(v);
    return found == nullptr ? v : *found;
  }
  Val constant(int64_t number, uint8_t width) {
    return constants_.of(static_cast<uint64_t>(number), width);
  }
  Val append(Node made, Block to) {
    made.unit = f_.blocks[to].unit;
    made.result = static_cast<Val>(f_.values.size());
    f_.values.push_back({false, made.width, false, 0, static_cast<uint32_t>(f_.nodes.size()), to});
    f_.blocks[to].nodes.push_back(static_cast<uint32_t>(f_.nodes.size()));
    f_.nodes.push_back(made);
    return made.result;
  }
  Val sum(Val a, Val b, Block to) {
    Node made;
    made.op = Op::kAdd;
    made.width = 8;
    made.in[0] = a;
    made.in[1] = b;
    return append(made, to);
  }

  // All turns are done when the last of them is within the limit.
  void limit() {
    End& end = f_.blocks[head_].end;
    const Value limit = f_.values[c_.limit];
    end.in[0] = copy_[c_.counter];
    end.width = limit.width;
    if (limit.constant) {
      const int64_t number = as_signed(limit.bits, limit.width) + limit_of_first(c_, c_.turns);
      end.in[1] = constant(number, limit.width);
      return;
    }
    const Block front = head_ - 1;
    Val wide_limit = c_.limit;
    if (limit.width != 8) {
      Node wide;
      wide.op = Op::kSext;
      wide.width = 8;
      wide.from = limit.width;
      wide.in[0] = end.in[0];
      end.in[0] = append(wide, head_);
      wide.in[0] = c_.limit;
      wide_limit = append(wide, front);
      end.width = 8;
    }
    end.in[1] = sum(wide_limit, constant(limit_of_first(c_, c_.turns), 8), front);
  }

  // Checks that the first and the last turn must pass; else the loop itself does all of it.
  void questions() {
    Block at = head_ + 1;
    for (const uint32_t number : steps_.asked_once()) {
      const Val first = in_first_turn(f_.nodes[number].in[0], at);
      question(at, number, first);
      const int64_t way = steps_.of(f_.nodes[number].in[0]) * (int64_t{c_.turns} - 1);
      question(at + 1, number, sum(first, constant(way, 8), at + 1));
      at += 2;
    }
  }
  void question(Block at, uint32_t check, Val value) {
    End& end = f_.blocks[at].end;
    end.kind = EndKind::kBranch;
    end.cond = Cond::kLtU;
    end.width = 8;
    end.in[0] = value;
    end.in[1] = real(f_.nodes[check].in[1]);
    end.target[0] = at + 1;
    end.target[1] = f_.loops[c_.loop].head;
  }
  // Made of parameters and of what is from before the loop.
  Val in_first_turn(Val v, Block at) {
    v = real(v);
    if (steps_.of(v) == 0 || f_.values[v].node == kNone) return now(v);
    if (const Val* const known = asked_.find(v)) return *known;
    Node made = f_.nodes[f_.values[v].node];
    for (Val& in : made.in) {
      if (in != kNone) in = in_first_turn(in, at);
    }
    const Val first = append(made, at);
    return asked_[v] = first;
  }

  void node(uint32_t number, uint32_t turn) {
    const std::vector<uint32_t>& once = steps_.asked_once();
    if (std::find(once.begin(), once.end(), number) != once.end()) return;
    Node made = f_.nodes[number];
    for (Val& v : made.in) v = real(v);
    made.mem.index = real(made.mem.index);
    const Val was = made.result;
    const Val index = made.mem.index;
    for (Val& v : made.in) v = now(v);
    made.mem.pointer = now(made.mem.pointer);
    made.mem.index = now(index);
    const Val* const base = base_.find(index);
    if (base != nullptr) {
      const int64_t by = steps_.of(index) * made.mem.scale * turn;
      if (fits(made.mem, by)) {
        made.mem.index = *base;
        made.mem.disp += by;
      }
    }
    if (made.op == Op::kAdd) add_up(made);
    if (made.exit != kNone) made.exit = exit(made.exit, turn);
    if (was != kNone) {
      Value value = f_.values[was];
      value.block = turns_;
      value.node = static_cast<uint32_t>(f_.nodes.size());
      made.result = static_cast<Val>(f_.values.size());
      f_.values.push_back(value);
      copy_[was] = made.result;
      if (turn == 0 && steps_.of(was) != 0) base_[was] = made.result;
    }
    f_.blocks[turns_].nodes.push_back(static_cast<uint32_t>(f_.nodes.size()));
    f_.nodes.push_back(made);
  }

  static bool fits(const Mem& mem, int64_t by) {
    const int64_t low = mem.base == MemBase::kData ? 0 : -kMostStep;
    const int64_t high = mem.base == MemBase::kData ? INT64_C(0xffffffff) : kMostStep;
    return by >= -kMostStep && by <= kMostStep && mem.disp + by >= low && mem.disp + by <= high;
  }

  // (x + 1) + 1: what is between may be wanted by nobody.
  void add_up(Node& made) {
    const Value& left = f_.values[made.in[0]];
    const Value& right = f_.values[made.in[1]];
    if (!right.constant || left.constant || left.node == kNone || left.block != turns_) return;
    const Node& before = f_.nodes[left.node];
    if (before.op != Op::kAdd || before.width != made.width) return;
    const Value& first = f_.values[before.in[1]];
    if (!first.constant) return;
    const int64_t sum = as_signed(first.bits, made.width) + as_signed(right.bits, made.width);
    if (sum < -kMostStep || sum > kMostStep) return;
    made.in[0] = before.in[0];
    made.in[1] = constant(sum, made.width);
  }

  // What the turns after it had taken is given back.
  uint32_t exit(uint32_t number, uint32_t turn) {
    Exit made = f_.exits[number];
    for (SlotValue& slot : made.slots) slot.value = now(real(slot.value));
    made.fuel_back = c_.turns - turn;
    f_.exits.push_back(std::move(made));
    return static_cast<uint32_t>(f_.exits.size() - 1);
  }

  Function& f_;
  const Counted& c_;
  const TurnSteps& steps_;
  Constants& constants_;
  Block head_, turns_;
  ByKey<Val> copy_;   // by value of the loop: in the turn that is made
  ByKey<Val> base_;   // in the first turn, when each one moves it
  ByKey<Val> asked_;  // in the first turn, for its questions
};

struct Unrolled {
  Unrolled(const Function& f, Counted c) : counted(std::move(c)), steps(f, counted) {}
  Counted counted;
  TurnSteps steps;
};

// Makes room in front of the loops' heads, and leads what comes from there to the new ones.
void insert_blocks(Function& f, const std::list<Unrolled>& all) {
  const auto count = static_cast<Block>(f.blocks.size());
  std::vector<Block> place(count);
  std::vector<uint32_t> room(count, 0);
  for (const Unrolled& one : all) {
    room[f.loops[one.counted.loop].head] = blocks_in_front(one.steps) + 1;
  }
  Block next = 0;
  for (Block b = 0; b < count; ++b) {
    next += room[b];
    place[b] = next++;
  }
  std::vector<BasicBlock> blocks(next);
  for (Value& value : f.values) value.block = place[value.block];
  for (Block b = 0; b < count; ++b) {
    BasicBlock& block = blocks[place[b]];
    block = std::move(f.blocks[b]);
    for (Block& to : block.end.target) {
      if (to == kNone) continue;
      to = place[to] - (block.end.kind != EndKind::kLoop ? room[to] : 0);
    }
  }
  f.blocks = std::move(blocks);
  for (Loop& loop : f.loops) {
    loop.head = place[loop.head];
    loop.last = place[loop.last];
  }
}

void turns_of_loop(Function& f, const Counted& c, const TurnSteps& steps, Constants& constants) {
  const Loop old = f.loops[c.loop];
  const Block head = old.head - blocks_in_front(steps) - 1;
  const Block turns = old.head - 1;
  const auto number = static_cast<uint32_t>(f.loops.size());
  Loop loop = old;
  loop.head = head;
  loop.last = turns;
  f.loops.push_back(loop);
  for (Block b = loop.head; b <= loop.last; ++b) {
    f.blocks[b].unit = f.blocks[old.head].unit;
    f.blocks[b].loop = number;
  }
  f.blocks[head].head = true;
  End& asks = f.blocks[head].end;
  asks.kind = EndKind::kBranch;
  asks.cond = c.stays;
  asks.target[0] = head + 1;
  asks.target[1] = old.head;
  End& takes = f.blocks[turns - 1].end;
  takes.kind = EndKind::kTakeFuel;
  takes.fuel = c.turns;
  takes.target[0] = turns;
  takes.target[1] = old.head;
  End& again = f.blocks[turns].end;
  again.kind = EndKind::kLoop;
  again.target[0] = head;
  Turns(f, c, steps, constants, head);
  for (Block b = head; b < turns; ++b) f.blocks[b].end.args[1] = f.blocks[head].params;
}

}  // namespace

void unroll(Function& f) {
  std::vector<bool> outer(f.loops.size(), false);
  for (const Loop& loop : f.loops) {
    if (loop.parent != kNone) outer[loop.parent] = true;
  }
  std::list<Unrolled> all;  // they refer to each other
  for (uint32_t l = 0; l < f.loops.size(); ++l) {
    if (outer[l]) continue;
    if (std::optional<Counted> c = counted(f, l)) all.emplace_back(f, std::move(*c));
  }
  if (all.empty()) return;
  insert_blocks(f, all);
  Constants constants(f);
  for (const Unrolled& one : all) turns_of_loop(f, one.counted, one.steps, constants);
}

}  // namespace vm::native
