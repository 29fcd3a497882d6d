#include "vm/native/walk.h"

#include <algorithm>
#include <bit>

#include "ir/types/handle.h"
#include "vm/exec/context.h"

namespace vm::native {

void Walk::change(const std::vector<uint32_t>& uses, Constants& constants, Renames& renames) {
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

uint32_t Walk::made(Node n, Block b) {
  n.unit = unit_;
  const auto number = static_cast<uint32_t>(f_.nodes.size());
  if (n.op != Op::kExitIf && n.result == kNone) {
    n.result = static_cast<Val>(f_.values.size());
    f_.values.push_back({false, n.width, false, 0, number, b});
  }
  f_.nodes.push_back(n);
  return number;
}

Val Walk::in_front(Op op, uint8_t width, Val a, Val b) {
  Node n;
  n.op = op;
  n.width = width;
  n.in[0] = a;
  n.in[1] = b;
  return in_front(n);
}

Val Walk::in_front(const Node& n) {
  f_.blocks[front_].nodes.push_back(made(n, front_));
  return f_.nodes.back().result;
}

Val Walk::part(Val reach, const Walker& w, size_t member, uint8_t width) {
  Node n;
  n.op = Op::kReachPart;
  n.width = width;
  n.in[0] = reach;
  n.imm = member;
  n.site = w.site;
  return in_front(n);
}

void Walk::begin(Walker& w) {
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

void Walk::ask(const Question& q, const Walker& w) {
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

Val Walk::new_param(Block b, uint32_t param) {
  const Val handle = f_.blocks[b].params[param];
  const auto distance = static_cast<Val>(f_.values.size());
  f_.values.push_back({false, 8, false, 0, kNone, b});
  f_.blocks[b].params[param] = distance;
  unit_ = f_.blocks[b].unit;
  f_.blocks[b].nodes.insert(f_.blocks[b].nodes.begin(), handle_at(handle, distance, b));
  return distance;
}

uint32_t Walk::handle_at(Val handle, Val distance, Block b) {
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

void Walk::lies_at(Val handle, Val distance) {
  distance_[handle] = distance;
  handles_.push_back(handle);
}

const Walk::Walker* Walk::walker(Val v) const {
  const uint32_t* const found = walker_.find(v);
  return found == nullptr || *found == kNone ? nullptr : &walkers_[*found];
}

void Walk::block(Block b) {
  if (b != loop_.head) params(b);
  const std::vector<uint32_t> nodes = std::move(f_.blocks[b].nodes);
  out_.clear();
  for (const uint32_t number : nodes) node(number, b);
  f_.blocks[b].nodes = out_;
}

void Walk::params(Block b) {
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

Val Walk::append(Op op, uint8_t width, Val a, Val b, Block block) {
  Node n;
  n.op = op;
  n.width = width;
  n.in[0] = a;
  n.in[1] = b;
  out_.push_back(made(n, block));
  return f_.nodes.back().result;
}

void Walk::leave_if(Cond cond, Val a, Val b, uint32_t exit) {
  Node n;
  n.op = Op::kExitIf;
  n.width = 8;
  n.cond = cond;
  n.in[0] = a;
  n.in[1] = b;
  n.exit = exit;
  out_.push_back(made(n, 0));
}

void Walk::node(uint32_t number, Block b) {
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

Val Walk::limit_of(uint32_t walker, uint64_t more) {
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

void Walk::resolve(uint32_t number, Block b) {
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

bool Walk::is_covered(Val distance, int64_t bytes, Block b) const {
  const Covered* const c = covered_.find(distance);
  if (bytes < 0 || c == nullptr) return false;
  const uint64_t here = c->block == b ? std::max(c->here, c->surely) : c->surely;
  return static_cast<uint64_t>(bytes) <= here;
}

void Walk::cover(Val distance, uint64_t bytes, Block b) {
  Covered& c = covered_[distance];
  if (c.block != b) c.here = 0;
  c.block = b;
  c.here = std::max(c.here, bytes);
  if (sure_.find(b) != kNone) c.surely = std::max(c.surely, bytes);
}

void Walk::find_steps(const std::vector<uint32_t>& uses) {
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
        const auto own = std::count_if(kept.begin(), kept.end(),
                                       [&](const SlotValue& slot) { return slot.value == moved; });
        if (uses[moved] == 1 + static_cast<uint32_t>(own)) steps_[moved] = exit;
        moved = kNone;
      } else if (!is_operation(n) && n.op != Op::kLoad) {
        moved = kNone;
      }
    }
  }
}

void Walk::move(uint32_t number, Block b) {
  const Node n = f_.nodes[number];
  const Walker& w = *walker(n.in[0]);
  const Val from = distance_.at(n.in[0]);
  const Val by = n.in[1];
  const Value& way = f_.values[by];
  const int64_t bytes = way.constant ? static_cast<int64_t>(way.bits) : -1;
  const Val to = append(Op::kAdd, 8, from, by, b);
  lies_at(n.result, to);
  if (steps_.find(n.result) != nullptr) return;
  if (!is_covered(from, bytes, b)) leave_if(Cond::kGtU, to, w.size, n.exit);
  out_.push_back(handle_at(n.result, to, b));
}

void Walk::select(uint32_t number, Block b) {
  Node n = f_.nodes[number];
  const uint32_t first = n.op == Op::kSelect ? 1 : 0;
  for (uint32_t i = first; i < first + 2; ++i) n.in[i] = distance_.at(n.in[i]);
  const Val handle = n.result;
  n.result = kNone;
  out_.push_back(made(n, b));
  lies_at(handle, f_.nodes.back().result);
  out_.push_back(handle_at(handle, distance_.at(handle), b));
}

}  // namespace vm::native
