// One function as x86-64 code. Registers that stay what they are:
//   r13  the frame           rbp  the instance       rbx  data memory + 2 GiB
//   r12  the Context         r14  the fuel           r11, xmm15  scratch
// What code reaches most often has the registers of the shortest instructions.
// The rest is the allocator's. Spill slots lie at rsp.
#pragma once

#include "vm/native/emit.h"
#include "vm/native/jump_tables.h"
#include "vm/native/x64/assembler.h"

namespace vm::native::x64 {

inline constexpr uint8_t kIntegers[] = {kRax, kRcx, kRdx, kRsi, kRdi, kR8, kR9, kR10, kR15};
inline constexpr uint32_t kIntegerCount = sizeof kIntegers;
inline constexpr uint32_t kFloatCount = 15;
inline constexpr uint8_t kFrameRegister = kR13;
inline constexpr uint8_t kSelfRegister = kRbp;
inline constexpr uint8_t kDataRegister = kRbx;
inline constexpr uint8_t kContextRegister = kR12;
inline constexpr uint8_t kFuelRegister = kR14;
inline constexpr uint8_t kScratch = kR11;
inline constexpr uint8_t kFloatScratch = 15;

// Code that all functions of one piece of memory share.
struct Shared {
  Label enter;      // uint64_t (const void* to, frame, self, data + 2 GiB, Context*)
  Label leave;      // everything but pc and POU is in its register
  Label interpret;  // entry of a POU without code: its number is in edi
};
Shared emit_shared(Assembler& assembler);

class X64Target : public Target {
 public:
  X64Target() {
    integers = kIntegerCount;
    floats = kFloatCount;
  }
  Demands demands(const Function& f, const Node& node) const override;
  bool takes_constant(const Function& f, const Node& node, uint32_t operand) const override;
  bool takes_memory(const Function& f, const Node& node, uint32_t operand) const override;
  int folds(const Node& node) const override;
  bool end_takes_memory(const Function& f, const End& end) const override;
  bool end_takes_constant(const Function& f, const End& end, uint32_t operand) const override;
};

class Emitter {
 public:
  Emitter(const PouCode& pou, const Shared& shared, Assembler& assembler);
  Entries run();

 private:
  struct Stub {
    Label label;
    uint32_t exit;
  };
  struct EdgeStub {
    Label label;
    Block block;
    uint32_t target;
  };
  struct TableStub {
    Label label;
    std::vector<Label> entries;
  };

  // emitter.cc: blocks, moves, exits
  void block(Block b);
  void end(Block b);
  void branch(Block b);
  void loop_end(Block b);
  void take_turns(Block b);
  void give_back(uint32_t fuel);
  void again(Block from, Block head);
  void branch_integer(const End& end, const Place in[2], Label yes, Label no, bool yes_is_next);
  void branch_float(const End& end, const Place in[2], Label yes, Label no, bool yes_is_next);
  void moves(const std::vector<Move>& all);
  void move(const Move& m);
  void move_to_spill(const Move& m);
  void load_place(uint8_t to, const Place& from, uint8_t width);
  void load_float(uint8_t to, const Place& from, uint8_t width);
  void stubs();
  void store_slot(const SlotValue& slot, const Place& place);
  Label exit_label(uint32_t exit);
  void enter_frame();
  void leave_frame();

  // emit_table.cc
  Label label_of(const JumpTable::Way& way);
  void jump_by_table(Block b, const JumpTable& table);
  void tables();

  // emit_nodes.cc
  void node(const Step& step);
  void integer(const Node& node, const Step& step);
  void three(Alu op, const Node& node, const Step& step);
  void multiply(const Node& node, const Step& step);
  void bool_not(const Node& node, const Step& step);
  void shift(const Node& node, const Step& step);
  void divide(const Node& node, const Step& step);
  void clear_for_set(uint8_t to, const Step& step);
  void compare(const Node& node, const Step& step);
  void compare(uint8_t width, Cond cond, const Place& a, const Place& b);
  void test_bits(uint8_t width, uint8_t left, const Place& b);
  void select(const Node& node, const Step& step);
  void load(const Node& node, const Step& step);
  void store(const Node& node, const Step& step);
  void data_address(const Node& node, const Step& step);
  void address_to_data(uint8_t to, Address at);
  void floating(const Node& node, const Step& step);
  void float_sign(const Node& node, const Step& step);
  void float_compare(const Node& node, const Step& step);
  void instance(const Node& node, const Step& step);
  void helper(const Node& node, const Step& step);
  void native(const Node& node);
  void pool(const Step& step);

  // emit_call.cc
  void call(const Node& node);
  void enter(const Node& node, const Step& step);
  void push_record(uint32_t call);
  void inlined_exit(uint32_t exit);
  void activation(uint32_t inlined);
  void slow_call(const Call& call, uint32_t number);

  uint8_t integer_register(const Place& place) const;
  uint8_t float_register(const Place& place) const;
  Operand operand(const Place& place) const;
  Operand operand(const Node& node, const Step& step, uint32_t number) const;
  Address spill(uint32_t slot) const;
  Address variable(uint32_t number) const;
  Address address(const Mem& mem, const Place& index, const Place& pointer = {}) const;
  Address context(size_t offset) const {
    return {kContextRegister, 0xff, 1, true, static_cast<int32_t>(offset)};
  }

  const PouCode& pou_;
  const Function& f_;
  const Allocated& places_;
  const Shared& shared_;
  Assembler& a_;
  bool has_and_not_;
  Entries entries_;
  int32_t frame_bytes_ = 0;
  std::vector<Label> blocks_;
  std::vector<Label> exits_;
  std::vector<EdgeStub> edges_;
  JumpTables tables_;
  std::vector<TableStub> table_stubs_;
  std::vector<std::pair<Label, uint32_t>> stops_;  // a helper that trapped: its unit
  struct CallStub {
    Label label;
    uint32_t side;
    uint32_t exit;
  };
  std::vector<CallStub> call_stubs_;  // out of fuel at a call
  std::vector<Label> inlined_;        // by Function::inlined: makes the activation
  Label leave_ = 0;
};

Condition condition_of(Cond cond);
bool has_and_not();  // this machine: BMI1
// As the field of an instruction that works on `width` bytes.
inline int32_t field(uint64_t bits, uint8_t width) {
  if (width == 1) return static_cast<int8_t>(bits);
  if (width == 2) return static_cast<int16_t>(bits);
  return static_cast<int32_t>(bits);
}

}  // namespace vm::native::x64
