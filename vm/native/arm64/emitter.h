// One function as AArch64 code. Registers that stay what they are:
//   x19  the frame           x20  the instance       x21  data memory
//   x22  the Context         x23  the fuel           x16, x17, v31  scratch
// x17 makes addresses and long branches, x16 is free inside of one operation. x18, x29 and x30 are
// not touched; the rest is the allocator's. At sp lie the spill slots and then the return address.
#pragma once

#include "vm/native/arm64/assembler.h"
#include "vm/native/emit.h"
#include "vm/native/jump_tables.h"

namespace vm::native::arm64 {

constexpr bool is_signed(Cond cond) {
  return cond == Cond::kLtS || cond == Cond::kLeS || cond == Cond::kGtS || cond == Cond::kGeS;
}

inline constexpr uint8_t kIntegers[] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9, 10,
                                        11, 12, 13, 14, 15, 24, 25, 26, 27, 28};
inline constexpr uint32_t kIntegerCount = sizeof kIntegers;
inline constexpr uint32_t kFloatCount = 31;
inline constexpr uint8_t kScratch = 16;
inline constexpr uint8_t kFrameRegister = 19;
inline constexpr uint8_t kSelfRegister = 20;
inline constexpr uint8_t kDataRegister = 21;
inline constexpr uint8_t kContextRegister = 22;
inline constexpr uint8_t kFuelRegister = 23;
inline constexpr uint8_t kFloatScratch = 31;
inline constexpr uint8_t kPouNumber = 9;  // at `interpret`

// Code that all functions of one piece of memory share.
struct Shared {
  Label enter;      // uint64_t (const void* to, frame, self, data + 2 GiB, Context*)
  Label leave;      // everything but pc and POU is in its register
  Label interpret;  // entry of a POU without code: its number is in w9
};
Shared emit_shared(Assembler& assembler);

class Arm64Target : public Target {
 public:
  Arm64Target() {
    integers = kIntegerCount;
    floats = kFloatCount;
  }
  Demands demands(const Function& f, const Node& node) const override;
  bool takes_constant(const Function& f, const Node& node, uint32_t operand) const override;
  bool takes_memory(const Function& f, const Node& node, uint32_t operand) const override;
  bool end_takes_constant(const Function& f, const End& end, uint32_t operand) const override;
};

class Emitter {
 public:
  Emitter(const PouCode& pou, const Shared& shared, Assembler& assembler);
  Entries run();

 private:
  struct EdgeStub {
    Label label;
    Block block;
    uint32_t target;
  };
  struct TableStub {
    Label label;
    std::vector<Label> entries;
  };
  struct CallStub {
    Label label;
    uint32_t side;
    uint32_t exit;
  };
  struct NanStub {  // a float whose bits this machine would choose otherwise
    Label label;
    Label back;
    uint8_t result;
    uint8_t a;
    uint8_t b;
    uint8_t width;
  };

  // emitter.cc: blocks, moves, exits
  void function();
  void block(Block b);
  void end(Block b);
  void branch(Block b);
  void loop_end(Block b);
  void again(Block head);
  void take_turns(Block b);
  void give_back(uint32_t fuel);
  bool only_asks(Block head) const;
  void moves(const std::vector<Move>& all);
  void move(const Move& m);
  void move_to_spill(const Move& m);
  void load_place(uint8_t to, const Place& from);
  void load_float(uint8_t to, const Place& from, uint8_t width);
  void load_bool(uint8_t to, const Address& from);
  void stubs();
  void store_slot(const SlotValue& slot, const Place& place);
  void leave_at_side(uint32_t side);
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
  void shift_by_constant(const Node& node, uint8_t to, uint8_t from, uint32_t count);
  void rotate_by_constant(const Node& node, uint8_t to, uint8_t from, uint32_t count);
  void divide(const Node& node, const Step& step);
  void compare(uint8_t width, Cond cond, const Place& a, const Place& b);
  void test_bits(uint8_t width, uint8_t left, const Place& b);
  void jump_if(uint8_t width, Cond cond, const Place& a, const Place& b, Label to);
  void test_bool(uint8_t reg);
  void select(const Node& node, const Step& step);
  void load(const Node& node, const Step& step);
  void store(const Node& node, const Step& step);
  void data_address(const Node& node, const Step& step);
  void instance(const Node& node, const Step& step);
  void helper(const Node& node, const Step& step);
  void native(const Node& node);
  void pool(const Step& step);

  // emit_float.cc
  void floating(const Node& node, const Step& step);
  void float_compare(const Node& node, const Step& step);
  void float_to_int(const Node& node, const Step& step);
  void settle_nan(uint8_t result, uint8_t a, uint8_t b, uint8_t width);
  void nan_stubs();

  // emit_call.cc
  void call(const Node& node);
  void enter(const Node& node, const Step& step);
  void take_fuel(const Node& node);
  void push_record(uint32_t call);
  void inlined_exit(uint32_t exit);
  void activation(uint32_t inlined);
  void slow_call(uint32_t number);

  uint8_t integer_register(const Place& place) const;
  uint8_t float_register(const Place& place) const;
  Address spill(uint32_t slot) const;
  Address variable(uint32_t number) const;
  Address address(const Mem& mem, const Place& index, const Place& pointer = {}) const;
  Address context(size_t offset) const;
  void store_word(const Address& to, uint32_t value);

  const PouCode& pou_;
  const Function& f_;
  const Allocated& places_;
  const Shared& shared_;
  Assembler& a_;
  Entries entries_;
  int32_t frame_bytes_ = 0;
  std::vector<Label> blocks_;
  std::vector<Label> exits_;
  std::vector<EdgeStub> edges_;
  JumpTables tables_;
  std::vector<TableStub> table_stubs_;
  std::vector<std::pair<Label, uint32_t>> stops_;  // a helper that trapped: its unit
  std::vector<CallStub> call_stubs_;               // out of fuel at a call
  std::vector<NanStub> nan_stubs_;
  std::vector<Label> inlined_;  // by Function::inlined: makes the activation
  Label leave_ = 0;
};

// The condition of integers that are compared.
Condition condition_of(Cond cond);
// The condition after FCMP: false for what is no number, but kNe.
Condition float_condition_of(Cond cond);
// The constant as a comparison of `width` bytes takes it.
int64_t compared_constant(uint64_t bits, uint8_t width, Cond cond);

}  // namespace vm::native::arm64
