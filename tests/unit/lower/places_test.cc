#include "tests/unit/lower/lowered.h"

namespace ir {
namespace {

constexpr std::string_view kTypes = R"(type %25 = string 10
type %26 = array INT [1..3, 0..1]
type Motor = struct
  member local speed : INT
  member local table : %26
type %28 = array Motor [0..9]
type Counter = function_block
  member input up : BOOL
  member in_out total : DINT
  member output count : INT
type %30 = array Counter [0..1]
const #0 = 'abc'
)";
constexpr std::string_view kMembers = R"(  member local first : Counter
  member local many : %30
  member local text : %25
  member local i : INT
  member local n : DINT
  member local motors : %28
  member local table : %26
)";
constexpr std::string_view kCounter = R"(pou function_block Counter self Counter
  b0:
    v0 = load i32 self.total^
    v1 = const i32 1
    v2 = add i32 v0, v1
    store i32 self.total^, v2
    return
)";

std::string code(std::string_view body, std::string_view more = "") {
  return main_code(kMembers, body, kTypes, std::string(kCounter) + std::string(more));
}

TEST(Places, UsesOneInstanceAddressForInputsCallAndOutputs) {
  EXPECT_EQ(code(R"(  b0:
    v0 = const bool TRUE
    store bool self.first!.up, v0
    v1 = address addr self.n
    store addr self.first!.total, v1
    call_instance self.first
    v2 = load i16 self.first!.count
    store i16 self.i, v2
    return
)"),
            "INST f0, s:first\nST_B f0, #1, +up\n"
            "LEA f1, s:n, DINT\nST_REF_AT f0, f1, +total\n"
            "CALL_INST s:first\nLD_16 f2, f0, +count\nMOV_16 s:i, f2\nRET\n");
}

TEST(Places, DereferencesInOutsOfTheInstanceOnce) {
  const Program program = parsed(main_with(kMembers, "  b0:\n    return\n", kTypes, kCounter));
  const std::string text = disassemble(lowered(program, "Counter"), program);
  EXPECT_EQ(text,
            "Counter:\n  0: LD_REF f0, s:total\n  1: LD_32 f1, f0, +\n"
            "  2: ADD_32 f1, f1, #1\n  3: ST_32 f0, f1, +\n  4: RET\n");
}

TEST(Places, IndexesByPlaceFirstAndFoldsConstantSteps) {
  EXPECT_EQ(code(R"(  b0:
    v0 = load i16 self.i
    v1 = load i16 self.motors[v0].table[2][1]
    store i16 self.motors[3].table[1][0], v1
    return
)"),
            "INDEX_PLACE_I16 f0, s:i, bounds of motors dim 0, s:motors\n"
            "LD_16 f1, f0, +table[2][1]\nMOV_16 s:motors[3].table[1][0], f1\nRET\n");
}

TEST(Places, IndexesBehindAnAddressAndReusesIt) {
  EXPECT_EQ(code(R"(  b0:
    v0 = load i16 self.i
    v1 = load i16 self.motors[v0].table[2][v0]
    v2 = const i16 1
    v3 = add i16 v1, v2
    store i16 self.motors[v0].table[2][v0], v3
    return
)"),
            "INDEX_PLACE_I16 f0, s:i, bounds of motors dim 0, s:motors\n"
            "INDEX_I16 f1, s:i, f0, bounds of motors[..].table[2] dim 1, +table[2]\n"
            "LD_16 f2, f1, +\nADD_16 f2, f2, #1\nST_16 f1, f2, +\nRET\n");
}

TEST(Places, LeavesAConstantIndexOutOfBoundsToTheTrap) {
  EXPECT_EQ(code(R"(  b0:
    v0 = const i16 7
    v1 = load i16 self.motors[1].table[v0][0]
    store i16 self.i, v1
    return
)"),
            "MOV_64 f0, #7\n"
            "INDEX_PLACE_I64 f1, f0, bounds of motors[1].table dim 0, s:motors[1].table\n"
            "LD_16 f2, f1, +[0]\nMOV_16 s:i, f2\nRET\n");
}

TEST(Places, CallsAnElementOfAnArrayOfFunctionBlocks) {
  EXPECT_EQ(code(R"(  b0:
    v0 = load i16 self.i
    v1 = const bool TRUE
    store bool self.many[v0]!.up, v1
    v2 = address addr self.n
    store addr self.many[v0]!.total, v2
    call_instance self.many[v0]
    call_instance self.many[1]
    return
)"),
            "INDEX_PLACE_I16 f0, s:i, bounds of many dim 0, s:many\n"
            "INST_AT f1, f0, +\nST_B f1, #1, +up\nLEA f2, s:n, DINT\nST_REF_AT f1, f2, +total\n"
            "CALL_INST_AT f0, +\nCALL_INST s:many[1]\nRET\n");
}

TEST(Places, CopiesStringsAndStructures) {
  EXPECT_EQ(code(R"(  b0:
    init self.text, #0
    copy self.motors[0], self.motors[1]
    init self.motors[2]
    return
)"),
            "STR f0, s:text, capacity 10\nSTR f1, c:STRING[10], capacity 10\nSCOPY f0, f1\n"
            "LEA f2, s:motors[0], Motor\nLEA f3, s:motors[1], Motor\nCOPY f2, f3, Motor\n"
            "LEA f2, s:motors[2], Motor\nLEA f3, c:Motor, Motor\nCOPY f2, f3, Motor\nRET\n");
}

TEST(Places, ForgetsReferencesAtCallsButNotInstances) {
  const std::string text = code(R"(  b0:
    call_instance self.first
    v0 = load i16 self.first!.count
    store i16 self.i, v0
    call_instance self.first
    v1 = load i16 self.first!.count
    store i16 self.i, v1
    return
)");
  EXPECT_EQ(text,
            "CALL_INST s:first\nINST f0, s:first\nLD_16 f1, f0, +count\nMOV_16 s:i, f1\n"
            "CALL_INST s:first\nLD_16 f1, f0, +count\nMOV_16 s:i, f1\nRET\n");
}

constexpr std::string_view kLimit = R"(pou function Limit
  local input low : INT
  local in_out hits : DINT
  local return Limit : INT
  local temp k : INT
  b0:
    init local.k
    v0 = load i16 local.low
    v1 = const i16 2
    v2 = mul i16 v0, v1
    store i16 local.k, v2
    v3 = load i16 local.k
    store i16 local.Limit, v3
    v4 = load i32 local.hits^
    v5 = add i32 v4, v4
    store i32 local.hits^, v5
    return
)";

TEST(Places, PassesArgumentsAndReadsResults) {
  EXPECT_EQ(code(R"(  b0:
    v0 = load i16 self.i
    v1 = address addr self.n
    store i16 arg(Limit).low, v0
    store addr arg(Limit).hits, v1
    call Limit
    v2 = load i16 arg(Limit).Limit
    store i16 self.i, v2
    return
)",
                 kLimit),
            "MOV_16 arg:Limit.0, s:i\nLEA arg:Limit.1, s:n, DINT\nCALL Limit\n"
            "MOV_16 s:i, arg:Limit.2\nRET\n");
}

constexpr std::string_view kWithBlock = R"(pou function Use
  local in_out fb : Counter
  local return Use : INT
  b0:
    v0 = load i16 local.fb^!.count
    store i16 local.Use, v0
    return
)";

// The address of a function block is that of its area.
TEST(Places, ReachesAFunctionBlockPassedAsInOut) {
  EXPECT_EQ(code(R"(  b0:
    v0 = address addr self.first
    store addr arg(Use).fb, v0
    call Use
    return
)",
                 kWithBlock),
            "INST f1, s:first\nMOV_A arg:Use.0, f1\nCALL Use\nRET\n");
  EXPECT_EQ(instructions(main_with(kMembers, "  b0:\n    return\n", kTypes,
                                   std::string(kCounter) + std::string(kWithBlock)),
                         "Use"),
            "LD_16 f:Use, f:fb, +count\nRET\n");
}

TEST(Places, UsesNamedLocalsAsOperands) {
  const std::string text = instructions(main_with(kMembers, "  b0:\n    return\n", kTypes,
                                                  std::string(kCounter) + std::string(kLimit)),
                                        "Limit");
  EXPECT_EQ(text,
            "MOV_16 f:k, #0\nMUL_16 f:k, f:low, #2\nMOV_16 f:Limit, f:k\n"
            "LD_32 f4, f:hits, +\nADD_32 f4, f4, f4\nST_32 f:hits, f4, +\nRET\n");
}

TEST(Places, CallsNativesThroughTheirSlots) {
  EXPECT_EQ(code(R"(  b0:
    v0 = string str self.text
    v1 = native i32 LEN/i:S v0
    v2 = wrap i16 v1
    store i16 self.i, v2
    return
)"),
            "STR narg0, s:text, capacity 10\nNATIVE native 11\nMOV_32 f2, narg0\n"
            "NARROW_32_16 f3, f2\nMOV_16 s:i, f3\nRET\n");
}

}  // namespace
}  // namespace ir
