// Machine code of x86-64, byte by byte. Registers are their numbers in the encoding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "vm/native/code_buffer.h"

namespace vm::native::x64 {

enum Register : uint8_t {
  kRax,
  kRcx,
  kRdx,
  kRbx,
  kRsp,
  kRbp,
  kRsi,
  kRdi,
  kR8,
  kR9,
  kR10,
  kR11,
  kR12,
  kR13,
  kR14,
  kR15
};

struct Address {
  uint8_t base = kRsp;
  uint8_t index = 0xff;  // none
  uint8_t scale = 1;
  bool has_base = true;
  int32_t disp = 0;
};

// A register or memory.
struct Operand {
  bool memory = false;
  uint8_t reg = 0;
  Address at;
  static Operand of(uint8_t reg) { return {false, reg, {}}; }
  static Operand of(Address at) { return {true, 0, at}; }
};

enum class Condition : uint8_t {
  kOverflow,
  kNoOverflow,
  kBelow,
  kAboveOrEqual,
  kEqual,
  kNotEqual,
  kBelowOrEqual,
  kAbove,
  kSign,
  kNoSign,
  kParity,
  kNoParity,
  kLess,
  kGreaterOrEqual,
  kLessOrEqual,
  kGreater
};
// Conditions come in pairs, which differ in the lowest bit.
inline Condition inverted(Condition c) {
  return static_cast<Condition>(static_cast<uint8_t>(c) ^ 1);
}

// 0: add, 1: or, 4: and, 5: sub, 6: xor, 7: cmp
enum class Alu : uint8_t { kAdd = 0, kOr = 1, kAnd = 4, kSub = 5, kXor = 6, kCmp = 7 };
enum class Shift : uint8_t { kRol = 0, kRor = 1, kShl = 4, kShr = 5, kSar = 7 };

class Assembler : public CodeBuffer {
 public:
  // Jumps so far get their distances: their labels are bound.
  void patch();

  // Integer instructions work on `width` bytes.
  void move(uint8_t to, uint8_t from);  // 8 bytes
  void move_imm(uint8_t to, uint64_t bits);
  void load(uint8_t to, const Address& from, uint8_t width);  // zero-extended
  void load_signed(uint8_t to, Operand from, uint8_t width);  // to 8 bytes
  void zero_extend(uint8_t to, Operand from, uint8_t width);
  void store(const Address& to, uint8_t from, uint8_t width);
  void store_imm(const Address& to, int32_t imm, uint8_t width);
  void alu(Alu op, uint8_t to, Operand from, uint8_t width);
  void alu_imm(Alu op, Operand to, int32_t imm, uint8_t width);
  void test(uint8_t a, uint8_t b, uint8_t width);
  void test_imm(uint8_t reg, int32_t imm, uint8_t width);
  void and_not(uint8_t to, uint8_t complemented, uint8_t with);  // andn of 4 bytes: BMI1
  void multiply(uint8_t to, Operand from, uint8_t width);
  void multiply_imm(uint8_t to, Operand from, int32_t imm, uint8_t width);
  void negate(uint8_t reg, uint8_t width);
  void complement(uint8_t reg, uint8_t width);
  void shift(Shift op, uint8_t reg, uint8_t count, uint8_t width);
  void shift_cl(Shift op, uint8_t reg, uint8_t width);
  void divide(uint8_t by, bool is_signed, uint8_t width);  // rdx:rax
  void multiply_wide(uint8_t by, bool is_signed);          // rdx:rax := rax by it
  void sign_into_rdx(uint8_t width);
  void address(uint8_t to, const Address& at, uint8_t width);  // lea
  void address_of(uint8_t to, Label label);
  void set(Condition condition, uint8_t to);
  void move_if(Condition condition, uint8_t to, uint8_t from);  // 8 bytes

  void jump(Label to);
  void jump_long(Label to) { jump(to); }
  void jump_if(Condition condition, Label to);
  void jump_to(uint8_t reg);
  void call(Label to);
  void call(Operand to);
  void ret();
  void push(uint8_t reg);
  void pop(uint8_t reg);
  void trap();  // ud2: is never reached
  void table_entry(Label table, Label to);  // 4 bytes: to - table, which is bound

  // Floating point of 4 or 8 bytes.
  void float_move(uint8_t to, uint8_t from);
  void float_load(uint8_t to, const Address& from, uint8_t width);
  void float_store(const Address& to, uint8_t from, uint8_t width);
  void float_op(uint8_t opcode, uint8_t to, Operand from, uint8_t width);  // 58 add, 59 mul ...
  void float_compare(uint8_t a, Operand b, uint8_t width);
  void float_logic(uint8_t opcode, uint8_t to,
                   uint8_t from);  // 54 and, 57 xor; of the whole register
  void float_from_integer(uint8_t to, uint8_t from, uint8_t width, uint8_t from_width);
  void integer_from_float(uint8_t to, uint8_t from, uint8_t from_width, bool truncate);
  void float_width(uint8_t to, Operand from, uint8_t from_width);
  void bits_to_float(uint8_t to, uint8_t from, uint8_t width);
  void float_to_bits(uint8_t to, uint8_t from, uint8_t width);

 private:
  void byte(uint32_t b) { code_.push_back(static_cast<uint8_t>(b)); }
  void imm32(int64_t v);
  void imm(int64_t v, uint8_t bytes);
  // [prefix] [rex] opcode modrm...; `bytes`: both registers may be low bytes that need a rex.
  void instruction(uint8_t prefix, bool wide, std::initializer_list<uint8_t> opcode, uint8_t reg,
                   const Operand& rm, bool byte_reg = false, bool byte_rm = false);
  void modrm(uint8_t reg, const Operand& rm);
  void jump_field(Label to);

  struct Fixup {
    uint32_t at;
    Label to;
  };
  std::vector<Fixup> fixups_;
};

}  // namespace vm::native::x64
