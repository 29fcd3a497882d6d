// Members of FunctionEmitter: one operation after the other, and calls.
#pragma once

#include "vm/native/function_emitter.h"

namespace vm::native {

#define CONTEXT(member) context(offsetof(Context, member))
#define RECORD(member) Registers::at(Registers::kRecord, offsetof(CallRecord, member))

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::node(const Step& step) {
  const Node& n = f_.nodes[step.node];
  switch (n.op) {
    case Op::kConst:
      return;
    case Op::kLoad:
      return self().load(n, step);
    case Op::kStore:
      return self().store(n, step);
    case Op::kAddr:
      return self().data_address(n, step);
    case Op::kPlace:
      return a_.address(integer_register(step.result),
                        self().address(n.mem, step.index, step.pointer), 8);
    case Op::kAdd:
    case Op::kSub:
    case Op::kAnd:
    case Op::kOr:
    case Op::kXor:
      return self().three(n, step);
    case Op::kAddShifted:
      return self().add_shifted(n, step);
    case Op::kMul:
      return self().multiply(n, step);
    case Op::kDivS:
    case Op::kDivU:
    case Op::kModS:
    case Op::kModU:
      return self().divide(n, step);
    case Op::kMulHighS:
    case Op::kMulHighU:
      return self().multiply_high(n, step);
    case Op::kAndNot:
    case Op::kOrNot:
      return self().bool_not(n, step);
    case Op::kShl:
    case Op::kShr:
    case Op::kSar:
    case Op::kRol:
    case Op::kRor:
      return self().shift(n, step);
    case Op::kNeg:
    case Op::kNot:
    case Op::kNotBool:
    case Op::kSext:
    case Op::kZext:
      return self().unary(n, step);
    case Op::kCompare:
      return self().compare(n, step);
    case Op::kSelect:
    case Op::kSelectCmp:
      return self().select(n, step);
    case Op::kResolve:
      return self().resolve(n, step);
    case Op::kMoveHandle:
      return self().move_handle(n, step);
    case Op::kReach:
      return self().reach(n, step);
    case Op::kReachPart:
      return self().reach_part(n, step);
    case Op::kHandleAt:
      return self().handle_at(n, step);
    case Op::kExitIf:
      return self().exit_if(n, step, exit_label(n.exit));
    case Op::kInstance:
      return self().instance(n, step);
    case Op::kTaskTime:
      return a_.load(integer_register(step.result), CONTEXT(task_time_ns), 8);
    case Op::kAdvanceTime:
      a_.load(Registers::kScratch, CONTEXT(task_time_ns), 8);
      self().add_register(Registers::kScratch, integer_register(step.in[0]));
      return a_.store(CONTEXT(task_time_ns), Registers::kScratch, 8);
    case Op::kPool:
      return self().pool(step);
    case Op::kContext:
      return a_.load(integer_register(step.result), context(n.imm), n.width);
    case Op::kNative:
      return self().native(n);
    case Op::kHelper:
      return helper(n, step);
    case Op::kCall:
      return call(n);
    case Op::kEnter:
      return enter(n, step);
    case Op::kFCompare:
      return self().float_compare(n, step);
    case Op::kFAdd:
    case Op::kFSub:
    case Op::kFMul:
    case Op::kFDiv:
    case Op::kFMin:
    case Op::kFMax:
    case Op::kFNeg:
    case Op::kFAbs:
    case Op::kFSqrt:
    case Op::kFSelect:
    case Op::kIntToFloat:
    case Op::kFloatToInt:
    case Op::kFloatWidth:
    case Op::kBitsToFloat:
    case Op::kFloatToBits:
      return self().floating(n, step);
  }
}

// The record of the call, the callee's frame and instance, and after the call everything as
// before. The ID of the callee's instance is in kId, the place of its data in kPointer.
template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::call(const Node& n) {
  const Call& c = f_.calls[n.call];
  if (c.kind == CallKind::kSlow) return call_slowly(n.call);
  call_stubs_.push_back({a_.label(), pou_.side->call[n.call], n.exit});
  self().take_fuel(1);
  a_.jump_if(Registers::Condition::kEqual, call_stubs_.back().label);
  push_record(n.call);
  if (c.kind == CallKind::kBody) {
    a_.load(Registers::kPouNumber, CONTEXT(instances), 8);
    a_.load(Registers::kPouNumber,
            Registers::indexed(Registers::kPouNumber, Registers::kId, sizeof(InstanceEntry),
                               offsetof(InstanceEntry, pou)),
            4);
  } else if (c.kind != CallKind::kVirtual) {
    a_.move_imm(Registers::kPouNumber, c.pou);
  }
  if (c.kind == CallKind::kFunction) self().store_word(CONTEXT(instance), 0);
  if (c.kind == CallKind::kBody || c.kind == CallKind::kMethod || c.kind == CallKind::kVirtual) {
    a_.store(CONTEXT(instance), Registers::kId, 4);
    self().place_in_data(Registers::kSelf, Registers::kPointer);
  }
  self().add(Registers::kFrame, c.frame_step);
  self().call_pou(c);
  pop_record();
  comes_back(n.call);
}

// The interpreter calls, and what it calls returns to the resume unit.
template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::call_slowly(uint32_t number) {
  leave_at(&pou_.side->units[pou_.side->call[number]]);
  comes_back(number);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::comes_back(uint32_t call) {
  entries_.behind_call[call] = a_.label();
  a_.bind(entries_.behind_call[call]);
}

// After a body that was inlined the interpreter goes on.
template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::push_record(uint32_t call) {
  const Call& c = f_.calls[call];
  const ir::Unit* const resume =
      c.inlined ? &pou_.units[c.behind] : &pou_.side->units[pou_.side->resume[call]];
  a_.load(Registers::kRecord, CONTEXT(call), 8);
  a_.move_imm(Registers::kScratch, reinterpret_cast<uintptr_t>(resume));
  a_.store(RECORD(resume), Registers::kScratch, 8);
  a_.store(RECORD(frame), Registers::kFrame, 8);
  a_.store(RECORD(self), Registers::kSelf, 8);
  self().store_word(RECORD(pou), pou_.number);
  a_.load(Registers::kValue, CONTEXT(instance), 4);
  a_.store(RECORD(instance), Registers::kValue, 4);
  self().add(Registers::kRecord, sizeof(CallRecord));
  a_.store(CONTEXT(call), Registers::kRecord, 8);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::pop_record() {
  a_.load(Registers::kRecord, CONTEXT(call), 8);
  self().add(Registers::kRecord, -static_cast<int64_t>(sizeof(CallRecord)));
  a_.store(CONTEXT(call), Registers::kRecord, 8);
  a_.load(Registers::kFrame, RECORD(frame), 8);
  a_.load(Registers::kSelf, RECORD(self), 8);
  a_.load(Registers::kValue, RECORD(instance), 4);
  a_.store(CONTEXT(instance), Registers::kValue, 4);
}

// An inlined body begins.
template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::enter(const Node& n, const Step& step) {
  self().take_fuel(1);
  a_.jump_if(Registers::Condition::kEqual, exit_label(n.exit));
  if (n.result == kNone) return;
  const uint8_t to = integer_register(step.result);
  if (n.in[1] != kNone) return self().place_in_data(to, integer_register(step.in[1]));
  a_.address(to, self().address(n.mem, step.index), 8);
}

// Inside of an inlined body: its slots, then the instance in kId and kPointer, the unit's number
// in kPouNumber.
template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::inlined_exit(uint32_t exit) {
  const Exit& e = f_.exits[exit];
  const std::vector<Place>& places = places_.exits[exit];
  const bool has_instance = f_.inlined[e.inlined].has_instance;
  const size_t slots = e.slots.size() - (has_instance ? 2 : 0);
  store_slots(exit, slots);
  if (has_instance) {
    load_place(Registers::kScratch, places[slots]);
    load_place(Registers::kPointer, places[slots + 1]);
    a_.move(Registers::kId, Registers::kScratch);
  }
  a_.move_imm(Registers::kPouNumber, e.unit);
  a_.jump(inlined_[e.inlined]);
}

// The activation that the interpreter goes on with.
template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::activation(uint32_t number) {
  const Inlined& inlined = f_.inlined[number];
  const Call& c = f_.calls[inlined.call];
  a_.bind(inlined_[number]);
  push_record(inlined.call);
  if (inlined.has_instance) {
    a_.store(CONTEXT(instance), Registers::kId, 4);
    a_.move(Registers::kSelf, Registers::kPointer);
  } else if (c.kind == CallKind::kFunction) {
    self().store_word(CONTEXT(instance), 0);
  }
  self().add(Registers::kFrame, c.frame_step);
  self().unit_address(Registers::kScratch, inlined.units, Registers::kPouNumber);
  a_.store(CONTEXT(pc), Registers::kScratch, 8);
  self().store_word(CONTEXT(pou), c.known);
  a_.jump_long(shared_.leave);
}

template <class Self, class Registers>
void FunctionEmitter<Self, Registers>::helper(const Node& n, const Step& step) {
  const ir::Unit& unit = pou_.side->units[pou_.side->helper[step.node]];
  self().store_word(CONTEXT(pou), pou_.number);
  a_.move_imm(Registers::kArguments[0], reinterpret_cast<uintptr_t>(&unit));
  a_.move(Registers::kArguments[1], Registers::kFrame);
  a_.move(Registers::kArguments[2], Registers::kSelf);
  self().data_memory(Registers::kArguments[3]);
  a_.load(Registers::kArguments[4], CONTEXT(consts), 8);
  a_.move(Registers::kArguments[5], Registers::kContext);
  self().call_function(reinterpret_cast<uintptr_t>(kHandlers.of[unit.op]));
  stops_.push_back({a_.label(), n.unit});
  self().jump_unless_running(stops_.back().label);
}

#undef RECORD
#undef CONTEXT

}  // namespace vm::native
