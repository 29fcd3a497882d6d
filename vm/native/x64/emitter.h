// One function as x86-64 code. Registers that stay what they are:
//   r13  the frame           rbp  the instance       rbx  data memory + 2 GiB
//   r12  the Context         r14  the fuel           r11, xmm15  scratch
// What code reaches most often has the registers of the shortest instructions.
// The rest is the allocator's. Spill slots lie at rsp.
#pragma once

#include "vm/native/function_emitter.h"
#include "vm/native/x64/assembler.h"

namespace vm::native::x64 {

inline constexpr uint8_t kScratch = kR11;
inline constexpr uint8_t kFloatScratch = 15;

struct Registers {
  using Assembler = x64::Assembler;
  using Address = x64::Address;
  using Condition = x64::Condition;
  static Address at(uint8_t base, int64_t offset) {
    return {base, 0xff, 1, true, static_cast<int32_t>(offset)};
  }
  static Address indexed(uint8_t base, uint8_t index, uint8_t scale, int64_t offset) {
    return {base, index, scale, true, static_cast<int32_t>(offset)};
  }
  static constexpr uint8_t kIntegers[] = {kRax, kRcx, kRdx, kRsi, kRdi, kR8, kR9, kR10, kR15};
  static constexpr uint32_t kIntegerCount = sizeof kIntegers;
  static constexpr uint32_t kFloatCount = 15;
  static constexpr uint8_t kScratch = x64::kScratch;
  static constexpr uint8_t kFloatScratch = x64::kFloatScratch;
  static constexpr uint8_t kFrame = kR13;
  static constexpr uint8_t kSelf = kRbp;
  static constexpr uint8_t kData = kRbx;
  static constexpr uint8_t kContext = kR12;
  static constexpr uint8_t kFuel = kR14;
  static constexpr uint8_t kStack = kRsp;
  static constexpr uint8_t kId = kRax;
  static constexpr uint8_t kPointer = kRdx;
  static constexpr uint8_t kPouNumber = kRdi;
  static constexpr uint8_t kRecord = kRcx;
  static constexpr uint8_t kValue = kRsi;
  static constexpr uint8_t kArguments[] = {kRdi, kRsi, kRdx, kRcx, kR8, kR9};
};

Shared emit_shared(Assembler& assembler);

class X64Target : public Target {
 public:
  X64Target() {
    integers = Registers::kIntegerCount;
    floats = Registers::kFloatCount;
  }
  Demands demands(const Function& f, const Node& node) const override;
  bool takes_constant(const Function& f, const Node& node, uint32_t operand) const override;
  bool takes_memory(const Function& f, const Node& node, uint32_t operand) const override;
  int folds(const Node& node) const override;
  bool end_takes_memory(const Function& f, const End& end) const override;
  bool end_takes_constant(const Function& f, const End& end, uint32_t operand) const override;
};

class Emitter : public FunctionEmitter<Emitter, Registers> {
 public:
  Emitter(const PouCode& pou, const Shared& shared, Assembler& assembler);
  Entries run();

 private:
  friend class FunctionEmitter<Emitter, Registers>;
  struct HandleStub {  // another variable than the one that is known
    const Node* node;
    Label label;
    Label back;
    Label exit;  // of kResolve
    uint8_t handle;
    Place bytes;  // of kMoveHandle; nowhere: none
    uint8_t result;
  };

  // emitter.cc: what FunctionEmitter asks for
  void enter_frame();
  void leave_frame();
  void jump_if_exposed(Label exit);
  void jump_when(const End& end, const Place in[2], bool when, Label to);
  void jump_if(uint8_t width, Cond cond, const Place& a, const Place& b, Label to);
  void jump_when_float(const End& end, const Place in[2], bool when, Label to);
  void jump_through(Label table, uint8_t value, uint8_t width);
  void jump_unless_running(Label to);
  void take_fuel(uint32_t turns);
  void add(uint8_t to, int64_t value);
  void add_register(uint8_t to, uint8_t from);
  void load_bool(uint8_t to, const Address& from);
  void float_constant(uint8_t to, uint64_t bits, uint8_t width);
  void store_word(const Address& to, uint32_t value);
  void address_to_data(uint8_t to, Address at);
  void place_in_data(uint8_t to, uint8_t place);
  void data_memory(uint8_t to);
  void unit_address(uint8_t to, const ir::Unit* units, uint8_t number);

  // emit_nodes.cc
  void three(const Node& node, const Step& step);
  void add_shifted(const Node& node, const Step& step);
  void multiply(const Node& node, const Step& step);
  void bool_not(const Node& node, const Step& step);
  void shift(const Node& node, const Step& step);
  void divide(const Node& node, const Step& step);
  void multiply_high(const Node& node, const Step& step);
  void unary(const Node& node, const Step& step);
  void clear_for_set(uint8_t to, const Step& step);
  void compare(const Node& node, const Step& step);
  void ask(const Node& node, const Step& step);
  void ask(uint8_t width, Cond cond, const Place& a, const Place& b);
  void ask_bits(uint8_t width, uint8_t left, const Place& b);
  void exit_if(const Node& node, const Step& step, Label exit);
  void select(const Node& node, const Step& step);
  void load(const Node& node, const Step& step);
  void store(const Node& node, const Step& step);
  void data_address(const Node& node, const Step& step);
  void instance(const Node& node, const Step& step);
  void pool(const Step& step);

  // emit_handles.cc
  void resolve(const Node& node, const Step& step);
  void move_handle(const Node& node, const Step& step);
  void reach(const Node& node, const Step& step);
  void reach_part(const Node& node, const Step& step);
  void handle_at(const Node& node, const Step& step);
  void store_handle(const Address& to, uint8_t site);
  Address known(uint8_t site, size_t member) const;
  void own_stubs();

  // emit_float.cc
  void floating(const Node& node, const Step& step);
  void float_sign(const Node& node, const Step& step);
  void float_compare(const Node& node, const Step& step);

  // emit_call.cc
  void call_pou(const Call& call);
  void call_function(uintptr_t function);
  void native(const Node& node);

  Operand operand(const Place& place) const;
  Operand operand(const Node& node, const Step& step, uint32_t number) const;
  Address address(const Mem& mem, const Place& index, const Place& pointer = {}) const;

  bool has_and_not_;
  std::vector<HandleStub> handle_stubs_;
};
void emit_ask_for_handle(Assembler& a, Label label);

Condition condition_of(Cond cond);
bool has_and_not();  // this machine: BMI1
// As the field of an instruction that works on `width` bytes.
inline int32_t field(uint64_t bits, uint8_t width) {
  if (width == 1) return static_cast<int8_t>(bits);
  if (width == 2) return static_cast<int16_t>(bits);
  return static_cast<int32_t>(bits);
}

}  // namespace vm::native::x64
