// SWITCH and the table of jumps behind it (V4): what hostile images may say there.
#include <gtest/gtest.h>

#include "ir/bytecode/verify.h"
#include "tests/unit/bytecode/sample_image.h"

namespace {

using namespace sample;
using base::Refusal;

void expect_accepted(const char* what, const Code& code, std::vector<ir::Merge> merges) {
  const auto verified = ir::verify(ir::encode(image(code, std::move(merges))));
  EXPECT_TRUE(verified.ok()) << what << ": " << verified.error().text;
}
void expect_refused(Refusal refusal, const char* text, const Code& code,
                    std::vector<ir::Merge> merges) {
  const auto verified = ir::verify(ir::encode(image(code, std::move(merges))));
  ASSERT_FALSE(verified.ok()) << text;
  EXPECT_EQ(verified.error().refusal, refusal) << verified.error().text;
  EXPECT_NE(verified.error().text.find(text), std::string::npos) << verified.error().text;
}

const Code kRet = op(Opcode::RET);
const Code kLoad = op(Opcode::MOV_16, F(kW0), C(kOne16));  // unit 0; a table begins at unit 3
Code jmp(int32_t distance) { return jump(Opcode::JMP, distance); }
Code choose(uint32_t low, uint32_t entries, Opcode opcode = Opcode::SWITCH_16) {
  return ext(opcode, {}, F(kW0), {}, low, entries);
}

TEST(VerifyTables, V4_ATableOfJumps) {
  const Code three = jmp(2) + jmp(1) + jmp(0) + kRet;
  expect_accepted("three", kLoad + choose(1, 3) + three, {{6, {}}});
  expect_accepted("from -1 on", kLoad + choose(0xffffffffu, 3) + three, {{6, {}}});
  // What holds in front holds at its targets.
  const Code used = jmp(1) + jmp(0) + op(Opcode::MOV_16, S(kX), F(kW0)) + kRet;
  expect_accepted("a slot", kLoad + choose(7, 2) + used, {{5, {1}}});
}

TEST(VerifyTables, V4_TablesThatLeadElsewhere) {
  const Code begin = kLoad + choose(1, 2);
  const Code three = jmp(2) + jmp(1) + jmp(0) + kRet;
  expect_refused(Refusal::kBadJump, "a table of 0 jumps", kLoad + choose(1, 0) + kRet, {});
  expect_refused(Refusal::kBadJump, "after its table", kLoad + choose(1, 4) + three, {{6, {}}});
  expect_refused(Refusal::kBadJump, "after its table", kLoad + choose(1, 65536) + three,
                 {{6, {}}});
  expect_refused(Refusal::kBadJump, "a table of 65537 jumps", kLoad + choose(1, 65537) + three,
                 {{6, {}}});
  expect_refused(Refusal::kBadJump, "a table of 4294967295 jumps",
                 kLoad + choose(1, 0xffffffffu) + three, {{6, {}}});
  expect_refused(Refusal::kBadJump, "jumps to unit", begin + jmp(1) + jmp(9) + kRet, {{5, {}}});
  expect_refused(Refusal::kBadJump, "no JMP", begin + jmp(1) + kLoad + kRet, {{5, {}}});
  expect_refused(Refusal::kBadJump, "no JMP", begin + jmp(1) + kRet + kRet, {{5, {}}});
  expect_refused(Refusal::kBadJump, "into a table", begin + jmp(0) + jmp(0) + kRet,
                 {{4, {}}, {5, {}}});
  expect_refused(Refusal::kNoFuel, "jumps back", begin + jmp(-4) + jmp(0) + kRet,
                 {{0, {}}, {5, {}}});
}

TEST(VerifyTables, V6_TheOperandOfATable) {
  const Code two = jmp(1) + jmp(0) + kRet;
  expect_refused(Refusal::kReadBeforeWrite, "", choose(1, 2) + two, {{4, {}}});
  expect_refused(Refusal::kBadTyping, "", kLoad + choose(1, 2, Opcode::SWITCH_32) + two, {{5, {}}});
  expect_refused(Refusal::kBadOpcode, "not zero",
                 kLoad + ext(Opcode::SWITCH_16, {}, F(kW0), F(3), 1, 2) + two, {{5, {}}});
}

}  // namespace
