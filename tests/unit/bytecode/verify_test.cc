// Every rule of the verifier (V1 to V20, reliability.md) has images that only it rejects:
// each is the accepted sample with one thing changed.
#include "ir/bytecode/verify.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/limits.h"
#include "tests/unit/bytecode/sample_image.h"

namespace {

using namespace sample;
using base::Refusal;
using ir::Image;

std::string outcome(const Image& image) {
  const auto verified = ir::verify(ir::encode(image));
  return verified ? "accepted" : base::to_string(verified.error());
}

// `change` makes the accepted sample unacceptable for exactly this reason.
void expect_refused(Refusal refusal, const char* what, const std::function<void(Image&)>& change) {
  Image image = busy_image();
  ASSERT_EQ(outcome(image), "accepted");
  change(image);
  const auto verified = ir::verify(ir::encode(image));
  ASSERT_FALSE(verified.ok()) << what;
  EXPECT_EQ(verified.error().refusal, refusal) << what << ": " << verified.error().text;
  EXPECT_FALSE(verified.error().text.empty());
}

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

const Code kRet = op(Opcode::RET);
const uint32_t kInt = static_cast<uint32_t>(ir::Kind::kInt);
const ir::TypeId kIntType(kInt);
const ir::TypeId kDint(static_cast<uint32_t>(ir::Kind::kDint));

Code load_w0() { return op(Opcode::MOV_16, F(kW0), C(kOne16)); }
Code load_b0() { return op(Opcode::MOV_B, F(kB0), C(kTrue)); }
Code lea_x(uint32_t slot = kAddrInt) { return ext(Opcode::LEA, F(slot), S(0), {}, kX, kInt); }
Code arguments() {
  return op(Opcode::MOV_16, F(kArgA), C(kOne16)) + op(Opcode::MOV_16, F(kArgB), C(kOne16));
}
Code call_add() { return op(Opcode::CALL, F(kNext / 8), {}, F(kAddPou)); }

TEST(Verify, TheSampleIsAccepted) { EXPECT_EQ(outcome(busy_image()), "accepted"); }

TEST(Verify, V1_FormOfTables) {
  expect_refused(Refusal::kBadFormat, "a layout is missing",
                 [](Image& i) { i.layouts.own().of.pop_back(); });
  expect_refused(Refusal::kBadFormat, "a type contains itself", [](Image& i) {
    i.types.own().edit(types_of(i).pair).members[0].type = types_of(i).pair;
  });
  expect_refused(Refusal::kBadFormat, "members overlap", [](Image& i) {
    i.layouts.own().of[types_of(i).pair.index].member_offsets[1] = 1;
  });
  expect_refused(Refusal::kBadFormat, "a member behind the end", [](Image& i) {
    i.layouts.own().of[types_of(i).pair.index].member_offsets[1] = 4;
  });
  // Whoever follows a reference goes by what an area uses.
  expect_refused(Refusal::kBadFormat, "an area that uses more than it has", [](Image& i) {
    i.layouts.own().of[types_of(i).counter.index].used = 0xfffffff0;
  });
  expect_refused(Refusal::kBadFormat, "a member behind what its area uses", [](Image& i) {
    i.layouts.own().of[types_of(i).counter.index].used = kIo;
  });
  expect_refused(Refusal::kBadFormat, "a structure that uses more than it has",
                 [](Image& i) { i.layouts.own().of[types_of(i).pair.index].used = 9; });
  // Process images go by the address, memory by the layout.
  expect_refused(Refusal::kBadFormat, "a member of a union with two places", [](Image& i) {
    i.types.own().edit(types_of(i).pair).kind = ir::Kind::kUnion;
  });
  expect_refused(Refusal::kBadFormat, "a size that the type does not have",
                 [](Image& i) { i.layouts.own().of[types_of(i).numbers.index].size = 10; });
  expect_refused(Refusal::kBadFormat, "array bounds the wrong way round", [](Image& i) {
    i.types.own().edit(types_of(i).numbers).dims = {{4, 1}};
  });
  expect_refused(Refusal::kBadFormat, "a subrange of a structure",
                 [](Image& i) { i.types.own().edit(types_of(i).level).base = types_of(i).pair; });
  // Whoever describes a type follows its base.
  expect_refused(Refusal::kBadFormat, "a structure with a base",
                 [](Image& i) { i.types.own().edit(types_of(i).pair).base = types_of(i).pair; });
  expect_refused(Refusal::kBadFormat, "a program with a base that does not exist",
                 [](Image& i) { i.types.own().edit(types_of(i).main).base = ir::TypeId(1u << 30); });
  expect_refused(Refusal::kBadFormat, "a member type that does not exist", [](Image& i) {
    i.types.own().edit(types_of(i).main).members[0].type = ir::TypeId(999);
  });
  expect_refused(Refusal::kBadFormat, "the globals are something else",
                 [](Image& i) { i.globals = types_of(i).pair; });
  expect_refused(Refusal::kBadFormat, "initial data out of order",
                 [](Image& i) { std::swap(i.data[0], i.data[2]); });
  expect_refused(Refusal::kBadFormat, "initial data behind the end", [](Image& i) {
    i.data.push_back({1020, base::Bytes(8)});
  });
  expect_refused(Refusal::kBadFormat, "a string that is too large", [](Image& i) {
    i.types.own().edit(types_of(i).text).capacity = base::kMaxStringCapacity + 1;
  });
}

TEST(Verify, V2_HashBeforeAnythingElse) {
  base::Bytes bytes = ir::encode(busy_image());
  bytes[bytes.size() / 2] ^= 4;
  EXPECT_EQ(ir::verify(bytes).error().refusal, Refusal::kBadHash);
}

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

TEST(Verify, V8_Frames) {
  expect_refused(Refusal::kBadFrame, "no multiple of 8",
                 [](Image& i) { i.pous[kAddPou].frame_size = 9; });
  expect_refused(Refusal::kBadFrame, "a slot behind the end",
                 [](Image& i) { i.pous[kAddPou].slots[2].offset = 7; });
  expect_refused(Refusal::kBadFrame, "slots overlap",
                 [](Image& i) { i.pous[kAddPou].slots[1].offset = 1; });
  expect_refused(Refusal::kBadFrame, "the callee's frame begins elsewhere", [](Image& i) {
    for (Unit& unit : i.code) {
      if (unit.opcode() == Opcode::CALL) unit.a += 1;
    }
  });
  expect_refused(Refusal::kBadFrame, "a frame above the limit",
                 [](Image& i) { i.pous[kCounterPou].frame_size = base::kMaxFrameBytes + 8; });
  expect_refused(Refusal::kBadFrame, "an instance in a frame", [](Image& i) {
    i.pous[kMainPou].slots[12].region = {types_of(i).counters, 0};
  });
  // Whoever compares what callers see looks at the types of parameters.
  for (const ir::Region region : {ir::Region{}, ir::Region{ir::TypeId(999), 0},
                                  ir::Region{ir::TypeId(1u << 30), 0}, ir::Region{kDint, 0},
                                  ir::Region{kIntType, 1}}) {
    expect_refused(Refusal::kBadFrame, "a parameter of a type that is not of its class",
                   [&](Image& i) { i.pous[kAddPou].slots[0].region = region; });
  }
  expect_refused(Refusal::kBadFrame, "a scalar that is a structure", [](Image& i) {
    i.pous[kMainPou].slots[1].region = {types_of(i).pair, 0};
  });
  expect_refused(Refusal::kBadFrame, "a string's place of a type that is nowhere", [](Image& i) {
    i.pous[kMainPou].slots[10].region = {ir::TypeId(999), 0};
  });
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

TEST(Verify, V11_CallGraphAndStack) {
  expect_refused(Refusal::kStackUnbounded, "a function that calls itself", [](Image& i) {
    i.pous[kAddPou].slots.resize(3);
    set_code(i, kAddPou,
             op(Opcode::MOV_16, F(8), F(0)) + op(Opcode::MOV_16, F(10), F(2)) +
                 op(Opcode::CALL, F(1), {}, F(kAddPou)) + op(Opcode::MOV_16, F(4), F(12)) + kRet);
  });
  expect_refused(Refusal::kStackUnbounded, "stack too small",
                 [](Image& i) { i.stack_bytes = kNext + 7; });
  expect_refused(Refusal::kStackUnbounded, "depth too small", [](Image& i) { i.call_depth = 0; });
  Image exact = busy_image();
  exact.stack_bytes = kNext + 8;
  exact.call_depth = 1;
  EXPECT_EQ(outcome(exact), "accepted");
  // A task of another priority may lie on top.
  expect_refused(Refusal::kStackUnbounded, "two priorities need both", [](Image& i) {
    i.stack_bytes = kNext + 8 + 8;
    i.instances[6] = i.instances[1];
    i.instances[6].name = "Main2";
    i.instances[6].data = 640;
    i.free = {{768, 256}};
    i.instances.push_back(i.instances[2]);
    i.instances.push_back(i.instances[2]);
    i.instances.push_back(i.instances[2]);
    for (uint32_t n = 0; n < 3; ++n) {
      i.instances[7 + n].parent = 6;
      i.instances[7 + n].data = 448 + 16 * n;
    }
    i.data.push_back({640 + kFb, {7, 0, 0, 0, 8, 0, 0, 0, 9, 0, 0, 0}});
    i.tasks.push_back({"Slow", 20'000'000, 100'000'000, 2, 0, {6}});
    set_code(i, kMainPou, kRet);
  });
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

TEST(Verify, V13_Instances) {
  expect_refused(Refusal::kBadInstance, "outside data memory",
                 [](Image& i) { i.instances[2].data = 1016; });
  expect_refused(Refusal::kBadInstance, "in the first bytes",
                 [](Image& i) { i.instances[2].data = 0; });
  expect_refused(Refusal::kBadInstance, "misaligned", [](Image& i) { i.instances[5].data = 436; });
  expect_refused(Refusal::kBadInstance, "overlapping", [](Image& i) { i.instances[3].data = 392; });
  expect_refused(Refusal::kBadInstance, "in free space",
                 [](Image& i) { i.instances[5].data = 512; });
  expect_refused(Refusal::kBadInstance, "free space outside",
                 [](Image& i) { i.free[0].size = 513; });
  expect_refused(Refusal::kBadInstance, "a slot that names no instance",
                 [](Image& i) { i.data[1].bytes[0] = 0; });
  expect_refused(Refusal::kBadInstance, "a slot that names a free ID",
                 [](Image& i) { i.data[1].bytes[0] = 6; });
  expect_refused(Refusal::kBadInstance, "a slot that names one of another type",
                 [](Image& i) { i.data[1].bytes[0] = 1; });
  expect_refused(Refusal::kBadInstance, "an instance named twice",
                 [](Image& i) { i.data[3].bytes[4] = 2; });
  expect_refused(Refusal::kBadInstance, "another parent",
                 [](Image& i) { i.instances[2].parent = 0; });
  // Whoever looks for the root of an instance goes up until there is no parent.
  expect_refused(Refusal::kBadInstance, "globals below an instance",
                 [](Image& i) { i.instances[0].parent = 4; });
  expect_refused(Refusal::kBadInstance, "globals below what is not there",
                 [](Image& i) { i.instances[0].parent = 1u << 30; });
  expect_refused(Refusal::kBadInstance, "globals that are free",
                 [](Image& i) { i.instances[0].live = false; });
  expect_refused(Refusal::kBadInstance, "globals with code",
                 [](Image& i) { i.instances[0].pou = kMainPou; });
  // What was prepared for a change looks at rows before it asks whether they are live.
  expect_refused(Refusal::kBadInstance, "a free ID without a type",
                 [](Image& i) { i.instances[6].type = {}; });
  expect_refused(Refusal::kBadInstance, "a free ID with an area",
                 [](Image& i) { i.instances[6].data = 448; });
  expect_refused(Refusal::kBadInstance, "a free ID with code",
                 [](Image& i) { i.instances[6].pou = 1u << 30; });
  expect_refused(Refusal::kBadInstance, "a free ID with a parent",
                 [](Image& i) { i.instances[6].parent = 1u << 30; });
  expect_refused(Refusal::kBadInstance, "a program below an instance",
                 [](Image& i) { i.instances[kMainInstance].parent = 5; });
  expect_refused(Refusal::kBadInstance, "an instance that no slot names", [](Image& i) {
    i.instances[6] = i.instances[2];
    i.instances[6].data = 448;
  });
  expect_refused(Refusal::kBadInstance, "the code of another type",
                 [](Image& i) { i.instances[2].pou = kMainPou; });
  expect_refused(Refusal::kBadInstance, "an in-out that starts bound", [](Image& i) {
    i.data.push_back({384 + kIo, {0, 1, 0, 0}});
  });
  expect_refused(Refusal::kBadInstance, "no globals", [](Image& i) { i.instances.clear(); });
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

TEST(Verify, V15_Tasks) {
  expect_refused(Refusal::kBadTask, "none", [](Image& i) { i.tasks.clear(); });
  expect_refused(Refusal::kBadTask, "no period", [](Image& i) { i.tasks[0].period_ns = 0; });
  expect_refused(Refusal::kBadTask, "no watchdog", [](Image& i) { i.tasks[0].watchdog_ns = 0; });
  expect_refused(Refusal::kBadTask, "no program", [](Image& i) { i.tasks[0].programs = {999}; });
  expect_refused(Refusal::kBadTask, "the globals", [](Image& i) { i.tasks[0].programs = {0}; });
  expect_refused(Refusal::kBadTask, "a program in two tasks",
                 [](Image& i) { i.tasks.push_back(i.tasks[0]); });
  expect_refused(Refusal::kBadTask, "a cycle of 1 us", [](Image& i) {
    i.tasks.push_back({"Slow", 10'001'000, 100'000'000, 1, 0, {}});
  });
  expect_refused(Refusal::kBadTask, "a cycle that is shorter than the least",
                 [](Image& i) { i.tasks[0].period_ns = base::kMinBaseCycleNs - 1; });
  Image least = sample::busy_image();
  least.tasks[0].period_ns = base::kMinBaseCycleNs;
  EXPECT_TRUE(ir::verify(ir::encode(least)).ok());
  expect_refused(Refusal::kBadTask, "a freewheeling task with a period",
                 [](Image& i) { i.tasks[0].policy.freewheeling = true; });
  expect_refused(Refusal::kBadTask, "synchronous without a period", [](Image& i) {
    i.tasks[0].period_ns = 0;
    i.tasks[0].policy.freewheeling = true;
    i.tasks[0].policy.io = ir::TaskIo::kSynchronous;
  });
  expect_refused(Refusal::kBadTask, "a freewheeling task that is late", [](Image& i) {
    i.tasks[0].period_ns = 0;
    i.tasks[0].policy.freewheeling = true;
    i.tasks[0].policy.overrun = ir::Overrun::kAtOnce;
  });
  expect_refused(Refusal::kBadTask, "a freewheeling task that lengthens cycles", [](Image& i) {
    i.tasks[0].period_ns = 0;
    i.tasks[0].policy.freewheeling = true;
    i.tasks[0].policy.overrun = ir::Overrun::kLengthen;
  });
  expect_refused(Refusal::kBadTask, "at once with inputs of its period", [](Image& i) {
    i.tasks[0].policy.io = ir::TaskIo::kSynchronous;
    i.tasks[0].policy.overrun = ir::Overrun::kAtOnce;
  });
  Image fine = sample::busy_image();
  fine.tasks[0].policy.overrun = ir::Overrun::kAtOnce;
  EXPECT_TRUE(ir::verify(ir::encode(fine)).ok());
  fine.tasks[0].policy = {.io = ir::TaskIo::kSynchronous, .overrun = ir::Overrun::kLengthen};
  EXPECT_TRUE(ir::verify(ir::encode(fine)).ok());
}

TEST(Verify, V14_SafeOutputs) {
  const auto refuse = [](const char* what, std::vector<ir::SafeOutput> rows) {
    expect_refused(Refusal::kBadIoAccess, what, [&](Image& i) { i.safe = std::move(rows); });
  };
  constexpr auto kValue = ir::SafeKind::kValue;
  refuse("behind the outputs", {{8, 1, kValue, 1, 0}});
  refuse("no bits", {{0, 0, kValue, 0, 0}});
  refuse("two bits", {{0, 2, kValue, 0, 0}});
  refuse("a byte across two", {{1, 8, kValue, 0, 0}});
  refuse("more bytes than there are", {{0, 64, kValue, 0, 0}});
  refuse("a value that is too large", {{0, 1, kValue, 2, 0}});
  refuse("a negative hold", {{0, 1, ir::SafeKind::kHoldThenValue, 1, -1}});
  refuse("twice the same", {{0, 1, kValue, 1, 0}, {0, 1, kValue, 1, 0}});
  refuse("not sorted", {{1, 1, kValue, 1, 0}, {0, 1, kValue, 1, 0}});
}

TEST(Verify, V16_Retain) {
  expect_refused(Refusal::kBadRetain, "outside", [](Image& i) { i.retain[0].data = 2000; });
  expect_refused(Refusal::kBadRetain, "in free space", [](Image& i) { i.retain[0].data = 600; });
  expect_refused(Refusal::kBadRetain, "beyond its area", [](Image& i) { i.retain[0].size = 65; });
}

// What is exchanged with other resources is a plain variable, once.
TEST(Verify, SharedGlobals) {
  const auto refuse = [](const char* what, std::vector<ir::SharedGlobal> rows) {
    expect_refused(Refusal::kBadSharedGlobal, what, [&](Image& i) { i.shared = rows; });
  };
  refuse("there are five globals", {{5, false}});
  refuse("far outside", {{UINT32_MAX, false}});
  refuse("an input", {{1, false}});
  refuse("an output", {{2, true}});
  refuse("a constant", {{3, false}});
  refuse("a function block", {{4, true}});
  refuse("twice the same", {{0, true}, {0, true}});
}

TEST(Verify, V18_Memory) {
  expect_refused(Refusal::kTooLarge, "data memory",
                 [](Image& i) { i.data_capacity = base::kMaxDataBytes + 1; });
  expect_refused(Refusal::kTooLarge, "stack",
                 [](Image& i) { i.stack_bytes = ir::kStackLimit + 1; });
  expect_refused(Refusal::kTooLarge, "depth",
                 [](Image& i) { i.call_depth = base::kMaxCallDepth + 1; });
  expect_refused(Refusal::kTooLarge, "constants",
                 [](Image& i) { i.pool.resize(ir::kConstPoolLimit + 1); });
  expect_refused(Refusal::kTooLarge, "tasks",
                 [](Image& i) { i.tasks.resize(base::kMaxTasks + 1, i.tasks[0]); });
  // Each task has copies of the process image.
  expect_refused(Refusal::kTooLarge, "inputs",
                 [](Image& i) { i.input_bytes = base::kMaxDeviceBytes + 1; });
  expect_refused(Refusal::kTooLarge, "outputs",
                 [](Image& i) { i.output_bytes = base::kMaxDeviceBytes + 1; });
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
