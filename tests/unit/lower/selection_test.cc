#include "tests/unit/lower/lowered.h"

namespace ir {
namespace {

constexpr std::string_view kBools = R"(  member local a : BOOL
  member local b : BOOL
  member local c : BOOL
  member local x : BOOL
  member local i : INT
  member local j : INT
  member local r : REAL
)";

TEST(Selection, FoldsMembersAndNotIntoTwoInstructions) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load bool self.a
    v1 = load bool self.b
    v2 = not bool v1
    v3 = and bool v0, v2
    v4 = load bool self.c
    v5 = or bool v3, v4
    store bool self.x, v5
    return
)"),
            "ANDN_B f0, s:a, s:b\nOR_B s:x, f0, s:c\nRET\n");
}

TEST(Selection, FoldsNotOfTheLeftOperandToo) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load bool self.a
    v1 = not bool v0
    v2 = load bool self.b
    v3 = or bool v1, v2
    store bool self.x, v3
    return
)"),
            "ORN_B s:x, s:b, s:a\nRET\n");
}

TEST(Selection, ReadsALoadBeforeItsPlaceIsOverwritten) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load i16 self.i
    v1 = load i16 self.j
    store i16 self.i, v1
    store i16 self.j, v0
    return
)"),
            "MOV_16 f0, s:i\nMOV_16 s:i, s:j\nMOV_16 s:j, f0\nRET\n");
}

TEST(Selection, ComputesATreeBeforeOneOfItsLeavesIsOverwritten) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load i16 self.i
    v1 = load i16 self.j
    v2 = add i16 v0, v1
    v3 = const i16 7
    store i16 self.i, v3
    store i16 self.j, v2
    return
)"),
            "ADD_16 f0, s:i, s:j\nMOV_16 s:i, #7\nMOV_16 s:j, f0\nRET\n");
}

TEST(Selection, ReadsALoadOfSeveralUsesFromItsPlaceEachTime) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load i16 self.i
    v1 = add i16 v0, v0
    store i16 self.j, v1
    return
)"),
            "ADD_16 s:j, s:i, s:i\nRET\n");
}

TEST(Selection, PutsConstantsSecondAndTurnsComparisonsRound) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = const i16 5
    v1 = load i16 self.i
    v2 = add i16 v0, v1
    store i16 self.j, v2
    v3 = lt i16 v0, v1
    store bool self.x, v3
    v4 = load i16 self.j
    v5 = le i16 v4, v0
    v6 = not bool v5
    store bool self.a, v6
    return
)"),
            "ADD_16 s:j, s:i, #5\n"
            "GT_I16 f0, s:i, #5\nMOV_B s:x, f0\n"
            "GT_I16 f0, s:j, #5\nMOV_B s:a, f0\nRET\n");
}

TEST(Selection, KeepsTheOrderOfFloatsUnderNot) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load f32 self.r
    v1 = const f32 2.5
    v2 = lt f32 v0, v1
    v3 = not bool v2
    store bool self.x, v3
    return
)"),
            "MOV_F32 f0, #1075838976\nLT_F32 f1, s:r, f0\nNOT_B s:x, f1\nRET\n");
}

TEST(Selection, BranchesOnMembersAndSwapsForNot) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load bool self.a
    v1 = not bool v0
    branch v1, b1, b2
  b1:
    v2 = const i16 1
    store i16 self.i, v2
    jump b2
  b2:
    return
)"),
            "JT s:a, -> 2\nMOV_16 s:i, #1\nRET\n");
}

TEST(Selection, LoopsBackwardsWithLoopOnly) {
  const Program program = parsed(main_with(kBools, R"(  b0:
    v0 = const i16 0
    jump b1(v0)
  b1(v1:i16):
    v2 = const i16 10
    v3 = lt i16 v1, v2
    branch v3, b2, b3
  b2:
    v4 = load i16 self.i
    v5 = add i16 v4, v1
    store i16 self.i, v5
    v6 = const i16 1
    v7 = add i16 v1, v6
    jump b1(v7)
  b3:
    return
)"));
  const Object object = lowered(program, "Main");
  EXPECT_EQ(disassemble(object, program),
            "Main:\n"
            "  0: MOV_16 f0, #0\n"
            "@1 has f0\n"
            "  1: LT_I16 f1, f0, #10\n"
            "  2: JF f1, -> 6\n"
            "  3: ADD_16 s:i, s:i, f0\n"
            "  4: ADD_16 f0, f0, #1\n"
            "  5: LOOP -> 1\n"
            "@6 has\n"
            "  6: RET\n");
}

TEST(Selection, ExchangesBlockParametersThroughATemporary) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load i16 self.i
    v1 = load i16 self.j
    jump b1(v0, v1)
  b1(v2:i16, v3:i16):
    store i16 self.i, v2
    v4 = lt i16 v2, v3
    branch v4, b1(v3, v2), b2
  b2:
    return
)"),
            "MOV_16 f0, s:i\nMOV_16 f1, s:j\n"
            "MOV_16 s:i, f0\nLT_I16 f2, f0, f1\nJF f2, -> 9\n"
            "MOV_16 f3, f0\nMOV_16 f0, f1\nMOV_16 f1, f3\nLOOP -> 2\nRET\n");
}

TEST(Selection, KeepsTrapsBeforeStores) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load i16 self.i
    v1 = load i16 self.j
    v2 = div i16 v0, v1
    v3 = const i16 3
    store i16 self.i, v3
    store i16 self.j, v2
    return
)"),
            "DIV_I16 f0, s:i, s:j\nMOV_16 s:i, #3\nMOV_16 s:j, f0\nRET\n");
}

TEST(Selection, ChecksAndConvertsWithoutCopies) {
  EXPECT_EQ(main_code("  member local i : INT\n  member local w : WORD\n  member local p : %25\n",
                      R"(  b0:
    v0 = load i16 self.i
    v1 = wrap u16 v0
    store u16 self.w, v1
    v2 = check_range i16 v0, 0..100
    store i16 self.p, v2
    return
)",
                      "type %25 = subrange INT 0..100\n"),
            "MOV_16 s:w, s:i\nCHECK_I16 s:i, 0..100\nMOV_16 s:p, s:i\nRET\n");
}

TEST(Selection, ConvertsBoolsToWideIntegersInTwoSteps) {
  EXPECT_EQ(main_code("  member local b : BOOL\n  member local d : DINT\n", R"(  b0:
    v0 = load bool self.b
    v1 = wrap i32 v0
    store i32 self.d, v1
    return
)"),
            "B_TO_8 f0, s:b\nZEXT_8_32 f1, f0\nMOV_32 s:d, f1\nRET\n");
}

TEST(Selection, SelectsWithAConditionalMove) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load bool self.a
    v1 = load i16 self.i
    v2 = load i16 self.j
    v3 = select i16 v0, v1, v2
    store i16 self.i, v3
    return
)"),
            "MOV_16 f0, s:i\nCMOV_16 f0, s:a, s:j\nMOV_16 s:i, f0\nRET\n");
}

TEST(Selection, DropsUnreachableBlocksAndUnusedValues) {
  EXPECT_EQ(main_code(kBools, R"(  b0:
    v0 = load i16 self.i
    v1 = add i16 v0, v0
    return
  b1:
    return
)"),
            "RET\n");
}

TEST(Selection, MergesNameTheLocalsThatAreReadLater) {
  const Program program = parsed(main_with(kBools, "  b0:\n    return\n", "", R"(pou function Pick
  local input up : BOOL
  local return Pick : INT
  local temp unread : INT
  local temp k : INT
  b0:
    init local.Pick
    init local.unread
    init local.k
    v0 = load bool local.up
    branch v0, b1, b2
  b1:
    v1 = const i16 4
    store i16 local.k, v1
    jump b2
  b2:
    v2 = load i16 local.k
    store i16 local.Pick, v2
    return
)"));
  EXPECT_EQ(disassemble(lowered(program, "Pick"), program),
            "Pick:\n"
            "  0: MOV_16 f:Pick, #0\n  1: MOV_16 f:unread, #0\n  2: MOV_16 f:k, #0\n"
            "  3: JF f:up, -> 5\n  4: MOV_16 f:k, #4\n"
            "@5 has f:k\n"
            "  5: MOV_16 f:Pick, f:k\n  6: RET\n");
}

TEST(Selection, MergesNameLocalsWhoseAddressWasTaken) {
  const Program program = parsed(main_with(kBools, "  b0:\n    return\n", "", R"(pou function Far
  local input up : BOOL
  local temp k : INT
  b0:
    init local.k
    v0 = address addr local.k
    v1 = load bool local.up
    branch v1, b1, b2
  b1:
    v2 = const i16 4
    store i16 pointee(v0 : INT), v2
    jump b2
  b2:
    return
)"));
  const Object object = lowered(program, "Far");
  ASSERT_EQ(object.merges.size(), 1u);
  EXPECT_EQ(object.merges[0].slots, std::vector<uint16_t>{1});
}

TEST(Selection, RefusesMoreConstantsThanAFieldCanName) {
  std::string body = "  b0:\n";
  for (int i = 0; i < 66'000; ++i) {
    const std::string v = "v" + std::to_string(i);
    body +=
        "    " + v + " = const i32 " + std::to_string(i) + "\n    store i32 self.d, " + v + "\n";
  }
  const Program program = parsed(main_with("  member local d : DINT\n", body + "    return\n"));
  const base::Result<Object> object = lower(program, program.find_pou("Main"));
  ASSERT_FALSE(object.ok());
  EXPECT_EQ(object.error().refusal, base::Refusal::kTooMany);
}

TEST(Selection, LimitsTheDepthOfATree) {
  std::string body = "  b0:\n    v0 = load bool self.a\n";
  for (int i = 1; i < 50'000; ++i) {
    body += "    v" + std::to_string(i) + " = not bool v" + std::to_string(i - 1) + "\n";
  }
  body += "    store bool self.x, v49999\n    return\n";
  EXPECT_TRUE(lower(parsed(main_with(kBools, body)), PouId(0)).ok());
}

TEST(Selection, IsDeterministic) {
  const std::string text = main_with(kBools, R"(  b0:
    v0 = load i16 self.i
    v1 = add i16 v0, v0
    store i16 self.j, v1
    return
)");
  const Program first = parsed(text);
  const Program second = parsed(text);
  EXPECT_EQ(canonical_bytes(lowered(first, "Main"), first),
            canonical_bytes(lowered(second, "Main"), second));
}

}  // namespace
}  // namespace ir
