// Machine code of AArch64, word by word. Registers are their numbers in the encoding: 31 is the
// stack pointer where an address or a sum with a constant is meant, else zero.
//
// Loads, stores and address() take every address; what no instruction takes goes through x17.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vm/native/code_buffer.h"

namespace vm::native::arm64 {

inline constexpr uint8_t kZero = 31;
inline constexpr uint8_t kSp = 31;
inline constexpr uint8_t kLink = 30;
inline constexpr uint8_t kAddressScratch = 17;

// base + (index << shift) + disp
struct Address {
  uint8_t base = kSp;
  uint8_t index = 0xff;  // none
  uint8_t shift = 0;
  bool has_base = true;  // address() only
  int64_t disp = 0;
};

// In pairs that differ in the lowest bit.
enum class Condition : uint8_t {
  kEqual,
  kNotEqual,
  kAboveOrEqual,
  kBelow,
  kMinus,
  kPlus,
  kOverflow,
  kNoOverflow,
  kAbove,
  kBelowOrEqual,
  kGreaterOrEqual,
  kLess,
  kGreater,
  kLessOrEqual
};
inline Condition inverted(Condition c) {
  return static_cast<Condition>(static_cast<uint8_t>(c) ^ 1);
}

enum class Alu : uint32_t {
  kAdd = 0x0b000000,
  kAddFlags = 0x2b000000,
  kSub = 0x4b000000,
  kSubFlags = 0x6b000000,
  kAnd = 0x0a000000,
  kAndNot = 0x0a200000,
  kOr = 0x2a000000,
  kOrNot = 0x2a200000,
  kXor = 0x4a000000,
  kAndFlags = 0x6a000000
};
enum class Logical : uint32_t {
  kAnd = 0x12000000,
  kOr = 0x32000000,
  kXor = 0x52000000,
  kAndFlags = 0x72000000
};
enum class Field : uint32_t { kSigned = 0x13000000, kInsert = 0x33000000, kUnsigned = 0x53000000 };
// Two operands in registers.
enum class Binary : uint32_t {
  kDivU = 0x1ac00800,
  kDivS = 0x1ac00c00,
  kShl = 0x1ac02000,
  kShr = 0x1ac02400,
  kSar = 0x1ac02800,
  kRor = 0x1ac02c00
};
enum class FloatBinary : uint32_t {
  kMul = 0x1e200800,
  kDiv = 0x1e201800,
  kAdd = 0x1e202800,
  kSub = 0x1e203800
};
enum class FloatUnary : uint32_t {
  kMove = 0x1e204000,
  kAbs = 0x1e20c000,
  kNeg = 0x1e214000,
  kSqrt = 0x1e21c000
};

class Assembler : public CodeBuffer {
 public:
  // Jumps so far get their distances: their labels are bound.
  void patch();

  // Short branches reach 1 MiB. What does not is made anew, with long ones (4 GiB).
  struct Mark {
    size_t code, labels, fixups;
  };
  Mark mark() const { return {code_.size(), labels(), fixups_.size()}; }
  bool reaches(const Mark& since) const;  // all labels used since then are bound
  void rewind(const Mark& to);
  void set_long(bool is_long) { long_ = is_long; }

  // Integer instructions work on `width` 4 (and zero the upper half) or 8.
  void move(uint8_t to, uint8_t from);  // 8 bytes; not of the stack pointer
  void move_imm(uint8_t to, uint64_t bits);
  void alu(Alu op, uint8_t to, uint8_t a, uint8_t b, uint8_t width, uint8_t shift_b = 0);
  void logical(Logical op, uint8_t to, uint8_t a, uint32_t immediate, uint8_t width);
  void add_imm(uint8_t to, uint8_t a, int64_t value, uint8_t width);  // any; may need x17
  void compare_imm(uint8_t a, int64_t value, uint8_t width);          // a sum immediate
  void decrement(uint8_t reg, uint32_t by);  // 8 bytes, sets flags; less than 4096
  // `b` is extended from 1 or 2 bytes.
  void compare_extended(uint8_t a, uint8_t b, uint8_t from, bool is_signed);
  void multiply(uint8_t to, uint8_t a, uint8_t b, uint8_t width);
  void multiply_high(uint8_t to, uint8_t a, uint8_t b, bool is_signed);  // of 8 bytes
  void multiply_subtract(uint8_t to, uint8_t a, uint8_t b, uint8_t c, uint8_t width);  // c - a * b
  void binary(Binary op, uint8_t to, uint8_t a, uint8_t b, uint8_t width);
  void field(Field op, uint8_t to, uint8_t from, uint32_t immr, uint32_t imms, uint8_t width);
  void rotate_right(uint8_t to, uint8_t from, uint32_t count, uint8_t width);
  void shift_left(uint8_t to, uint8_t from, uint32_t count, uint8_t width);
  void zero_extend(uint8_t to, uint8_t from, uint8_t from_width);
  void sign_extend(uint8_t to, uint8_t from, uint8_t from_width);  // to 8 bytes
  void set(Condition condition, uint8_t to);
  void select(Condition condition, uint8_t to, uint8_t yes, uint8_t no);  // 8 bytes

  void load(uint8_t to, const Address& from, uint8_t width);  // zero-extended
  void store(const Address& to, uint8_t from, uint8_t width);
  void address(uint8_t to, const Address& at, uint8_t width);
  void address_of(uint8_t to, Label label);
  // At a multiple of 8 from the stack pointer; `floats`: the d registers.
  void store_pair(uint8_t a, uint8_t b, int32_t at, bool floats);
  void load_pair(uint8_t a, uint8_t b, int32_t at, bool floats);

  void jump(Label to);
  void jump_if(Condition condition, Label to);
  void jump_if_zero(bool zero, uint8_t reg, uint8_t width, Label to);
  void jump_long(Label to);  // by x17
  void jump_to(uint8_t reg);
  void call(uint8_t reg);
  void ret();
  void trap();                              // is never reached
  void table_entry(Label table, Label to);  // 4 bytes: table - to; `table` is bound

  // Floating point of 4 or 8 bytes.
  void float_unary(FloatUnary op, uint8_t to, uint8_t from, uint8_t width);
  void float_binary(FloatBinary op, uint8_t to, uint8_t a, uint8_t b, uint8_t width);
  void float_move(uint8_t to, uint8_t from);  // 8 bytes
  void float_imm(uint8_t to, uint8_t immediate, uint8_t width);
  void float_zero(uint8_t to);
  void float_load(uint8_t to, const Address& from, uint8_t width);
  void float_store(const Address& to, uint8_t from, uint8_t width);
  void float_compare(uint8_t a, uint8_t b, uint8_t width);
  void float_select(Condition condition, uint8_t to, uint8_t yes, uint8_t no);  // 8 bytes
  void float_from_integer(uint8_t to, uint8_t from, uint8_t width, uint8_t from_width);
  // To 8 bytes; half to even, or towards zero.
  void integer_from_float(uint8_t to, uint8_t from, uint8_t from_width, bool truncate);
  void float_width(uint8_t to, uint8_t from, uint8_t from_width);
  void bits_to_float(uint8_t to, uint8_t from, uint8_t width);
  void float_to_bits(uint8_t to, uint8_t from, uint8_t width);

 private:
  enum class Reach : uint8_t { kJump, kConditional, kPage, kDistance };
  struct Fixup {
    uint32_t at;
    Label to;
    Reach reach;
  };
  void word(uint32_t w);
  void registers(uint32_t op, uint32_t to, uint32_t a, uint32_t b, bool wide);
  void sum(bool subtracts, bool flags, uint8_t to, uint8_t a, uint32_t field, uint8_t width);
  void access(uint32_t op, uint8_t reg, const Address& at, uint8_t width);
  Address simple(const Address& at, uint8_t width);
  void branch(uint32_t op, Label to, Reach reach);

  std::vector<Fixup> fixups_;
  bool long_ = false;
};

}  // namespace vm::native::arm64
