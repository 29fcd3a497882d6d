#include "vm/native/unroll.h"

#include "vm/native/counted.h"
#include "vm/native/ranges.h"

namespace vm::native {
namespace {

constexpr int64_t kMostUnrolledBytes = int64_t{1} << 30;
constexpr uint32_t kNewBlocks = 3;  // of one loop: its head, what takes fuel, the turns

// The turns of one loop, in the block `turns_`.
class Turns {
 public:
  Turns(Function& f, const Counted& c, Block head) : f_(f), c_(c), head_(head), turns_(head + 2) {
    copy_.assign(f.values.size(), kNone);
    base_.assign(f.values.size(), kNone);
    move_.assign(f.values.size(), 0);
    same_.assign(f.values.size(), kNone);
    for (const auto& [param, value] : c.same) same_[param] = real(value);
    const Loop& old = f.loops[c.loop];
    for (const Val param : f.blocks[old.head].params) {
      Value value = f.values[param];
      value.block = head;
      f.blocks[head].params.push_back(static_cast<Val>(f.values.size()));
      copy_[param] = static_cast<Val>(f.values.size());
      f.values.push_back(value);
    }
    limit();
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
  Val real(Val v) const { return v < same_.size() && same_[v] != kNone ? same_[v] : v; }
  Val now(Val v) const {
    return v == kNone || v >= copy_.size() || copy_[v] == kNone ? v : copy_[v];
  }
  Val constant(int64_t number, uint8_t width) {
    const uint64_t bits = static_cast<uint64_t>(number) & ~uint64_t{0} >> (64 - 8 * width);
    f_.values.push_back({false, width, true, bits, kNone, 0});
    return static_cast<Val>(f_.values.size() - 1);
  }
  Val append(Node made, Block to) {
    made.unit = f_.blocks[to].unit;
    made.width = 8;
    made.result = static_cast<Val>(f_.values.size());
    f_.values.push_back({false, 8, false, 0, static_cast<uint32_t>(f_.nodes.size()), to});
    f_.blocks[to].nodes.push_back(static_cast<uint32_t>(f_.nodes.size()));
    f_.nodes.push_back(made);
    return made.result;
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
    Node wide;
    wide.op = Op::kSext;
    wide.from = limit.width;
    wide.in[0] = end.in[0];
    end.in[0] = append(wide, head_);
    end.width = 8;
    wide.in[0] = c_.limit;
    Node sum;
    sum.op = Op::kAdd;
    sum.in[0] = append(wide, front);
    sum.in[1] = constant(limit_of_first(c_, c_.turns), 8);
    end.in[1] = append(sum, front);
  }

  void node(uint32_t number, uint32_t turn) {
    Node made = f_.nodes[number];
    for (Val& v : made.in) v = real(v);
    made.mem.index = real(made.mem.index);
    if (turn == 0) find_move(made);
    const Val was = made.result;
    const Val index = made.mem.index;
    for (Val& v : made.in) v = now(v);
    made.mem.pointer = now(made.mem.pointer);
    made.mem.index = now(index);
    if (index < base_.size() && base_[index] != kNone) {
      const int64_t by = move_[index] * made.mem.scale * turn;
      if (fits(made.mem, by)) {
        made.mem.index = base_[index];
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
      if (turn == 0 && move_[was] != 0) base_[was] = made.result;
    }
    f_.blocks[turns_].nodes.push_back(static_cast<uint32_t>(f_.nodes.size()));
    f_.nodes.push_back(made);
  }

  static bool fits(const Mem& mem, int64_t by) {
    const int64_t low = mem.base == MemBase::kData ? 0 : -kMostUnrolledBytes;
    const int64_t high = mem.base == MemBase::kData ? INT64_C(0xffffffff) : kMostUnrolledBytes;
    return by >= -kMostUnrolledBytes && by <= kMostUnrolledBytes && mem.disp + by >= low &&
           mem.disp + by <= high;
  }

  // By how much the value is another in the next turn; 0: it is the same, or nobody knows.
  int64_t move_of(Val v) const { return v == kNone || v >= move_.size() ? 0 : move_[v]; }
  bool is_fixed(Val v) const { return f_.values[v].constant || copy_[v] == kNone; }

  // Sums of 8 bytes: those of the counter's numbers do not wrap, as they are within its limit.
  void find_move(const Node& n) {
    if (n.result == kNone || n.width != 8) return;
    const Val a = n.in[0];
    const Val b = n.in[1];
    int64_t& by = move_[n.result];
    const auto of = [&](Val v) {
      if (v == c_.counter && f_.values[v].width == 8) return c_.step;
      return move_of(v);
    };
    const auto known = [&](Val v) { return of(v) != 0 || is_fixed(v); };
    const auto times = [&](uint64_t factor) {
      int64_t product;
      const bool wraps = factor > INT32_MAX ||
                         __builtin_mul_overflow(of(a), static_cast<int64_t>(factor), &product);
      by = wraps ? 0 : product;
    };
    switch (n.op) {
      case Op::kSext:
        by = a == c_.counter && n.from == f_.values[a].width ? c_.step : 0;
        return;
      case Op::kAdd:
        if (known(a) && known(b)) by = of(a) + of(b);
        break;
      case Op::kSub:
        if (known(a) && known(b)) by = of(a) - of(b);
        break;
      case Op::kAddShifted:
        if (known(a) && known(b)) by = of(a) + of(b) * (int64_t{1} << n.imm);
        break;
      case Op::kShl:
        if (f_.values[b].constant && f_.values[b].bits < 31)
          times(uint64_t{1} << f_.values[b].bits);
        break;
      case Op::kMul:
        if (f_.values[b].constant) times(f_.values[b].bits);
        break;
      default:
        break;
    }
    if (by < -kMostUnrolledBytes || by > kMostUnrolledBytes) by = 0;
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
    if (sum < -kMostUnrolledBytes || sum > kMostUnrolledBytes) return;
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
  Block head_, turns_;
  std::vector<Val> same_;      // by parameter inside of a turn: what it is
  std::vector<Val> copy_;      // by value of the loop: in the turn that is made
  std::vector<Val> base_;      // in the first turn, when each one moves it
  std::vector<int64_t> move_;  // by how much
};

// Makes room in front of the loops' heads, and leads what comes from there to the new ones.
void insert_blocks(Function& f, const std::vector<Counted>& all) {
  const auto count = static_cast<Block>(f.blocks.size());
  std::vector<Block> place(count);
  std::vector<bool> has(count, false);
  for (const Counted& c : all) has[f.loops[c.loop].head] = true;
  Block next = 0;
  for (Block b = 0; b < count; ++b) {
    if (has[b]) next += kNewBlocks;
    place[b] = next++;
  }
  std::vector<BasicBlock> blocks(next);
  for (Value& value : f.values) value.block = place[value.block];
  for (Block b = 0; b < count; ++b) {
    BasicBlock& block = blocks[place[b]];
    block = std::move(f.blocks[b]);
    for (Block& to : block.end.target) {
      if (to == kNone) continue;
      to = place[to] - (has[to] && block.end.kind != EndKind::kLoop ? kNewBlocks : 0);
    }
  }
  f.blocks = std::move(blocks);
  for (Loop& loop : f.loops) {
    loop.head = place[loop.head];
    loop.last = place[loop.last];
  }
}

void turns_of_loop(Function& f, const Counted& c) {
  const Loop old = f.loops[c.loop];
  const Block head = old.head - kNewBlocks;
  const auto number = static_cast<uint32_t>(f.loops.size());
  Loop loop = old;
  loop.head = head;
  loop.last = head + kNewBlocks - 1;
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
  End& takes = f.blocks[head + 1].end;
  takes.kind = EndKind::kTakeFuel;
  takes.fuel = c.turns;
  takes.target[0] = head + 2;
  takes.target[1] = old.head;
  End& again = f.blocks[head + 2].end;
  again.kind = EndKind::kLoop;
  again.target[0] = head;
  Turns(f, c, head);
  f.blocks[head].end.args[1] = f.blocks[head + 1].end.args[1] = f.blocks[head].params;
}

}  // namespace

void unroll(Function& f) {
  std::vector<bool> outer(f.loops.size(), false);
  for (const Loop& loop : f.loops) {
    if (loop.parent != kNone) outer[loop.parent] = true;
  }
  std::vector<Counted> all;
  for (uint32_t l = 0; l < f.loops.size(); ++l) {
    if (outer[l]) continue;
    if (std::optional<Counted> c = counted(f, l)) all.push_back(std::move(*c));
  }
  if (all.empty()) return;
  insert_blocks(f, all);
  for (const Counted& c : all) turns_of_loop(f, c);
}

}  // namespace vm::native
