// One function as AArch64 code. Registers that stay what they are:
//   x19  the frame           x20  the instance       x21  data memory
//   x22  the Context         x23  the fuel           x16, x17, v31  scratch
// x17 makes addresses and long branches, x16 is free inside of one operation. x18, x29 and x30 are
// not touched; the rest is the allocator's. At sp lie the spill slots and then the return address.
#pragma once

#include "vm/native/arm64/assembler.h"
#include "vm/native/function_emitter.h"

namespace vm::native::arm64 {

constexpr bool is_signed(Cond cond) {
  return cond == Cond::kLtS || cond == Cond::kLeS || cond == Cond::kGtS || cond == Cond::kGeS;
}

inline constexpr uint8_t kScratch = 16;
inline constexpr uint8_t kFloatScratch = 31;

struct Registers {
  using Assembler = arm64::Assembler;
  using Address = arm64::Address;
  using Condition = arm64::Condition;
  static Address at(uint8_t base, int64_t offset) { return {base, 0xff, 0, true, offset}; }
  static Address indexed(uint8_t base, uint8_t index, uint8_t scale, int64_t offset) {
    return {base, index, static_cast<uint8_t>(scale == 8 ? 3 : scale / 2), true, offset};
  }
  static constexpr uint8_t kIntegers[] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9, 10,
                                          11, 12, 13, 14, 15, 24, 25, 26, 27, 28};
  static constexpr uint32_t kIntegerCount = sizeof kIntegers;
  static constexpr uint32_t kFloatCount = 31;
  static constexpr uint8_t kScratch = arm64::kScratch;
  static constexpr uint8_t kFloatScratch = arm64::kFloatScratch;
  static constexpr uint8_t kFrame = 19;
  static constexpr uint8_t kSelf = 20;
  static constexpr uint8_t kData = 21;
  static constexpr uint8_t kContext = 22;
  static constexpr uint8_t kFuel = 23;
  static constexpr uint8_t kStack = kSp;
  static constexpr uint8_t kId = 0;
  static constexpr uint8_t kPointer = 1;
  static constexpr uint8_t kPouNumber = 9;
  static constexpr uint8_t kRecord = 2;
  static constexpr uint8_t kValue = 3;
  static constexpr uint8_t kArguments[] = {0, 1, 2, 3, 4, 5};
};

Shared emit_shared(Assembler& assembler);

class Arm64Target : public Target {
 public:
  Arm64Target() {
    integers = Registers::kIntegerCount;
    floats = Registers::kFloatCount;
  }
  Demands demands(const Function& f, const Node& node) const override;
  bool takes_constant(const Function& f, const Node& node, uint32_t operand) const override;
  bool takes_memory(const Function& f, const Node& node, uint32_t operand) const override;
  bool end_takes_constant(const Function& f, const End& end, uint32_t operand) const override;
};

class Emitter : public FunctionEmitter<Emitter, Registers> {
 public:
  Emitter(const PouCode& pou, const Shared& shared, Assembler& assembler);
  Entries run();

 private:
  friend class FunctionEmitter<Emitter, Registers>;
  struct NanStub {  // a float whose bits this machine would choose otherwise
    Label label;
    Label back;
    uint8_t result;
    uint8_t a;
    uint8_t b;
    uint8_t width;
  };

  // emitter.cc: what FunctionEmitter asks for
  void enter_frame();
  void leave_frame();
  void jump_if_exposed(Label exit);
  void jump_when(const End& end, const Place in[2], bool when, Label to);
  void jump_if(uint8_t width, Cond cond, const Place& a, const Place& b, Label to);
  void jump_through(Label table, uint8_t value, uint8_t width);
  void jump_unless_running(Label to);
  void take_fuel(uint32_t turns);
  void add(uint8_t to, int64_t value);
  void add_register(uint8_t to, uint8_t from);
  void load_bool(uint8_t to, const Address& from);
  void float_constant(uint8_t to, uint64_t bits, uint8_t width);
  void store_word(const Address& to, uint32_t value);
  void address_to_data(uint8_t to, const Address& at);
  void place_in_data(uint8_t to, uint8_t place);
  void data_memory(uint8_t to);
  void unit_address(uint8_t to, const ir::Unit* units, uint8_t number);

  // emit_nodes.cc
  void three(const Node& node, const Step& step);
  void add_shifted(const Node& node, const Step& step);
  void multiply(const Node& node, const Step& step);
  void bool_not(const Node& node, const Step& step);
  void shift(const Node& node, const Step& step);
  void shift_by_constant(const Node& node, uint8_t to, uint8_t from, uint32_t count);
  void rotate_by_constant(const Node& node, uint8_t to, uint8_t from, uint32_t count);
  void divide(const Node& node, const Step& step);
  void multiply_high(const Node& node, const Step& step);
  void unary(const Node& node, const Step& step);
  void compare(const Node& node, const Step& step);
  void ask(uint8_t width, Cond cond, const Place& a, const Place& b);
  void ask_bits(uint8_t width, uint8_t left, const Place& b);
  void ask_bool(uint8_t reg);
  void exit_if(const Node& node, const Step& step, Label exit);
  void select(const Node& node, const Step& step);
  void load(const Node& node, const Step& step);
  void store(const Node& node, const Step& step);
  void data_address(const Node& node, const Step& step);
  void instance(const Node& node, const Step& step);
  void pool(const Step& step);
  // Nobody builds these for this machine (host.h).
  void resolve(const Node&, const Step&) { a_.trap(); }
  void move_handle(const Node&, const Step&) { a_.trap(); }
  void reach(const Node&, const Step&) { a_.trap(); }
  void reach_part(const Node&, const Step&) { a_.trap(); }
  void handle_at(const Node&, const Step&) { a_.trap(); }
  void store_handle(const Address&, uint8_t) { a_.trap(); }

  // emit_float.cc
  void floating(const Node& node, const Step& step);
  void float_compare(const Node& node, const Step& step);
  void float_to_int(const Node& node, const Step& step);
  void settle_nan(uint8_t result, uint8_t a, uint8_t b, uint8_t width);
  void own_stubs();

  // emit_call.cc
  void call_pou(const Call& call);
  void call_function(uintptr_t function);
  void native(const Node& node);

  Address address(const Mem& mem, const Place& index, const Place& pointer = {}) const;

  std::vector<NanStub> nan_stubs_;
};

// The condition of integers that are compared.
Condition condition_of(Cond cond);
// The condition after FCMP: false for what is no number, but kNe.
Condition float_condition_of(Cond cond);
// The constant as a comparison of `width` bytes takes it.
int64_t compared_constant(uint64_t bits, uint8_t width, Cond cond);

}  // namespace vm::native::arm64
