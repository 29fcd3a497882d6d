// Every form that the assembler writes, against what GNU as makes of the same text ({load} and
// {disp32} choose between encodings that mean the same).
#include "vm/native/x64/assembler.h"

#include <gtest/gtest.h>

namespace vm::native::x64 {
namespace {

struct Form {
  const char* text;
  std::vector<uint8_t> bytes;
  void (*emit)(Assembler&);
};

// clang-format off
const Form kForms[] = {
    // moves and constants
    {"{load} mov rax, r15", {0x49, 0x8b, 0xc7}, [](Assembler& a) { a.move(kRax, kR15); }},
    {"xor r9d, r9d", {0x45, 0x31, 0xc9}, [](Assembler& a) { a.move_imm(kR9, 0); }},
    {"mov esi, 0x12345678", {0xbe, 0x78, 0x56, 0x34, 0x12}, [](Assembler& a) { a.move_imm(kRsi, 0x12345678); }},
    {"mov r8d, 0xffffffff", {0x41, 0xb8, 0xff, 0xff, 0xff, 0xff}, [](Assembler& a) { a.move_imm(kR8, 0xffffffffu); }},
    {"mov rcx, -2", {0x48, 0xc7, 0xc1, 0xfe, 0xff, 0xff, 0xff}, [](Assembler& a) { a.move_imm(kRcx, ~uint64_t{1}); }},
    {"movabs r10, 0x123456789abcdef0", {0x49, 0xba, 0xf0, 0xde, 0xbc, 0x9a, 0x78, 0x56, 0x34, 0x12}, [](Assembler& a) { a.move_imm(kR10, 0x123456789abcdef0u); }},
    // loads and stores of every form of address
    {"movzx eax, byte ptr [rbx]", {0x0f, 0xb6, 0x03}, [](Assembler& a) { a.load(kRax, {kRbx}, 1); }},
    {"movzx r8d, word ptr [rbp]", {0x44, 0x0f, 0xb7, 0x45, 0x00}, [](Assembler& a) { a.load(kR8, {kRbp}, 2); }},
    {"mov r9d, dword ptr [r12+127]", {0x45, 0x8b, 0x4c, 0x24, 0x7f}, [](Assembler& a) { a.load(kR9, {kR12, 0xff, 1, true, 127}, 4); }},
    {"mov rdi, qword ptr [r13-128]", {0x49, 0x8b, 0x7d, 0x80}, [](Assembler& a) { a.load(kRdi, {kR13, 0xff, 1, true, -128}, 8); }},
    {"mov rdi, qword ptr [rsp+128]", {0x48, 0x8b, 0xbc, 0x24, 0x80, 0x00, 0x00, 0x00}, [](Assembler& a) { a.load(kRdi, {kRsp, 0xff, 1, true, 128}, 8); }},
    {"mov eax, dword ptr [rbx+r9*4-129]", {0x42, 0x8b, 0x84, 0x8b, 0x7f, 0xff, 0xff, 0xff}, [](Assembler& a) { a.load(kRax, {kRbx, kR9, 4, true, -129}, 4); }},
    {"mov eax, dword ptr [r13+rcx*8]", {0x41, 0x8b, 0x44, 0xcd, 0x00}, [](Assembler& a) { a.load(kRax, {kR13, kRcx, 8, true, 0}, 4); }},
    {"mov eax, dword ptr [rdx*2+5]", {0x8b, 0x04, 0x55, 0x05, 0x00, 0x00, 0x00}, [](Assembler& a) { a.load(kRax, {0, kRdx, 2, false, 5}, 4); }},
    {"movsx rax, sil", {0x48, 0x0f, 0xbe, 0xc6}, [](Assembler& a) { a.load_signed(kRax, Operand::of(uint8_t{kRsi}), 1); }},
    {"movsx r9, word ptr [rbx]", {0x4c, 0x0f, 0xbf, 0x0b}, [](Assembler& a) { a.load_signed(kR9, Operand::of(Address{kRbx}), 2); }},
    {"movsxd rax, ecx", {0x48, 0x63, 0xc1}, [](Assembler& a) { a.load_signed(kRax, Operand::of(uint8_t{kRcx}), 4); }},
    {"{load} mov rax, rcx", {0x48, 0x8b, 0xc1}, [](Assembler& a) { a.load_signed(kRax, Operand::of(uint8_t{kRcx}), 8); }},
    {"movzx eax, dil", {0x40, 0x0f, 0xb6, 0xc7}, [](Assembler& a) { a.zero_extend(kRax, Operand::of(uint8_t{kRdi}), 1); }},
    {"movzx eax, r11w", {0x41, 0x0f, 0xb7, 0xc3}, [](Assembler& a) { a.zero_extend(kRax, Operand::of(uint8_t{kR11}), 2); }},
    {"{load} mov eax, ecx", {0x8b, 0xc1}, [](Assembler& a) { a.zero_extend(kRax, Operand::of(uint8_t{kRcx}), 4); }},
    {"mov byte ptr [rbx], sil", {0x40, 0x88, 0x33}, [](Assembler& a) { a.store({kRbx}, kRsi, 1); }},
    {"mov word ptr [rbx], r8w", {0x66, 0x44, 0x89, 0x03}, [](Assembler& a) { a.store({kRbx}, kR8, 2); }},
    {"mov dword ptr [rbx], eax", {0x89, 0x03}, [](Assembler& a) { a.store({kRbx}, kRax, 4); }},
    {"mov qword ptr [r12], r15", {0x4d, 0x89, 0x3c, 0x24}, [](Assembler& a) { a.store({kR12}, kR15, 8); }},
    {"mov byte ptr [rbx], -1", {0xc6, 0x03, 0xff}, [](Assembler& a) { a.store_imm({kRbx}, -1, 1); }},
    {"mov word ptr [rbx], 0x1234", {0x66, 0xc7, 0x03, 0x34, 0x12}, [](Assembler& a) { a.store_imm({kRbx}, 0x1234, 2); }},
    {"mov dword ptr [rbx], 0x12345678", {0xc7, 0x03, 0x78, 0x56, 0x34, 0x12}, [](Assembler& a) { a.store_imm({kRbx}, 0x12345678, 4); }},
    {"mov qword ptr [r13+8], -7", {0x49, 0xc7, 0x45, 0x08, 0xf9, 0xff, 0xff, 0xff}, [](Assembler& a) { a.store_imm({kR13, 0xff, 1, true, 8}, -7, 8); }},
    // arithmetic
    {"{load} add al, dil", {0x40, 0x02, 0xc7}, [](Assembler& a) { a.alu(Alu::kAdd, kRax, Operand::of(uint8_t{kRdi}), 1); }},
    {"{load} or ax, cx", {0x66, 0x0b, 0xc1}, [](Assembler& a) { a.alu(Alu::kOr, kRax, Operand::of(uint8_t{kRcx}), 2); }},
    {"{load} and eax, r9d", {0x41, 0x23, 0xc1}, [](Assembler& a) { a.alu(Alu::kAnd, kRax, Operand::of(uint8_t{kR9}), 4); }},
    {"sub r15, qword ptr [rbx+8]", {0x4c, 0x2b, 0x7b, 0x08}, [](Assembler& a) { a.alu(Alu::kSub, kR15, Operand::of(Address{kRbx, 0xff, 1, true, 8}), 8); }},
    {"{load} xor edx, edx", {0x33, 0xd2}, [](Assembler& a) { a.alu(Alu::kXor, kRdx, Operand::of(uint8_t{kRdx}), 4); }},
    {"cmp al, byte ptr [rbx]", {0x3a, 0x03}, [](Assembler& a) { a.alu(Alu::kCmp, kRax, Operand::of(Address{kRbx}), 1); }},
    {"{load} sbb r11, r11", {0x4d, 0x1b, 0xdb}, [](Assembler& a) { a.alu(static_cast<Alu>(3), kR11, Operand::of(uint8_t{kR11}), 8); }},
    {"cmp dil, 5", {0x40, 0x80, 0xff, 0x05}, [](Assembler& a) { a.alu_imm(Alu::kCmp, Operand::of(uint8_t{kRdi}), 5, 1); }},
    {"add cx, 0x1234", {0x66, 0x81, 0xc1, 0x34, 0x12}, [](Assembler& a) { a.alu_imm(Alu::kAdd, Operand::of(uint8_t{kRcx}), 0x1234, 2); }},
    {"sub ecx, -128", {0x83, 0xe9, 0x80}, [](Assembler& a) { a.alu_imm(Alu::kSub, Operand::of(uint8_t{kRcx}), -128, 4); }},
    {"and r9, 0x12345678", {0x49, 0x81, 0xe1, 0x78, 0x56, 0x34, 0x12}, [](Assembler& a) { a.alu_imm(Alu::kAnd, Operand::of(uint8_t{kR9}), 0x12345678, 8); }},
    {"cmp byte ptr [rbx], 0", {0x80, 0x3b, 0x00}, [](Assembler& a) { a.alu_imm(Alu::kCmp, Operand::of(Address{kRbx}), 0, 1); }},
    {"test sil, sil", {0x40, 0x84, 0xf6}, [](Assembler& a) { a.test(kRsi, kRsi, 1); }},
    {"test ax, cx", {0x66, 0x85, 0xc8}, [](Assembler& a) { a.test(kRax, kRcx, 2); }},
    {"test dil, -128", {0x40, 0xf6, 0xc7, 0x80}, [](Assembler& a) { a.test_imm(kRdi, -128, 1); }},
    {"test cx, 0x1234", {0x66, 0xf7, 0xc1, 0x34, 0x12}, [](Assembler& a) { a.test_imm(kRcx, 0x1234, 2); }},
    {"test r10d, 0x12345678", {0x41, 0xf7, 0xc2, 0x78, 0x56, 0x34, 0x12}, [](Assembler& a) { a.test_imm(kR10, 0x12345678, 4); }},
    {"test r9, -2", {0x49, 0xf7, 0xc1, 0xfe, 0xff, 0xff, 0xff}, [](Assembler& a) { a.test_imm(kR9, -2, 8); }},
    {"andn eax, ecx, edx", {0xc4, 0xe2, 0x70, 0xf2, 0xc2}, [](Assembler& a) { a.and_not(kRax, kRcx, kRdx); }},
    {"andn r15d, r11d, r8d", {0xc4, 0x42, 0x20, 0xf2, 0xf8}, [](Assembler& a) { a.and_not(kR15, kR11, kR8); }},
    {"test r9, r9", {0x4d, 0x85, 0xc9}, [](Assembler& a) { a.test(kR9, kR9, 8); }},
    {"imul eax, r9d", {0x41, 0x0f, 0xaf, 0xc1}, [](Assembler& a) { a.multiply(kRax, Operand::of(uint8_t{kR9}), 4); }},
    {"imul rax, qword ptr [rbx]", {0x48, 0x0f, 0xaf, 0x03}, [](Assembler& a) { a.multiply(kRax, Operand::of(Address{kRbx}), 8); }},
    {"imul eax, ecx, 100", {0x6b, 0xc1, 0x64}, [](Assembler& a) { a.multiply_imm(kRax, Operand::of(uint8_t{kRcx}), 100, 4); }},
    {"imul r8, rcx, 1000", {0x4c, 0x69, 0xc1, 0xe8, 0x03, 0x00, 0x00}, [](Assembler& a) { a.multiply_imm(kR8, Operand::of(uint8_t{kRcx}), 1000, 8); }},
    {"neg r10d", {0x41, 0xf7, 0xda}, [](Assembler& a) { a.negate(kR10, 4); }},
    {"not rdx", {0x48, 0xf7, 0xd2}, [](Assembler& a) { a.complement(kRdx, 8); }},
    {"rol sil, 3", {0x40, 0xc0, 0xc6, 0x03}, [](Assembler& a) { a.shift(Shift::kRol, kRsi, 3, 1); }},
    {"ror cx, 5", {0x66, 0xc1, 0xc9, 0x05}, [](Assembler& a) { a.shift(Shift::kRor, kRcx, 5, 2); }},
    {"shl r9d, 31", {0x41, 0xc1, 0xe1, 0x1f}, [](Assembler& a) { a.shift(Shift::kShl, kR9, 31, 4); }},
    {"sar rax, 63", {0x48, 0xc1, 0xf8, 0x3f}, [](Assembler& a) { a.shift(Shift::kSar, kRax, 63, 8); }},
    {"shr edx, cl", {0xd3, 0xea}, [](Assembler& a) { a.shift_cl(Shift::kShr, kRdx, 4); }},
    {"mul r9", {0x49, 0xf7, 0xe1}, [](Assembler& a) { a.multiply_wide(kR9, false); }},
    {"imul rcx", {0x48, 0xf7, 0xe9}, [](Assembler& a) { a.multiply_wide(kRcx, true); }},
    {"idiv ecx", {0xf7, 0xf9}, [](Assembler& a) { a.divide(kRcx, true, 4); }},
    {"div r9", {0x49, 0xf7, 0xf1}, [](Assembler& a) { a.divide(kR9, false, 8); }},
    {"cdq", {0x99}, [](Assembler& a) { a.sign_into_rdx(4); }},
    {"cqo", {0x48, 0x99}, [](Assembler& a) { a.sign_into_rdx(8); }},
    {"lea eax, [rdx*4+5]", {0x8d, 0x04, 0x95, 0x05, 0x00, 0x00, 0x00}, [](Assembler& a) { a.address(kRax, {0, kRdx, 4, false, 5}, 4); }},
    {"lea rbp, [r12+rdx-0x80000000]", {0x49, 0x8d, 0xac, 0x14, 0x00, 0x00, 0x00, 0x80}, [](Assembler& a) { a.address(kRbp, {kR12, kRdx, 1, true, INT32_MIN}, 8); }},
    {"sete dil", {0x40, 0x0f, 0x94, 0xc7}, [](Assembler& a) { a.set(Condition::kEqual, kRdi); }},
    {"setg r9b", {0x41, 0x0f, 0x9f, 0xc1}, [](Assembler& a) { a.set(Condition::kGreater, kR9); }},
    {"cmovb rax, r9", {0x49, 0x0f, 0x42, 0xc1}, [](Assembler& a) { a.move_if(Condition::kBelow, kRax, kR9); }},
    // branches
    {"{disp32} jmp .+6; ret", {0xe9, 0x01, 0x00, 0x00, 0x00, 0xc3}, [](Assembler& a) { const Label l = a.label(); a.jump(l); a.ret(); a.bind(l); }},
    {"ret; {disp32} jmp .-1", {0xc3, 0xe9, 0xfa, 0xff, 0xff, 0xff}, [](Assembler& a) { const Label l = a.label(); a.bind(l); a.ret(); a.jump(l); }},
    {"{disp32} jle .+7; ret", {0x0f, 0x8e, 0x01, 0x00, 0x00, 0x00, 0xc3}, [](Assembler& a) { const Label l = a.label(); a.jump_if(Condition::kLessOrEqual, l); a.ret(); a.bind(l); }},
    {"call .+6; ret", {0xe8, 0x01, 0x00, 0x00, 0x00, 0xc3}, [](Assembler& a) { const Label l = a.label(); a.call(l); a.ret(); a.bind(l); }},
    {"jmp r11", {0x41, 0xff, 0xe3}, [](Assembler& a) { a.jump_to(kR11); }},
    {"call rdi", {0xff, 0xd7}, [](Assembler& a) { a.call(Operand::of(uint8_t{kRdi})); }},
    {"call qword ptr [rsi+r8+24]", {0x42, 0xff, 0x54, 0x06, 0x18}, [](Assembler& a) { a.call(Operand::of(Address{kRsi, kR8, 1, true, 24})); }},
    {"push rbx", {0x53}, [](Assembler& a) { a.push(kRbx); }},
    {"push r15", {0x41, 0x57}, [](Assembler& a) { a.push(kR15); }},
    {"pop r12", {0x41, 0x5c}, [](Assembler& a) { a.pop(kR12); }},
    {"pop rbp", {0x5d}, [](Assembler& a) { a.pop(kRbp); }},
    {"ud2", {0x0f, 0x0b}, [](Assembler& a) { a.trap(); }},
    // floating point
    {"movaps xmm1, xmm9", {0x41, 0x0f, 0x28, 0xc9}, [](Assembler& a) { a.float_move(1, 9); }},
    {"movss xmm1, dword ptr [rbx]", {0xf3, 0x0f, 0x10, 0x0b}, [](Assembler& a) { a.float_load(1, {kRbx}, 4); }},
    {"movsd xmm14, qword ptr [r12+8]", {0xf2, 0x45, 0x0f, 0x10, 0x74, 0x24, 0x08}, [](Assembler& a) { a.float_load(14, {kR12, 0xff, 1, true, 8}, 8); }},
    {"movss dword ptr [rbx], xmm1", {0xf3, 0x0f, 0x11, 0x0b}, [](Assembler& a) { a.float_store({kRbx}, 1, 4); }},
    {"movsd qword ptr [rbx], xmm15", {0xf2, 0x44, 0x0f, 0x11, 0x3b}, [](Assembler& a) { a.float_store({kRbx}, 15, 8); }},
    {"addss xmm1, xmm2", {0xf3, 0x0f, 0x58, 0xca}, [](Assembler& a) { a.float_op(0x58, 1, Operand::of(uint8_t{2}), 4); }},
    {"divsd xmm9, qword ptr [rbx]", {0xf2, 0x44, 0x0f, 0x5e, 0x0b}, [](Assembler& a) { a.float_op(0x5e, 9, Operand::of(Address{kRbx}), 8); }},
    {"ucomiss xmm1, xmm2", {0x0f, 0x2e, 0xca}, [](Assembler& a) { a.float_compare(1, Operand::of(uint8_t{2}), 4); }},
    {"ucomisd xmm1, xmm10", {0x66, 0x41, 0x0f, 0x2e, 0xca}, [](Assembler& a) { a.float_compare(1, Operand::of(uint8_t{10}), 8); }},
    {"andps xmm1, xmm15", {0x41, 0x0f, 0x54, 0xcf}, [](Assembler& a) { a.float_logic(0x54, 1, 15); }},
    {"xorps xmm1, xmm1; cvtsi2ss xmm1, ecx", {0x0f, 0x57, 0xc9, 0xf3, 0x0f, 0x2a, 0xc9}, [](Assembler& a) { a.float_from_integer(1, kRcx, 4, 4); }},
    {"xorps xmm1, xmm1; cvtsi2sd xmm1, r9", {0x0f, 0x57, 0xc9, 0xf2, 0x49, 0x0f, 0x2a, 0xc9}, [](Assembler& a) { a.float_from_integer(1, kR9, 8, 8); }},
    {"cvttss2si rax, xmm1", {0xf3, 0x48, 0x0f, 0x2c, 0xc1}, [](Assembler& a) { a.integer_from_float(kRax, 1, 4, true); }},
    {"cvtsd2si r9, xmm1", {0xf2, 0x4c, 0x0f, 0x2d, 0xc9}, [](Assembler& a) { a.integer_from_float(kR9, 1, 8, false); }},
    {"cvtss2sd xmm1, xmm2", {0xf3, 0x0f, 0x5a, 0xca}, [](Assembler& a) { a.float_width(1, Operand::of(uint8_t{2}), 4); }},
    {"cvtsd2ss xmm1, qword ptr [rbx]", {0xf2, 0x0f, 0x5a, 0x0b}, [](Assembler& a) { a.float_width(1, Operand::of(Address{kRbx}), 8); }},
    {"movd xmm1, ecx", {0x66, 0x0f, 0x6e, 0xc9}, [](Assembler& a) { a.bits_to_float(1, kRcx, 4); }},
    {"movq xmm15, r11", {0x66, 0x4d, 0x0f, 0x6e, 0xfb}, [](Assembler& a) { a.bits_to_float(15, kR11, 8); }},
    {"movd ecx, xmm1", {0x66, 0x0f, 0x7e, 0xc9}, [](Assembler& a) { a.float_to_bits(kRcx, 1, 4); }},
    {"movq r11, xmm1", {0x66, 0x49, 0x0f, 0x7e, 0xcb}, [](Assembler& a) { a.float_to_bits(kR11, 1, 8); }},
};
// clang-format on

TEST(X64Assembler, InstructionsAreEncodedAsGnuAsDoes) {
  for (const Form& form : kForms) {
    Assembler a;
    form.emit(a);
    a.patch();
    EXPECT_EQ(a.code(), form.bytes) << form.text;
  }
}

// lea r9, [rip]; the table behind it
TEST(X64Assembler, TablesHoldDistancesFromTheirBeginning) {
  Assembler a;
  const Label to = a.label();
  const Label table = a.label();
  a.bind(to);
  a.ret();
  a.address_of(kR9, table);
  a.bind(table);
  a.table_entry(table, to);
  a.table_entry(table, table);
  a.patch();
  const std::vector<uint8_t> expected = {0xc3, 0x4c, 0x8d, 0x0d, 0, 0, 0, 0,
                                         0xf8, 0xff, 0xff, 0xff, 0, 0, 0, 0};
  EXPECT_EQ(a.code(), expected);
}

}  // namespace
}  // namespace vm::native::x64
