// Calls, and the code around all functions.
#include "vm/exec/context.h"
#include "vm/native/arm64/emitter.h"

namespace vm::native::arm64 {

#define CONTEXT(member) context(offsetof(Context, member))

namespace {

constexpr uint8_t kId = 0;
constexpr uint8_t kPointer = 1;
constexpr uint8_t kRecord = 2;
constexpr uint8_t kValue = 3;
constexpr int32_t kSavedBytes = 160;  // x19 to x30, d8 to d15

Address in_context(size_t offset) {
  return {kContextRegister, 0xff, 0, true, static_cast<int64_t>(offset)};
}
Address at_record(size_t member) { return {kRecord, 0xff, 0, true, static_cast<int64_t>(member)}; }

}  // namespace

Shared emit_shared(Assembler& a) {
  Shared shared{a.label(), a.label(), a.label()};
  const Label back = a.label();
  a.bind(shared.enter);
  a.add_imm(kSp, kSp, -kSavedBytes, 8);
  for (uint8_t i = 0; i < 12; i += 2) a.store_pair(19 + i, 20 + i, i * 8, false);
  for (uint8_t i = 0; i < 8; i += 2) a.store_pair(8 + i, 9 + i, 96 + i * 8, true);
  a.move(kFrameRegister, 1);
  a.move(kSelfRegister, 2);
  a.move_imm(kScratch, uint64_t{1} << 31);
  a.alu(Alu::kSub, kDataRegister, 3, kScratch, 8);
  a.move(kContextRegister, 4);
  a.add_imm(kScratch, kSp, 0, 8);
  a.store(in_context(offsetof(Context, native_stack)), kScratch, 8);
  a.load(kFuelRegister, in_context(offsetof(Context, fuel)), 8);
  a.call(0);
  a.move_imm(0, 0);
  a.bind(back);
  a.store(in_context(offsetof(Context, fuel)), kFuelRegister, 8);
  for (uint8_t i = 0; i < 12; i += 2) a.load_pair(19 + i, 20 + i, i * 8, false);
  for (uint8_t i = 0; i < 8; i += 2) a.load_pair(8 + i, 9 + i, 96 + i * 8, true);
  a.add_imm(kSp, kSp, kSavedBytes, 8);
  a.ret();

  // What the machine's stack holds is forgotten: the call records say it all.
  a.bind(shared.interpret);
  a.store(in_context(offsetof(Context, pou)), kPouNumber, 4);
  a.load(kScratch, in_context(offsetof(Context, pous)), 8);
  static_assert(sizeof(PouEntry) == 32);
  a.alu(Alu::kAdd, kScratch, kScratch, kPouNumber, 8, 5);
  a.load(kScratch, {kScratch, 0xff, 0, true, offsetof(PouEntry, code)}, 8);
  a.store(in_context(offsetof(Context, pc)), kScratch, 8);
  a.bind(shared.leave);
  a.store(in_context(offsetof(Context, frame)), kFrameRegister, 8);
  a.store(in_context(offsetof(Context, self)), kSelfRegister, 8);
  a.load(kScratch, in_context(offsetof(Context, native_stack)), 8);
  a.add_imm(kSp, kScratch, 0, 8);
  a.move_imm(0, 1);
  a.jump(back);
  return shared;
}

// At a call, out of fuel: the interpreter calls.
void Emitter::take_fuel(const Node& n) {
  const Label stub = a_.label();
  call_stubs_.push_back({stub, pou_.side->call[n.call], n.exit});
  a_.decrement(kFuelRegister, 1);
  a_.jump_if(Condition::kEqual, stub);
}

void Emitter::push_record(uint32_t call) {
  const Call& c = f_.calls[call];
  const ir::Unit* const resume =
      c.inlined ? &pou_.units[c.behind] : &pou_.side->units[pou_.side->resume[call]];
  a_.load(kRecord, CONTEXT(call), 8);
  a_.move_imm(kScratch, reinterpret_cast<uintptr_t>(resume));
  a_.store(at_record(offsetof(CallRecord, resume)), kScratch, 8);
  a_.store(at_record(offsetof(CallRecord, frame)), kFrameRegister, 8);
  a_.store(at_record(offsetof(CallRecord, self)), kSelfRegister, 8);
  store_word(at_record(offsetof(CallRecord, pou)), pou_.number);
  a_.load(kValue, CONTEXT(instance), 4);
  a_.store(at_record(offsetof(CallRecord, instance)), kValue, 4);
  a_.add_imm(kRecord, kRecord, sizeof(CallRecord), 8);
  a_.store(CONTEXT(call), kRecord, 8);
}

// An inlined body begins.
void Emitter::enter(const Node& n, const Step& step) {
  a_.decrement(kFuelRegister, 1);
  a_.jump_if(Condition::kEqual, exit_label(n.exit));
  if (n.result == kNone) return;
  const uint8_t to = integer_register(step.result);
  if (n.in[1] == kNone) return a_.address(to, address(n.mem, step.index), 8);
  a_.alu(Alu::kAdd, to, kDataRegister, integer_register(step.in[1]), 8);
}

// Inside of an inlined body: its slots, then the instance in x0 and x1, the unit's number in x9.
void Emitter::inlined_exit(uint32_t exit) {
  const Exit& e = f_.exits[exit];
  const std::vector<Place>& places = places_.exits[exit];
  const bool has_instance = f_.inlined[e.inlined].has_instance;
  const size_t slots = e.slots.size() - (has_instance ? 2 : 0);
  for (size_t i = 0; i < slots; ++i) store_slot(e.slots[i], places[i]);
  if (has_instance) {
    load_place(kScratch, places[slots]);
    load_place(kPointer, places[slots + 1]);
    a_.move(kId, kScratch);
  }
  a_.move_imm(kPouNumber, e.unit);
  a_.jump(inlined_[e.inlined]);
}

// The activation that the interpreter goes on with.
void Emitter::activation(uint32_t number) {
  const Inlined& inlined = f_.inlined[number];
  const Call& c = f_.calls[inlined.call];
  a_.bind(inlined_[number]);
  push_record(inlined.call);
  if (inlined.has_instance) {
    a_.store(CONTEXT(instance), kId, 4);
    a_.move(kSelfRegister, kPointer);
  } else if (c.kind == CallKind::kFunction) {
    a_.store(CONTEXT(instance), kZero, 4);
  }
  a_.add_imm(kFrameRegister, kFrameRegister, c.frame_step, 8);
  a_.move_imm(kScratch, reinterpret_cast<uintptr_t>(inlined.units));
  a_.alu(Alu::kAdd, kScratch, kScratch, kPouNumber, 8, 3);
  a_.store(CONTEXT(pc), kScratch, 8);
  store_word(CONTEXT(pou), c.known);
  a_.jump_long(shared_.leave);
}

// The record of the call, the callee's frame and instance, and after the call everything as
// before. The ID of the callee's instance is in x0, the area of its data in x1.
void Emitter::call(const Node& n) {
  const Call& c = f_.calls[n.call];
  if (c.kind == CallKind::kSlow) return slow_call(n.call);
  take_fuel(n);
  push_record(n.call);
  if (c.kind == CallKind::kBody) {
    a_.load(kScratch, CONTEXT(instances), 8);
    a_.load(kPouNumber, {kScratch, kId, 3, true, offsetof(InstanceEntry, pou)}, 4);
  } else {
    a_.move_imm(kPouNumber, c.pou);
  }
  if (c.kind == CallKind::kFunction) a_.store(CONTEXT(instance), kZero, 4);
  if (c.kind == CallKind::kBody || c.kind == CallKind::kMethod) {
    a_.store(CONTEXT(instance), kId, 4);
    a_.alu(Alu::kAdd, kSelfRegister, kDataRegister, kPointer, 8);
  }
  a_.add_imm(kFrameRegister, kFrameRegister, c.frame_step, 8);
  a_.load(kScratch, CONTEXT(pous), 8);
  a_.alu(Alu::kAdd, kScratch, kScratch, kPouNumber, 8, 5);
  a_.load(kScratch, {kScratch, 0xff, 0, true, offsetof(PouEntry, machine)}, 8);
  a_.call(kScratch);
  a_.load(kRecord, CONTEXT(call), 8);
  a_.add_imm(kRecord, kRecord, -static_cast<int64_t>(sizeof(CallRecord)), 8);
  a_.store(CONTEXT(call), kRecord, 8);
  a_.load(kFrameRegister, at_record(offsetof(CallRecord, frame)), 8);
  a_.load(kSelfRegister, at_record(offsetof(CallRecord, self)), 8);
  a_.load(kValue, at_record(offsetof(CallRecord, instance)), 4);
  a_.store(CONTEXT(instance), kValue, 4);
  entries_.behind_call[n.call] = a_.label();
  a_.bind(entries_.behind_call[n.call]);
}

// The arguments of the function are in their registers; the data memory comes first.
void Emitter::native(const Node& n) {
  a_.move(0, kDataRegister);
  a_.move_imm(kScratch, n.imm);
  a_.call(kScratch);
  if (n.result != kNone && f_.values[n.result].width == 4) a_.zero_extend(0, 0, 4);
}

void Emitter::pool(const Step& step) {
  a_.load(kScratch, CONTEXT(consts), 8);
  a_.alu(Alu::kSub, integer_register(step.result), kScratch, kDataRegister, 4);
}

// The interpreter calls, and what it calls returns to the resume unit.
void Emitter::slow_call(uint32_t number) {
  leave_at_side(pou_.side->call[number]);
  entries_.behind_call[number] = a_.label();
  a_.bind(entries_.behind_call[number]);
}

}  // namespace vm::native::arm64
