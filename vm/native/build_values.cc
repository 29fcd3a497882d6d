// Values, variables and memory while a Function is built.
#include <algorithm>
#include <bit>
#include <cstring>

#include "vm/native/build.h"
#include "vm/native/ranges.h"

namespace vm::native {
namespace {

uint64_t mix(uint64_t hash, uint64_t value) {
  hash ^= value + 0x9e3779b97f4a7c15u + (hash << 6) + (hash >> 2);
  return hash * 0xff51afd7ed558ccdu;
}

}  // namespace

uint64_t hash_of(const Node& n, uint32_t version) {
  uint64_t h = mix(static_cast<uint64_t>(n.op), n.width | n.from << 8 | n.boolean << 16);
  h = mix(h, static_cast<uint64_t>(n.cond));
  for (const Val in : n.in) h = mix(h, in);
  h = mix(h, n.imm);
  h = mix(h, static_cast<uint64_t>(n.mem.base) | n.mem.scale << 8);
  h = mix(h, n.mem.index);
  h = mix(h, n.mem.pointer);
  h = mix(h, static_cast<uint64_t>(n.mem.disp));
  return mix(h, version);
}

bool same(const Node& a, const Node& b) {
  return a.op == b.op && a.width == b.width && a.from == b.from && a.cond == b.cond &&
         a.boolean == b.boolean && a.imm == b.imm && std::memcmp(a.in, b.in, sizeof a.in) == 0 &&
         a.mem.base == b.mem.base && a.mem.scale == b.mem.scale && a.mem.index == b.mem.index &&
         a.mem.pointer == b.mem.pointer && a.mem.disp == b.mem.disp;
}

Val Builder::constant(uint64_t bits_, uint8_t width, bool floating) {
  bits_ &= mask(width);
  // By width too: 16#FFFF is -1 in two bytes.
  auto& known = constants_[(floating ? 4 : 0) + std::countr_zero(width)];
  const auto fresh = static_cast<Val>(f_.values.size());
  const Val value = known.add(bits_, fresh);
  if (value == fresh) {
    f_.values.push_back({floating, width, true, bits_, kNone, 0});
    epoch_of_.push_back(0);
  }
  return value;
}

Node Builder::node(Op op, uint8_t width, Val a, Val b, Val c, Val d) const {
  Node made;
  made.op = op;
  made.width = width;
  made.in[0] = a;
  made.in[1] = b;
  made.in[2] = c;
  made.in[3] = d;
  made.unit = unit_;
  return made;
}

void Builder::append(Node made) {
  f_.blocks[block_].nodes.push_back(static_cast<uint32_t>(f_.nodes.size()));
  f_.nodes.push_back(made);
}

// Operations on constants, and those that give an operand back. kNone: it must be computed.
Val Builder::fold(const Node& n) {
  const Val a = n.in[0];
  const Val b = n.in[1];
  const bool ca = a != kNone && is_constant(a);
  const bool cb = b != kNone && is_constant(b);
  const uint64_t x = ca ? bits(a) & mask(n.width) : 0;
  const uint64_t y = cb ? bits(b) & mask(n.width) : 0;
  switch (n.op) {
    case Op::kAdd:
      if (ca && cb) return constant(x + y, n.width, false);
      return cb && y == 0 ? a : kNone;
    case Op::kSub:
      if (ca && cb) return constant(x - y, n.width, false);
      return cb && y == 0 ? a : kNone;
    case Op::kMul:
      if (ca && cb) return constant(x * y, n.width, false);
      return cb && y == 1 ? a : kNone;
    case Op::kAnd:
      if (ca && cb) return constant(x & y, n.width, false);
      return a == b ? a : kNone;
    case Op::kOr:
      if (ca && cb) return constant(x | y, n.width, false);
      return a == b || (cb && y == 0) ? a : kNone;
    case Op::kXor:
      if (ca && cb) return constant(x ^ y, n.width, false);
      return cb && y == 0 ? a : kNone;
    case Op::kNotBool:
      return ca ? constant(bits(a) ^ 1, 1, false) : kNone;
    case Op::kCompare:
      return ca && cb ? constant(holds(n.cond, x, y, n.width) ? 1 : 0, 1, false) : kNone;
    case Op::kSext:
      return ca ? constant(static_cast<uint64_t>(as_signed(bits(a), n.from)), n.width, false)
                : kNone;
    case Op::kZext:
      if (ca) return constant(bits(a) & mask(n.from), n.width, false);
      return n.from == 4 ? kNone : kNone;
    case Op::kSelect:
      if (ca) return bits(a) != 0 ? n.in[1] : n.in[2];
      return n.in[1] == n.in[2] ? n.in[1] : kNone;
    default:
      return kNone;
  }
}

// a + (b << 3) is one address to the machine.
void Builder::add_shifted(Node& made) const {
  for (uint32_t i = 0; i < 2; ++i) {
    const Value& shifted = f_.values[made.in[1 - i]];
    if (shifted.node == kNone || epoch_of_[made.in[1 - i]] != epoch_) continue;
    const Node& shift = f_.nodes[shifted.node];
    if (shift.op != Op::kShl || shift.width != 8 || !is_constant(shift.in[1])) continue;
    if (bits(shift.in[1]) > 3 || is_constant(made.in[i])) continue;
    const Val left = made.in[i];
    made.op = Op::kAddShifted;
    made.imm = bits(shift.in[1]);
    made.in[0] = left;
    made.in[1] = shift.in[0];
    return;
  }
}

Val Builder::value_of(Node made, bool floating) {
  // A constant goes to the right.
  const bool commutes = made.op == Op::kAdd || made.op == Op::kMul || made.op == Op::kAnd ||
                        made.op == Op::kOr || made.op == Op::kXor;
  if (commutes && is_constant(made.in[0]) && !is_constant(made.in[1])) {
    std::swap(made.in[0], made.in[1]);
  }
  if (made.op == Op::kSub && is_constant(made.in[1])) {
    made.op = Op::kAdd;
    made.in[1] = constant(~bits(made.in[1]) + 1, made.width, false);
  }
  if (made.op == Op::kCompare && is_constant(made.in[0]) && !is_constant(made.in[1])) {
    std::swap(made.in[0], made.in[1]);
    made.cond = swapped(made.cond);
  }
  if (made.op == Op::kMul && made.width >= 4 && is_constant(made.in[1]) &&
      std::has_single_bit(bits(made.in[1])) && bits(made.in[1]) != 1) {
    made.op = Op::kShl;
    made.in[1] = constant(static_cast<uint64_t>(std::countr_zero(bits(made.in[1]))), 4, false);
  }
  if (made.op == Op::kAdd && made.width == 8) add_shifted(made);
  const Val folded = fold(made);
  if (folded != kNone) return folded;
  const bool memory = made.op == Op::kLoad && !made.immutable;
  const uint64_t hash = hash_of(made, memory ? version_ : 0);
  const uint32_t before = known_.set(hash, static_cast<uint32_t>(f_.nodes.size()));
  if (before != kNone && same(f_.nodes[before], made)) {
    known_.set(hash, before);
    return f_.nodes[before].result;
  }
  made.result = static_cast<Val>(f_.values.size());
  const bool answers = made.op == Op::kCompare || made.op == Op::kFCompare;
  f_.values.push_back({floating, answers ? uint8_t{1} : made.width, false, 0,
                       static_cast<uint32_t>(f_.nodes.size()), block_});
  epoch_of_.push_back(epoch_);
  append(made);
  return made.result;
}

Val Builder::int_op(Op op, uint8_t width, Val a, Val b, Val c, Val d) {
  return value_of(node(op, width, a, b, c, d), false);
}

// To 8 bytes.
Val Builder::extended(Val v, uint8_t width, bool is_signed) {
  if (width == 8) return v;
  Node made = node(is_signed ? Op::kSext : Op::kZext, 8, v);
  made.from = width;
  return value_of(made, false);
}

Val Builder::read(uint32_t variable) {
  named_at_[variable] = unit_;
  Val& value = now_.value[variable];
  if (value != kNone) return value;
  const Variable& v = f_.variables[variable];
  Node made = node(Op::kLoad, v.width);
  made.boolean = v.boolean;
  made.mem = {v.base, 1, kNone, static_cast<int64_t>(v.offset)};
  made.variable = variable;
  made.result = static_cast<Val>(f_.values.size());
  f_.values.push_back(
      {v.floating, v.width, false, 0, static_cast<uint32_t>(f_.nodes.size()), block_});
  epoch_of_.push_back(epoch_);
  append(made);
  return now_.value[variable] = made.result;
}

Val Builder::read_field(ir::Base base, uint32_t offset, ir::Class cls) {
  const bool floating = cls == ir::Class::kF32 || cls == ir::Class::kF64;
  const auto width = static_cast<uint8_t>(ir::class_size(cls));
  if (base == ir::Base::kConst) {
    uint64_t raw = 0;
    std::memcpy(&raw, facts_.image().pool.data() + offset, width);
    if (cls == ir::Class::kB) raw = raw != 0 ? 1 : 0;
    return constant(raw, width, floating);
  }
  return read(facts_.variable({base, offset, cls, true, false, false}));
}

Val Builder::read_a() { return read_field(u_.base_a(), u_.a, ir::opcode_row(u_.opcode()).a.cls); }
Val Builder::read_b() { return read_field(u_.base_b(), u_.b, ir::opcode_row(u_.opcode()).b.cls); }
Val Builder::read_c() { return read_field(u_.base_c(), u_.c, ir::opcode_row(u_.opcode()).c.cls); }

void Builder::write(uint32_t variable, Val value) {
  named_at_[variable] = unit_;
  const Variable& v = f_.variables[variable];
  now_.value[variable] = value;
  if (v.slot || (v.deferred && std::ranges::binary_search(deferred(), variable))) {
    now_.dirty[variable] = 1;
    return;
  }
  Node made = node(Op::kStore, v.width, value);
  made.mem = {v.base, 1, kNone, static_cast<int64_t>(v.offset)};
  made.variable = variable;
  append(made);
  for (const uint32_t other : f_.overlaps[variable]) now_.value[other] = kNone;
  ++version_;
}

void Builder::write_a(Val v) {
  write_field(u_.base_a(), u_.a, ir::opcode_row(u_.opcode()).a.cls, v);
}

void Builder::write_field(ir::Base base, uint32_t offset, ir::Class cls, Val v) {
  write(facts_.variable({base, offset, cls, false, true, false}), v);
}

Val Builder::load(const Mem& mem, uint8_t width, bool floating, bool boolean) {
  Node made = node(Op::kLoad, width);
  made.mem = mem;
  made.boolean = boolean;
  made.imm = floating ? 1 : 0;  // other bytes of a union are another value
  return value_of(made, floating);
}

// The place holds the value now: a load of it needs none.
void Builder::remember(const Mem& mem, uint8_t width, Val value, bool boolean) {
  Node made = node(Op::kLoad, width);
  made.mem = mem;
  made.boolean = boolean;
  made.imm = f_.values[value].floating ? 1 : 0;
  made.result = value;
  known_.set(hash_of(made, version_), static_cast<uint32_t>(f_.nodes.size()));
  f_.nodes.push_back(made);
}

// No code writes the ID of an instance.
Val Builder::load_id(const Mem& mem) {
  Node made = node(Op::kLoad, 4);
  made.mem = mem;
  made.immutable = true;
  return value_of(made, false);
}

void Builder::forget_everything() {
  known_.clear();
  ++epoch_;
  ++version_;
}

const std::vector<uint32_t>& Builder::deferred() const {
  static const std::vector<uint32_t> kNothing;
  const uint32_t loop = f_.blocks[block_].loop;
  return loop == kNone ? kNothing : facts_.deferred(loop);
}

void Builder::store_deferred() {
  for (const uint32_t v : deferred()) store_slot(v);
}

void Builder::store_slot(uint32_t variable) {
  if (now_.dirty[variable] == 0) return;
  const Variable& v = f_.variables[variable];
  Node made = node(Op::kStore, v.width, now_.value[variable]);
  made.mem = {v.base, 1, kNone, static_cast<int64_t>(v.offset)};
  made.variable = variable;
  append(made);
  now_.dirty[variable] = 0;
}

// The interpreter executes this unit anew. When it surely traps, it needs the unit's own operands
// of the frame; else everything that lives there.
uint32_t Builder::exit_here(bool everything) {
  Exit exit;
  exit.unit = unit_;
  const auto add = [&](uint32_t v) {
    if (v == kNone || now_.dirty[v] == 0) return;
    const Variable& variable = f_.variables[v];
    exit.slots.push_back({variable.offset, variable.width, now_.value[v], variable.base});
  };
  const Accesses accesses = accesses_of(u_);
  const auto is_written = [&](uint32_t v) {
    return std::any_of(accesses.begin(), accesses.end(), [&](const Access& access) {
      return access.writes && !access.reads && facts_.variable(access) == v;
    });
  };
  if (everything) {
    facts_.each_live_behind(unit_, [&](uint32_t v) {
      if (!is_written(v)) add(v);
    });
  }
  for (const Access& access : accesses) {
    const uint32_t v = access.reads ? facts_.variable(access) : kNone;
    if (v != kNone && f_.variables[v].slot) add(v);
  }
  for (const uint32_t v : deferred()) add(v);
  f_.exits.push_back(std::move(exit));
  return static_cast<uint32_t>(f_.exits.size() - 1);
}

// Leaves when a cond b; the same question is asked once only.
void Builder::exit_if(Cond cond, uint8_t width, Val a, Val b) {
  if (is_constant(a) && is_constant(b) &&
      !holds(cond, bits(a) & mask(width), bits(b) & mask(width), width)) {
    return;
  }
  Node made = node(Op::kExitIf, width, a, b);
  made.cond = cond;
  const uint64_t hash = hash_of(made, 0);
  const uint32_t before = known_.set(hash, static_cast<uint32_t>(f_.nodes.size()));
  if (before != kNone && same(f_.nodes[before], made)) {
    known_.set(hash, before);
    return;
  }
  made.exit = exit_here(false);
  append(made);
}

}  // namespace vm::native
