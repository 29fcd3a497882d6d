#include "vm/native/x64/assembler.h"

#include <algorithm>
#include <cstring>

namespace vm::native::x64 {
namespace {

bool fits8(int64_t v) { return v >= -128 && v <= 127; }

}  // namespace

void Assembler::patch() {
  for (const Fixup& fixup : fixups_) {
    int32_t distance;
    std::memcpy(&distance, &code_[fixup.at], sizeof distance);
    distance += static_cast<int32_t>(offset_of(fixup.to) - (fixup.at + 4));
    std::memcpy(&code_[fixup.at], &distance, sizeof distance);
  }
  fixups_.clear();
}

void Assembler::imm(int64_t v, uint8_t bytes) {
  for (uint8_t i = 0; i < bytes; ++i) byte(static_cast<uint32_t>(v >> (8 * i)) & 0xff);
}
void Assembler::imm32(int64_t v) { imm(v, 4); }

void Assembler::modrm(uint8_t reg, const Operand& rm) {
  const uint32_t field = static_cast<uint32_t>(reg & 7) << 3;
  if (!rm.memory) return byte(0xc0 | field | (rm.reg & 7));
  const Address& at = rm.at;
  const bool indexed = at.index != 0xff;
  const uint32_t scale = at.scale == 8 ? 3 : at.scale == 4 ? 2 : at.scale == 2 ? 1 : 0;
  if (!at.has_base) {
    byte(0x04 | field);
    byte(scale << 6 | static_cast<uint32_t>(indexed ? at.index & 7 : 4) << 3 | 5);
    return imm32(at.disp);
  }
  // rbp and r13 as a base want a displacement.
  const bool none = at.disp == 0 && (at.base & 7) != 5;
  const uint32_t mode = none ? 0x00 : fits8(at.disp) ? 0x40 : 0x80;
  if (indexed || (at.base & 7) == 4) {
    byte(mode | field | 4);
    byte(scale << 6 | static_cast<uint32_t>(indexed ? at.index & 7 : 4) << 3 | (at.base & 7));
  } else {
    byte(mode | field | (at.base & 7));
  }
  if (mode == 0x40) imm(at.disp, 1);
  if (mode == 0x80) imm32(at.disp);
}

void Assembler::instruction(uint8_t prefix, bool wide, std::initializer_list<uint8_t> opcode,
                            uint8_t reg, const Operand& rm, bool byte_reg, bool byte_rm) {
  if (prefix != 0) byte(prefix);
  uint32_t rex = wide ? 0x48 : 0x40;
  rex |= static_cast<uint32_t>(reg >> 3) << 2;
  if (rm.memory) {
    if (rm.at.index != 0xff) rex |= static_cast<uint32_t>(rm.at.index >> 3) << 1;
    if (rm.at.has_base) rex |= rm.at.base >> 3;
  } else {
    rex |= rm.reg >> 3;
  }
  const bool low = (byte_reg && reg >= 4) || (byte_rm && !rm.memory && rm.reg >= 4);
  if (rex != 0x40 || low) byte(rex);
  for (const uint8_t b : opcode) byte(b);
  modrm(reg, rm);
}

void Assembler::move(uint8_t to, uint8_t from) {
  if (to != from) instruction(0, true, {0x8b}, to, Operand::of(from));
}

void Assembler::move_imm(uint8_t to, uint64_t bits) {
  if (bits == 0) return instruction(0, false, {0x31}, to, Operand::of(to));
  if (bits <= 0xffffffffu) {
    if (to >= 8) byte(0x41);
    byte(0xb8u + (to & 7u));
    return imm32(static_cast<int64_t>(bits));
  }
  const auto v = static_cast<int64_t>(bits);
  if (v >= INT32_MIN && v < 0) {
    instruction(0, true, {0xc7}, 0, Operand::of(to));
    return imm32(v);
  }
  byte(to >= 8 ? 0x49 : 0x48);
  byte(0xb8u + (to & 7u));
  imm(v, 8);
}

void Assembler::load(uint8_t to, const Address& from, uint8_t width) {
  zero_extend(to, Operand::of(from), width);
}

void Assembler::zero_extend(uint8_t to, Operand from, uint8_t width) {
  if (width == 1) return instruction(0, false, {0x0f, 0xb6}, to, from, false, true);
  if (width == 2) return instruction(0, false, {0x0f, 0xb7}, to, from);
  instruction(0, width == 8, {0x8b}, to, from);
}

void Assembler::load_signed(uint8_t to, Operand from, uint8_t width) {
  if (width == 1) return instruction(0, true, {0x0f, 0xbe}, to, from, false, true);
  if (width == 2) return instruction(0, true, {0x0f, 0xbf}, to, from);
  if (width == 4) return instruction(0, true, {0x63}, to, from);
  instruction(0, true, {0x8b}, to, from);
}

void Assembler::store(const Address& to, uint8_t from, uint8_t width) {
  if (width == 1) return instruction(0, false, {0x88}, from, Operand::of(to), true);
  instruction(width == 2 ? 0x66 : 0, width == 8, {0x89}, from, Operand::of(to));
}

void Assembler::store_imm(const Address& to, int32_t value, uint8_t width) {
  if (width == 1) {
    instruction(0, false, {0xc6}, 0, Operand::of(to));
    return imm(value, 1);
  }
  instruction(width == 2 ? 0x66 : 0, width == 8, {0xc7}, 0, Operand::of(to));
  imm(value, width == 2 ? 2 : 4);
}

void Assembler::alu(Alu op, uint8_t to, Operand from, uint8_t width) {
  const auto code = static_cast<uint8_t>(static_cast<uint8_t>(op) << 3 | 2);
  if (width == 1) return instruction(0, false, {code}, to, from, true, true);
  instruction(width == 2 ? 0x66 : 0, width == 8, {static_cast<uint8_t>(code | 1)}, to, from);
}

void Assembler::alu_imm(Alu op, Operand to, int32_t value, uint8_t width) {
  const auto field = static_cast<uint8_t>(op);
  if (width == 1) {
    instruction(0, false, {0x80}, field, to, false, true);
    return imm(value, 1);
  }
  const bool small = fits8(value);
  instruction(width == 2 ? 0x66 : 0, width == 8, {static_cast<uint8_t>(small ? 0x83 : 0x81)}, field,
              to);
  imm(value, small ? 1 : width == 2 ? 2 : 4);
}

void Assembler::test(uint8_t a, uint8_t b, uint8_t width) {
  if (width == 1) return instruction(0, false, {0x84}, b, Operand::of(a), true, true);
  instruction(width == 2 ? 0x66 : 0, width == 8, {0x85}, b, Operand::of(a));
}

void Assembler::test_imm(uint8_t reg, int32_t value, uint8_t width) {
  const bool byte_wide = width == 1;
  instruction(width == 2 ? 0x66 : 0, width == 8, {static_cast<uint8_t>(byte_wide ? 0xf6 : 0xf7)}, 0,
              Operand::of(reg), false, byte_wide);
  imm(value, std::min<uint8_t>(width, 4));
}
void Assembler::and_not(uint8_t to, uint8_t complemented, uint8_t with) {
  byte(0xc4);
  byte((to >= 8 ? 0u : 0x80u) | 0x40u | (with >= 8 ? 0u : 0x20u) | 2u);
  byte(static_cast<uint32_t>(~complemented & 15) << 3);
  byte(0xf2);
  modrm(to, Operand::of(with));
}

void Assembler::multiply(uint8_t to, Operand from, uint8_t width) {
  instruction(0, width == 8, {0x0f, 0xaf}, to, from);
}
void Assembler::multiply_imm(uint8_t to, Operand from, int32_t value, uint8_t width) {
  const bool small = fits8(value);
  instruction(0, width == 8, {static_cast<uint8_t>(small ? 0x6b : 0x69)}, to, from);
  imm(value, small ? 1 : 4);
}
void Assembler::negate(uint8_t reg, uint8_t width) {
  instruction(0, width == 8, {0xf7}, 3, Operand::of(reg));
}
void Assembler::complement(uint8_t reg, uint8_t width) {
  instruction(0, width == 8, {0xf7}, 2, Operand::of(reg));
}

void Assembler::shift(Shift op, uint8_t reg, uint8_t count, uint8_t width) {
  const auto field = static_cast<uint8_t>(op);
  const uint8_t code = width == 1 ? 0xc0 : 0xc1;
  instruction(width == 2 ? 0x66 : 0, width == 8, {code}, field, Operand::of(reg), false,
              width == 1);
  byte(count);
}
void Assembler::shift_cl(Shift op, uint8_t reg, uint8_t width) {
  instruction(0, width == 8, {0xd3}, static_cast<uint8_t>(op), Operand::of(reg));
}

void Assembler::divide(uint8_t by, bool is_signed, uint8_t width) {
  instruction(0, width == 8, {0xf7}, is_signed ? 7 : 6, Operand::of(by));
}
void Assembler::multiply_wide(uint8_t by, bool is_signed) {
  instruction(0, true, {0xf7}, is_signed ? 5 : 4, Operand::of(by));
}
void Assembler::sign_into_rdx(uint8_t width) {
  if (width == 8) byte(0x48);
  byte(0x99);
}
void Assembler::address(uint8_t to, const Address& at, uint8_t width) {
  instruction(0, width == 8, {0x8d}, to, Operand::of(at));
}
void Assembler::set(Condition condition, uint8_t to) {
  instruction(0, false, {0x0f, static_cast<uint8_t>(0x90 | static_cast<uint8_t>(condition))}, 0,
              Operand::of(to), false, true);
}
void Assembler::move_if(Condition condition, uint8_t to, uint8_t from) {
  instruction(0, true, {0x0f, static_cast<uint8_t>(0x40 | static_cast<uint8_t>(condition))}, to,
              Operand::of(from));
}

void Assembler::jump_field(Label to) {
  fixups_.push_back({here(), to});
  imm32(0);
}
void Assembler::jump(Label to) {
  byte(0xe9);
  jump_field(to);
}
void Assembler::jump_if(Condition condition, Label to) {
  byte(0x0f);
  byte(0x80u | static_cast<uint8_t>(condition));
  jump_field(to);
}
void Assembler::address_of(uint8_t to, Label label) {
  byte(to >= 8 ? 0x4c : 0x48);
  byte(0x8d);
  byte(0x05u | (to & 7u) << 3);
  jump_field(label);
}
void Assembler::table_entry(Label table, Label to) {
  fixups_.push_back({here(), to});
  imm32(int64_t{here()} + 4 - offset_of(table));
}
void Assembler::jump_to(uint8_t reg) { instruction(0, false, {0xff}, 4, Operand::of(reg)); }
void Assembler::call(Label to) {
  byte(0xe8);
  jump_field(to);
}
void Assembler::call(Operand to) { instruction(0, false, {0xff}, 2, to); }
void Assembler::ret() { byte(0xc3); }
void Assembler::push(uint8_t reg) {
  if (reg >= 8) byte(0x41);
  byte(0x50u + (reg & 7u));
}
void Assembler::pop(uint8_t reg) {
  if (reg >= 8) byte(0x41);
  byte(0x58u + (reg & 7u));
}
void Assembler::trap() {
  byte(0x0f);
  byte(0x0b);
}

void Assembler::float_move(uint8_t to, uint8_t from) {
  if (to != from) instruction(0, false, {0x0f, 0x28}, to, Operand::of(from));
}
void Assembler::float_load(uint8_t to, const Address& from, uint8_t width) {
  instruction(width == 4 ? 0xf3 : 0xf2, false, {0x0f, 0x10}, to, Operand::of(from));
}
void Assembler::float_store(const Address& to, uint8_t from, uint8_t width) {
  instruction(width == 4 ? 0xf3 : 0xf2, false, {0x0f, 0x11}, from, Operand::of(to));
}
void Assembler::float_op(uint8_t opcode, uint8_t to, Operand from, uint8_t width) {
  instruction(width == 4 ? 0xf3 : 0xf2, false, {0x0f, opcode}, to, from);
}
void Assembler::float_compare(uint8_t a, Operand b, uint8_t width) {
  instruction(width == 4 ? 0 : 0x66, false, {0x0f, 0x2e}, a, b);
}
void Assembler::float_logic(uint8_t opcode, uint8_t to, uint8_t from) {
  instruction(0, false, {0x0f, opcode}, to, Operand::of(from));
}
void Assembler::float_from_integer(uint8_t to, uint8_t from, uint8_t width, uint8_t from_width) {
  float_logic(0x57, to, to);
  instruction(width == 4 ? 0xf3 : 0xf2, from_width == 8, {0x0f, 0x2a}, to, Operand::of(from));
}
void Assembler::integer_from_float(uint8_t to, uint8_t from, uint8_t from_width, bool truncate) {
  instruction(from_width == 4 ? 0xf3 : 0xf2, true,
              {0x0f, static_cast<uint8_t>(truncate ? 0x2c : 0x2d)}, to, Operand::of(from));
}
void Assembler::float_width(uint8_t to, Operand from, uint8_t from_width) {
  instruction(from_width == 4 ? 0xf3 : 0xf2, false, {0x0f, 0x5a}, to, from);
}
void Assembler::bits_to_float(uint8_t to, uint8_t from, uint8_t width) {
  instruction(0x66, width == 8, {0x0f, 0x6e}, to, Operand::of(from));
}
void Assembler::float_to_bits(uint8_t to, uint8_t from, uint8_t width) {
  instruction(0x66, width == 8, {0x0f, 0x7e}, from, Operand::of(to));
}

}  // namespace vm::native::x64
