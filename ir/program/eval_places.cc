// Places to variables, and the instructions that read and write them.
#include <algorithm>

#include "base/check.h"
#include "ir/program/eval_machine.h"
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
  switch (place.base) {
    case PlaceBase::kLocal:
      return {&frame.locals[place.base_index], frame.serial};
    case PlaceBase::kSelf:
      return {frame.self, 0};
    case PlaceBase::kGlobal:
      return {&globals_, 0};
    case PlaceBase::kConst:
      return {&constant(place), 0};
    case PlaceBase::kArg:
      base::check(frame.callee != nullptr, "the call discipline was verified");
      return {&frame.callee->locals[place.base_index], frame.callee->serial};
    case PlaceBase::kPointee:
      return frame.values[place.value.index].address;
  }
  return {};
}

bool EvalMachine::follow(const Inst& inst, Address& at) {
  at = at.variable->target;
  if (!alive(at)) {
    trap(inst, TrapKind::kReference, "");
    return false;
  }
  return true;
}

// All index steps of one array, from `step` on; leaves `step` at the last of them.
bool EvalMachine::select(const Frame& frame, const Inst& inst, const Place& place, size_t& step,
                         Variable*& variable) {
  const Type& array = program_.types[variable->type];
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
           "index " + integer_text(scalar, index) + " of " + program_.types.text(variable->type));
      return false;
    }
    flat = flat * dim.count() + (index - static_cast<uint64_t>(dim.low));
  }
  step += array.dims.size() - 1;
  variable = &variable->parts[flat];
  return true;
}

Address EvalMachine::locate(Frame& frame, const Inst& inst, PlaceId id) {
  const Place& place = frame.pou->places[id.index];
  Address at = locate_base(frame, place);
  if (place.base == PlaceBase::kPointee && !alive(at)) {
    trap(inst, TrapKind::kReference, "");
    return {};
  }
  for (size_t i = 0; i < place.steps.size(); ++i) {
    switch (place.steps[i].kind) {
      case StepKind::kMember:
        at.variable = &at.variable->parts[place.steps[i].index];
        break;
      case StepKind::kIndex:
        if (!select(frame, inst, place, i, at.variable)) {
          return {};
        }
        break;
      case StepKind::kEnter:
        break;
      case StepKind::kDeref:
        if (!follow(inst, at)) {
          return {};
        }
        break;
    }
  }
  return at;
}

void EvalMachine::run_memory(Frame& frame, const Inst& inst) {
  const Place& place = frame.pou->places[inst.place.index];
  if (place.base == PlaceBase::kArg && inst.op != Op::kLoad) {
    next_callee(frame, place.pou);
  }
  const Address to = locate(frame, inst, inst.place);
  if (trap_) {
    return;
  }
  switch (inst.op) {
    case Op::kLoad:
      frame.values[inst.result.index].bits = to.variable->bits;
      break;
    case Op::kStore:
      if (to.variable->slot) {
        to.variable->target = frame.values[inst.operands[0].index].address;
      } else {
        to.variable->bits = bits(frame, inst.operands[0]);
      }
      break;
    case Op::kInit:
      variables_.reset(*to.variable, inst.constant);
      break;
    default:
      if (const Address from = locate(frame, inst, inst.place2); !trap_) {
        variables_.copy(*to.variable, *from.variable);
      }
  }
}

// Whoever gets the address of a constant gets a copy, so that no constant changes.
void EvalMachine::run_string_or_address(Frame& frame, const Inst& inst) {
  Address at = locate(frame, inst, inst.place);
  if (trap_) {
    return;
  }
  const bool is_constant = frame.pou->places[inst.place.index].base == PlaceBase::kConst;
  if (is_constant && inst.op == Op::kAddress) {
    frame.constants.push_back(std::make_unique<Variable>(*at.variable));
    at = {frame.constants.back().get(), frame.serial};
  }
  frame.values[inst.result.index].address = at;
}

namespace {

uint32_t unit_size(const TypeTable& types, const Variable& string) {
  return types[string.type].kind == Kind::kWstring ? 2 : 1;
}

// A string as native functions see it: NUL-terminated, with room for its capacity.
std::vector<uint8_t> buffer_of(const TypeTable& types, const Variable& string) {
  const size_t units = size_t{types[string.type].capacity} + 1;
  std::vector<uint8_t> buffer(units * unit_size(types, string), 0);
  std::copy(string.text.begin(), string.text.end(), buffer.begin());
  return buffer;
}

}  // namespace

void EvalMachine::run_native(Frame& frame, const Inst& inst) {
  const stdlib::NativeRow& row = stdlib::native_row(inst.native);
  std::vector<stdlib::NativeArg> args(inst.operands.size());
  std::vector<std::vector<uint8_t>> buffers(inst.operands.size());
  for (size_t i = 0; i < args.size(); ++i) {
    const EvalValue& value = frame.values[inst.operands[i].index];
    args[i].bits = value.bits;
    const bool string = row.arguments[i] == 'S' || row.arguments[i] == 'W';
    if (string && !alive(value.address)) {
      return trap(inst, TrapKind::kReference, "");
    }
    if (string) {
      buffers[i] = buffer_of(program_.types, *value.address.variable);
      args[i].data = buffers[i].data();
      args[i].capacity = program_.types[value.address.variable->type].capacity;
    }
  }
  frame.callee.reset();
  const uint64_t result = row.function(args.data());
  if (row.result == 'v') {
    Variable& to = *frame.values[inst.operands[0].index].address.variable;
    variables_.set_text(to, {reinterpret_cast<const char*>(buffers[0].data()), buffers[0].size()});
  } else if (inst.result.valid()) {
    frame.values[inst.result.index].bits = canonical(inst.scalar, result);
  }
}

}  // namespace ir
