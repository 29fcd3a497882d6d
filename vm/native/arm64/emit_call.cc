// Calls, and the code around all functions.
#include "vm/exec/context.h"
#include "vm/native/arm64/emitter.h"

namespace vm::native::arm64 {

#define CONTEXT(member) context(offsetof(Context, member))

namespace {

constexpr int32_t kSavedBytes = 160;  // x19 to x30, d8 to d15

Address in_context(size_t offset) {
  return Registers::at(Registers::kContext, static_cast<int64_t>(offset));
}

}  // namespace

Shared emit_shared(Assembler& a) {
  Shared shared{a.label(), a.label(), a.label()};
  const Label back = a.label();
  a.bind(shared.enter);
  a.add_imm(kSp, kSp, -kSavedBytes, 8);
  for (uint8_t i = 0; i < 12; i += 2) a.store_pair(19 + i, 20 + i, i * 8, false);
  for (uint8_t i = 0; i < 8; i += 2) a.store_pair(8 + i, 9 + i, 96 + i * 8, true);
  a.move(Registers::kFrame, 1);
  a.move(Registers::kSelf, 2);
  a.move_imm(kScratch, uint64_t{1} << 31);
  a.alu(Alu::kSub, Registers::kData, 3, kScratch, 8);
  a.move(Registers::kContext, 4);
  a.add_imm(kScratch, kSp, 0, 8);
  a.store(in_context(offsetof(Context, native_stack)), kScratch, 8);
  a.load(Registers::kFuel, in_context(offsetof(Context, fuel)), 8);
  a.call(0);
  a.move_imm(0, 0);
  a.bind(back);
  a.store(in_context(offsetof(Context, fuel)), Registers::kFuel, 8);
  for (uint8_t i = 0; i < 12; i += 2) a.load_pair(19 + i, 20 + i, i * 8, false);
  for (uint8_t i = 0; i < 8; i += 2) a.load_pair(8 + i, 9 + i, 96 + i * 8, true);
  a.add_imm(kSp, kSp, kSavedBytes, 8);
  a.ret();

  // What the machine's stack holds is forgotten: the call records say it all.
  a.bind(shared.interpret);
  a.store(in_context(offsetof(Context, pou)), Registers::kPouNumber, 4);
  a.load(kScratch, in_context(offsetof(Context, pous)), 8);
  static_assert(sizeof(PouEntry) == 32);
  a.alu(Alu::kAdd, kScratch, kScratch, Registers::kPouNumber, 8, 5);
  a.load(kScratch, {kScratch, 0xff, 0, true, offsetof(PouEntry, code)}, 8);
  a.store(in_context(offsetof(Context, pc)), kScratch, 8);
  a.bind(shared.leave);
  a.store(in_context(offsetof(Context, frame)), Registers::kFrame, 8);
  a.store(in_context(offsetof(Context, self)), Registers::kSelf, 8);
  a.load(kScratch, in_context(offsetof(Context, native_stack)), 8);
  a.add_imm(kSp, kScratch, 0, 8);
  a.move_imm(0, 1);
  a.jump(back);
  return shared;
}

void Emitter::call_pou(const Call&) {
  a_.load(kScratch, CONTEXT(pous), 8);
  static_assert(sizeof(PouEntry) == 32);
  a_.alu(Alu::kAdd, kScratch, kScratch, Registers::kPouNumber, 8, 5);
  a_.load(kScratch, Registers::at(kScratch, offsetof(PouEntry, machine)), 8);
  a_.call(kScratch);
}

void Emitter::call_function(uintptr_t function) {
  a_.move_imm(kScratch, function);
  a_.call(kScratch);
}

// The arguments of the function are in their registers; the data memory comes first.
void Emitter::native(const Node& n) {
  data_memory(Registers::kArguments[0]);
  call_function(n.imm);
  if (n.result != kNone && f_.values[n.result].width == 4) a_.zero_extend(0, 0, 4);
}

}  // namespace vm::native::arm64
