// Pointers that walk: what a loop follows is a pointer from before it, or one that each turn moves.
// Such a pointer stays in its variable, or the loop is left; so the variable is looked for once, and
// the pointer is a distance from its first byte, which is compared with its size (docs/adr/0048).
#include <algorithm>
#include <bit>

#include "ir/types/handle.h"
#include "vm/exec/context.h"
#include "vm/native/loops.h"

namespace vm::native {
namespace {

constexpr uint64_t kOrder = uint64_t{1} << 31;  // offsets are in order with this bit the other way
// Limits are smaller: nobody else could say so (counted.h).
constexpr uint64_t kSmall = (uint64_t{1} << 61) - 1;
constexpr size_t kMostQuestions = 16;  // in front of one loop: variables by pointers

// What handles of a loop are called behind it.
struct Renamed {
  Val to = kNone;
  Block head = 0;
  Block last = 0;
};
using Renames = ByKey<Renamed>;

// The ways that lead to a block: from where, and by which of its targets.
using Ways = std::vector<std::vector<std::pair<Block, uint32_t>>>;

class Walk {
 public:
  Walk(Function& f, const Facts& facts, const Ways& ways, uint32_t loop)
      : f_(f),
        facts_(facts),
        ways_(ways),
        number_(loop),
        loop_(f.loops[loop]),
        front_(loop_.head - 1) {}

  // Does every pointer that the loop follows come from before it, or is one that the loop moves?
  bool find() {
    for (Block b = loop_.head; b <= loop_.last; ++b) {
      for (const uint32_t number : f_.blocks[b].nodes) {
        const Node& n = f_.nodes[number];
        if (n.op == Op::kCall || n.op == Op::kEnter) return false;
        if (n.op != Op::kResolve && n.op != Op::kMoveHandle) continue;
        if (n.exit == kNone || walker_of(n.in[0]) == kNone) return false;
        if (n.op == Op::kMoveHandle) walker_of(n.result);
        if (n.op != Op::kResolve) continue;
        resolved_.set(n.result, 0);
        any_ = true;
      }
    }
    if (!any_) return true;
    for (const Walker& w : walkers_) {
      if (w.param == kNone) continue;
      bool same = true;
      each_turn([&](End& end) { same &= walker_of(end.args[0][w.param]) == index_of(w); });
      if (!same) return false;
    }
    find_questions();
    return walkers_.size() <= kLoopReaches &&
           walkers_.size() * questions_.size() <= kMostQuestions;
  }

  // `uses`: by value.
  void change(const std::vector<uint32_t>& uses, Constants& constants, Renames& renames) {
    if (!any_) return;
    constants_ = &constants;
    for (const Block b : every_turn(f_, loop_)) sure_.set(b, 0);
    find_steps(uses);
    for (Walker& w : walkers_) begin(w);
    for (Block b = loop_.head; b <= loop_.last; ++b) block(b);
    each_turn([&](End& end) {
      for (const Walker& w : walkers_) {
        if (w.param != kNone) end.args[0][w.param] = distance_.at(end.args[0][w.param]);
      }
    });
    slots();
    count();
    behind(renames);
  }

 private:
  struct Walker {
    Val handle = kNone;      // in the loop
    uint32_t param = kNone;  // of the head; kNone: it stays what it is
    uint8_t site = 0;
    Val first = kNone;  // data address of the variable
    Val place = kNone;  // the same, of the machine
    Val size = kNone;
    Val distance = kNone;  // where the loop begins
    Val begin = kNone;     // ... and the place that the handle names there
    Val named = kNone;     // what distances add to for comparisons of places
    std::vector<std::pair<uint64_t, Val>> limits;  // size less so many bytes, at least 0
  };
  // A stretch of variables that the loop names.
  struct Question {
    MemBase base = MemBase::kSelf;
    uint64_t begin = 0;
    uint64_t end = 0;
  };

  uint32_t index_of(const Walker& w) const { return static_cast<uint32_t>(&w - walkers_.data()); }
  bool is_inside(Val v) const { return !f_.values[v].constant && f_.values[v].block >= loop_.head; }

  template <class Visit>
  void each_turn(Visit visit) {
    for (Block b = loop_.head; b <= loop_.last; ++b) {
      End& end = f_.blocks[b].end;
      if (end.kind == EndKind::kLoop && end.target[0] == loop_.head) visit(end);
    }
  }

  // --- what is followed -------------------------------------------------------------

  uint32_t walker_of(Val v) {
    if (const uint32_t* const known = walker_.find(v)) return *known;
    const uint32_t found = find_walker(v);
    return walker_[v] = found;
  }

  uint32_t find_walker(Val v) {
    const Value& value = f_.values[v];
    if (value.constant || value.width != 8 || value.floating) return kNone;
    if (!is_inside(v)) return add_walker(v, kNone);
    if (value.node == kNone) {
      const std::vector<Val>& params = f_.blocks[value.block].params;
      const auto at = std::find(params.begin(), params.end(), v);
      if (at == params.end()) return kNone;
      const auto index = static_cast<uint32_t>(at - params.begin());
      if (value.block == loop_.head) return add_walker(v, index);
      return walker_of_all_ways(value.block, index);
    }
    const Node& n = f_.nodes[value.node];
    switch (n.op) {
      case Op::kMoveHandle:
        return walker_of(n.in[0]);
      case Op::kSelect:
        return same(walker_of(n.in[1]), walker_of(n.in[2]));
      case Op::kSelectCmp:
        return same(walker_of(n.in[0]), walker_of(n.in[1]));
      default:
        return kNone;
    }
  }

  static uint32_t same(uint32_t a, uint32_t b) { return a == b ? a : kNone; }

  uint32_t walker_of_all_ways(Block block, uint32_t param) {
    uint32_t one = kNone;
    for (const auto& [from, way] : ways_[block]) {
      const uint32_t found = walker_of(f_.blocks[from].end.args[way][param]);
      if (found == kNone || (one != kNone && found != one)) return kNone;
      one = found;
    }
    return one;
  }

  uint32_t add_walker(Val handle, uint32_t param) {
    Walker w;
    w.handle = handle;
    w.param = param;
    w.site = static_cast<uint8_t>(kKnownReaches + walkers_.size());
    walkers_.push_back(w);
    return static_cast<uint32_t>(walkers_.size() - 1);
  }

  // --- what they must not lead to ---------------------------------------------------

  // Loads may see what a register has instead of memory; stores may change whatever the loop names.
  void find_questions() {
    std::vector<uint32_t> named = facts_.deferred(number_);
    if (stores()) {
      const std::vector<uint32_t>& reads = facts_.reads(number_);
      named.insert(named.end(), loop_.modified.begin(), loop_.modified.end());
      named.insert(named.end(), reads.begin(), reads.end());
      for (const Reload& reload : f_.blocks[front_].reloads) named.push_back(reload.variable);
    }
    for (const uint32_t v : named) {
      const Variable& variable = f_.variables[v];
      if (variable.slot || variable.constant) continue;
      add_question({variable.base, variable.offset, uint64_t{variable.offset} + variable.width});
      if (questions_.size() > kMostQuestions) return;
    }
  }

  // One with those that it touches.
  void add_question(Question q) {
    std::erase_if(questions_, [&](const Question& other) {
      const bool touches = other.base == q.base && other.begin <= q.end && q.begin <= other.end;
      if (touches) q = {q.base, std::min(q.begin, other.begin), std::max(q.end, other.end)};
      return touches;
    });
    questions_.push_back(q);
  }

  // Is an address wanted by anything but loads?
  bool stores() const {
    const auto is_resolved = [&](Val v) { return v != kNone && resolved_.find(v) != kNone; };
    for (Block b = loop_.head; b <= loop_.last; ++b) {
      for (const uint32_t number : f_.blocks[b].nodes) {
        const Node& n = f_.nodes[number];
        if (n.op != Op::kLoad && is_resolved(n.mem.index)) return true;
        if (std::any_of(std::begin(n.in), std::end(n.in), is_resolved)) return true;
      }
    }
    return false;
  }

  // --- in front of the loop ---------------------------------------------------------

  Val constant(uint64_t bits, uint8_t width) { return constants_->of(bits, width); }
  uint32_t made(Node n, Block b) {
    n.unit = unit_;
    const auto number = static_cast<uint32_t>(f_.nodes.size());
    if (n.op != Op::kExitIf && n.result == kNone) {
      n.result = static_cast<Val>(f_.values.size());
      f_.values.push_back({false, n.width, false, 0, number, b});
    }
    f_.nodes.push_back(n);
    return number;
  }
  Val in_front(Op op, uint8_t width, Val a, Val b = kNone) {
    Node n;
    n.op = op;
    n.width = width;
    n.in[0] = a;
    n.in[1] = b;
    return in_front(n);
  }
  Val in_front(const Node& n) {
    f_.blocks[front_].nodes.push_back(made(n, front_));
    return f_.nodes.back().result;
  }
  Val part(Val reach, const Walker& w, size_t member, uint8_t width) {
    Node n;
    n.op = Op::kReachPart;
    n.width = width;
    n.in[0] = reach;
    n.imm = member;
    n.site = w.site;
    return in_front(n);
  }

  void begin(Walker& w) {
    unit_ = f_.blocks[front_].unit;
    std::vector<Val>& args = f_.blocks[front_].end.args[0];
    const Val handle = w.param == kNone ? w.handle : args[w.param];
    Node look;
    look.op = Op::kReach;
    look.width = 8;
    look.in[0] = handle;
    look.site = w.site;
    const Val distance = in_front(look);
    const Val home = part(distance, w, offsetof(KnownReach, home), 4);
    w.size = part(distance, w, offsetof(KnownReach, size), 8);
    w.first = in_front(Op::kAdd, 4, home, part(distance, w, offsetof(KnownReach, begin), 4));
    Node place;
    place.op = Op::kPlace;
    place.width = 8;
    place.mem = {MemBase::kData, 1, w.first, 0};
    w.place = in_front(place);
    w.distance = distance;
    w.begin = in_front(Op::kAnd, 8, handle, constant(ir::kPlaceMask, 8));
    w.named = in_front(Op::kSub, 8, w.begin, distance);
    for (const Question& q : questions_) ask(q, w);
    if (w.param == kNone) {
      return lies_at(w.handle, distance);
    }
    args[w.param] = distance;
    lies_at(w.handle, new_param(loop_.head, w.param));
  }

  // Does the variable of the pointer hold one of these? Its bytes begin so far behind theirs, or
  // theirs behind its.
  void ask(const Question& q, const Walker& w) {
    const uint64_t more = q.end - q.begin - 1;
    Node address;
    address.op = Op::kAddr;
    address.width = 4;
    address.mem = {q.base, 1, kNone, static_cast<int64_t>(q.begin)};
    const Val apart = in_front(Op::kSub, 4, in_front(address), w.first);
    Node question;
    question.op = Op::kExitIf;
    question.width = 4;
    question.cond = Cond::kLtU;
    question.in[0] = in_front(Op::kAdd, 4, apart, constant(more, 4));
    question.in[1] = in_front(Op::kAdd, 4, w.size, constant(more, 4));
    question.exit = static_cast<uint32_t>(f_.exits.size());
    Exit exit;
    exit.unit = f_.blocks[front_].unit;
    exit.slots = f_.blocks[front_].dirty;
    f_.exits.push_back(std::move(exit));
    in_front(question);
  }

  // The parameter is a distance. What still wants the handle gets it at the block's beginning.
  Val new_param(Block b, uint32_t param) {
    const Val handle = f_.blocks[b].params[param];
    const auto distance = static_cast<Val>(f_.values.size());
    f_.values.push_back({false, 8, false, 0, kNone, b});
    f_.blocks[b].params[param] = distance;
    unit_ = f_.blocks[b].unit;
    f_.blocks[b].nodes.insert(f_.blocks[b].nodes.begin(), handle_at(handle, distance, b));
    return distance;
  }

  uint32_t handle_at(Val handle, Val distance, Block b) {
    Node n;
    n.op = Op::kHandleAt;
    n.width = 8;
    n.in[0] = distance;
    n.site = walkers_[walker_.at(handle)].site;
    n.result = handle;
    const uint32_t number = made(n, b);
    f_.values[handle].node = number;
    f_.values[handle].home = kNone;
    return number;
  }

  void lies_at(Val handle, Val distance) {
    distance_[handle] = distance;
    handles_.push_back(handle);
  }

  // --- in the loop ------------------------------------------------------------------

  // Null: the value is no pointer that walks.
  const Walker* walker(Val v) const {
    const uint32_t* const found = walker_.find(v);
    return found == nullptr || *found == kNone ? nullptr : &walkers_[*found];
  }

  void block(Block b) {
    if (b != loop_.head) params(b);
    const std::vector<uint32_t> nodes = std::move(f_.blocks[b].nodes);
    out_.clear();
    for (const uint32_t number : nodes) node(number, b);
    f_.blocks[b].nodes = out_;
  }

  // Ways forward alone lead here, so what they bring has its distance; but a way that lies behind
  // has none yet, and there is none.
  void params(Block b) {
    for (uint32_t i = 0; i < f_.blocks[b].params.size(); ++i) {
      const Val handle = f_.blocks[b].params[i];
      if (walker(handle) == nullptr) continue;
      lies_at(handle, new_param(b, i));
      for (const auto& [from, way] : ways_[b]) {
        Val& arg = f_.blocks[from].end.args[way][i];
        arg = distance_.at(arg);
      }
    }
  }

  Val append(Op op, uint8_t width, Val a, Val b, Block block) {
    Node n;
    n.op = op;
    n.width = width;
    n.in[0] = a;
    n.in[1] = b;
    out_.push_back(made(n, block));
    return f_.nodes.back().result;
  }
  void leave_if(Cond cond, Val a, Val b, uint32_t exit) {
    Node n;
    n.op = Op::kExitIf;
    n.width = 8;
    n.cond = cond;
    n.in[0] = a;
    n.in[1] = b;
    n.exit = exit;
    out_.push_back(made(n, 0));
  }

  void node(uint32_t number, Block b) {
    Node& n = f_.nodes[number];
    unit_ = n.unit;
    const Walker* const w = walker(n.result);
    if (n.op == Op::kResolve) return resolve(number, b);
    if (n.op == Op::kMoveHandle) return move(number, b);
    if (w != nullptr && (n.op == Op::kSelect || n.op == Op::kSelectCmp)) return select(number, b);
    if (n.op == Op::kHandleAt) return out_.push_back(number);  // of a parameter
    const bool names = n.op == Op::kAnd && walker(n.in[0]) != nullptr &&
                       f_.values[n.in[1]].constant && f_.values[n.in[1]].bits == ir::kPlaceMask;
    if (names) {
      n.op = Op::kAdd;
      n.in[1] = walker(n.in[0])->named;
      n.in[0] = distance_.at(n.in[0]);
    }
    const Address* const address = addresses_.find(n.mem.index);
    if (address != nullptr && n.mem.base == MemBase::kData && n.mem.scale == 1 &&
        (n.op == Op::kLoad || n.op == Op::kStore)) {
      n.mem = {MemBase::kPointer, 1, address->distance, n.mem.disp + address->bytes, address->place};
    }
    out_.push_back(number);
  }

  // A distance from here on does not leave so many bytes more behind it.
  Val limit_of(uint32_t walker, uint64_t more) {
    Walker& w = walkers_[walker];
    for (const auto& [bytes, limit] : w.limits) {
      if (bytes == more) return limit;
    }
    Val limit = w.size;
    if (more != 0) {
      const Val bytes = constant(more, 8);
      Node n;
      n.op = Op::kSelectCmp;
      n.width = n.from = 8;
      n.cond = Cond::kGtU;
      n.in[0] = in_front(Op::kSub, 8, w.size, bytes);
      n.in[1] = in_front(Op::kSub, 8, w.size, w.size);
      n.in[2] = w.size;
      n.in[3] = bytes;
      limit = in_front(n);
    }
    limit = in_front(Op::kAnd, 8, limit, constant(kSmall, 8));
    w.limits.push_back({more, limit});
    return limit;
  }

  void resolve(uint32_t number, Block b) {
    const Node n = f_.nodes[number];
    const uint32_t w = walker_.at(n.in[0]);
    const Val distance = distance_.at(n.in[0]);
    const auto bytes = static_cast<uint32_t>(n.imm);
    const auto last = bytes + (n.imm >> 32) - 1;
    const uint32_t* const step = steps_.find(n.in[0]);
    leave_if(Cond::kGeU, distance, limit_of(w, last), step == nullptr ? n.exit : *step);
    if (step != nullptr) f_.exits[n.exit].slots.clear();
    cover(distance, last + 1, b);
    addresses_[n.result] = {distance, walkers_[w].place, bytes};
    // For what is neither load nor store.
    Node sum;
    sum.op = Op::kAdd;
    sum.width = 4;
    sum.in[0] = walkers_[w].first;
    sum.in[1] = distance;
    if (bytes != 0) sum.in[0] = append(Op::kAdd, 4, sum.in[0], constant(bytes, 4), b);
    sum.result = n.result;
    const uint32_t made_at = made(sum, b);
    f_.values[n.result].node = made_at;
    out_.push_back(made_at);
  }

  // Have so many bytes behind the distance been asked for already?
  bool is_covered(Val distance, int64_t bytes, Block b) const {
    const Covered* const c = covered_.find(distance);
    if (bytes < 0 || c == nullptr) return false;
    const uint64_t here = c->block == b ? std::max(c->here, c->surely) : c->surely;
    return static_cast<uint64_t>(bytes) <= here;
  }
  void cover(Val distance, uint64_t bytes, Block b) {
    Covered& c = covered_[distance];
    if (c.block != b) c.here = 0;
    c.block = b;
    c.here = std::max(c.here, bytes);
    if (sure_.find(b) != kNone) c.surely = std::max(c.surely, bytes);
  }

  // p[i]: a handle that is made to be resolved at once needs no question of its own; where the one
  // of the RESOLVE is not answered, the interpreter makes it.
  void find_steps(const std::vector<uint32_t>& uses) {
    for (Block b = loop_.head; b <= loop_.last; ++b) {
      Val moved = kNone;
      uint32_t exit = kNone;
      for (const uint32_t number : f_.blocks[b].nodes) {
        const Node& n = f_.nodes[number];
        if (n.op == Op::kMoveHandle) {
          moved = n.result;
          exit = n.exit;
        } else if (n.op == Op::kResolve && n.in[0] == moved && moved != kNone) {
          const std::vector<SlotValue>& kept = f_.exits[n.exit].slots;
          const auto own = std::count_if(kept.begin(), kept.end(), [&](const SlotValue& slot) {
            return slot.value == moved;
          });
          if (uses[moved] == 1 + static_cast<uint32_t>(own)) steps_[moved] = exit;
          moved = kNone;
        } else if (!is_operation(n) && n.op != Op::kLoad) {
          moved = kNone;
        }
      }
    }
  }

  void move(uint32_t number, Block b) {
    const Node n = f_.nodes[number];
    const Walker& w = *walker(n.in[0]);
    const Val from = distance_.at(n.in[0]);
    Val by = n.in[1];
    int64_t bytes = -1;
    if (f_.values[by].constant) {
      bytes = static_cast<int32_t>(f_.values[by].bits);
      by = constant(static_cast<uint64_t>(bytes), 8);
    } else if (!is_within(by, 31)) {
      Node wide;
      wide.op = Op::kSext;
      wide.width = 8;
      wide.from = 4;
      wide.in[0] = by;
      out_.push_back(made(wide, b));
      by = f_.nodes.back().result;
    }
    const Val to = append(Op::kAdd, 8, from, by, b);
    lies_at(n.result, to);
    if (steps_.find(n.result) != nullptr) return;
    if (!is_covered(from, bytes, b)) leave_if(Cond::kGtU, to, w.size, n.exit);
    out_.push_back(handle_at(n.result, to, b));
  }

  // Is it a number between -2^bits and 2^bits, whatever it is made of?
  bool is_within(Val v, uint32_t bits) const {
    const Value& value = f_.values[v];
    if (value.constant || value.node == kNone) return false;
    const Node& n = f_.nodes[value.node];
    const bool times = (n.op == Op::kMul || n.op == Op::kShl) && f_.values[n.in[1]].constant;
    switch (n.op) {
      case Op::kSext:
      case Op::kZext:
        return 8u * n.from <= bits;
      case Op::kMul:
      case Op::kShl: {
        if (!times || n.width != 8) return false;
        const uint64_t by = f_.values[n.in[1]].bits;
        const uint64_t more = n.op == Op::kShl ? by : static_cast<uint64_t>(std::bit_width(by));
        return more <= bits && is_within(n.in[0], bits - static_cast<uint32_t>(more));
      }
      default:
        return false;
    }
  }

  void select(uint32_t number, Block b) {
    Node n = f_.nodes[number];
    const uint32_t first = n.op == Op::kSelect ? 1 : 0;
    for (uint32_t i = first; i < first + 2; ++i) n.in[i] = distance_.at(n.in[i]);
    const Val handle = n.result;
    n.result = kNone;
    out_.push_back(made(n, b));
    lies_at(handle, f_.nodes.back().result);
    out_.push_back(handle_at(handle, distance_.at(handle), b));
  }

  // WHILE p < stop: where the head asks whether a pointer is in front of another one, it asks for a
  // distance less than that of the other one, as a counter for its limit (counted.h).
  void count() {
    End& end = f_.blocks[loop_.head].end;
    if (end.kind != EndKind::kBranch || end.compare != Op::kCompare || end.width != 8) return;
    for (uint32_t i = 0; i < 2; ++i) {
      const Cond cond = i == 0 ? end.cond : swapped(end.cond);
      const bool strict = cond == Cond::kLtU || cond == Cond::kGeU;
      if (!strict && cond != Cond::kLeU && cond != Cond::kGtU) continue;
      const Walker* const w = asked(end.in[i]);
      const Val other = end.in[1 - i];
      if (w == nullptr || !to_front(other)) continue;
      // Of the first byte, seen from what the loop begins with: a pointer that is not walked with
      // is far behind it.
      const Val now = in_front(Op::kXor, 8, w->begin, constant(kOrder, 8));
      const Val own = in_front(Op::kSub, 8, now, w->distance);
      Val more = in_front(Op::kSub, 8, other, own);
      if (!strict) more = in_front(Op::kAdd, 8, more, constant(1, 8));
      Node limit;
      limit.op = Op::kSelectCmp;
      limit.width = limit.from = 8;
      limit.cond = strict ? Cond::kGtS : Cond::kGeS;
      limit.in[0] = more;
      limit.in[1] = in_front(Op::kSub, 8, own, own);
      limit.in[2] = other;
      limit.in[3] = own;
      end.in[1] = in_front(Op::kAnd, 8, in_front(limit), constant(kSmall, 8));
      end.in[0] = distance_.at(w->handle);
      end.cond = cond == Cond::kLtU || cond == Cond::kLeU ? Cond::kLtS : Cond::kGeS;
      return;
    }
  }

  // Is it the same in each turn? Then it is made in front.
  bool to_front(Val v) {
    if (v == kNone || !is_inside(v)) return true;
    const uint32_t number = f_.values[v].node;
    if (number == kNone) return false;
    const Node n = f_.nodes[number];
    if (!is_operation(n) || n.exit != kNone || walker(v) != nullptr) return false;
    if (!to_front(n.mem.index) || !to_front(n.mem.pointer)) return false;
    for (const Val in : n.in) {
      if (!to_front(in)) return false;
    }
    std::erase(f_.blocks[f_.values[v].block].nodes, number);
    f_.blocks[front_].nodes.push_back(number);
    f_.values[v].block = front_;
    return true;
  }

  // The pointer that each turn begins with, when the value is its place in an order with others.
  const Walker* asked(Val v) const {
    if (f_.values[v].constant || f_.values[v].node == kNone) return nullptr;
    const Node& order = f_.nodes[f_.values[v].node];
    if (order.op != Op::kXor || f_.values[order.in[0]].node == kNone) return nullptr;
    if (!f_.values[order.in[1]].constant || f_.values[order.in[1]].bits != kOrder) return nullptr;
    const Node& place = f_.nodes[f_.values[order.in[0]].node];
    for (const Walker& w : walkers_) {
      const bool is_it = place.op == Op::kAdd && place.in[1] == w.named && w.param != kNone;
      if (is_it && place.in[0] == distance_.at(w.handle)) return &w;
    }
    return nullptr;
  }

  // --- when it is left --------------------------------------------------------------

  void slots() {
    for (Block b = loop_.head; b <= loop_.last; ++b) {
      for (const uint32_t n : f_.blocks[b].nodes) slots(f_.nodes[n].exit);
      slots(f_.blocks[b].end.exit);
    }
  }
  void slots(uint32_t exit) {
    if (exit == kNone) return;
    for (SlotValue& slot : f_.exits[exit].slots) {
      const Walker* const w = walker(slot.value);
      if (w == nullptr || slot.site != kNoSite || !is_inside(slot.value)) continue;
      slot.site = w->site;
      slot.value = distance_.at(slot.value);
    }
  }

  // Where the loop has one way on, handles are made there.
  void behind(Renames& renames) {
    Block out = kNone;
    for (Block b = loop_.head; b <= loop_.last; ++b) {
      for (const Block to : f_.blocks[b].end.target) {
        if (to == kNone || (to >= loop_.head && to <= loop_.last)) continue;
        if (out != kNone && out != to) return;
        out = to;
      }
    }
    if (out == kNone || out < loop_.head || f_.blocks[out].resumes || has_other_way(out)) return;
    unit_ = f_.blocks[out].unit;
    for (uint32_t i = 0; i < f_.blocks[out].params.size(); ++i) param_behind(out, i);
    for (const Val handle : handles_) {
      const bool inside = is_inside(handle) && f_.values[handle].block <= loop_.last;
      if (!inside || steps_.find(handle) != nullptr) continue;
      const auto renamed = static_cast<Val>(f_.values.size());
      f_.values.push_back({false, 8, false, 0, kNone, out});
      Node n;
      n.op = Op::kHandleAt;
      n.width = 8;
      n.in[0] = distance_.at(handle);
      n.site = walker(handle)->site;
      n.result = renamed;
      f_.values[renamed].node = made(n, out);
      std::vector<uint32_t>& nodes = f_.blocks[out].nodes;
      nodes.insert(nodes.begin(), f_.values[renamed].node);
      renames[handle] = {renamed, loop_.head, loop_.last};
    }
  }

  bool has_other_way(Block out) const {
    return std::any_of(ways_[out].begin(), ways_[out].end(), [&](const auto& way) {
      return way.first < loop_.head || way.first > loop_.last;
    });
  }

  // What all ways bring is one pointer's: its distance.
  void param_behind(Block out, uint32_t param) {
    const auto each = [&](auto visit) {
      for (const auto& [from, way] : ways_[out]) visit(f_.blocks[from].end.args[way][param]);
    };
    uint32_t one = kNone;
    bool same = true;
    each([&](Val v) {
      const uint32_t* const found = walker_.find(v);
      const bool walks = found != nullptr && *found != kNone && is_inside(v);
      if (one == kNone && walks) one = *found;
      same &= walks && *found == one;
    });
    if (!same || one == kNone) return;
    walker_[f_.blocks[out].params[param]] = one;
    new_param(out, param);
    each([&](Val& v) { v = distance_.at(v); });
  }

  struct Address {
    Val distance = kNone;
    Val place = kNone;
    uint32_t bytes = 0;
  };

  struct Covered {
    uint64_t surely = 0;  // asked for in every turn
    uint64_t here = 0;    // in this block
    Block block = 0;
  };

  Function& f_;
  const Facts& facts_;
  const Ways& ways_;
  Constants* constants_ = nullptr;
  uint32_t number_;
  Loop loop_;
  Block front_;
  uint32_t unit_ = 0;
  std::vector<Walker> walkers_;
  ByKey<uint32_t> walker_;    // by handle; kNone: it is none
  ByKey<Val> distance_;       // by handle
  std::vector<Val> handles_;  // that have one
  ByKey<uint32_t> steps_;     // exits, by handle that is resolved at once
  ByKey<Address> addresses_;  // by what they were
  ByKey<Covered> covered_;    // by distance: bytes behind it
  NumberTable sure_;          // blocks that every turn goes through
  NumberTable resolved_;  // results of RESOLVE
  bool any_ = false;      // ... of which there are some
  std::vector<Question> questions_;
  std::vector<uint32_t> out_;
};

}  // namespace

namespace {

Ways ways_of(const Function& f) {
  Ways ways(f.blocks.size());
  for (Block b = 0; b < f.blocks.size(); ++b) {
    const End& end = f.blocks[b].end;
    for (uint32_t way = 0; way < 2; ++way) {
      if (end.target[way] != kNone) ways[end.target[way]].push_back({b, way});
    }
  }
  return ways;
}

std::vector<uint32_t> count_uses(const Function& f) {
  std::vector<uint32_t> uses(f.values.size(), 0);
  const auto use = [&](Val v) {
    if (v != kNone) ++uses[v];
  };
  for (const BasicBlock& block : f.blocks) {
    for (const uint32_t number : block.nodes) {
      const Node& n = f.nodes[number];
      for (const Val v : n.in) use(v);
      use(n.mem.index);
      use(n.mem.pointer);
      if (n.exit == kNone) continue;
      for (const SlotValue& slot : f.exits[n.exit].slots) use(slot.value);
    }
    for (const Val v : block.end.in) use(v);
    for (const std::vector<Val>& args : block.end.args) {
      for (const Val v : args) use(v);
    }
    if (block.end.exit == kNone) continue;
    for (const SlotValue& slot : f.exits[block.end.exit].slots) use(slot.value);
  }
  return uses;
}

void rename(Function& f, const Renames& renames) {
  for (Block b = 0; b < f.blocks.size(); ++b) {
    const auto change = [&](Val& v) {
      const Renamed* const found = renames.find(v);
      if (found != nullptr && (b < found->head || b > found->last)) v = found->to;
    };
    const auto exit = [&](uint32_t number) {
      if (number == kNone) return;
      for (SlotValue& slot : f.exits[number].slots) change(slot.value);
    };
    BasicBlock& block = f.blocks[b];
    for (const uint32_t number : block.nodes) {
      Node& n = f.nodes[number];
      for (Val& v : n.in) change(v);
      change(n.mem.index);
      change(n.mem.pointer);
      exit(n.exit);
    }
    for (Val& v : block.end.in) change(v);
    for (std::vector<Val>& args : block.end.args) {
      for (Val& v : args) change(v);
    }
    exit(block.end.exit);
    for (Reload& reload : block.reloads) change(reload.value);
    for (SlotValue& slot : block.dirty) change(slot.value);
  }
}

}  // namespace

bool walk_pointers(Function& f, const Facts& facts, std::vector<uint32_t>& unwalked) {
  std::vector<Walk> walks;
  Ways ways;
  bool all = true;
  const auto loops = static_cast<uint32_t>(facts.loops().size());
  for (uint32_t l = 0; l < loops; ++l) {
    if (!facts.is_walked(l)) continue;
    if (ways.empty()) ways = ways_of(f);
    walks.emplace_back(f, facts, ways, l);
    if (walks.back().find()) continue;
    unwalked.push_back(facts.blocks()[facts.loops()[l].head].first);
    all = false;
  }
  if (!all) return false;
  if (walks.empty()) return true;
  const std::vector<uint32_t> uses = count_uses(f);
  Renames renames;
  Constants constants(f);
  for (Walk& walk : walks) walk.change(uses, constants, renames);
  if (!renames.all().empty()) rename(f, renames);
  return true;
}

}  // namespace vm::native
