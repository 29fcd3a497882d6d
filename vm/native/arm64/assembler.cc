#include "vm/native/arm64/assembler.h"

#include <cstring>

#include "vm/native/arm64/immediates.h"

namespace vm::native::arm64 {
namespace {

constexpr uint32_t kWide = 1u << 31;

uint32_t distance(uint32_t from, uint32_t to) { return to - from; }
int64_t signed_distance(uint32_t from, uint32_t to) { return int64_t{to} - int64_t{from}; }

}  // namespace

void Assembler::word(uint32_t w) {
  for (unsigned i = 0; i < 4; ++i) code_.push_back(static_cast<uint8_t>(w >> (8 * i)));
}

// --- labels -------------------------------------------------------------------------

bool Assembler::reaches(const Mark& since) const {
  for (size_t i = since.fixups; i < fixups_.size(); ++i) {
    const Fixup& fixup = fixups_[i];
    const int64_t far = signed_distance(fixup.at, offset_of(fixup.to));
    if (fixup.reach == Reach::kPage || fixup.reach == Reach::kDistance) continue;
    const int64_t most = int64_t{1} << (fixup.reach == Reach::kJump ? 27 : 20);
    if (far < -most || far >= most) return false;
  }
  return true;
}

void Assembler::rewind(const Mark& to) {
  code_.resize(to.code);
  forget_labels(to.labels);
  fixups_.resize(to.fixups);
}

void Assembler::patch() {
  for (const Fixup& fixup : fixups_) {
    const uint32_t to = offset_of(fixup.to);
    uint32_t w[2] = {};
    std::memcpy(w, &code_[fixup.at], fixup.reach == Reach::kPage ? 8 : 4);
    switch (fixup.reach) {
      case Reach::kJump:
        w[0] |= distance(fixup.at, to) >> 2 & 0x3ffffff;
        break;
      case Reach::kConditional:
        w[0] |= (distance(fixup.at, to) >> 2 & 0x7ffff) << 5;
        break;
      case Reach::kPage: {
        // The code begins at a page.
        const auto pages = static_cast<uint32_t>(int64_t{to >> 12} - int64_t{fixup.at >> 12});
        w[0] |= (pages & 3) << 29 | (pages >> 2 & 0x7ffff) << 5;
        w[1] |= (to & 0xfff) << 10;
        break;
      }
      case Reach::kDistance:
        w[0] = distance(to, fixup.at - w[0]);
        break;
    }
    std::memcpy(&code_[fixup.at], w, fixup.reach == Reach::kPage ? 8 : 4);
  }
  fixups_.clear();
}

void Assembler::branch(uint32_t op, Label to, Reach reach) {
  fixups_.push_back({here(), to, reach});
  word(op);
}
void Assembler::jump(Label to) {
  if (long_) return jump_long(to);
  branch(0x14000000, to, Reach::kJump);
}
// adrp, add, br
void Assembler::address_of(uint8_t to, Label label) {
  branch(0x90000000 | to, label, Reach::kPage);
  word(0x91000000 | uint32_t{to} << 5 | to);
}
void Assembler::jump_long(Label to) {
  address_of(kAddressScratch, to);
  jump_to(kAddressScratch);
}
void Assembler::table_entry(Label table, Label to) {
  const uint32_t behind_table = here() - offset_of(table);
  branch(behind_table, to, Reach::kDistance);
}
void Assembler::jump_if(Condition condition, Label to) {
  if (!long_) return branch(0x54000000 | static_cast<uint32_t>(condition), to, Reach::kConditional);
  word(0x54000000 | 4 << 5 | static_cast<uint32_t>(inverted(condition)));
  jump_long(to);
}
void Assembler::jump_if_zero(bool zero, uint8_t reg, uint8_t width, Label to) {
  const uint32_t op = (width == 8 ? kWide : 0) | 0x34000000 | reg;
  const uint32_t negates = 1u << 24;
  if (!long_) return branch(zero ? op : op | negates, to, Reach::kConditional);
  word((zero ? op | negates : op) | 4 << 5);
  jump_long(to);
}
void Assembler::jump_to(uint8_t reg) { word(0xd61f0000 | uint32_t{reg} << 5); }
void Assembler::call(uint8_t reg) { word(0xd63f0000 | uint32_t{reg} << 5); }
void Assembler::ret() { word(0xd65f03c0); }
void Assembler::trap() { word(0xd4200000); }

// --- integers -----------------------------------------------------------------------

void Assembler::registers(uint32_t op, uint32_t to, uint32_t a, uint32_t b, bool wide) {
  word((wide ? kWide : 0) | op | b << 16 | a << 5 | to);
}

void Assembler::move(uint8_t to, uint8_t from) {
  if (to != from) alu(Alu::kOr, to, kZero, from, 8);
}

// As few MOVZ, MOVN and MOVK as there are, or one ORR.
void Assembler::move_imm(uint8_t to, uint64_t bits) {
  unsigned zeros = 0;
  unsigned ones = 0;
  for (unsigned i = 0; i < 4; ++i) {
    const uint64_t part = bits >> (16 * i) & 0xffff;
    if (part == 0) ++zeros;
    if (part == 0xffff) ++ones;
  }
  if (zeros < 3 && ones < 3) {
    if (const auto field = logical_immediate(bits, 8)) {
      return logical(Logical::kOr, to, kZero, *field, 8);
    }
  }
  const bool inverts = ones > zeros;
  const uint64_t from = inverts ? ~bits : bits;
  bool first = true;
  for (uint32_t i = 0; i < 4; ++i) {
    const auto part = static_cast<uint32_t>(from >> (16 * i) & 0xffff);
    if (part == 0 && (from != 0 || i != 0)) continue;
    if (first) {
      word((inverts ? 0x92800000 : 0xd2800000) | i << 21 | part << 5 | to);
    } else {
      const uint32_t kept = inverts ? ~part & 0xffff : part;
      word(0xf2800000 | i << 21 | kept << 5 | to);
    }
    first = false;
  }
}

void Assembler::alu(Alu op, uint8_t to, uint8_t a, uint8_t b, uint8_t width, uint8_t shift_b) {
  registers(static_cast<uint32_t>(op) | uint32_t{shift_b} << 10, to, a, b, width == 8);
}
void Assembler::logical(Logical op, uint8_t to, uint8_t a, uint32_t immediate, uint8_t width) {
  word((width == 8 ? kWide : 0) | static_cast<uint32_t>(op) | immediate << 10 | uint32_t{a} << 5 |
       to);
}

void Assembler::sum(bool subtracts, bool flags, uint8_t to, uint8_t a, uint32_t field,
                    uint8_t width) {
  const bool shifted = field >= 0x1000;
  word((width == 8 ? kWide : 0) | 0x11000000 | (subtracts ? 1u << 30 : 0) | (flags ? 1u << 29 : 0) |
       (shifted ? 1u << 22 : 0) | (shifted ? field >> 12 : field) << 10 | uint32_t{a} << 5 | to);
}

void Assembler::add_imm(uint8_t to, uint8_t a, int64_t value, uint8_t width) {
  const bool subtracts = value < 0;
  const uint64_t size =
      subtracts ? uint64_t{0} - static_cast<uint64_t>(value) : static_cast<uint64_t>(value);
  if (size < 0x1000000) {
    const auto field = static_cast<uint32_t>(size);
    if (field < 0x1000 || (field & 0xfff) == 0) return sum(subtracts, false, to, a, field, width);
    sum(subtracts, false, to, a, field & 0xfff000, width);
    return sum(subtracts, false, to, to, field & 0xfff, width);
  }
  move_imm(kAddressScratch, static_cast<uint64_t>(value));
  alu(Alu::kAdd, to, a, kAddressScratch, width);
}
void Assembler::compare_imm(uint8_t a, int64_t value, uint8_t width) {
  const bool adds = value < 0;
  sum(!adds, true, kZero, a, static_cast<uint32_t>(adds ? -value : value), width);
}
void Assembler::decrement(uint8_t reg, uint32_t by) { sum(true, true, reg, reg, by, 8); }
void Assembler::compare_extended(uint8_t a, uint8_t b, uint8_t from, bool is_signed) {
  const uint32_t option = (is_signed ? 4u : 0u) | (from == 2 ? 1u : 0u);
  registers(0x6b200000 | option << 13, kZero, a, b, false);
}

void Assembler::multiply(uint8_t to, uint8_t a, uint8_t b, uint8_t width) {
  registers(0x1b000000 | uint32_t{kZero} << 10, to, a, b, width == 8);
}
void Assembler::multiply_high(uint8_t to, uint8_t a, uint8_t b, bool is_signed) {
  registers((is_signed ? 0x1b400000 : 0x1bc00000) | uint32_t{kZero} << 10, to, a, b, true);
}
void Assembler::multiply_subtract(uint8_t to, uint8_t a, uint8_t b, uint8_t c, uint8_t width) {
  registers(0x1b008000 | uint32_t{c} << 10, to, a, b, width == 8);
}
void Assembler::binary(Binary op, uint8_t to, uint8_t a, uint8_t b, uint8_t width) {
  registers(static_cast<uint32_t>(op), to, a, b, width == 8);
}

void Assembler::field(Field op, uint8_t to, uint8_t from, uint32_t immr, uint32_t imms,
                      uint8_t width) {
  const uint32_t wide = width == 8 ? kWide | 1u << 22 : 0;
  word(wide | static_cast<uint32_t>(op) | immr << 16 | imms << 10 | uint32_t{from} << 5 | to);
}
void Assembler::rotate_right(uint8_t to, uint8_t from, uint32_t count, uint8_t width) {
  registers(0x13800000 | (width == 8 ? 1u << 22 : 0) | count << 10, to, from, from, width == 8);
}
void Assembler::shift_left(uint8_t to, uint8_t from, uint32_t count, uint8_t width) {
  const uint32_t bits = width * 8u;
  field(Field::kUnsigned, to, from, (bits - count) % bits, bits - 1 - count, width);
}
void Assembler::zero_extend(uint8_t to, uint8_t from, uint8_t from_width) {
  if (from_width == 8) return move(to, from);
  if (from_width == 4) return alu(Alu::kOr, to, kZero, from, 4);
  field(Field::kUnsigned, to, from, 0, from_width * 8u - 1, 4);
}
void Assembler::sign_extend(uint8_t to, uint8_t from, uint8_t from_width) {
  if (from_width == 8) return move(to, from);
  field(Field::kSigned, to, from, 0, from_width * 8u - 1, 8);
}
void Assembler::set(Condition condition, uint8_t to) {
  registers(0x1a800400 | static_cast<uint32_t>(inverted(condition)) << 12, to, kZero, kZero, false);
}
void Assembler::select(Condition condition, uint8_t to, uint8_t yes, uint8_t no) {
  registers(0x1a800000 | static_cast<uint32_t>(condition) << 12, to, yes, no, true);
}

}  // namespace vm::native::arm64
