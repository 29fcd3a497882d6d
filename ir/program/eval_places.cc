// Places to variables, and the instructions that read and write them.
#include <algorithm>
#include <utility>

#include "base/check.h"
#include "ir/program/eval_machine.h"
#include "ir/types/handle.h"
#include "ir/types/parts.h"
#include "stdlib/native/natives.h"

namespace ir {

// Arguments of a call go into the callee's frame before it runs; after the call the
// same frame holds its results, and the next call's first argument replaces it.
Frame& EvalMachine::next_callee(Frame& frame, PouId pou) {
  const Pou& callee = program_.pous[pou.index];
  if (frame.callee == nullptr || frame.callee->ran || frame.callee->pou != &callee) {
    frame.callee = make_frame(callee, nullptr);
  }
  return *frame.callee;
}

Variable& EvalMachine::constant(const Place& place) {
  std::unique_ptr<Variable>& known = constants_[{place.constant.index, place.base_type.index}];
  if (known == nullptr) {
    known = std::make_unique<Variable>(variables_.make(place.base_type, place.constant));
  }
  return *known;
}

Address EvalMachine::locate_base(Frame& frame, const Place& place) {
  const auto whole = [](Variable& variable, uint64_t serial, bool is_constant) {
    return Address{&variable, serial, &variable, 0, variable.type, 0, is_constant};
  };
  switch (place.base) {
    case PlaceBase::kLocal:
      return whole(frame.locals[place.base_index], frame.serial, false);
    case PlaceBase::kSelf:
      return whole(*frame.self, 0, false);
    case PlaceBase::kGlobal:
      return whole(globals_, 0, false);
    case PlaceBase::kConst:
      return whole(constant(place), 0, true);
    case PlaceBase::kArg:
      base::check(frame.callee != nullptr, "the call discipline was verified");
      return whole(frame.callee->locals[place.base_index], frame.callee->serial, false);
    case PlaceBase::kPointee:
    case PlaceBase::kTarget:
      return frame.values[place.value.index].address;
  }
  return {};
}

namespace {

// A global that names a program is not the program itself.
Variable* entered(Variable* instance) {
  return instance->slot ? instance->target.variable : instance;
}

}  // namespace

bool EvalMachine::follow(const Inst& inst, Address& at) {
  at = at.variable->target;
  if (!alive(at)) {
    trap(inst, TrapKind::kReference, "");
    return false;
  }
  return true;
}

// All index steps of one array, from `step` on, as the number of the element; leaves `step` at
// the last of them.
std::optional<uint64_t> EvalMachine::element(const Frame& frame, const Inst& inst,
                                             const Place& place, size_t& step, TypeId type) {
  const Type& array = program_.types[type];
  uint64_t flat = 0;
  for (size_t i = 0; i < array.dims.size(); ++i) {
    const Step& at = place.steps[step + i];
    const Dimension& dim = array.dims[i];
    const Scalar scalar =
        at.value.valid() ? frame.pou->values[at.value.index].scalar : Scalar::kI64;
    const uint64_t index =
        at.value.valid() ? bits(frame, at.value) : static_cast<uint64_t>(at.constant_index);
    const bool huge = scalar == Scalar::kU64 && index > uint64_t{INT64_MAX};
    const int64_t position = static_cast<int64_t>(index);
    if (huge || position < dim.low || position > dim.high) {
      trap(inst, TrapKind::kIndex,
           "index " + integer_text(scalar, index) + " of " + program_.types.text(type));
      return std::nullopt;
    }
    flat = flat * dim.count() + (index - static_cast<uint64_t>(dim.low));
  }
  step += array.dims.size() - 1;
  return flat;
}

// What overlaps has no parts of its own: from there on it is bytes.
void EvalMachine::enter_member(Address& at, uint32_t number) const {
  if (layouts_ != nullptr) {
    at.offset += (*layouts_)[at.type].member_offsets[number];
  }
  const bool parts = at.variable != nullptr && !program_.types.overlaps(at.type);
  at.type = program_.types[at.type].members[number].type;
  at.variable = parts ? &at.variable->parts[number] : nullptr;
}

bool EvalMachine::walk(const Frame& frame, const Inst& inst, const Place& place, size_t first,
                       Address& at) {
  for (size_t i = first; i < place.steps.size(); ++i) {
    switch (place.steps[i].kind) {
      case StepKind::kMember:
        enter_member(at, place.steps[i].index);
        break;
      case StepKind::kIndex: {
        const std::optional<uint64_t> flat = element(frame, inst, place, i, at.type);
        if (!flat) {
          return false;
        }
        at.type = program_.types[at.type].base;
        at.variable = at.variable == nullptr ? nullptr : &at.variable->parts[*flat];
        if (layouts_ != nullptr) {
          at.offset += static_cast<uint32_t>(*flat * (*layouts_)[at.type].size);
        }
        break;
      }
      case StepKind::kEnter:
        at.variable = at.root = entered(at.variable);
        at.offset = 0;
        at.frame = 0;
        break;
      case StepKind::kDeref:
        if (!follow(inst, at)) {
          return false;
        }
        break;
    }
  }
  return true;
}

Address EvalMachine::locate(Frame& frame, const Inst& inst, PlaceId id) {
  const Place& place = frame.pou->places[id.index];
  if (place.base == PlaceBase::kTarget) {
    return locate_target(frame, inst, place);
  }
  Address at = locate_base(frame, place);
  if (place.base == PlaceBase::kPointee && !alive(at)) {
    trap(inst, TrapKind::kReference, "");
    return {};
  }
  if (!walk(frame, inst, place, 0, at)) {
    return {};
  }
  at.capacity = program_.types[at.type].capacity;
  return at;
}

namespace {

bool is_string(const TypeTable& types, TypeId type) {
  return types[type].kind == Kind::kString || types[type].kind == Kind::kWstring;
}

}  // namespace

std::optional<uint64_t> EvalMachine::moved(const Frame& frame, const Inst& inst,
                                           const Place& place) {
  Address at;
  at.type = place.base_type;
  if (!walk(frame, inst, place, 0, at)) {
    return std::nullopt;
  }
  return references_->move(bits(frame, place.value), at.offset);
}

// Behind a handle only the part that is used must be there. Where instances are, the whole must.
Address EvalMachine::locate_target(Frame& frame, const Inst& inst, const Place& place) {
  const bool whole = holds_instance(program_.types, place.base_type);
  const std::optional<uint64_t> handle =
      whole ? bits(frame, place.value) : moved(frame, inst, place);
  if (!handle) {
    return {};
  }
  const TypeId type = whole ? place.base_type : place.type;
  const bool string = is_string(program_.types, type) && inst.op != Op::kAddress;
  std::optional<Address> at = references_->resolve(*handle, type, string);
  if (!at) {
    trap(inst, TrapKind::kReference, references_->why_unresolved(*handle, type, string));
    return {};
  }
  if (whole && !walk(frame, inst, place, 0, *at)) {
    return {};
  }
  if (whole) {
    at->capacity = program_.types[at->type].capacity;
  }
  return *at;
}

// A BOOL that was written as bytes counts as TRUE when it is not zero.
uint64_t EvalMachine::load_bits(const Address& at) const {
  const Scalar scalar = program_.types.scalar(at.type);
  uint64_t bits = 0;
  if (at.variable != nullptr) {
    bits = at.variable->bits;
  } else {
    std::vector<uint8_t> raw(scalar_size(scalar));
    references_->bytes().read(*at.root, at.offset, raw);
    for (size_t i = 0; i < raw.size(); ++i) {
      bits |= uint64_t{raw[i]} << (8 * i);
    }
  }
  return scalar == Scalar::kBool ? bits != 0 : canonical(scalar, bits);
}

void EvalMachine::store_bits(const Address& at, uint64_t bits) {
  if (at.variable != nullptr) {
    at.variable->bits = bits;
    return;
  }
  std::vector<uint8_t> raw(scalar_size(program_.types.scalar(at.type)));
  for (size_t i = 0; i < raw.size(); ++i) {
    raw[i] = static_cast<uint8_t>(bits >> (8 * i));
  }
  references_->bytes().write(*at.root, at.offset, raw);
}

// The units of a string from its first one on, capacity + 1 of them.
std::vector<uint8_t> EvalMachine::units_of(const Address& string) const {
  const size_t unit = program_.types[string.type].kind == Kind::kWstring ? 2 : 1;
  std::vector<uint8_t> units((size_t{string.capacity} + 1) * unit);
  if (string.variable != nullptr) {
    std::copy_n(string.variable->bytes.begin(), units.size(), units.begin());
  } else {
    references_->bytes().read(*string.root, string.offset, units);
  }
  return units;
}

void EvalMachine::set_units(const Address& to, const std::vector<uint8_t>& units) {
  if (to.variable != nullptr) {
    std::copy(units.begin(), units.end(), to.variable->bytes.begin());
  } else {
    references_->bytes().write(*to.root, to.offset, units);
  }
}

// Up to the NUL or the capacity, and a NUL; what lies after stays.
void EvalMachine::set_text(const Address& to, std::string_view text) {
  const size_t unit = program_.types[to.type].kind == Kind::kWstring ? 2 : 1;
  size_t length = 0;
  const size_t most = std::min(text.size() / unit, size_t{to.capacity});
  while (length < most &&
         text.substr(length * unit, unit).find_first_not_of('\0') != std::string_view::npos) {
    ++length;
  }
  std::vector<uint8_t> units(text.begin(), text.begin() + static_cast<ptrdiff_t>(length * unit));
  units.resize(units.size() + unit);
  set_units(to, units);
}

void EvalMachine::copy(const Address& to, const Address& from) {
  if (is_string(program_.types, to.type)) {
    const std::vector<uint8_t> units = units_of(from);
    const size_t unit = program_.types[from.type].kind == Kind::kWstring ? 2 : 1;
    return set_text(to, {reinterpret_cast<const char*>(units.data()), from.capacity * unit});
  }
  if (program_.types.is_scalar(to.type)) {
    return store_bits(to, load_bits(from));
  }
  if (to.variable != nullptr && from.variable != nullptr) {
    return variables_.copy(*to.variable, *from.variable);
  }
  std::vector<uint8_t> raw((*layouts_)[to.type].size);
  references_->bytes().read(*from.root, from.offset, raw);
  references_->bytes().write(*to.root, to.offset, raw);
}

void EvalMachine::run_memory(Frame& frame, const Inst& inst) {
  const Place& place = frame.pou->places[inst.place.index];
  if (place.base == PlaceBase::kArg && inst.op != Op::kLoad) {
    next_callee(frame, place.pou);
  }
  // Which of two traps comes first: indices are checked in front of a copy, and handles are
  // resolved by it, that of the source first.
  Address from;
  std::optional<EvalTrap> unresolved;
  if (inst.op == Op::kCopy) {
    from = locate(frame, inst, inst.place2);
    const bool handle = frame.pou->places[inst.place2.index].base == PlaceBase::kTarget;
    const bool late = trap_ && trap_->kind == TrapKind::kReference;
    if (late && handle) unresolved = std::exchange(trap_, {});
  }
  const Address to = trap_ ? Address() : locate(frame, inst, inst.place);
  if (unresolved && (!trap_ || trap_->kind == TrapKind::kReference)) trap_ = std::move(unresolved);
  if (trap_) return;
  switch (inst.op) {
    case Op::kLoad:
      frame.values[inst.result.index].bits = load_bits(to);
      break;
    case Op::kStore:
      if (to.variable != nullptr && to.variable->slot) {
        to.variable->target = frame.values[inst.operands[0].index].address;
      } else {
        store_bits(to, bits(frame, inst.operands[0]));
      }
      break;
    case Op::kInit: {
      Variable initial = variables_.make(to.type, inst.constant);
      copy(to, {&initial, 0, &initial, 0, to.type, program_.types[to.type].capacity, true});
      break;
    }
    default:
      copy(to, from);
  }
}

// Whoever gets the address of a constant gets a copy, so that no constant changes.
void EvalMachine::run_string_or_address(Frame& frame, const Inst& inst) {
  Address at = locate(frame, inst, inst.place);
  if (trap_) {
    return;
  }
  if (at.constant && inst.op == Op::kAddress) {
    frame.constants.push_back(std::make_unique<Variable>(*at.variable));
    at.variable = at.root = frame.constants.back().get();
    at.offset = 0;
    at.frame = frame.serial;
  }
  frame.values[inst.result.index].address = at;
}

void EvalMachine::run_handle(Frame& frame, const Inst& inst) {
  uint64_t& result = frame.values[inst.result.index].bits;
  if (inst.op == Op::kFlat) {
    result = references_->flat(bits(frame, inst.operands[0]));
    return;
  }
  if (inst.op == Op::kUnflat) {
    result = references_->unflat(static_cast<uint32_t>(bits(frame, inst.operands[0])));
    return;
  }
  const Place& place = frame.pou->places[inst.place.index];
  const bool moves = std::all_of(place.steps.begin(), place.steps.end(), [](const Step& step) {
    return step.kind == StepKind::kMember || step.kind == StepKind::kIndex;
  });
  const bool instance = !place.steps.empty() && program_.types.is_instance(place.type);
  if (place.base == PlaceBase::kTarget && moves && !instance) {
    if (const std::optional<uint64_t> handle = moved(frame, inst, place)) {
      result = *handle;
    }
    return;
  }
  Address at = locate(frame, inst, inst.place);
  if (trap_) {
    return;
  }
  if (program_.types.is_instance(at.type)) {
    at.root = entered(at.variable);  // the slot's instance: its area
    at.offset = 0;
  }
  const std::optional<uint64_t> handle = references_->handle_of(at, task_);
  if (!handle) {
    return trap(inst, TrapKind::kStack, "");
  }
  result = *handle;
}

void EvalMachine::run_native(Frame& frame, const Inst& inst) {
  const stdlib::NativeRow& row = stdlib::native_row(inst.native);
  // Strings lie one after the other in `memory`, and references to them among the arguments.
  std::vector<uint64_t> args(std::max<size_t>(inst.operands.size(), stdlib::kDirectArguments));
  std::vector<uint8_t> memory;
  size_t first_size = 0;
  for (size_t i = 0; i < inst.operands.size(); ++i) {
    const EvalValue& value = frame.values[inst.operands[i].index];
    args[i] = value.bits;
    if (row.arguments[i] != 'S' && row.arguments[i] != 'W') continue;
    if (!alive(value.address)) {
      return trap(inst, TrapKind::kReference, "");
    }
    const std::vector<uint8_t> units = units_of(value.address);
    args[i] = memory.size() | uint64_t{value.address.capacity} << 32;
    memory.insert(memory.end(), units.begin(), units.end());
    if (i == 0) first_size = memory.size();
  }
  frame.callee.reset();
  const bool direct = inst.operands.size() <= stdlib::kDirectArguments;
  const uint64_t first = direct ? args[0] : reinterpret_cast<uintptr_t>(args.data());
  const uint64_t result = row.function(memory.data(), first, args[1], args[2], args[3], args[4]);
  if (row.result == 'v') {
    memory.resize(first_size);
    set_units(frame.values[inst.operands[0].index].address, memory);
  } else if (inst.result.valid()) {
    frame.values[inst.result.index].bits = canonical(inst.scalar, result);
  }
}

}  // namespace ir
