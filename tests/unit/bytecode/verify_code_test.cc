// As verify_test.cc: what the verifier asks of code.
#include "base/limits.h"
#include "tests/unit/bytecode/verify_outcome.h"

namespace {

using namespace sample;
using namespace verify_outcome;
using base::Refusal;
using ir::Image;

// Main with this code is accepted; `merges` say what holds at jump targets.
void expect_code(const char* what, const Code& code, std::vector<ir::Merge> merges = {}) {
  EXPECT_EQ(outcome(image(code, std::move(merges))), "accepted") << what;
}
void expect_code_refused(Refusal refusal, const char* what, const Code& code,
                         std::vector<ir::Merge> merges = {}) {
  const auto verified = ir::verify(ir::encode(image(code, std::move(merges))));
  ASSERT_FALSE(verified.ok()) << what;
  EXPECT_EQ(verified.error().refusal, refusal) << what << ": " << verified.error().text;
  EXPECT_NE(verified.error().text.find("`Main`"), std::string::npos) << verified.error().text;
}

Code load_w0() { return op(Opcode::MOV_16, F(kW0), C(kOne16)); }
Code load_b0() { return op(Opcode::MOV_B, F(kB0), C(kTrue)); }
Code lea_x(uint32_t slot = kAddrInt) { return ext(Opcode::LEA, F(slot), S(0), {}, kX, kInt); }
Code arguments() {
  return op(Opcode::MOV_16, F(kArgA), C(kOne16)) + op(Opcode::MOV_16, F(kArgB), C(kOne16));
}
Code call_add() { return op(Opcode::CALL, F(kNext / 8), {}, F(kAddPou)); }

TEST(Verify, V3_EveryInstructionDefined) {
  Unit undefined = Unit::make(static_cast<Opcode>(ir::kOpcodeCount));
  expect_code_refused(Refusal::kBadOpcode, "undefined opcode", Code{undefined} + kRet);
  expect_code_refused(Refusal::kBadOpcode, "half an instruction",
                      kRet + Code{Unit::make(Opcode::LEA)});
  expect_code_refused(Refusal::kBadOpcode, "a base that the operand cannot have",
                      op(Opcode::ADD_8, S(kX), S(kX), S(kX)) + kRet);
  expect_code_refused(Refusal::kBadOpcode, "a constant as destination",
                      op(Opcode::MOV_16, C(kOne16), C(kOne16)) + kRet);
  expect_code_refused(Refusal::kBadOpcode, "an unused field",
                      op(Opcode::MOV_16, F(kW0), C(kOne16), F(1)) + kRet);
}

TEST(Verify, V4_JumpTargets) {
  expect_code("forwards", load_b0() + jump(Opcode::JT, 1, F(kB0)) + load_w0() + kRet, {{3, {}}});
  expect_code_refused(Refusal::kBadJump, "no merge there",
                      load_b0() + jump(Opcode::JT, 1, F(kB0)) + load_w0() + kRet);
  expect_code_refused(Refusal::kBadJump, "behind the end", jump(Opcode::JMP, 5) + kRet, {{1, {}}});
  expect_code_refused(Refusal::kBadJump, "into the middle of an instruction",
                      load_b0() + jump(Opcode::JT, 1, F(kB0)) + lea_x() + kRet, {{3, {}}});
  expect_code_refused(Refusal::kBadJump, "a loop forwards", jump(Opcode::LOOP, 0) + kRet,
                      {{1, {}}});
  expect_code_refused(Refusal::kBadJump, "a merge behind the end", kRet, {{7, {}}});
}

TEST(Verify, V5_EveryPathReturns) {
  expect_code_refused(Refusal::kNoReturn, "the end is open", load_w0());
  expect_code_refused(Refusal::kNoReturn, "a call at the end", arguments() + call_add());
}

TEST(Verify, V6_NoUnreachableCode) {
  expect_code_refused(Refusal::kUnreachable, "behind a return", kRet + load_w0() + kRet);
  expect_code_refused(Refusal::kUnreachable, "a merge that nothing reaches", kRet + kRet,
                      {{1, {}}});
  expect_code_refused(Refusal::kUnreachable, "a loop that only its own end reaches",
                      kRet + load_w0() + jump(Opcode::LOOP, -2), {{1, {}}});
  expect_refused(Refusal::kUnreachable, "code of no POU",
                 [](Image& i) { i.code.push_back(Unit::make(Opcode::RET)); });
  expect_refused(Refusal::kUnreachable, "a POU that was removed, behind all code", [](Image& i) {
    i.pous.push_back({});
    i.pous.back().first_unit = 0xfffffff0;
  });
  expect_refused(Refusal::kUnreachable, "two POUs share code",
                 [](Image& i) { i.pous[kMainPou].first_unit -= 1; });
}

TEST(Verify, V7_TypesAtEveryPointAndAtMerges) {
  expect_code_refused(Refusal::kBadTyping, "slot of another class",
                      op(Opcode::MOV_32, F(kW0), C(kOne32)) + kRet);
  expect_code_refused(Refusal::kBadTyping, "the middle of a slot",
                      op(Opcode::MOV_8, F(kD0 + 1), C(0)) + kRet);
  expect_code_refused(Refusal::kBadTyping, "variable of another class",
                      op(Opcode::MOV_B, S(kX), C(kTrue)) + kRet);
  expect_code_refused(Refusal::kBadTyping, "a BOOL constant of 7",
                      op(Opcode::MOV_B, F(kB0), C(kNotBool)) + kRet);
  expect_code_refused(
      Refusal::kBadTyping, "an address of another type",
      ext(Opcode::LEA, F(kAddrInt), S(0), {}, kPair, types_of(busy_image()).pair.index) + kRet);
  // One way brings w0, the other does not.
  expect_code_refused(Refusal::kBadTyping, "a merge that one way cannot keep",
                      load_b0() + jump(Opcode::JT, 1, F(kB0)) + load_w0() + kRet, {{3, {1}}});
  expect_code("a merge that both keep",
              load_b0() + load_w0() + jump(Opcode::JT, 1, F(kB0)) + load_w0() + kRet, {{4, {1}}});
  expect_code_refused(
      Refusal::kBadTyping, "a loop that forgets what its head needs",
      load_w0() + op(Opcode::MOV_16, S(kX), F(kW0)) + jump(Opcode::JMP, 0) + jump(Opcode::LOOP, -3),
      {{1, {1}}, {3, {}}});
  expect_code_refused(Refusal::kBadTyping, "merge of a slot that does not exist",
                      jump(Opcode::JMP, 0) + kRet, {{1, {99}}});
  expect_code_refused(Refusal::kBadTyping, "merge of an aggregate", jump(Opcode::JMP, 0) + kRet,
                      {{1, {12}}});
}

TEST(Verify, V9_NothingReadBeforeItIsWritten) {
  expect_code_refused(Refusal::kReadBeforeWrite, "a slot",
                      op(Opcode::MOV_16, S(kX), F(kW0)) + kRet);
  expect_code_refused(Refusal::kReadBeforeWrite, "an address",
                      op(Opcode::LD_16, F(kW0), F(kAddrInt), F(0)) + kRet);
  expect_code_refused(Refusal::kReadBeforeWrite, "a merge forgets it",
                      load_w0() + jump(Opcode::JMP, 0) + op(Opcode::MOV_16, S(kX), F(kW0)) + kRet,
                      {{2, {}}});
  expect_code_refused(Refusal::kReadBeforeWrite, "kept unless the condition holds",
                      load_b0() + op(Opcode::CMOV_16, F(kW0), F(kB0), C(kOne16)) + kRet);
  expect_code_refused(Refusal::kReadBeforeWrite, "a result that nobody left",
                      op(Opcode::MOV_16, S(kX), F(kResult)) + kRet);
  expect_code_refused(Refusal::kReadBeforeWrite, "the address of an unwritten scalar",
                      ext(Opcode::LEA, F(kAddrInt), F(0), {}, kW0, kInt) + kRet);
  expect_code("an aggregate always holds something", op(Opcode::MOV_16, S(kX), F(kPair0)) + kRet);
}

TEST(Verify, V10_ConstantsVariablesMembers) {
  expect_code_refused(Refusal::kBadReference, "no variable",
                      op(Opcode::MOV_16, S(100), C(0)) + kRet);
  expect_code_refused(Refusal::kBadReference, "half a variable",
                      op(Opcode::MOV_16, S(kX + 1), C(0)) + kRet);
  expect_code_refused(Refusal::kBadReference, "a character as scalar",
                      op(Opcode::NOT_B, S(kText), S(kFlag)) + kRet);
  expect_code_refused(Refusal::kBadReference, "no constant",
                      op(Opcode::MOV_64, F(kQ0), C(68)) + kRet);
  expect_code_refused(Refusal::kBadReference, "no global",
                      op(Opcode::MOV_16, F(kW0), G(10)) + kRet);
  expect_code_refused(Refusal::kBadReference, "another area as global",
                      op(Opcode::MOV_16, F(kW0), G(kMainData)) + kRet);
  expect_code_refused(Refusal::kBadReference, "a CONSTANT is written",
                      op(Opcode::MOV_16, G(kLimit), C(kOne16)) + kRet);
  expect_code_refused(Refusal::kBadReference, "no range",
                      op(Opcode::CHECK_I16, {}, S(kX), F(1)) + kRet);
  expect_code_refused(Refusal::kBadReference, "no bounds",
                      ext(Opcode::INDEX_PLACE_I16, F(kAddrInt), S(kX), S(0), 9, kNumbers) + kRet);
  expect_code_refused(Refusal::kBadReference, "bounds of another array",
                      ext(Opcode::INDEX_PLACE_I16, F(kAddrInt), S(kX), S(0), 0, kFbs) + kRet);
  expect_code_refused(Refusal::kBadReference, "no trap", op(Opcode::TRAP, F(99)));
  expect_code_refused(Refusal::kBadReference, "behind the end of what an address points to",
                      lea_x() + op(Opcode::LD_16, F(kW0), F(kAddrInt), F(2)) + kRet);
  expect_code_refused(Refusal::kBadReference, "a string of more capacity",
                      ext(Opcode::STR, F(kStr0), S(0), {}, kText, 11) + kRet);
  expect_code_refused(Refusal::kBadReference, "a string from its second character",
                      ext(Opcode::STR, F(kStr0), S(0), {}, kText + 1, 5) + kRet);
  expect_code_refused(Refusal::kBadTyping, "a constant string without an end",
                      ext(Opcode::STR, F(kStr0), C(0), {}, kNoEnd, 7) + kRet);
  expect_code_refused(Refusal::kBadReference, "a type that does not exist",
                      ext(Opcode::LEA, F(kAddrInt), S(0), {}, kX, 0x0fffffff) + kRet);
  expect_refused(Refusal::kBadReference, "bounds that the array does not have",
                 [](Image& i) { i.bounds[0].count = 5; });
  expect_refused(Refusal::kBadReference, "an empty range", [](Image& i) {
    i.ranges[0] = {5, 4, "level"};
  });
  expect_refused(Refusal::kBadReference, "an initial value that does not exist",
                 [](Image& i) { i.types.own().edit(types_of(i).pair).init = ir::ConstId(5); });
  expect_refused(Refusal::kBadReference, "an initial value that contains itself", [](Image& i) {
    i.constants.own().add({0, {}, {{0, 1, ir::ConstId(0)}}});
  });
  expect_refused(Refusal::kBadReference, "two POUs of one type", [](Image& i) {
    i.pous[kAddPou].kind = ir::PouKind::kFunctionBlock;
    i.pous[kAddPou].self = types_of(i).counter;
    i.pous[kAddPou].slots.clear();
  });
}

// Addresses of constants and inputs are good for reading only, whatever way they take.
TEST(Verify, V10_ReadOnlyStaysReadOnly) {
  const auto pair = types_of(busy_image()).pair.index;
  const Code constant = ext(Opcode::LEA, F(kAddrPair), C(0), {}, kPairValue, pair);
  const Code part = ext(Opcode::LEA_AT, F(kAddrInt), F(kAddrPair), {}, 0, kInt);
  expect_code("read", constant + op(Opcode::LD_16, F(kW0), F(kAddrPair), F(0)) + kRet);
  expect_code_refused(Refusal::kBadReference, "store",
                      constant + op(Opcode::ST_16, F(kAddrPair), C(kOne16), F(0)) + kRet);
  expect_code_refused(Refusal::kBadReference, "store through a part",
                      constant + part + op(Opcode::ST_16, F(kAddrInt), C(kOne16), F(0)) + kRet);
  expect_code_refused(Refusal::kBadReference, "store through a copy of the address",
                      constant + part + op(Opcode::MOV_A, F(kAddrInt2), F(kAddrInt)) +
                          op(Opcode::ST_16, F(kAddrInt2), C(kOne16), F(0)) + kRet);
  expect_code_refused(Refusal::kBadReference, "copy into it",
                      constant + op(Opcode::COPY, F(kAddrPair), F(kAddrPair)) +
                          Code{Unit::extension(pair, 0)} + kRet);
  expect_code_refused(Refusal::kBadReference, "string copy into it",
                      ext(Opcode::STR, F(kStr0), C(0), {}, kHello, 5) +
                          op(Opcode::SCOPY, F(kStr0), F(kStr0)) + kRet);
  expect_code_refused(Refusal::kBadReference, "result of a native function into it",
                      ext(Opcode::STR, F(kNext), C(0), {}, kHello, 5) +
                          op(Opcode::MOV_64, F(kNext + 8), C(kBig64)) +
                          op(Opcode::NATIVE, F(kNext / 8), {}, F(native("LINT_TO_STRING"))) + kRet);
  expect_code_refused(Refusal::kBadReference, "after the ways join",
                      lea_x() + op(Opcode::MOV_A, F(kAddrInt2), F(kAddrInt)) + constant + part +
                          jump(Opcode::JT, 1, S(kFlag)) +
                          op(Opcode::MOV_A, F(kAddrInt), F(kAddrInt2)) +
                          op(Opcode::ST_16, F(kAddrInt), C(kOne16), F(0)) + kRet,
                      {{9, {6}}});
  expect_code_refused(Refusal::kBadTyping, "in a later turn of a loop",
                      lea_x() + op(Opcode::ST_16, F(kAddrInt), C(kOne16), F(0)) + constant + part +
                          jump(Opcode::LOOP, -6),
                      {{2, {6}}});
  expect_code_refused(Refusal::kBadReference, "an in-out bound to it",
                      constant + part + wide(Opcode::INST, F(kAddrCounter), S(kFb)) +
                          op(Opcode::ST_REF_AT, F(kAddrCounter), F(kAddrInt), F(kIo)) + kRet);
}

TEST(Verify, V12_Arguments) {
  expect_code("all given", arguments() + call_add() + op(Opcode::MOV_16, S(kX), F(kResult)) + kRet);
  expect_code_refused(Refusal::kBadCall, "one is missing",
                      op(Opcode::MOV_16, F(kArgA), C(kOne16)) + call_add() + kRet);
  expect_code_refused(Refusal::kBadCall, "of another class",
                      op(Opcode::MOV_16, F(kArgA), C(kOne16)) +
                          op(Opcode::MOV_B, F(kArgB), C(kTrue)) + call_add() + kRet);
  expect_code_refused(
      Refusal::kBadCall, "one too many",
      arguments() + op(Opcode::MOV_16, F(kNext + 16), C(kOne16)) + call_add() + kRet);
  expect_code_refused(Refusal::kBadCall, "no such function",
                      arguments() + op(Opcode::CALL, F(kNext / 8), {}, F(77)) + kRet);
  expect_code_refused(Refusal::kBadCall, "a function block as function",
                      op(Opcode::CALL, F(kNext / 8), {}, F(kCounterPou)) + kRet);
  expect_code_refused(Refusal::kBadCall, "arguments without a call", arguments() + kRet);
  expect_code_refused(Refusal::kBadCall, "arguments across a jump target",
                      arguments() + jump(Opcode::JMP, 0) + call_add() + kRet, {{3, {}}});
  expect_code_refused(Refusal::kReadBeforeWrite, "an input read as result",
                      arguments() + call_add() + op(Opcode::MOV_16, S(kX), F(kArgA)) + kRet);
  expect_code_refused(Refusal::kReadBeforeWrite, "a result after the next call",
                      arguments() + call_add() + wide(Opcode::CALL_INST, F(kNext / 8), S(kFb)) +
                          op(Opcode::MOV_16, S(kX), F(kResult)) + kRet);
  expect_code("a result behind a jump target",
              arguments() + call_add() + jump(Opcode::JMP, 0) +
                  op(Opcode::MOV_16, S(kX), F(kResult)) + kRet,
              {{4, {}}});
  expect_code_refused(Refusal::kReadBeforeWrite, "a result that only one way leaves",
                      jump(Opcode::JT, 3, S(kFlag)) + arguments() + call_add() +
                          op(Opcode::MOV_16, S(kX), F(kResult)) + kRet,
                      {{4, {}}});
  expect_code_refused(Refusal::kBadCall, "no such native function",
                      op(Opcode::NATIVE, F(kNext / 8), {}, F(9999)) + kRet);
  expect_code_refused(Refusal::kBadCall, "a native function without its argument",
                      op(Opcode::NATIVE, F(kNext / 8), {}, F(native("SIN"))) + kRet);
  expect_code_refused(Refusal::kBadCall, "a native argument of another class",
                      op(Opcode::MOV_64, F(kNext), C(kBig64)) +
                          op(Opcode::NATIVE, F(kNext / 8), {}, F(native("SIN"))) + kRet);
  expect_refused(Refusal::kBadCall, "a result that the callee does not write",
                 [](Image& i) { set_code(i, kAddPou, kRet); });
}

TEST(Verify, V12_LoopsKeepTheirPromisesAboutResults) {
  // The loop calls, so what was left before it cannot be read at its head.
  expect_code_refused(Refusal::kReadBeforeWrite, "results across a loop that calls",
                      arguments() + call_add() + op(Opcode::MOV_16, S(kX), F(kResult)) +
                          wide(Opcode::CALL_INST, F(kNext / 8), S(kFb)) + jump(Opcode::LOOP, -3),
                      {{3, {}}});
  expect_code(
      "results across a loop that does not call",
      arguments() + call_add() + op(Opcode::MOV_16, S(kX), F(kResult)) + jump(Opcode::LOOP, -2),
      {{3, {}}});
}

TEST(Verify, V14_InputsAndOutputs) {
  expect_code_refused(Refusal::kBadIoAccess, "an input is written",
                      op(Opcode::MOV_B, G(kIn), C(kTrue)) + kRet);
  expect_refused(Refusal::kBadIoAccess, "outside the process image",
                 [](Image& i) { i.io[0].address.bit_offset = 8; });
  expect_refused(Refusal::kBadIoAccess, "of no variable", [](Image& i) { i.io[0].data = 600; });
  expect_refused(Refusal::kBadIoAccess, "of a variable that is not located",
                 [](Image& i) { i.io[0].data = kMainData + kFlag; });
  expect_refused(Refusal::kBadIoAccess, "an output as input",
                 [](Image& i) { i.io[0].data = kOut; });
  // Two tasks whose programs both write %QX0.0.
  expect_refused(Refusal::kBadIoAccess, "two writer tasks", [](Image& i) {
    ir::Type type = i.types[types_of(i).main];
    type.name = "OtherType";
    type.members.clear();
    const ir::TypeId other = i.types.own().declare(type);
    i.layouts.own().of.resize(i.types.size());
    i.layouts.own().of.back() = {4, 4, {}, 0, 8};
    ir::LinkedPou pou;
    pou.name = "Other";
    pou.kind = ir::PouKind::kProgram;
    pou.self = other;
    i.pous.push_back(pou);
    set_code(i, 3, op(Opcode::MOV_B, G(kOut), C(kTrue)) + kRet);
    i.instances[6].type = other;
    i.instances[6].data = 448;
    i.instances[6].pou = 3;
    i.instances[6].live = true;
    i.tasks.push_back({"Slow", 20'000'000, 100'000'000, 1, 0, {6}});
  });
}

TEST(Verify, V19_BackEdgesTakeFuel) {
  const Code body = load_b0() + jump(Opcode::JT, -2, F(kB0)) + kRet;
  expect_code_refused(Refusal::kNoFuel, "a conditional jump back", body, {{0, {}}});
  expect_code_refused(Refusal::kNoFuel, "a jump back", load_b0() + jump(Opcode::JMP, -2),
                      {{0, {}}});
  expect_code("a loop", load_b0() + jump(Opcode::LOOP, -2), {{0, {}}});
}

TEST(Verify, V20_ReferencesInReferenceSlotsOnly) {
  expect_code_refused(Refusal::kBadTyping, "a number into an address slot",
                      op(Opcode::MOV_32, F(kAddrInt), C(kOne32)) + kRet);
  expect_code_refused(Refusal::kBadTyping, "a number into a string reference",
                      op(Opcode::MOV_64, F(kStr0), C(kBig64)) + kRet);
  expect_code_refused(Refusal::kBadReferenceSlot, "an address into a number",
                      ext(Opcode::LEA, F(kD0), S(0), {}, kX, kInt) + kRet);
  expect_code_refused(Refusal::kBadReference, "an ID is written",
                      op(Opcode::MOV_32, S(kFb), C(kOne32)) + kRet);
  expect_code_refused(Refusal::kBadReference, "an in-out is written as number",
                      wide(Opcode::INST, F(kAddrCounter), S(kFb)) +
                          op(Opcode::ST_32, F(kAddrCounter), C(kOne32), F(kIo)) + kRet);
  expect_code_refused(Refusal::kBadReferenceSlot, "a number as in-out",
                      wide(Opcode::LD_REF, F(kAddrInt), S(kLong)) + kRet);
  expect_code_refused(Refusal::kBadReferenceSlot, "a number as ID",
                      wide(Opcode::CALL_INST, F(kNext / 8), S(kLong)) + kRet);
  expect_code_refused(
      Refusal::kBadTyping, "an in-out of another type",
      wide(Opcode::INST, F(kAddrCounter), S(kFb)) +
          ext(Opcode::LEA, F(kAddrPair), S(0), {}, kPair, types_of(busy_image()).pair.index) +
          op(Opcode::ST_REF_AT, F(kAddrCounter), F(kAddrPair), F(kIo)) + kRet);
  expect_code_refused(Refusal::kBadReferenceSlot, "an instance is copied",
                      wide(Opcode::INST, F(kAddrCounter), S(kFb)) +
                          op(Opcode::COPY, F(kAddrCounter), F(kAddrCounter)) +
                          Code{Unit::extension(types_of(busy_image()).counter.index, 0)} + kRet);
}

}  // namespace
