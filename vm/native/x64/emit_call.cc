// Calls, and the code around all functions.
#include "vm/exec/context.h"
#include "vm/native/x64/emitter.h"

namespace vm::native::x64 {

#define CONTEXT(member) context(offsetof(Context, member))

namespace {

constexpr uint8_t kSaved[] = {kRbp, kRbx, kR12, kR13, kR14, kR15};

Address in_context(size_t offset) {
  return {kContextRegister, 0xff, 1, true, static_cast<int32_t>(offset)};
}
Address at_record(size_t member) { return {kRcx, 0xff, 1, true, static_cast<int32_t>(member)}; }

}  // namespace

Shared emit_shared(Assembler& a) {
  Shared shared{a.label(), a.label(), a.label()};
  const Label back = a.label();
  a.bind(shared.enter);
  for (const uint8_t reg : kSaved) a.push(reg);
  a.alu_imm(Alu::kSub, Operand::of(kRsp), 8, 8);
  a.move(kFrameRegister, kRsi);
  a.move(kSelfRegister, kRdx);
  a.move(kDataRegister, kRcx);
  a.move(kContextRegister, kR8);
  a.store(in_context(offsetof(Context, native_stack)), kRsp, 8);
  a.load(kFuelRegister, in_context(offsetof(Context, fuel)), 8);
  a.call(Operand::of(uint8_t{kRdi}));
  a.move_imm(kRax, 0);
  a.bind(back);
  a.store(in_context(offsetof(Context, fuel)), kFuelRegister, 8);
  a.alu_imm(Alu::kAdd, Operand::of(kRsp), 8, 8);
  for (size_t i = sizeof kSaved; i-- > 0;) a.pop(kSaved[i]);
  a.ret();

  // What the machine's stack holds is forgotten: the call records say it all.
  a.bind(shared.interpret);
  a.store(in_context(offsetof(Context, pou)), kRdi, 4);
  a.load(kRax, in_context(offsetof(Context, pous)), 8);
  static_assert(sizeof(PouEntry) == 32);
  a.shift(Shift::kShl, kRdi, 5, 8);
  a.load(kRax, {kRax, kRdi, 1, true, offsetof(PouEntry, code)}, 8);
  a.store(in_context(offsetof(Context, pc)), kRax, 8);
  a.bind(shared.leave);
  a.store(in_context(offsetof(Context, frame)), kFrameRegister, 8);
  a.store(in_context(offsetof(Context, self)), kSelfRegister, 8);
  a.load(kRsp, in_context(offsetof(Context, native_stack)), 8);
  a.move_imm(kRax, 1);
  a.jump(back);
  return shared;
}

// After a body the interpreter goes on. By rcx, rsi and the scratch register.
void Emitter::push_record(uint32_t call) {
  const Call& c = f_.calls[call];
  const ir::Unit* const resume =
      c.inlined ? &pou_.units[c.behind] : &pou_.side->units[pou_.side->resume[call]];
  a_.load(kRcx, CONTEXT(call), 8);
  a_.move_imm(kScratch, reinterpret_cast<uintptr_t>(resume));
  a_.store(at_record(offsetof(CallRecord, resume)), kScratch, 8);
  a_.store(at_record(offsetof(CallRecord, frame)), kFrameRegister, 8);
  a_.store(at_record(offsetof(CallRecord, self)), kSelfRegister, 8);
  a_.store_imm(at_record(offsetof(CallRecord, pou)), static_cast<int32_t>(pou_.number), 4);
  a_.load(kRsi, CONTEXT(instance), 4);
  a_.store(at_record(offsetof(CallRecord, instance)), kRsi, 4);
  a_.alu_imm(Alu::kAdd, Operand::of(kRcx), sizeof(CallRecord), 8);
  a_.store(CONTEXT(call), kRcx, 8);
}

// An inlined body begins.
void Emitter::enter(const Node& n, const Step& step) {
  a_.alu_imm(Alu::kSub, Operand::of(kFuelRegister), 1, 8);
  a_.jump_if(Condition::kEqual, exit_label(n.exit));
  if (n.result == kNone) return;
  Address at = address(n.mem, step.index);
  if (n.in[1] != kNone) at = {kDataRegister, integer_register(step.in[1]), 1, true, INT32_MIN};
  a_.address(integer_register(step.result), at, 8);
}

// Inside of an inlined body: its slots, then the unit's number in the scratch register.
void Emitter::inlined_exit(uint32_t exit) {
  const Exit& e = f_.exits[exit];
  const bool has_instance = f_.inlined[e.inlined].has_instance;
  const size_t slots = e.slots.size() - (has_instance ? 2 : 0);
  for (size_t i = 0; i < slots; ++i) store_slot(e.slots[i], places_.exits[exit][i]);
  if (has_instance) {
    load_place(kScratch, places_.exits[exit][slots], 4);
    a_.store(CONTEXT(native_scratch[0]), kScratch, 8);
    load_place(kScratch, places_.exits[exit][slots + 1], 8);
    a_.store(CONTEXT(native_scratch[1]), kScratch, 8);
  }
  a_.move_imm(kRdi, e.unit);
  a_.jump(inlined_[e.inlined]);
}

// The activation that the interpreter goes on with; the unit's number is in rdi.
void Emitter::activation(uint32_t number) {
  const Inlined& inlined = f_.inlined[number];
  const Call& c = f_.calls[inlined.call];
  a_.bind(inlined_[number]);
  push_record(inlined.call);
  if (inlined.has_instance) {
    a_.load(kRax, CONTEXT(native_scratch[0]), 4);
    a_.store(CONTEXT(instance), kRax, 4);
    a_.load(kSelfRegister, CONTEXT(native_scratch[1]), 8);
  } else if (c.kind == CallKind::kFunction) {
    a_.store_imm(CONTEXT(instance), 0, 4);
  }
  a_.alu_imm(Alu::kAdd, Operand::of(kFrameRegister), static_cast<int32_t>(c.frame_step), 8);
  a_.move_imm(kRax, reinterpret_cast<uintptr_t>(inlined.units));
  a_.address(kRax, {kRax, kRdi, 8, true, 0}, 8);
  a_.store(CONTEXT(pc), kRax, 8);
  a_.store_imm(CONTEXT(pou), static_cast<int32_t>(c.known), 4);
  a_.jump(shared_.leave);
}

// The record of the call, the callee's frame and instance, and after the call everything as
// before.
void Emitter::call(const Node& n) {
  const Call& c = f_.calls[n.call];
  if (c.kind == CallKind::kSlow) return slow_call(c, n.call);
  const Label stub = a_.label();
  call_stubs_.push_back({stub, pou_.side->call[n.call], n.exit});
  a_.alu_imm(Alu::kSub, Operand::of(kFuelRegister), 1, 8);
  a_.jump_if(Condition::kEqual, stub);
  push_record(n.call);
  a_.load(kRsi, CONTEXT(pous), 8);
  if (c.kind == CallKind::kBody) {
    a_.load(kRdi, CONTEXT(instances), 8);
    a_.load(kRdi, {kRdi, kRax, 8, true, offsetof(InstanceEntry, pou)}, 4);
  } else {
    a_.move_imm(kRdi, c.pou);
  }
  if (c.kind == CallKind::kFunction) a_.store_imm(CONTEXT(instance), 0, 4);
  if (c.kind == CallKind::kBody || c.kind == CallKind::kMethod) {
    a_.store(CONTEXT(instance), kRax, 4);
    a_.address(kSelfRegister, {kDataRegister, kRdx, 1, true, INT32_MIN}, 8);
  }
  a_.alu_imm(Alu::kAdd, Operand::of(kFrameRegister), static_cast<int32_t>(c.frame_step), 8);
  Address callee{kRsi, 0xff, 1, true, static_cast<int32_t>(offsetof(PouEntry, machine))};
  if (c.kind == CallKind::kBody) {
    a_.move(kR8, kRdi);
    a_.shift(Shift::kShl, kR8, 5, 8);
    callee.index = kR8;
  } else {
    callee.disp += static_cast<int32_t>(c.pou * sizeof(PouEntry));
  }
  a_.call(Operand::of(callee));
  a_.load(kRcx, CONTEXT(call), 8);
  a_.alu_imm(Alu::kSub, Operand::of(kRcx), sizeof(CallRecord), 8);
  a_.store(CONTEXT(call), kRcx, 8);
  a_.load(kFrameRegister, at_record(offsetof(CallRecord, frame)), 8);
  a_.load(kSelfRegister, at_record(offsetof(CallRecord, self)), 8);
  a_.load(kRsi, at_record(offsetof(CallRecord, instance)), 4);
  a_.store(CONTEXT(instance), kRsi, 4);
  entries_.behind_call[n.call] = a_.label();
  a_.bind(entries_.behind_call[n.call]);
}

// The arguments of the function are in their registers; the data memory comes first.
void Emitter::native(const Node& n) {
  a_.address(kRdi, {kDataRegister, 0xff, 1, true, INT32_MIN}, 8);
  a_.move_imm(kRax, n.imm);
  a_.call(Operand::of(uint8_t{kRax}));
  if (n.result != kNone && f_.values[n.result].width == 4) {
    a_.zero_extend(kRax, Operand::of(uint8_t{kRax}), 4);
  }
}

void Emitter::pool(const Step& step) {
  const uint8_t to = integer_register(step.result);
  a_.load(to, CONTEXT(consts), 8);
  a_.alu(Alu::kSub, to, Operand::of(kDataRegister), 4);
  a_.alu_imm(Alu::kAdd, Operand::of(to), INT32_MIN, 4);
}

void Emitter::helper(const Node& n, const Step& step) {
  const uint32_t side = pou_.side->helper[step.node];
  const ir::Unit& unit = pou_.side->units[side];
  a_.store_imm(CONTEXT(pou), static_cast<int32_t>(pou_.number), 4);
  a_.move_imm(kRdi, reinterpret_cast<uintptr_t>(&unit));
  a_.move(kRsi, kFrameRegister);
  a_.move(kRdx, kSelfRegister);
  a_.address(kRcx, {kDataRegister, 0xff, 1, true, INT32_MIN}, 8);
  a_.load(kR8, CONTEXT(consts), 8);
  a_.move(kR9, kContextRegister);
  a_.move_imm(kRax, reinterpret_cast<uintptr_t>(kHandlers.of[unit.op]));
  a_.call(Operand::of(uint8_t{kRax}));
  const Label stopped = a_.label();
  stops_.push_back({stopped, n.unit});
  a_.alu_imm(Alu::kCmp, Operand::of(CONTEXT(running)), 0, 1);
  a_.jump_if(Condition::kEqual, stopped);
}

// The interpreter calls, and what it calls returns to the resume unit.
void Emitter::slow_call(const Call&, uint32_t number) {
  a_.move_imm(kScratch, reinterpret_cast<uintptr_t>(&pou_.side->units[pou_.side->call[number]]));
  a_.store(CONTEXT(pc), kScratch, 8);
  a_.store_imm(CONTEXT(pou), static_cast<int32_t>(pou_.number), 4);
  a_.jump(shared_.leave);
  entries_.behind_call[number] = a_.label();
  a_.bind(entries_.behind_call[number]);
}

}  // namespace vm::native::x64
