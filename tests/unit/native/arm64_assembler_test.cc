// Every form that the assembler writes, against what GNU as makes of the same text.
#include "vm/native/arm64/assembler.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "vm/native/arm64/immediates.h"

namespace vm::native::arm64 {
namespace {

struct Form {
  const char* text;
  std::vector<uint32_t> words;
  void (*emit)(Assembler&);
};

std::vector<uint32_t> words_of(const Assembler& a) {
  std::vector<uint32_t> words(a.code().size() / 4);
  std::memcpy(words.data(), a.code().data(), words.size() * 4);
  return words;
}

// clang-format off
const Form kForms[] = {
    // moves and constants
    {"mov x3, x15", {0xaa0f03e3}, [](Assembler& a) { a.move(3, 15); }},
    {"movz x0, #0", {0xd2800000}, [](Assembler& a) { a.move_imm(0, 0); }},
    {"movz x1, #0x1234", {0xd2824681}, [](Assembler& a) { a.move_imm(1, 0x1234); }},
    {"movz x28, #0x8000, lsl #16", {0xd2b0001c}, [](Assembler& a) { a.move_imm(28, 0x80000000u); }},
    {"movz x2, #0x5678; movk x2, #0x1234, lsl #32", {0xd28acf02, 0xf2c24682}, [](Assembler& a) { a.move_imm(2, 0x123400005678u); }},
    {"movn x4, #0", {0x92800004}, [](Assembler& a) { a.move_imm(4, ~uint64_t{0}); }},
    {"movn x4, #0xff", {0x92801fe4}, [](Assembler& a) { a.move_imm(4, ~uint64_t{0xff}); }},
    {"movn x5, #0x1233; movk x5, #0x1111, lsl #16", {0x92824665, 0xf2a22225}, [](Assembler& a) { a.move_imm(5, 0xffffffff1111edccu); }},
    {"mov x6, #0x5555555555555555", {0xb200f3e6}, [](Assembler& a) { a.move_imm(6, 0x5555555555555555u); }},
    {"mov x6, #0x00ffff0000ffff00", {0xb2183fe6}, [](Assembler& a) { a.move_imm(6, 0x00ffff0000ffff00u); }},
    {"movz x7, #0xdef0; movk x7, #0x9abc, lsl #16; movk x7, #0x5678, lsl #32; movk x7, #0x1234, lsl #48", {0xd29bde07, 0xf2b35787, 0xf2cacf07, 0xf2e24687}, [](Assembler& a) { a.move_imm(7, 0x123456789abcdef0u); }},
    {"movz x16, #0x8000, lsl #48", {0xd2f00010}, [](Assembler& a) { a.move_imm(16, uint64_t{1} << 63); }},
    // sums and logic of registers
    {"add w1, w2, w3", {0x0b030041}, [](Assembler& a) { a.alu(Alu::kAdd, 1, 2, 3, 4); }},
    {"add x1, x2, x3, lsl #5", {0x8b031441}, [](Assembler& a) { a.alu(Alu::kAdd, 1, 2, 3, 8, 5); }},
    {"adds w1, w2, w3", {0x2b030041}, [](Assembler& a) { a.alu(Alu::kAddFlags, 1, 2, 3, 4); }},
    {"sub x30, x29, x28", {0xcb1c03be}, [](Assembler& a) { a.alu(Alu::kSub, 30, 29, 28, 8); }},
    {"neg w9, w10", {0x4b0a03e9}, [](Assembler& a) { a.alu(Alu::kSub, 9, kZero, 10, 4); }},
    {"cmp x9, x10", {0xeb0a013f}, [](Assembler& a) { a.alu(Alu::kSubFlags, kZero, 9, 10, 8); }},
    {"and w1, w2, w3", {0x0a030041}, [](Assembler& a) { a.alu(Alu::kAnd, 1, 2, 3, 4); }},
    {"bic x1, x2, x3", {0x8a230041}, [](Assembler& a) { a.alu(Alu::kAndNot, 1, 2, 3, 8); }},
    {"orr w1, w2, w3", {0x2a030041}, [](Assembler& a) { a.alu(Alu::kOr, 1, 2, 3, 4); }},
    {"mvn x1, x3", {0xaa2303e1}, [](Assembler& a) { a.alu(Alu::kOrNot, 1, kZero, 3, 8); }},
    {"eor x1, x2, x3", {0xca030041}, [](Assembler& a) { a.alu(Alu::kXor, 1, 2, 3, 8); }},
    {"tst w2, w3", {0x6a03005f}, [](Assembler& a) { a.alu(Alu::kAndFlags, kZero, 2, 3, 4); }},
    // with constants
    {"add w1, w2, #0xfff", {0x113ffc41}, [](Assembler& a) { a.add_imm(1, 2, 0xfff, 4); }},
    {"add x1, x2, #0xfff, lsl #12", {0x917ffc41}, [](Assembler& a) { a.add_imm(1, 2, 0xfff000, 8); }},
    {"sub x1, x2, #1", {0xd1000441}, [](Assembler& a) { a.add_imm(1, 2, -1, 8); }},
    {"add x1, x2, #0x123, lsl #12; add x1, x1, #0x456", {0x91448c41, 0x91115821}, [](Assembler& a) { a.add_imm(1, 2, 0x123456, 8); }},
    {"sub sp, sp, #2, lsl #12; sub sp, sp, #0x10", {0xd1400bff, 0xd10043ff}, [](Assembler& a) { a.add_imm(kSp, kSp, -0x2010, 8); }},
    {"movz x17, #0x100, lsl #16; add x1, x2, x17", {0xd2a02011, 0x8b110041}, [](Assembler& a) { a.add_imm(1, 2, 0x1000000, 8); }},
    {"subs x3, x3, #8", {0xf1002063}, [](Assembler& a) { a.decrement(3, 8); }},
    {"cmp w3, #7", {0x71001c7f}, [](Assembler& a) { a.compare_imm(3, 7, 4); }},
    {"cmp x3, #0x7, lsl #12", {0xf1401c7f}, [](Assembler& a) { a.compare_imm(3, 0x7000, 8); }},
    {"cmn w3, #1", {0x3100047f}, [](Assembler& a) { a.compare_imm(3, -1, 4); }},
    {"cmp w3, w4, uxtb", {0x6b24007f}, [](Assembler& a) { a.compare_extended(3, 4, 1, false); }},
    {"cmp w3, w4, uxth", {0x6b24207f}, [](Assembler& a) { a.compare_extended(3, 4, 2, false); }},
    {"cmp w3, w4, sxtb", {0x6b24807f}, [](Assembler& a) { a.compare_extended(3, 4, 1, true); }},
    {"cmp w3, w4, sxth", {0x6b24a07f}, [](Assembler& a) { a.compare_extended(3, 4, 2, true); }},
    {"and w1, w2, #0xff", {0x12001c41}, [](Assembler& a) { a.logical(Logical::kAnd, 1, 2, *logical_immediate(0xff, 4), 4); }},
    {"orr x1, x2, #0x8000000000000001", {0xb2410441}, [](Assembler& a) { a.logical(Logical::kOr, 1, 2, *logical_immediate(0x8000000000000001u, 8), 8); }},
    {"eor w1, w2, #1", {0x52000041}, [](Assembler& a) { a.logical(Logical::kXor, 1, 2, *logical_immediate(1, 4), 4); }},
    {"tst w2, #0xff", {0x72001c5f}, [](Assembler& a) { a.logical(Logical::kAndFlags, kZero, 2, *logical_immediate(0xff, 4), 4); }},
    // products, quotients, shifts
    {"mul w1, w2, w3", {0x1b037c41}, [](Assembler& a) { a.multiply(1, 2, 3, 4); }},
    {"mul x1, x2, x3", {0x9b037c41}, [](Assembler& a) { a.multiply(1, 2, 3, 8); }},
    {"smulh x1, x2, x3", {0x9b437c41}, [](Assembler& a) { a.multiply_high(1, 2, 3, true); }},
    {"umulh x1, x2, x3", {0x9bc37c41}, [](Assembler& a) { a.multiply_high(1, 2, 3, false); }},
    {"msub x1, x2, x3, x4", {0x9b039041}, [](Assembler& a) { a.multiply_subtract(1, 2, 3, 4, 8); }},
    {"msub w1, w2, w3, w4", {0x1b039041}, [](Assembler& a) { a.multiply_subtract(1, 2, 3, 4, 4); }},
    {"sdiv w1, w2, w3", {0x1ac30c41}, [](Assembler& a) { a.binary(Binary::kDivS, 1, 2, 3, 4); }},
    {"udiv x1, x2, x3", {0x9ac30841}, [](Assembler& a) { a.binary(Binary::kDivU, 1, 2, 3, 8); }},
    {"lsl w1, w2, w3", {0x1ac32041}, [](Assembler& a) { a.binary(Binary::kShl, 1, 2, 3, 4); }},
    {"lsr x1, x2, x3", {0x9ac32441}, [](Assembler& a) { a.binary(Binary::kShr, 1, 2, 3, 8); }},
    {"asr w1, w2, w3", {0x1ac32841}, [](Assembler& a) { a.binary(Binary::kSar, 1, 2, 3, 4); }},
    {"ror x1, x2, x3", {0x9ac32c41}, [](Assembler& a) { a.binary(Binary::kRor, 1, 2, 3, 8); }},
    {"lsl w1, w2, #31", {0x53010041}, [](Assembler& a) { a.shift_left(1, 2, 31, 4); }},
    {"lsl x1, x2, #0", {0xd340fc41}, [](Assembler& a) { a.shift_left(1, 2, 0, 8); }},
    {"lsl x1, x2, #3", {0xd37df041}, [](Assembler& a) { a.shift_left(1, 2, 3, 8); }},
    {"ror w1, w2, #9", {0x13822441}, [](Assembler& a) { a.rotate_right(1, 2, 9, 4); }},
    {"ror x1, x2, #63", {0x93c2fc41}, [](Assembler& a) { a.rotate_right(1, 2, 63, 8); }},
    {"ubfx w1, w2, #3, #5", {0x53031c41}, [](Assembler& a) { a.field(Field::kUnsigned, 1, 2, 3, 7, 4); }},
    {"sbfx x1, x2, #3, #61", {0x9343fc41}, [](Assembler& a) { a.field(Field::kSigned, 1, 2, 3, 63, 8); }},
    {"bfi w1, w2, #5, #11", {0x331b2841}, [](Assembler& a) { a.field(Field::kInsert, 1, 2, 27, 10, 4); }},
    {"uxtb w1, w2", {0x53001c41}, [](Assembler& a) { a.zero_extend(1, 2, 1); }},
    {"uxth w1, w2", {0x53003c41}, [](Assembler& a) { a.zero_extend(1, 2, 2); }},
    {"mov w1, w2", {0x2a0203e1}, [](Assembler& a) { a.zero_extend(1, 2, 4); }},
    {"sxtb x1, w2", {0x93401c41}, [](Assembler& a) { a.sign_extend(1, 2, 1); }},
    {"sxth x1, w2", {0x93403c41}, [](Assembler& a) { a.sign_extend(1, 2, 2); }},
    {"sxtw x1, w2", {0x93407c41}, [](Assembler& a) { a.sign_extend(1, 2, 4); }},
    {"cset w1, eq", {0x1a9f17e1}, [](Assembler& a) { a.set(Condition::kEqual, 1); }},
    {"cset w1, hi", {0x1a9f97e1}, [](Assembler& a) { a.set(Condition::kAbove, 1); }},
    {"csel x1, x2, x3, lt", {0x9a83b041}, [](Assembler& a) { a.select(Condition::kLess, 1, 2, 3); }},
    // loads and stores
    {"ldrb w1, [x2]", {0x39400041}, [](Assembler& a) { a.load(1, {.base = 2}, 1); }},
    {"ldrh w1, [x2, #8190]", {0x797ffc41}, [](Assembler& a) { a.load(1, {.base = 2, .disp = 8190}, 2); }},
    {"ldr w1, [sp, #16380]", {0xb97fffe1}, [](Assembler& a) { a.load(1, {.base = kSp, .disp = 16380}, 4); }},
    {"ldr x1, [x2, #32760]", {0xf97ffc41}, [](Assembler& a) { a.load(1, {.base = 2, .disp = 32760}, 8); }},
    {"ldur x1, [x2, #7]", {0xf8407041}, [](Assembler& a) { a.load(1, {.base = 2, .disp = 7}, 8); }},
    {"ldur w1, [x2, #-256]", {0xb8500041}, [](Assembler& a) { a.load(1, {.base = 2, .disp = -256}, 4); }},
    {"strb w1, [x2, #4095]", {0x393ffc41}, [](Assembler& a) { a.store({.base = 2, .disp = 4095}, 1, 1); }},
    {"sturh w1, [x2, #255]", {0x780ff041}, [](Assembler& a) { a.store({.base = 2, .disp = 255}, 1, 2); }},
    {"str wzr, [x2]", {0xb900005f}, [](Assembler& a) { a.store({.base = 2}, kZero, 4); }},
    {"str x1, [x2, x3]", {0xf8236841}, [](Assembler& a) { a.store({.base = 2, .index = 3}, 1, 8); }},
    {"ldr w1, [x2, x3, lsl #2]", {0xb8637841}, [](Assembler& a) { a.load(1, {.base = 2, .index = 3, .shift = 2}, 4); }},
    {"ldrb w1, [x2, x3]", {0x38636841}, [](Assembler& a) { a.load(1, {.base = 2, .index = 3}, 1); }},
    {"str d1, [x2, #8]", {0xfd000441}, [](Assembler& a) { a.float_store({.base = 2, .disp = 8}, 1, 8); }},
    {"ldr s1, [x2, x3, lsl #2]", {0xbc637841}, [](Assembler& a) { a.float_load(1, {.base = 2, .index = 3, .shift = 2}, 4); }},
    {"ldur d31, [x2, #1]", {0xfc40105f}, [](Assembler& a) { a.float_load(31, {.base = 2, .disp = 1}, 8); }},
    // addresses that no instruction takes
    {"add x17, x2, #1, lsl #12; ldrb w1, [x17, #1]", {0x91400451, 0x39400621}, [](Assembler& a) { a.load(1, {.base = 2, .disp = 0x1001}, 1); }},
    {"add x17, x2, #0x10, lsl #12; str x1, [x17, #0xff8]", {0x91404051, 0xf907fe21}, [](Assembler& a) { a.store({.base = 2, .disp = 0x10ff8}, 1, 8); }},
    {"movz x17, #0x1003; ldr x1, [x2, x17]", {0xd2820071, 0xf8716841}, [](Assembler& a) { a.load(1, {.base = 2, .disp = 0x1003}, 8); }},
    {"movz x17, #0x9000, lsl #16; ldr w1, [x2, x17]", {0xd2b20011, 0xb8716841}, [](Assembler& a) { a.load(1, {.base = 2, .disp = 0x90000000}, 4); }},
    {"movn x17, #0x100; ldr w1, [x2, x17]", {0x92802011, 0xb8716841}, [](Assembler& a) { a.load(1, {.base = 2, .disp = -257}, 4); }},
    {"add x17, x2, x3, lsl #3; ldr w1, [x17]", {0x8b030c51, 0xb9400221}, [](Assembler& a) { a.load(1, {.base = 2, .index = 3, .shift = 3}, 4); }},
    {"add x17, x2, x3, lsl #2; ldr w1, [x17, #4]", {0x8b030851, 0xb9400621}, [](Assembler& a) { a.load(1, {.base = 2, .index = 3, .shift = 2, .disp = 4}, 4); }},
    {"movz x17, #0x10, lsl #16; add x17, x17, x3, lsl #2; ldr w1, [x2, x17]", {0xd2a00211, 0x8b030a31, 0xb8716841}, [](Assembler& a) { a.load(1, {.base = 2, .index = 3, .shift = 2, .disp = 0x100000}, 4); }},
    {"add x1, x2, x3, lsl #1; add x1, x1, #5", {0x8b030441, 0x91001421}, [](Assembler& a) { a.address(1, {.base = 2, .index = 3, .shift = 1, .disp = 5}, 8); }},
    {"add w1, wzr, w3, lsl #3; add w1, w1, #5", {0x0b030fe1, 0x11001421}, [](Assembler& a) { a.address(1, {.index = 3, .shift = 3, .has_base = false, .disp = 5}, 4); }},
    {"movz x1, #0x9000, lsl #16", {0xd2b20001}, [](Assembler& a) { a.address(1, {.has_base = false, .disp = 0x90000000}, 4); }},
    {"add x1, x2, #0", {0x91000041}, [](Assembler& a) { a.address(1, {.base = 2}, 8); }},
    {"stp x19, x20, [sp, #16]", {0xa90153f3}, [](Assembler& a) { a.store_pair(19, 20, 16, false); }},
    {"ldp x29, x30, [sp]", {0xa9407bfd}, [](Assembler& a) { a.load_pair(29, 30, 0, false); }},
    {"stp d8, d9, [sp, #96]", {0x6d0627e8}, [](Assembler& a) { a.store_pair(8, 9, 96, true); }},
    {"ldp d14, d15, [sp, #144]", {0x6d493fee}, [](Assembler& a) { a.load_pair(14, 15, 144, true); }},
    // branches that need no label
    {"br x3", {0xd61f0060}, [](Assembler& a) { a.jump_to(3); }},
    {"blr x16", {0xd63f0200}, [](Assembler& a) { a.call(16); }},
    {"ret", {0xd65f03c0}, [](Assembler& a) { a.ret(); }},
    {"brk #0", {0xd4200000}, [](Assembler& a) { a.trap(); }},
    // floating point
    {"fadd s1, s2, s3", {0x1e232841}, [](Assembler& a) { a.float_binary(FloatBinary::kAdd, 1, 2, 3, 4); }},
    {"fsub d1, d2, d3", {0x1e633841}, [](Assembler& a) { a.float_binary(FloatBinary::kSub, 1, 2, 3, 8); }},
    {"fmul s1, s2, s3", {0x1e230841}, [](Assembler& a) { a.float_binary(FloatBinary::kMul, 1, 2, 3, 4); }},
    {"fdiv d1, d2, d3", {0x1e631841}, [](Assembler& a) { a.float_binary(FloatBinary::kDiv, 1, 2, 3, 8); }},
    {"fmov d1, d2", {0x1e604041}, [](Assembler& a) { a.float_move(1, 2); }},
    {"fabs s1, s2", {0x1e20c041}, [](Assembler& a) { a.float_unary(FloatUnary::kAbs, 1, 2, 4); }},
    {"fneg d1, d2", {0x1e614041}, [](Assembler& a) { a.float_unary(FloatUnary::kNeg, 1, 2, 8); }},
    {"fsqrt s1, s2", {0x1e21c041}, [](Assembler& a) { a.float_unary(FloatUnary::kSqrt, 1, 2, 4); }},
    {"movi d31, #0", {0x2f00e41f}, [](Assembler& a) { a.float_zero(31); }},
    {"fmov s1, #1.0", {0x1e2e1001}, [](Assembler& a) { a.float_imm(1, *float_immediate(0x3f800000u, 4), 4); }},
    {"fmov d2, #-0.125", {0x1e781002}, [](Assembler& a) { a.float_imm(2, *float_immediate(0xbfc0000000000000u, 8), 8); }},
    {"fmov d2, #31.0", {0x1e67f002}, [](Assembler& a) { a.float_imm(2, *float_immediate(0x403f000000000000u, 8), 8); }},
    {"fmov d2, #2.5", {0x1e609002}, [](Assembler& a) { a.float_imm(2, *float_immediate(0x4004000000000000u, 8), 8); }},
    {"fcmp s1, s2", {0x1e222020}, [](Assembler& a) { a.float_compare(1, 2, 4); }},
    {"fcmp d1, d2", {0x1e622020}, [](Assembler& a) { a.float_compare(1, 2, 8); }},
    {"fcsel d1, d2, d3, mi", {0x1e634c41}, [](Assembler& a) { a.float_select(Condition::kMinus, 1, 2, 3); }},
    {"scvtf s1, w2", {0x1e220041}, [](Assembler& a) { a.float_from_integer(1, 2, 4, 4); }},
    {"scvtf s1, x2", {0x9e220041}, [](Assembler& a) { a.float_from_integer(1, 2, 4, 8); }},
    {"scvtf d1, w2", {0x1e620041}, [](Assembler& a) { a.float_from_integer(1, 2, 8, 4); }},
    {"scvtf d1, x2", {0x9e620041}, [](Assembler& a) { a.float_from_integer(1, 2, 8, 8); }},
    {"fcvtns x1, s2", {0x9e200041}, [](Assembler& a) { a.integer_from_float(1, 2, 4, false); }},
    {"fcvtzs x1, s2", {0x9e380041}, [](Assembler& a) { a.integer_from_float(1, 2, 4, true); }},
    {"fcvtns x1, d2", {0x9e600041}, [](Assembler& a) { a.integer_from_float(1, 2, 8, false); }},
    {"fcvtzs x1, d2", {0x9e780041}, [](Assembler& a) { a.integer_from_float(1, 2, 8, true); }},
    {"fcvt d1, s2", {0x1e22c041}, [](Assembler& a) { a.float_width(1, 2, 4); }},
    {"fcvt s1, d2", {0x1e624041}, [](Assembler& a) { a.float_width(1, 2, 8); }},
    {"fmov s1, w2", {0x1e270041}, [](Assembler& a) { a.bits_to_float(1, 2, 4); }},
    {"fmov d1, x2", {0x9e670041}, [](Assembler& a) { a.bits_to_float(1, 2, 8); }},
    {"fmov w1, s2", {0x1e260041}, [](Assembler& a) { a.float_to_bits(1, 2, 4); }},
    {"fmov x1, d2", {0x9e660041}, [](Assembler& a) { a.float_to_bits(1, 2, 8); }},
    // branches
    {"b .+8; ret", {0x14000002, 0xd65f03c0}, [](Assembler& a) { const Label l = a.label(); a.jump(l); a.ret(); a.bind(l); }},
    {"ret; b .-4", {0xd65f03c0, 0x17ffffff}, [](Assembler& a) { const Label l = a.label(); a.bind(l); a.ret(); a.jump(l); }},
    {"b.mi .+8; ret", {0x54000044, 0xd65f03c0}, [](Assembler& a) { const Label l = a.label(); a.jump_if(Condition::kMinus, l); a.ret(); a.bind(l); }},
    {"ret; b.le .-4", {0xd65f03c0, 0x54ffffed}, [](Assembler& a) { const Label l = a.label(); a.bind(l); a.ret(); a.jump_if(Condition::kLessOrEqual, l); }},
    {"cbz w5, .+8; ret", {0x34000045, 0xd65f03c0}, [](Assembler& a) { const Label l = a.label(); a.jump_if_zero(true, 5, 4, l); a.ret(); a.bind(l); }},
    {"cbnz x5, .+8; ret", {0xb5000045, 0xd65f03c0}, [](Assembler& a) { const Label l = a.label(); a.jump_if_zero(false, 5, 8, l); a.ret(); a.bind(l); }},
};
// clang-format on

TEST(Arm64Assembler, InstructionsAreEncodedAsGnuAsDoes) {
  for (const Form& form : kForms) {
    Assembler a;
    form.emit(a);
    a.patch();
    EXPECT_EQ(words_of(a), form.words) << form.text;
  }
}

TEST(Arm64Assembler, LongBranchesGoByTheirPage) {
  // adrp x17, page; add x17, x17, #offset; br x17
  Assembler a;
  a.set_long(true);
  const Label far = a.label();
  a.jump_if(Condition::kLess, far);
  a.jump_if_zero(true, 3, 8, far);
  a.jump(far);
  while (a.here() < 0x5008) a.ret();
  a.bind(far);
  a.jump_long(far);
  a.patch();
  const std::vector<uint32_t> words = words_of(a);
  const std::vector<uint32_t> begin(words.begin(), words.begin() + 11);
  const std::vector<uint32_t> expected = {
      0x5400008a, 0xb0000031, 0x91002231, 0xd61f0220,  // b.ge .+16
      0xb5000083, 0xb0000031, 0x91002231, 0xd61f0220,  // cbnz x3, .+16
      0xb0000031, 0x91002231, 0xd61f0220};
  EXPECT_EQ(begin, expected);
  const std::vector<uint32_t> back(words.end() - 3, words.end());
  EXPECT_EQ(back, (std::vector<uint32_t>{0x90000011, 0x91002231, 0xd61f0220}));
}

TEST(Arm64Assembler, CodeWhoseBranchesDoNotReachIsMadeAnew) {
  Assembler a;
  a.ret();
  const Assembler::Mark mark = a.mark();
  const auto emit = [&](uint32_t bytes) {
    const Label end = a.label();
    a.jump_if(Condition::kEqual, end);
    for (uint32_t i = 4; i < bytes; i += 4) a.ret();
    a.bind(end);
  };
  emit((1 << 20) - 4);
  EXPECT_TRUE(a.reaches(mark));
  a.rewind(mark);
  EXPECT_EQ(a.here(), 4u);
  emit(1 << 20);
  EXPECT_FALSE(a.reaches(mark));
  a.rewind(mark);
  a.set_long(true);
  emit(1 << 20);
  EXPECT_TRUE(a.reaches(mark));
}

// adrp x9, 0; add x9, x9, 12; the table behind it
TEST(Arm64Assembler, TablesHoldDistancesToTheirBeginning) {
  Assembler a;
  const Label to = a.label();
  const Label table = a.label();
  a.bind(to);
  a.ret();
  a.address_of(9, table);
  a.bind(table);
  a.table_entry(table, to);
  a.table_entry(table, table);
  a.patch();
  const std::vector<uint8_t> expected = {0xc0, 0x03, 0x5f, 0xd6, 0x09, 0, 0, 0x90, 0x29, 0x31,
                                         0x00, 0x91, 0x0c, 0,    0,    0, 0, 0,    0,    0};
  EXPECT_EQ(a.code(), expected);
}

TEST(Arm64Assembler, LogicalImmediatesAreRunsOfOnes) {
  // All of them, by what they mean: a run of ones, turned, repeated.
  uint32_t count = 0;
  for (uint32_t size = 2; size <= 64; size *= 2) {
    for (uint32_t ones = 1; ones < size; ++ones) {
      for (uint32_t turn = 0; turn < size; ++turn) {
        const uint64_t mask = size == 64 ? ~uint64_t{0} : (uint64_t{1} << size) - 1;
        const uint64_t run = (uint64_t{1} << ones) - 1;
        uint64_t bits = turn == 0 ? run : ((run >> turn) | (run << (size - turn))) & mask;
        for (uint32_t wide = size; wide < 64; wide *= 2) bits |= bits << wide;
        const uint32_t n = size == 64 ? 1 : 0;
        const uint32_t imms = ((~(size - 1) << 1) & 0x3f) | (ones - 1);
        EXPECT_EQ(logical_immediate(bits, 8), n << 12 | turn << 6 | imms) << bits;
        ++count;
      }
    }
  }
  EXPECT_EQ(count, 5334u);
  for (const uint64_t none :
       {uint64_t{0}, ~uint64_t{0}, uint64_t{5}, uint64_t{0xff00ff}, uint64_t{0x1234}}) {
    EXPECT_FALSE(logical_immediate(none, 8).has_value()) << none;
  }
  EXPECT_FALSE(logical_immediate(0xffffffffu, 4).has_value());
  EXPECT_TRUE(logical_immediate(0xffffffffu, 8).has_value());
  // Of a byte, only the byte matters.
  EXPECT_EQ(logical_immediate_of(0x55, 1), logical_immediate(0x55555555u, 4));
  EXPECT_EQ(logical_immediate_of(0xfe, 1), logical_immediate(0xfe, 4));
  EXPECT_EQ(logical_immediate_of(0xbf, 1), logical_immediate(0xffffffbfu, 4));
  EXPECT_EQ(logical_immediate_of(0x8001, 2), logical_immediate(0xffff8001u, 4));
  EXPECT_EQ(logical_immediate_of(0xff, 4), logical_immediate(0xff, 4));
  EXPECT_FALSE(logical_immediate_of(0xa5, 1).has_value());
}

TEST(Arm64Assembler, SumImmediatesHaveTwelveBits) {
  for (const int64_t fits : {0, 1, -1, 4095, -4095, 4096, 0xfff000, -0xfff000}) {
    EXPECT_TRUE(is_sum_immediate(fits)) << fits;
  }
  for (const int64_t large : {4097L, -4097L, 0x1000000L, INT64_MIN}) {
    EXPECT_FALSE(is_sum_immediate(large)) << large;
  }
}

TEST(Arm64Assembler, FloatImmediatesAreSmallNumbers) {
  uint32_t found = 0;
  for (uint32_t i = 0; i < 256; ++i) {
    const double sixteenths = 16 + (i & 15);
    const int r = static_cast<int>((i >> 4 & 7) < 4 ? (i >> 4 & 7) + 1 : (i >> 4 & 7)) -
                  ((i >> 4 & 7) < 4 ? 0 : 7);
    const double value = (i & 128 ? -1 : 1) * sixteenths / 16 * (r < 0 ? 1.0 / (1 << -r) : 1 << r);
    EXPECT_EQ(float_immediate(std::bit_cast<uint64_t>(value), 8), i) << value;
    EXPECT_EQ(float_immediate(std::bit_cast<uint32_t>(static_cast<float>(value)), 4), i) << value;
    ++found;
  }
  EXPECT_EQ(found, 256u);
  for (const double none : {0.0, -0.0, 0.1, 32.0, 0.0625, 1.03125, 1e300}) {
    EXPECT_FALSE(float_immediate(std::bit_cast<uint64_t>(none), 8).has_value()) << none;
  }
}

}  // namespace
}  // namespace vm::native::arm64
