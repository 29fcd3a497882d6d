// Calls, and the code around all functions.
#include "vm/exec/context.h"
#include "vm/native/x64/emitter.h"

namespace vm::native::x64 {

#define CONTEXT(member) context(offsetof(Context, member))

namespace {

constexpr uint8_t kSaved[] = {kRbp, kRbx, kR12, kR13, kR14, kR15};

Address in_context(size_t offset) {
  return Registers::at(Registers::kContext, static_cast<int64_t>(offset));
}

}  // namespace

Shared emit_shared(Assembler& a) {
  Shared shared{a.label(), a.label(), a.label(), a.label()};
  const Label back = a.label();
  a.bind(shared.enter);
  for (const uint8_t reg : kSaved) a.push(reg);
  a.alu_imm(Alu::kSub, Operand::of(kRsp), 8, 8);
  a.move(Registers::kFrame, kRsi);
  a.move(Registers::kSelf, kRdx);
  a.move(Registers::kData, kRcx);
  a.move(Registers::kContext, kR8);
  a.store(in_context(offsetof(Context, native_stack)), kRsp, 8);
  a.load(Registers::kFuel, in_context(offsetof(Context, fuel)), 8);
  a.call(Operand::of(uint8_t{kRdi}));
  a.move_imm(kRax, 0);
  a.bind(back);
  a.store(in_context(offsetof(Context, fuel)), Registers::kFuel, 8);
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
  a.store(in_context(offsetof(Context, frame)), Registers::kFrame, 8);
  a.store(in_context(offsetof(Context, self)), Registers::kSelf, 8);
  a.load(kRsp, in_context(offsetof(Context, native_stack)), 8);
  a.move_imm(kRax, 1);
  a.jump(back);
  emit_ask_for_handle(a, shared.ask_for_handle);
  return shared;
}

void Emitter::call_pou(const Call& c) {
  a_.load(kRsi, CONTEXT(pous), 8);
  Address callee = Registers::at(kRsi, offsetof(PouEntry, machine));
  if (c.kind == CallKind::kBody || c.kind == CallKind::kVirtual) {
    a_.move(kR8, Registers::kPouNumber);
    a_.shift(Shift::kShl, kR8, 5, 8);
    callee.index = kR8;
  } else {
    callee.disp += static_cast<int32_t>(c.pou * sizeof(PouEntry));
  }
  a_.call(Operand::of(callee));
}

void Emitter::call_function(uintptr_t function) {
  a_.move_imm(kRax, function);
  a_.call(Operand::of(uint8_t{kRax}));
}

// The arguments of the function are in their registers; the data memory comes first.
void Emitter::native(const Node& n) {
  data_memory(Registers::kArguments[0]);
  call_function(n.imm);
  if (n.result != kNone && f_.values[n.result].width == 4) {
    a_.zero_extend(kRax, Operand::of(uint8_t{kRax}), 4);
  }
}

}  // namespace vm::native::x64
