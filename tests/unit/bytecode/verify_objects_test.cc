// The verifier's rules about objects and tries: the accepted sample with one thing changed.
#include <gtest/gtest.h>

#include <functional>

#include "base/limits.h"
#include "ir/bytecode/verify.h"
#include "tests/unit/bytecode/sample_objects.h"

namespace {

using namespace sample;
using base::Refusal;
using ir::Image;

std::string outcome(const Image& image) {
  const auto verified = ir::verify(ir::encode(image));
  return verified ? "accepted" : base::to_string(verified.error());
}

void expect_refused(Refusal refusal, const char* what, const std::function<void(Image&)>& change) {
  Image image = busy_object_image();
  change(image);
  const auto verified = ir::verify(ir::encode(image));
  ASSERT_FALSE(verified.ok()) << what;
  EXPECT_EQ(verified.error().refusal, refusal) << what << ": " << verified.error().text;
}

void expect_code(const char* what, const Code& code, std::vector<ir::Merge> merges = {}) {
  EXPECT_EQ(outcome(object_image(code, std::move(merges))), "accepted") << what;
}
void expect_code_refused(Refusal refusal, const char* what, const Code& code,
                         std::vector<ir::Merge> merges = {}) {
  const auto verified = ir::verify(ir::encode(object_image(code, std::move(merges))));
  ASSERT_FALSE(verified.ok()) << what;
  EXPECT_EQ(verified.error().refusal, refusal) << what << ": " << verified.error().text;
}

const Code kRet = op(Opcode::RET);
const uint32_t kInt = static_cast<uint32_t>(ir::Kind::kInt);

TEST(VerifyObjects, TheSampleIsAccepted) { EXPECT_EQ(outcome(busy_object_image()), "accepted"); }

TEST(VerifyObjects, V1_WhatExtendsABlockBeginsAsTheBlock) {
  const auto derived = [](Image& i) -> ir::Type& {
    return i.types.own().edit(object_types(i).derived);
  };
  expect_refused(Refusal::kBadFormat, "no block as base",
                 [&](Image& i) { derived(i).base = ir::TypeId(kInt); });
  expect_refused(Refusal::kBadFormat, "no type as base",
                 [&](Image& i) { derived(i).base = ir::TypeId(999); });
  expect_refused(Refusal::kBadFormat, "extends itself",
                 [&](Image& i) { derived(i).base = object_types(i).derived; });
  expect_refused(Refusal::kBadFormat, "no interface",
                 [&](Image& i) { derived(i).interfaces = {object_types(i).base}; });
  expect_refused(Refusal::kBadFormat, "no type as interface",
                 [&](Image& i) { derived(i).interfaces = {ir::TypeId(999)}; });
  expect_refused(Refusal::kBadFormat, "a program that implements something", [&](Image& i) {
    i.types.own().edit(object_types(i).main).interfaces = {object_types(i).adder};
  });
  expect_refused(Refusal::kBadFormat, "a member of the base is missing", [&](Image& i) {
    i.types.own().edit(object_types(i).base).members.resize(3, derived(i).members[1]);
    i.layouts.own().of[object_types(i).base.index].member_offsets = {0, 2, 4};
  });
  expect_refused(Refusal::kBadFormat, "another name",
                 [&](Image& i) { derived(i).members[0].name = "m"; });
  expect_refused(Refusal::kBadFormat, "another type", [&](Image& i) {
    derived(i).members[0].type = i.types.elementary(ir::Kind::kUint);
  });
  expect_refused(Refusal::kBadFormat, "another section",
                 [&](Image& i) { derived(i).members[0].section = ir::Section::kOutput; });
  expect_refused(Refusal::kBadFormat, "a constant",
                 [&](Image& i) { derived(i).members[0].constant = true; });
  expect_refused(Refusal::kBadFormat, "another address", [&](Image& i) {
    derived(i).members[0].address = {ir::DirectArea::kInput, 0, 16};
  });
  expect_refused(Refusal::kBadFormat, "another offset", [&](Image& i) {
    i.layouts.own().of[object_types(i).derived.index].member_offsets[0] = 2;
  });
}

TEST(VerifyObjects, V1_NothingIsAnInterfaceAndProgramsAreInTheGlobalsOnly) {
  expect_refused(Refusal::kBadFormat, "an interface as member", [](Image& i) {
    i.types.own().edit(object_types(i).main).members[2].type = object_types(i).adder;
  });
  expect_refused(Refusal::kBadFormat, "a program as member of a block", [](Image& i) {
    i.types.own().edit(object_types(i).derived).members[1].type = object_types(i).main;
  });
  expect_refused(Refusal::kBadFormat, "an array of programs", [](Image& i) {
    i.types.own().array(object_types(i).main, {{1, 2}});
    i.layouts.own().of.resize(i.types.size());
    i.layouts.own().of.back().size = 8;
  });
  expect_refused(Refusal::kBadFormat, "an interface with a size",
                 [](Image& i) { i.layouts.own().of[object_types(i).adder.index].size = 4; });
  expect_code_refused(
      Refusal::kBadReference, "the address of an interface",
      ext(Opcode::LEA, F(kAddr), C(0), {}, 0, object_types(busy_object_image()).adder.index) +
          kRet);
}

// A global of program type: the ID of a live instance of that type.
TEST(VerifyObjects, V13_ProgramsAmongTheGlobals) {
  const auto with_global = [](uint32_t id) {
    Image image = busy_object_image();
    ir::Member main;
    main.name = "Main";
    main.type = object_types(image).main;
    image.types.own().edit(image.globals).members = {main};
    image.layouts.own().of[image.globals.index].member_offsets = {0};
    image.data.insert(image.data.begin(), {64, {static_cast<uint8_t>(id), 0, 0, 0}});
    return outcome(image);
  };
  EXPECT_EQ(with_global(1), "accepted");
  for (const uint32_t id : {0u, 2u, 3u, 9u}) {
    EXPECT_EQ(with_global(id).substr(0, 5), "R0113") << id << " " << with_global(id);
  }
}

TEST(VerifyObjects, V12_OverridesFit) {
  expect_refused(Refusal::kBadFormat, "out of order",
                 [](Image& i) { std::swap(i.overrides[1], i.overrides[2]); });
  expect_refused(Refusal::kBadFormat, "twice",
                 [](Image& i) { i.overrides[2].prototype = kAdderAdd; });
  expect_refused(Refusal::kBadReference, "of a program",
                 [](Image& i) { i.overrides[2].type = object_types(i).main; });
  expect_refused(Refusal::kBadReference, "of no type",
                 [](Image& i) { i.overrides[2].type = ir::TypeId(999); });
  expect_refused(Refusal::kBadCall, "no POU", [](Image& i) { i.overrides[2].target = 99; });
  expect_refused(Refusal::kBadCall, "a body",
                 [](Image& i) { i.overrides[2].target = kDerivedBody; });
  expect_refused(Refusal::kBadCall, "a body as prototype",
                 [](Image& i) { i.overrides[2].prototype = kDerivedBody; });
  expect_refused(Refusal::kBadCall, "a method of what extends the type",
                 [](Image& i) { i.overrides[0].target = kDerivedAdd; });
  expect_refused(Refusal::kBadCall, "a method of an interface",
                 [](Image& i) { i.overrides[1].target = kAdderAdd; });
  expect_refused(Refusal::kBadCall, "a prototype of which the type is not", [](Image& i) {
    i.overrides = {{object_types(i).base, kAdderAdd, kBaseAdd}};
  });
  const auto with_slots = [](const char* what, const std::function<void(ir::LinkedPou&)>& change) {
    expect_refused(Refusal::kBadCall, what, [&](Image& i) {
      i.pous[kDerivedAdd].slots.push_back(i.pous[kDerivedAdd].slots[1]);
      i.pous[kDerivedAdd].slots[2].offset = 4;
      i.pous[kDerivedAdd].slots[2].kind = ir::SlotKind::kTemp;
      change(i.pous[kDerivedAdd]);
    });
  };
  with_slots("one parameter more", [](auto& pou) {
    pou.slots[2].kind = ir::SlotKind::kParam;
    pou.slots[2].local = ir::LocalKind::kInput;
  });
  with_slots("one parameter less", [](auto& pou) { pou.slots[1].kind = ir::SlotKind::kTemp; });
  with_slots("at another place", [](auto& pou) {
    pou.slots[1].offset = 4;
    pou.slots[2].offset = 6;
  });
  with_slots("of another kind", [](auto& pou) { pou.slots[0].local = ir::LocalKind::kOutput; });
  with_slots("of another class", [](auto& pou) {
    pou.slots[0].cls = Class::k8;
    pou.slots[0].region.type = ir::TypeId(static_cast<uint32_t>(ir::Kind::kSint));
  });
}

TEST(VerifyObjects, V12_CallsOfMethodsFit) {
  expect_code("a base's method",
              argument() + call_slot(Opcode::CALL_METHOD, S(kDerivedSlot), kBaseAdd) + kRet);
  expect_code_refused(
      Refusal::kBadCall, "a method of what extends the type",
      argument() + call_slot(Opcode::CALL_METHOD, S(kBaseSlot), kDerivedAdd) + kRet);
  expect_code_refused(
      Refusal::kBadCall, "a method of an interface",
      argument() + call_slot(Opcode::CALL_METHOD, S(kDerivedSlot), kAdderAdd) + kRet);
  expect_code_refused(Refusal::kBadCall, "a body as method",
                      call_slot(Opcode::CALL_METHOD, S(kDerivedSlot), kBaseBody) + kRet);
  expect_code_refused(Refusal::kBadCall, "no POU",
                      argument() + call_slot(Opcode::CALL_METHOD, S(kDerivedSlot), 99) + kRet);
  expect_code_refused(Refusal::kBadReferenceSlot, "no slot",
                      argument() + call_slot(Opcode::CALL_METHOD, S(kObjectX), kBaseAdd) + kRet);
  expect_code_refused(Refusal::kBadCall, "an argument is missing",
                      call_slot(Opcode::CALL_METHOD, S(kDerivedSlot), kBaseAdd) + kRet);
  expect_code_refused(
      Refusal::kBadCall, "the own instance has no such method",
      argument() + op(Opcode::CALL_OWN, F(kObjectNext / 8), {}, F(kBaseAdd)) + kRet);
  expect_code_refused(Refusal::kBadCall, "a method called as function",
                      argument() + op(Opcode::CALL, F(kObjectNext / 8), {}, F(kBaseAdd)) + kRet);
  for (const Opcode opcode : {Opcode::CALL_METHOD_REF, Opcode::CALL_VIRTUAL}) {
    expect_code_refused(Refusal::kBadCall, "an argument is missing",
                        call_handle(opcode, kBaseAdd) + kRet);
    expect_code_refused(Refusal::kBadCall, "a body",
                        argument() + call_handle(opcode, kBaseBody) + kRet);
    expect_code_refused(Refusal::kBadCall, "no POU", argument() + call_handle(opcode, 99) + kRet);
    expect_code_refused(Refusal::kBadFrame, "another frame",
                        argument() + ext(opcode, F(1), S(kObjectRef), {}, kBaseAdd, 0) + kRet);
    expect_code_refused(
        Refusal::kBadTyping, "no handle",
        argument() + ext(opcode, F(kObjectNext / 8), F(kW), {}, kBaseAdd, 0) + kRet);
  }
  expect_code_refused(Refusal::kBadCall, "a method of an interface by reference",
                      argument() + call_handle(Opcode::CALL_METHOD_REF, kAdderAdd) + kRet);
  expect_code_refused(Refusal::kBadReference, "the type of nothing",
                      ext(Opcode::IS_TYPE, F(kB), S(kObjectRef), {}, kInt, 0) + kRet);
  expect_code_refused(Refusal::kBadTyping, "the answer is BOOL",
                      ext(Opcode::IS_TYPE, F(kW), S(kObjectRef), {},
                          object_types(busy_object_image()).base.index, 0) +
                          kRet);
}

TEST(VerifyObjects, V11_VirtualCallsHaveNoCircle) {
  Image image = busy_object_image();
  image.pous[kBaseAdd].frame_size = 16;
  image.pous[kBaseAdd].slots.push_back(image.pous[kBaseAdd].slots[0]);
  image.pous[kBaseAdd].slots[2].offset = 8;
  image.pous[kBaseAdd].slots[2].cls = Class::k64;
  image.pous[kBaseAdd].slots[2].region = {};
  image.pous[kBaseAdd].slots[2].kind = ir::SlotKind::kTemp;
  set_code(image, kBaseAdd,
           ext(Opcode::HANDLE, F(8), S(0), {}, 0, 0) + op(Opcode::MOV_16, F(16), F(0)) +
               ext(Opcode::CALL_VIRTUAL, F(2), F(8), {}, kBaseAdd, 0) +
               op(Opcode::MOV_16, F(2), F(16 + 2)) + kRet);
  EXPECT_NE(outcome(image).find("`Base.add` is in a circle of calls"), std::string::npos)
      << outcome(image);
  image.pous[kBaseAdd].recursion_depth = 3;
  EXPECT_EQ(outcome(image), "accepted");
}

TEST(VerifyObjects, V12_BodiesHaveNoParameters) {
  expect_refused(Refusal::kBadFrame, "a parameter of a program",
                 [](Image& i) { i.pous[kObjectMain].slots[0].kind = ir::SlotKind::kParam; });
}

// What is put into the next frame before a trap must not serve the code behind it.
TEST(VerifyObjects, V12_NoTrapBetweenAnArgumentAndItsCall) {
  expect_code_refused(Refusal::kBadCall, "a trap",
                      op(Opcode::MOV_B, F(kB), C(kOne16)) + jump(Opcode::JT, 2, F(kB)) +
                          argument() + op(Opcode::TRAP, F(1)) +
                          call_slot(Opcode::CALL_METHOD, S(kBaseSlot), kBaseAdd) + kRet,
                      {{4, {}}});
}

// --- tries -------------------------------------------------------------------------

const Code kTrap = op(Opcode::TRAP, F(1));
const Code kEnd = op(Opcode::END_TRY);

TEST(VerifyObjects, V4_TriesNest) {
  expect_code("two ways", jump(Opcode::TRY, 2) + kEnd + kRet + kRet, {{3, {}}});
  expect_code_refused(Refusal::kBadJump, "open at the return", jump(Opcode::TRY, 1) + kRet + kRet,
                      {{2, {}}});
  expect_code_refused(Refusal::kBadJump, "none is open", kEnd + kRet);
  expect_code_refused(Refusal::kBadJump, "other tries at a merge",
                      op(Opcode::MOV_B, F(kB), C(kOne16)) + jump(Opcode::JT, 1, F(kB)) +
                          jump(Opcode::TRY, 2) + kEnd + kRet + kRet,
                      {{3, {}}, {5, {}}});
  expect_code_refused(Refusal::kBadJump, "the body runs into the handler",
                      jump(Opcode::TRY, 0) + kRet, {{1, {}}});
  expect_code_refused(Refusal::kNoFuel, "a handler before its try",
                      op(Opcode::MOV_B, F(kB), C(kOne16)) + jump(Opcode::JT, 1, F(kB)) + kTrap +
                          jump(Opcode::TRY, -2) + kTrap,
                      {{2, {}}, {3, {}}});
  expect_code_refused(Refusal::kBadJump, "a loop opens one more each turn",
                      jump(Opcode::TRY, 1) + jump(Opcode::LOOP, -2) + kRet, {{0, {}}, {2, {}}});
  expect_code_refused(Refusal::kBadJump, "the handler is no merge",
                      jump(Opcode::TRY, 1) + kTrap + kRet);
}

TEST(VerifyObjects, V11_TriesNestToADepth) {
  const auto nested = [](uint32_t depth) {
    Code code;
    std::vector<ir::Merge> merges;
    for (uint32_t i = 0; i < depth; ++i)
      code = code + jump(Opcode::TRY, static_cast<int32_t>(depth));
    code = code + kTrap;
    for (uint32_t i = 0; i < depth; ++i) {
      merges.push_back({depth + 1 + i, {}});
      code = code + (i + 1 < depth ? kTrap : kRet);
    }
    // The innermost handler comes first.
    for (uint32_t i = 0; i < depth; ++i) {
      code[i].set_bc(2 * (depth - i) - 1);
    }
    return outcome(object_image(code, merges));
  };
  EXPECT_EQ(nested(base::kMaxTryDepth), "accepted");
  EXPECT_EQ(nested(base::kMaxTryDepth + 1).substr(0, 5), "R0111");
}

// What holds at the TRY holds at the handler, whatever the body did.
TEST(VerifyObjects, V9_HandlersHaveWhatTheirTryHad) {
  const Code lea = ext(Opcode::LEA, F(kAddr), S(0), {}, kObjectX, kInt);
  const Code store = op(Opcode::ST_16, F(kAddr), C(kOne16), F(0));
  expect_code("from before", lea + jump(Opcode::TRY, 2) + kEnd + kRet + store + kRet,
              {{5, {kSlotAddr}}});
  expect_code_refused(Refusal::kBadTyping, "written in the body",
                      jump(Opcode::TRY, 4) + lea + kEnd + kRet + store + kRet, {{5, {kSlotAddr}}});
  expect_code_refused(Refusal::kReadBeforeWrite, "not promised",
                      lea + jump(Opcode::TRY, 2) + kEnd + kRet + store + kRet, {{5, {}}});
  const Code constant = ext(Opcode::LEA, F(kAddr), C(0), {}, kFour16, kInt);
  expect_code_refused(Refusal::kBadTyping, "an address of a constant takes its place",
                      lea + jump(Opcode::TRY, 4) + constant + kEnd + kRet + store + kRet,
                      {{7, {kSlotAddr}}});
  expect_code_refused(Refusal::kBadTyping, "an address of the next frame takes its place",
                      lea + jump(Opcode::TRY, 4) +
                          ext(Opcode::LEA, F(kAddr), F(0), {}, kParamX, kInt) + kEnd + kRet +
                          store + kRet,
                      {{7, {kSlotAddr}}});
  // Results of a call are gone.
  expect_code_refused(Refusal::kReadBeforeWrite, "a result",
                      argument() + call_slot(Opcode::CALL_METHOD, S(kBaseSlot), kBaseAdd) +
                          jump(Opcode::TRY, 2) + kEnd + kRet +
                          op(Opcode::MOV_16, S(kObjectX), F(kParamR)) + kRet,
                      {{6, {}}});
}

TEST(VerifyObjects, V14_StartTasksHaveNoPeriod) {
  const auto once = [](int64_t period, uint32_t event) {
    Image image = busy_object_image();
    image.tasks.push_back({"Start", period, 1000, 0, event, {}, true});
    return outcome(image);
  };
  EXPECT_EQ(once(0, 0), "accepted");
  EXPECT_EQ(once(5, 0).substr(0, 5), "R0115");
  EXPECT_EQ(once(0, 64).substr(0, 5), "R0115");
}

}  // namespace
