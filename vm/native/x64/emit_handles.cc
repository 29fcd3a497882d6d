// Handles: where the variable is the one that the site has found last, a subtraction and a
// comparison say so; else the tables of the generation are asked (vm/exec/references.h).
#include "vm/exec/context.h"
#include "vm/native/x64/emitter.h"

namespace vm::native::x64 {
namespace {

constexpr uint8_t kLost[] = {kRax, kRcx, kRdx, kRsi, kRdi, kR8, kR9, kR10};  // by a C function
constexpr int32_t kFloatsAt = sizeof kLost * 8;
constexpr int32_t kSavedBytes = 200;  // the stack is a multiple of 16 again
static_assert(kFloatsAt + 8 * Registers::kFloatCount <= kSavedBytes && kSavedBytes % 16 == 8);
// What the stub has pushed, above the return address: the function first.
constexpr int32_t kFunctionAt = kSavedBytes + 8;

}  // namespace

void emit_ask_for_handle(Assembler& a, Label label) {
  const auto stack = [](int32_t at) { return Registers::at(kRsp, at); };
  const auto each = [&](auto integer, auto number) {
    int32_t at = 0;
    for (const uint8_t reg : kLost) integer(reg, stack(8 * at++));
    for (uint8_t r = 0; r < Registers::kFloatCount; ++r) number(r, stack(kFloatsAt + 8 * r));
  };
  a.bind(label);
  a.alu_imm(Alu::kSub, Operand::of(kRsp), kSavedBytes, 8);
  each([&](uint8_t reg, Address at) { a.store(at, reg, 8); },
       [&](uint8_t reg, Address at) { a.float_store(at, reg, 8); });
  a.load(kRax, stack(kFunctionAt), 8);
  a.load(kRcx, stack(kFunctionAt + 8), 8);
  a.load(kRdx, stack(kFunctionAt + 16), 8);
  a.load(kRsi, stack(kFunctionAt + 24), 8);
  a.move(kRdi, Registers::kContext);
  a.call(Operand::of(uint8_t{kRax}));
  a.store(stack(kFunctionAt + 24), kRax, 8);
  each([&](uint8_t reg, Address at) { a.load(reg, at, 8); },
       [&](uint8_t reg, Address at) { a.float_load(reg, at, 8); });
  a.alu_imm(Alu::kAdd, Operand::of(kRsp), kSavedBytes, 8);
  a.ret();
}

Address Emitter::known(uint8_t site, size_t member) const {
  return context(offsetof(Context, reaches) + site * sizeof(KnownReach) + member);
}

#define KNOWN(member) known(n.site, offsetof(KnownReach, member))

// An exit may need what lies in the result's register, so that is written last.
void Emitter::resolve(const Node& n, const Step& step) {
  const auto bytes = static_cast<uint32_t>(n.imm);
  const auto last = static_cast<int32_t>(bytes + (n.imm >> 32) - 1);
  const uint8_t handle = integer_register(step.in[0]);
  const uint8_t to = integer_register(step.result);
  handle_stubs_.push_back({&n, a_.label(), a_.label(), exit_label(n.exit), handle, {}, to});
  const Label slow = handle_stubs_.back().label;
  a_.move(kScratch, handle);
  a_.alu(Alu::kSub, kScratch, Operand::of(KNOWN(begin)), 8);
  if (last != 0) {
    a_.alu_imm(Alu::kAdd, Operand::of(kScratch), last, 8);
    a_.jump_if(Condition::kBelow, slow);  // it was before the beginning
  }
  a_.alu(Alu::kCmp, kScratch, Operand::of(KNOWN(size)), 8);
  a_.jump_if(Condition::kAboveOrEqual, slow);
  a_.load(kScratch, KNOWN(home), 4);
  a_.test(kScratch, kScratch, 4);
  a_.jump_if(Condition::kEqual, slow);
  a_.address(to, {kScratch, handle, 1, true, static_cast<int32_t>(bytes)}, 4);
  a_.bind(handle_stubs_.back().back);
}

// Inside before and after.
void Emitter::move_handle(const Node& n, const Step& step) {
  const uint8_t handle = integer_register(step.in[0]);
  const uint8_t to = integer_register(step.result);
  const Place& bytes = step.in[1];
  handle_stubs_.push_back({&n, a_.label(), a_.label(), 0, handle, bytes, to});
  const Label slow = handle_stubs_.back().label;
  a_.move(kScratch, handle);
  a_.alu(Alu::kSub, kScratch, Operand::of(KNOWN(begin)), 8);
  a_.alu(Alu::kCmp, kScratch, Operand::of(KNOWN(size)), 8);
  a_.jump_if(Condition::kAboveOrEqual, slow);
  if (bytes.kind == Place::kConstant) {
    const auto by = static_cast<int32_t>(bytes.bits);
    a_.alu_imm(Alu::kAdd, Operand::of(kScratch), by, 8);
    a_.alu(Alu::kCmp, kScratch, Operand::of(KNOWN(size)), 8);
    a_.jump_if(Condition::kAboveOrEqual, slow);
    a_.address(to, {handle, 0xff, 1, true, by}, 8);
  } else {
    // With all 64 bits: what goes past 4 GB is outside, too.
    a_.move(kScratch, integer_register(bytes));
    a_.alu(Alu::kAdd, kScratch, Operand::of(handle), 8);
    a_.alu(Alu::kSub, kScratch, Operand::of(KNOWN(begin)), 8);
    a_.alu(Alu::kCmp, kScratch, Operand::of(KNOWN(size)), 8);
    a_.jump_if(Condition::kAboveOrEqual, slow);
    a_.alu(Alu::kAdd, kScratch, Operand::of(KNOWN(begin)), 8);
    a_.move(to, kScratch);
  }
  a_.bind(handle_stubs_.back().back);
}

// Before the first byte, past the end or in another variable: it is asked for.
void Emitter::reach(const Node& n, const Step& step) {
  const uint8_t handle = integer_register(step.in[0]);
  const uint8_t to = integer_register(step.result);
  handle_stubs_.push_back({&n, a_.label(), a_.label(), 0, handle, {}, to});
  a_.move(kScratch, handle);
  a_.alu(Alu::kSub, kScratch, Operand::of(KNOWN(begin)), 8);
  a_.alu(Alu::kCmp, kScratch, Operand::of(KNOWN(size)), 8);
  a_.jump_if(Condition::kAboveOrEqual, handle_stubs_.back().label);
  a_.move(to, kScratch);
  a_.bind(handle_stubs_.back().back);
}

void Emitter::reach_part(const Node& n, const Step& step) {
  a_.load(integer_register(step.result), known(n.site, n.imm), n.width);
}

namespace {

constexpr uint32_t kOnePast = uint32_t{1} << ir::kSegmentBits;  // of the upper half

}  // namespace

void Emitter::handle_at(const Node& n, const Step& step) {
  const uint8_t to = integer_register(step.result);
  const Label inside = a_.label();
  a_.move(kScratch, integer_register(step.in[0]));
  a_.alu(Alu::kCmp, kScratch, Operand::of(KNOWN(size)), 8);
  a_.move(to, kScratch);
  a_.jump_if(Condition::kNotEqual, inside);
  a_.move_imm(kScratch, uint64_t{kOnePast} << 32);
  a_.alu(Alu::kAdd, to, Operand::of(kScratch), 8);
  a_.bind(inside);
  a_.alu(Alu::kAdd, to, Operand::of(KNOWN(begin)), 8);
}

#undef KNOWN

// Of the distance in the scratch register.
void Emitter::store_handle(const Address& to, uint8_t site) {
  const Operand begin = Operand::of(known(site, offsetof(KnownReach, begin)));
  const Label inside = a_.label();
  a_.alu(Alu::kAdd, kScratch, begin, 8);
  a_.store(to, kScratch, 8);
  a_.alu(Alu::kSub, kScratch, begin, 8);
  a_.alu(Alu::kCmp, kScratch, Operand::of(known(site, offsetof(KnownReach, size))), 8);
  a_.jump_if(Condition::kNotEqual, inside);
  Address upper = to;
  upper.disp += 4;
  a_.alu_imm(Alu::kAdd, Operand::of(upper), kOnePast, 4);
  a_.bind(inside);
}

void Emitter::own_stubs() {
  for (const HandleStub& stub : handle_stubs_) {
    const Node& n = *stub.node;
    const bool resolves = n.op == Op::kResolve;
    const auto function = resolves                  ? &resolve_for_code
                          : n.op == Op::kMoveHandle ? &move_for_code
                                                    : &reach_for_code;
    const auto push = [&](uint64_t bits) {
      a_.move_imm(kScratch, bits);
      a_.push(kScratch);
    };
    a_.bind(stub.label);
    a_.push(stub.handle);
    if (resolves) {
      push(n.imm);
    } else if (stub.bytes.kind != Place::kRegister) {
      push(stub.bytes.bits);
    } else {
      a_.push(integer_register(stub.bytes));
    }
    push(n.site);
    push(reinterpret_cast<uintptr_t>(function));
    a_.call(shared_.ask_for_handle);
    a_.alu_imm(Alu::kAdd, Operand::of(kRsp), 24, 8);
    a_.pop(kScratch);
    if (resolves) {
      a_.test(kScratch, kScratch, 8);
      a_.jump_if(Condition::kEqual, stub.exit);
    }
    a_.move(stub.result, kScratch);
    a_.jump(stub.back);
  }
}

}  // namespace vm::native::x64
