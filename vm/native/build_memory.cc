// Places, texts, native functions, what is copied whole.
#include <algorithm>
#include <bit>

#include "stdlib/native/natives.h"
#include "vm/exec/copies.h"
#include "vm/native/build.h"

namespace vm::native {
namespace {

constexpr uint32_t kMostArguments = 4;  // that a Node has room for
constexpr uint32_t kMostCopied = 128;   // bytes of one copy by registers
constexpr size_t kMostPieces = 16;
constexpr size_t kMostAtOnce = 6;  // pieces that are all read before the first is written

MemBase mem_base(ir::Base base) {
  if (base == ir::Base::kFrame) return MemBase::kFrame;
  return base == ir::Base::kSelf ? MemBase::kSelf : MemBase::kData;
}

}  // namespace

Mem Builder::place(ir::Base base, uint32_t offset) const {
  return {mem_base(base), 1, kNone, static_cast<int64_t>(offset)};
}

// What lies behind an address: a known place goes into the instruction.
Mem Builder::behind(Val address, uint32_t offset) const {
  const Value& value = f_.values[address];
  if (value.constant) return {MemBase::kData, 1, kNone, static_cast<int64_t>(value.bits + offset)};
  if (value.node != kNone && epoch_of_[address] == epoch_ && epoch_ != 0) {
    const Node& made = f_.nodes[value.node];
    if (made.op == Op::kAddr) {
      Mem mem = made.mem;
      mem.disp += offset;
      return mem;
    }
  }
  return {MemBase::kData, 1, address, static_cast<int64_t>(offset)};
}

Val Builder::address_of(const Mem& mem) {
  if (mem.base == MemBase::kData && mem.index == kNone) {
    return constant(static_cast<uint64_t>(mem.disp), 4, false);
  }
  if (mem.base == MemBase::kData && mem.scale == 1 && mem.disp == 0) return mem.index;
  Node made = node(Op::kAddr, 4);
  made.mem = mem;
  return value_of(made, false);
}

// The unit stores where no name says: what may lie there is known no more.
void Builder::kill_memory() {
  std::vector<uint32_t> killed;
  facts_.killed(unit_, killed);
  ++version_;
  std::vector<uint32_t> known;
  for (const uint32_t v : killed) {
    now_.value[v] = kNone;
    known.push_back(v);
  }
  if (known.empty()) return;
  Node& last = f_.nodes.back();
  last.kills = static_cast<uint32_t>(f_.kills.size());
  f_.kills.push_back(std::move(known));
}

// The pool lies at one of two places, as the generation says.
Val Builder::pool_address(uint32_t offset) {
  const Val pool = value_of(node(Op::kPool, 4), false);
  return int_op(Op::kAdd, 4, pool, constant(offset, 4, false));
}

// {offset:32, capacity:32}
void Builder::make_string(Val address) {
  const uint64_t capacity = uint64_t{x_.y()} << 32;
  write_a(int_op(Op::kOr, 8, address, constant(capacity, 8, false)));
}

// A function with the parameters of native ones; what the unit writes is known no more.
void Builder::call_function(stdlib::NativeFunction function, std::span<const Val> arguments,
                            Val result) {
  store_deferred();
  Node made = node(Op::kNative, 8);
  std::copy(arguments.begin(), arguments.end(), made.in);
  made.imm = reinterpret_cast<uintptr_t>(function);
  made.result = result;
  if (result != kNone) f_.values[result].node = static_cast<uint32_t>(f_.nodes.size());
  append(made);
  kill_memory();
}

void Builder::native() {
  const stdlib::NativeRow& row = stdlib::native_row(u_.c);
  const uint32_t slots = u_.a * 8u;
  const auto slot = [&](uint32_t number, char letter) {
    const ir::Class cls = ir::class_of(stdlib::native_scalar(letter));
    return facts_.find_variable({ir::Base::kFrame, slots + 8 * number, cls, true, false, false});
  };
  const auto count = static_cast<uint32_t>(row.arguments.size());
  if (count > kMostArguments) return helper();
  uint32_t variables[kMostArguments];
  for (uint32_t i = 0; i < count; ++i) {
    variables[i] = slot(i, row.arguments[i]);
    if (variables[i] == kNone) return helper();
  }
  Val arguments[kMostArguments];
  for (uint32_t i = 0; i < count; ++i) arguments[i] = read(variables[i]);
  const uint32_t to = row.result == 'v' ? kNone : slot(0, row.result);
  if (to == kNone) return call_function(row.function, {arguments, count}, kNone);
  const Variable& variable = f_.variables[to];
  const auto bits = static_cast<Val>(f_.values.size());
  f_.values.push_back({false, variable.width, false, 0, kNone, block_});
  epoch_of_.push_back(epoch_);
  call_function(row.function, {arguments, count}, bits);
  if (!variable.floating) return write(to, bits);
  Node number = node(Op::kBitsToFloat, variable.width, bits);
  number.from = variable.width;
  write(to, value_of(number, true));
}

void Builder::copy_text() {
  const bool wide = u_.opcode() == ir::Opcode::WCOPY;
  const Val arguments[] = {read_a(), read_b()};
  call_function(wide ? &copy_wstring : &copy_string, arguments, kNone);
}

// The bytes from `at` on as pieces that registers hold, cut where variables of either place begin
// and end. False: they are too many.
bool Builder::cut(const Mem places[2], uint32_t size, size_t most, std::vector<Piece>& out) const {
  if (size > kMostCopied) return false;
  std::vector<bool> begins(size + 1, false);
  begins[size] = true;
  for (uint32_t i = 0; i < 2; ++i) {
    each_variable_in(places[i], size, [&](uint32_t, int64_t at, uint8_t width) {
      if (at >= 0) begins[static_cast<size_t>(at)] = true;
      if (at + width < size) begins[static_cast<size_t>(at + width)] = true;
    });
  }
  for (uint32_t at = 0; at < size;) {
    uint32_t end = at + 1;
    while (!begins[end]) ++end;
    const auto width = static_cast<uint8_t>(std::bit_floor(std::min(end - at, 8u)));
    out.push_back({at, width});
    at += width;
    if (out.size() > most) return false;
  }
  return true;
}

template <class Visit>
void Builder::each_variable_in(const Mem& mem, uint32_t size, Visit visit) const {
  if (mem.index != kNone || mem.pointer != kNone) return;
  for (uint32_t v = 0; v < f_.variables.size(); ++v) {
    const Variable& variable = f_.variables[v];
    if (variable.base != mem.base || variable.constant) continue;
    const int64_t at = int64_t{variable.offset} - mem.disp;
    if (at < size && at + variable.width > 0) visit(v, at, variable.width);
  }
}

// The bytes of one piece: as the variable that lies there, when there is one. A BOOL there may be
// any byte.
Val Builder::read_piece(const Mem& from, const Piece& piece) {
  uint32_t found = kNone;
  each_variable_in(from, kMostCopied, [&](uint32_t v, int64_t at, uint8_t width) {
    const bool fits = at == piece.at && width == piece.width && !f_.variables[v].boolean;
    if (fits && (found == kNone || now_.value[v] != kNone)) found = v;
  });
  if (found != kNone) return read(found);
  Mem mem = from;
  mem.disp += piece.at;
  return load(mem, piece.width, false, false);
}

// What the place holds now, piece by piece.
void Builder::known_pieces(const Mem& to, std::span<const Piece> pieces,
                           std::span<const Val> values) {
  for (size_t i = 0; i < pieces.size(); ++i) {
    const Val value = values[i];
    each_variable_in(to, kMostCopied, [&](uint32_t v, int64_t at, uint8_t width) {
      const Variable& variable = f_.variables[v];
      if (at != pieces[i].at || width != pieces[i].width) return;
      if (variable.floating != f_.values[value].floating) return;
      if (!variable.boolean) {
        now_.value[v] = value;
        return;
      }
      Node is_true = node(Op::kCompare, 1, value, zero());
      is_true.cond = Cond::kNe;
      now_.value[v] = value_of(is_true, false);
    });
    Mem mem = to;
    mem.disp += pieces[i].at;
    remember(mem, pieces[i].width, value, false);
  }
}

void Builder::copy() {
  const uint32_t size = facts_.copied_bytes(unit_);
  if (size == 0) return;
  const Val addresses[2] = {read_a(), read_b()};
  const Mem places[2] = {behind(addresses[0], 0), behind(addresses[1], 0)};
  const bool apart = !facts_.may_overlap(unit_);
  std::vector<Piece> pieces;
  if (!cut(places, size, apart ? kMostPieces : kMostAtOnce, pieces)) {
    const Val arguments[] = {addresses[0], addresses[1], constant(size, 8, false)};
    return call_function(&move_bytes, arguments, kNone);
  }
  std::vector<Val> values;
  uint32_t first_store = kNone;
  const auto put = [&](size_t i) {
    Node made = node(Op::kStore, pieces[i].width, values[i]);
    made.mem = places[0];
    made.mem.disp += pieces[i].at;
    if (first_store == kNone) first_store = static_cast<uint32_t>(f_.nodes.size());
    append(made);
  };
  for (size_t i = 0; i < pieces.size(); ++i) {
    values.push_back(read_piece(places[1], pieces[i]));
    if (apart) put(i);
  }
  for (size_t i = 0; i < pieces.size() && !apart; ++i) put(i);
  kill_memory();
  // Before the first byte changes.
  f_.nodes[first_store].kills = f_.nodes.back().kills;
  known_pieces(places[0], pieces, values);
}

}  // namespace vm::native
