// References that find nothing: every way in which one can be wrong traps, in both tiers, at the
// instruction that uses it.
#include "tests/unit/references/rig.h"

namespace references {
namespace {

// "reference Main:7" from a body whose line 7 uses the handle.
std::string trap_of(std::string_view members, std::string_view body, std::string_view pous = "") {
  Rig rig(main_with(members, body, pous, "  member global gP : PInt\n"));
  return rig.scan();
}

TEST(ReferenceTraps, Null) {
  EXPECT_EQ(trap_of("  member local p : PInt\n",
                    "  b0:\n    v0 = load u64 self.p @6\n    v1 = load i16 target(v0 : INT) @7\n"
                    "    return\n"),
            "reference Main:7");
}

TEST(ReferenceTraps, NullMovedIsStillNull) {
  EXPECT_EQ(trap_of("  member local m : PMotor\n",
                    "  b0:\n    v0 = load u64 self.m @6\n"
                    "    v1 = load i16 target(v0 : Motor).speed @7\n    return\n"),
            "reference Main:7");
}

TEST(ReferenceTraps, BehindTheEndOfTheArea) {
  EXPECT_EQ(trap_of("  member local a : INT\n",
                    "  b0:\n    v0 = handle u64 self.a @5\n    v1 = const u64 2 @5\n"
                    "    v2 = move_handle u64 v0, v1 @6\n"
                    "    v3 = load i16 target(v2 : INT) @7\n    return\n"),
            "reference Main:7");
}

TEST(ReferenceTraps, OnlyPartlyInside) {
  EXPECT_EQ(trap_of("  member local a : INT\n",
                    "  b0:\n    v0 = handle u64 self.a @5\n"
                    "    v1 = load i32 target(v0 : DINT) @7\n    return\n"),
            "reference Main:7");
}

TEST(ReferenceTraps, BeforeTheBeginningWrapsInsideTheOffset) {
  EXPECT_EQ(trap_of("  member local a : INT\n",
                    "  b0:\n    v0 = handle u64 self @5\n    v1 = const i64 -2 @5\n"
                    "    v2 = move_handle u64 v0, v1 @6\n"
                    "    v3 = load i16 target(v2 : INT) @7\n    return\n"),
            "reference Main:7");
}

// The ID of an instance can be neither read nor written, not even one byte of it.
TEST(ReferenceTraps, OverAnInstanceSlot) {
  for (const char* offset : {"0", "3", "-1"}) {
    EXPECT_EQ(trap_of("  member local box : Box\n",
                      "  b0:\n    v0 = handle u64 self @5\n    v1 = size_of u32 Box @5\n"
                      "    v2 = wrap u64 v1 @5\n    v3 = const i64 " +
                          std::string(offset) +
                          " @5\n"
                          "    v4 = const u64 4 @5\n    v5 = sub u64 v2, v4 @5\n"
                          "    v6 = move_handle u64 v0, v5 @5\n"
                          "    v7 = move_handle u64 v6, v3 @5\n    v8 = const u16 1 @5\n"
                          "    store u16 target(v7 : WORD), v8 @7\n    return\n"),
              "reference Main:7")
        << offset;
  }
}

TEST(ReferenceTraps, OverAnInOutSlot) {
  EXPECT_EQ(trap_of("  member local fb : Fb\n  member local a : INT\n",
                    "  b0:\n    v0 = handle u64 self.fb!.x @5\n    v1 = const u64 4 @5\n"
                    "    v2 = address addr self.a @5\n    store addr self.fb!.io, v2 @5\n"
                    "    v3 = move_handle u64 v0, v1 @6\n"
                    "    v4 = load i16 target(v3 : INT) @7\n    return\n"),
            "reference Main:7");
}

TEST(ReferenceTraps, AnInstanceOfAnotherType) {
  EXPECT_EQ(trap_of("  member local a : INT\n",
                    "  b0:\n    v0 = handle u64 self @5\n    call_instance target(v0 : Fb) @7\n"
                    "    return\n"),
            "reference Main:7");
  EXPECT_EQ(trap_of("  member local a : INT\n",
                    "  b0:\n    v0 = handle u64 self @5\n"
                    "    v1 = load i16 target(v0 : Fb)!.x @7\n    return\n"),
            "reference Main:7");
}

TEST(ReferenceTraps, AStructureWithInstancesMustBeExactlyThere) {
  EXPECT_EQ(trap_of("  member local box : Box\n",
                    "  b0:\n    v0 = handle u64 self.box @5\n    v1 = const u64 1 @5\n"
                    "    v2 = move_handle u64 v0, v1 @6\n"
                    "    v3 = load i16 target(v2 : Box).a @7\n    return\n"),
            "reference Main:7");
}

// The local has gone with its POU, also when another call has used its place since.
TEST(ReferenceTraps, ALocalThatIsGone) {
  EXPECT_EQ(trap_of("",
                    "  b0:\n    call F @4\n    call F @5\n    v0 = load u64 global.gP @6\n"
                    "    v1 = load i16 target(v0 : INT) @7\n    return\n",
                    "pou function F\n  local temp a : INT\n  b0:\n    init local.a\n"
                    "    v0 = handle u64 local.a\n    store u64 global.gP, v0\n    return\n"),
            "reference Main:7");
}

TEST(ReferenceTraps, ALocalOfAnEarlierScan) {
  Rig rig(main_with("  member local n : INT\n",
                    "  local temp t : INT\n  b0:\n    v0 = load i16 self.n\n"
                    "    v1 = const i16 0\n    v2 = eq i16 v0, v1\n    branch v2, b1, b2\n"
                    "  b1:\n    init local.t\n    v3 = handle u64 local.t\n"
                    "    store u64 global.gP, v3\n    v4 = const i16 1\n"
                    "    store i16 self.n, v4\n    return\n"
                    "  b2:\n    v5 = load u64 global.gP\n    v6 = load i16 target(v5 : INT) @7\n"
                    "    return\n",
                    "", "  member global gP : PInt\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("gP"), "ref");
  EXPECT_EQ(rig.scan(), "reference Main:7");
}

TEST(ReferenceTraps, BehindTheEndOfALocal) {
  EXPECT_EQ(trap_of("", "  b0:\n    call F @4\n    return\n",
                    "pou function F\n  local temp a : INT\n  local temp b : INT\n  b0:\n"
                    "    init local.a\n    init local.b\n    v0 = handle u64 local.a @5\n"
                    "    v1 = const u64 2 @5\n    v2 = move_handle u64 v0, v1 @6\n"
                    "    v3 = load i16 target(v2 : INT) @7\n    return\n"),
            "reference F:7");
}

TEST(ReferenceTraps, AnIndexBehindAHandleIsChecked) {
  EXPECT_EQ(trap_of("  member local t : Words\n  member local i : INT\n",
                    "  b0:\n    v0 = handle u64 self.t @5\n    v1 = const i16 4 @5\n"
                    "    store i16 self.i, v1 @5\n    v2 = load i16 self.i @5\n"
                    "    v3 = load u16 target(v0 : Words)[v2] @7\n    return\n"),
            "index Main:7");
}

TEST(ReferenceTraps, AFlatAddressOutsideOfEverything) {
  EXPECT_EQ(trap_of("  member local d : DWORD\n",
                    "  b0:\n    v0 = const u32 4026531839 @5\n    v1 = unflat u64 v0 @6\n"
                    "    v2 = load i16 target(v1 : INT) @7\n    return\n"),
            "reference Main:7");
}

TEST(ReferenceTraps, AStringWhereNothingIsLeft) {
  EXPECT_EQ(trap_of("  member local a : INT\n",
                    "  b0:\n    v0 = handle u64 self.a @5\n    v1 = const u64 2 @5\n"
                    "    v2 = move_handle u64 v0, v1 @6\n"
                    "    v3 = string str target(v2 : S80) @7\n    v4 = native i32 LEN/i:S v3 @8\n"
                    "    return\n"),
            "reference Main:7");
}

// Of a trap at the bytes `by` behind the begin of the variable.
std::string text_of_left(std::string_view place, int by) {
  Rig rig(main_with("  member local v : INT\n  member local next : INT\n",
                    "  local temp gone : INT\n  b0:\n    init local.gone @5\n    v0 = handle u64 " +
                        std::string(place) + " @5\n    v1 = const i64 " + std::to_string(by) +
                        " @5\n    v2 = move_handle u64 v0, v1 @6\n"
                        "    v3 = load i16 target(v2 : INT) @7\n    return\n"));
  EXPECT_EQ(rig.scan(), "reference Main:7");
  return vm::describe(rig.image(), rig.execution().trap()).text;
}

TEST(ReferenceTraps, I3_TheTextNamesTheVariableThatWasLeft) {
  EXPECT_EQ(text_of_left("self.v", 1), "the pointer has left `v`");
  EXPECT_EQ(text_of_left("self.v", 2), "the pointer has left `v`");
  EXPECT_EQ(text_of_left("self.next", -2), "the pointer has left `next`");
  EXPECT_EQ(text_of_left("global.gInt", 2), "the pointer has left `gInt`");
  EXPECT_EQ(text_of_left("self.v", 1000), "the pointer has left its variable");
  EXPECT_EQ(text_of_left("local.gone", 2), "the pointer has left its variable");
}

// Any 64-bit number may be used as a handle; whatever it is, it finds a variable or traps.
TEST(ReferenceTraps, AnyNumberIsSafe) {
  for (uint64_t high :
       {1ull, 2ull, 3ull, 0x00ffffffull, 0x01000001ull, 0x7f000001ull, 0x80000000ull, 0x80000001ull,
        0xffffffffull, 0x08200001ull, 0x10000001ull, 0x70000001ull, 0x90000001ull, 0xf0000002ull}) {
    for (uint64_t low : {0ull, 1ull, 64ull, 0x7fffffffull, 0xffffffffull}) {
      trap_of("  member local fb : Fb\n",
              "  b0:\n    v0 = const u64 " + std::to_string(high << 32 | low) +
                  " @5\n    v1 = const u16 65535 @5\n    store u16 target(v0 : WORD), v1 @7\n"
                  "    return\n");
    }
  }
}

}  // namespace
}  // namespace references
