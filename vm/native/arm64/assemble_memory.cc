// Addresses, loads and stores, floating point.
#include <bit>

#include "vm/native/arm64/assembler.h"
#include "vm/native/arm64/immediates.h"

namespace vm::native::arm64 {
namespace {

constexpr uint32_t kFloating = 1u << 26;
constexpr uint32_t kLoad = 1u << 22;

uint32_t size_of(uint8_t width) { return static_cast<uint32_t>(std::countr_zero(width)); }

bool is_scaled(int64_t disp, uint8_t width) {
  return disp >= 0 && disp % width == 0 && disp / width < 0x1000;
}
bool is_direct(int64_t disp, uint8_t width) {
  return is_scaled(disp, width) || (disp >= -256 && disp < 256);
}
uint32_t type_of(uint8_t width) { return width == 8 ? 1u << 22 : 0; }

}  // namespace

// The address of the same place in a form that an instruction takes.
Address Assembler::simple(const Address& at, uint8_t width) {
  if (at.index == 0xff) {
    if (is_direct(at.disp, width)) return at;
    if (at.disp >= 0 && at.disp < 0x1000000 && is_scaled(at.disp & 0xfff, width)) {
      sum(false, false, kAddressScratch, at.base, static_cast<uint32_t>(at.disp) & 0xfff000, 8);
      return {kAddressScratch, 0xff, 0, true, at.disp & 0xfff};
    }
    move_imm(kAddressScratch, static_cast<uint64_t>(at.disp));
    return {at.base, kAddressScratch, 0, true, 0};
  }
  if (at.disp == 0 && (at.shift == 0 || at.shift == size_of(width))) return at;
  if (is_direct(at.disp, width)) {
    alu(Alu::kAdd, kAddressScratch, at.base, at.index, 8, at.shift);
    return {kAddressScratch, 0xff, 0, true, at.disp};
  }
  move_imm(kAddressScratch, static_cast<uint64_t>(at.disp));
  alu(Alu::kAdd, kAddressScratch, kAddressScratch, at.index, 8, at.shift);
  return {at.base, kAddressScratch, 0, true, 0};
}

void Assembler::access(uint32_t op, uint8_t reg, const Address& at, uint8_t width) {
  const Address from = simple(at, width);
  const uint32_t common = op | size_of(width) << 30 | uint32_t{from.base} << 5 | reg;
  if (from.index != 0xff) {
    const uint32_t scaled = from.shift != 0 ? 1u << 12 : 0;
    return word(common | 0x38206800 | uint32_t{from.index} << 16 | scaled);
  }
  if (is_scaled(from.disp, width)) {
    return word(common | 0x39000000 | static_cast<uint32_t>(from.disp / width) << 10);
  }
  word(common | 0x38000000 | (static_cast<uint32_t>(from.disp) & 0x1ff) << 12);
}

void Assembler::load(uint8_t to, const Address& from, uint8_t width) {
  access(kLoad, to, from, width);
}
void Assembler::store(const Address& to, uint8_t from, uint8_t width) {
  access(0, from, to, width);
}
void Assembler::float_load(uint8_t to, const Address& from, uint8_t width) {
  access(kFloating | kLoad, to, from, width);
}
void Assembler::float_store(const Address& to, uint8_t from, uint8_t width) {
  access(kFloating, from, to, width);
}

void Assembler::address(uint8_t to, const Address& at, uint8_t width) {
  uint8_t from = at.base;
  if (at.index != 0xff) {
    const uint8_t base = at.has_base ? at.base : kZero;
    const bool is_index = !at.has_base && at.shift == 0 && width == 8;
    from = is_index ? at.index : to;
    if (!is_index) alu(Alu::kAdd, to, base, at.index, width, at.shift);
  } else if (!at.has_base) {
    const auto bits = static_cast<uint64_t>(at.disp);
    return move_imm(to, width == 4 ? bits & 0xffffffffu : bits);
  }
  const int64_t disp = width == 4 ? sign_extended(static_cast<uint64_t>(at.disp), 4) : at.disp;
  if (disp != 0 || to != from) add_imm(to, from, disp, width);
}

void Assembler::store_pair(uint8_t a, uint8_t b, int32_t at, bool floats) {
  word((floats ? 0x6d000000 : 0xa9000000) | (static_cast<uint32_t>(at / 8) & 0x7f) << 15 |
       uint32_t{b} << 10 | uint32_t{kSp} << 5 | a);
}
void Assembler::load_pair(uint8_t a, uint8_t b, int32_t at, bool floats) {
  word((floats ? 0x6d400000 : 0xa9400000) | (static_cast<uint32_t>(at / 8) & 0x7f) << 15 |
       uint32_t{b} << 10 | uint32_t{kSp} << 5 | a);
}

// --- floating point -----------------------------------------------------------------

void Assembler::float_unary(FloatUnary op, uint8_t to, uint8_t from, uint8_t width) {
  word(static_cast<uint32_t>(op) | type_of(width) | uint32_t{from} << 5 | to);
}
void Assembler::float_binary(FloatBinary op, uint8_t to, uint8_t a, uint8_t b, uint8_t width) {
  word(static_cast<uint32_t>(op) | type_of(width) | uint32_t{b} << 16 | uint32_t{a} << 5 | to);
}
void Assembler::float_move(uint8_t to, uint8_t from) {
  if (to != from) float_unary(FloatUnary::kMove, to, from, 8);
}
void Assembler::float_imm(uint8_t to, uint8_t immediate, uint8_t width) {
  word(0x1e201000 | type_of(width) | uint32_t{immediate} << 13 | to);
}
void Assembler::float_zero(uint8_t to) { word(0x2f00e400u | to); }
void Assembler::float_compare(uint8_t a, uint8_t b, uint8_t width) {
  word(0x1e202000 | type_of(width) | uint32_t{b} << 16 | uint32_t{a} << 5);
}
void Assembler::float_select(Condition condition, uint8_t to, uint8_t yes, uint8_t no) {
  word(0x1e600c00 | uint32_t{no} << 16 | static_cast<uint32_t>(condition) << 12 |
       uint32_t{yes} << 5 | to);
}
void Assembler::float_from_integer(uint8_t to, uint8_t from, uint8_t width, uint8_t from_width) {
  registers(0x1e220000 | type_of(width), to, from, 0, from_width == 8);
}
void Assembler::integer_from_float(uint8_t to, uint8_t from, uint8_t from_width, bool truncate) {
  registers((truncate ? 0x1e380000 : 0x1e200000) | type_of(from_width), to, from, 0, true);
}
void Assembler::float_width(uint8_t to, uint8_t from, uint8_t from_width) {
  word((from_width == 4 ? 0x1e22c000 : 0x1e624000) | uint32_t{from} << 5 | to);
}
void Assembler::bits_to_float(uint8_t to, uint8_t from, uint8_t width) {
  word((width == 8 ? 0x9e670000 : 0x1e270000) | uint32_t{from} << 5 | to);
}
void Assembler::float_to_bits(uint8_t to, uint8_t from, uint8_t width) {
  word((width == 8 ? 0x9e660000 : 0x1e260000) | uint32_t{from} << 5 | to);
}

}  // namespace vm::native::arm64
