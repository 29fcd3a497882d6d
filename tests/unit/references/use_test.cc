// References that find their target: areas, locals, structures, strings, bytes, integers.
#include "tests/unit/references/rig.h"

namespace references {
namespace {

TEST(References, StoreAndLoadThroughAPointer) {
  Rig rig(main_with("  member local x : INT\n  member local p : PInt\n  member local y : INT\n",
                    "  b0:\n    v0 = handle u64 self.x\n    store u64 self.p, v0\n"
                    "    v1 = load u64 self.p\n    v2 = const i16 7\n"
                    "    store i16 target(v1 : INT), v2\n    v3 = load i16 target(v1 : INT)\n"
                    "    store i16 self.y, v3\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.x"), "7");
  EXPECT_EQ(rig.value("Main.y"), "7");
  EXPECT_EQ(rig.value("Main.p"), "Main.x");
}

TEST(References, NameGlobalsElementsAndBytesInside) {
  Rig rig(
      main_with("  member local m : Motor\n  member local p : PInt\n  member local q : PByte\n"
                "  member local r : PMotor\n  member local none : PInt\n",
                "  b0:\n    v0 = handle u64 global.gInt\n    store u64 self.p, v0\n"
                "    v1 = handle u64 self.m.table[2]\n    v2 = const u64 1\n"
                "    v3 = move_handle u64 v1, v2\n    store u64 self.q, v3\n"
                "    v4 = handle u64 self.m\n    store u64 self.r, v4\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.p"), "gInt");
  EXPECT_EQ(rig.value("Main.q"), "Main.m.table[2]+1");
  EXPECT_EQ(rig.value("Main.r"), "Main.m");
  EXPECT_EQ(rig.value("Main.none"), "NULL");
}

// p^.table[i], with the handle moved along a member and a checked index.
TEST(References, PathsMoveTheHandle) {
  Rig rig(main_with("  member local m : Motor\n  member local i : INT\n  member local w : WORD\n",
                    "  b0:\n    v0 = handle u64 self.m\n    v1 = const i16 3\n"
                    "    store i16 self.i, v1\n    v2 = load i16 self.i\n"
                    "    v3 = const u16 4711\n    store u16 target(v0 : Motor).table[v2], v3\n"
                    "    v4 = load u16 target(v0 : Motor).table[3]\n    store u16 self.w, v4\n"
                    "    v5 = const bool 1\n    store bool target(v0 : Motor).on, v5\n"
                    "    v6 = handle u64 target(v0 : Motor).table[v2]\n"
                    "    v7 = load u16 target(v6 : WORD)\n    store u16 self.w, v7\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.m.table[3]"), "16#1267");
  EXPECT_EQ(rig.value("Main.w"), "16#1267");
  EXPECT_EQ(rig.value("Main.m.on"), "TRUE");
}

TEST(References, AStructureIsSeenAsBytesAndCopied) {
  Rig rig(main_with("  member local m : Motor\n  member local n : Motor\n  member local b : BYTE\n",
                    "  b0:\n    v0 = handle u64 self.m\n    v1 = handle u64 self.m.speed\n"
                    "    v2 = const u8 1\n    store u8 target(v1 : BYTE), v2\n"
                    "    v3 = const u64 1\n    v4 = move_handle u64 v1, v3\n    v5 = const u8 2\n"
                    "    store u8 target(v4 : BYTE), v5\n    v6 = handle u64 self.n\n"
                    "    copy target(v6 : Motor), target(v0 : Motor)\n"
                    "    v7 = load u8 target(v4 : BYTE)\n    store u8 self.b, v7\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.m.speed"), "513");
  EXPECT_EQ(rig.value("Main.n.speed"), "513");
  EXPECT_EQ(rig.value("Main.b"), "16#02");
}

// POINTER TO ARRAY[0..32000] OF BYTE on a small buffer: what is touched is checked.
TEST(References, ALargeArrayTypeMayPointToASmallBuffer) {
  Rig rig(main_with("  member local r : REAL\n  member local i : INT\n",
                    "  b0:\n    v0 = handle u64 self.r\n    v1 = const u8 64\n"
                    "    store u8 target(v0 : Bytes)[3], v1\n    v2 = const i16 2\n"
                    "    store i16 self.i, v2\n    v3 = load i16 self.i\n    v4 = const u8 32\n"
                    "    store u8 target(v0 : Bytes)[v3], v4\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.r"), "2.5");
}

TEST(References, ABoolWrittenAsAByteIsTrueWhenItIsNotZero) {
  Rig rig(
      main_with("  member local a : BOOL\n  member local b : BOOL\n  member local c : BOOL\n"
                "  member local d : BOOL\n  member local e : BOOL\n  member local n : INT\n",
                "  b0:\n    v0 = handle u64 self.a\n    v1 = const u8 6\n"
                "    store u8 target(v0 : BYTE), v1\n    v2 = load bool self.a\n"
                "    store bool self.b, v2\n    v3 = not bool v2\n    store bool self.c, v3\n"
                "    v4 = const bool 1\n    v5 = load bool self.a\n    v6 = and bool v5, v4\n"
                "    store bool self.d, v6\n    v7 = load bool self.a\n"
                "    v8 = eq bool v7, v4\n    store bool self.e, v8\n"
                "    v9 = load bool self.a\n    v10 = wrap i16 v9\n"
                "    store i16 self.n, v10\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.a"), "TRUE");
  EXPECT_EQ(rig.value("Main.b"), "TRUE");
  EXPECT_EQ(rig.value("Main.c"), "FALSE");
  EXPECT_EQ(rig.value("Main.d"), "TRUE");
  EXPECT_EQ(rig.value("Main.e"), "TRUE");
  EXPECT_EQ(rig.value("Main.n"), "1");
}

TEST(References, AStringBehindAPointerHasWhatRoomIsThere) {
  // s holds 10, the pointer says 80: text and the member behind it stay apart.
  Rig rig(main_with("  member local long : S80\n  member local s : S10\n  member local t : S80\n"
                    "  member local length : INT\n",
                    "  b0:\n    copy self.long, const(#0 : S80)\n"
                    "    v0 = handle u64 self.s\n    copy target(v0 : S80), self.long\n"
                    "    copy self.t, target(v0 : S80)\n    v1 = string str target(v0 : S10)\n"
                    "    v2 = native i32 LEN/i:S v1\n    v3 = wrap i16 v2\n"
                    "    store i16 self.length, v3\n    return\n") +
          "const #0 = 'abcdefgh'\n");
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.s"), "'abcdefgh'");
  EXPECT_EQ(rig.value("Main.t"), "'abcdefgh'");
  EXPECT_EQ(rig.value("Main.length"), "8");
}

TEST(References, LocalsCanBeNamedWhileTheirPouRuns) {
  Rig rig(main_with("  member local r : INT\n  member local p : PInt\n",
                    "  b0:\n    call F\n    v0 = load i16 arg(F).F\n    store i16 self.r, v0\n"
                    "    return\n",
                    "pou function G\n  local input p : PInt\n  b0:\n    v0 = load u64 local.p\n"
                    "    v1 = load i16 target(v0 : INT)\n    v2 = const i16 1\n"
                    "    v3 = add i16 v1, v2\n    store i16 target(v0 : INT), v3\n    return\n"
                    "pou function F\n  local return F : INT\n  local temp a : INT\n"
                    "  local temp m : Motor\n  b0:\n    init local.F\n    v0 = const i16 40\n"
                    "    store i16 local.a, v0\n    init local.m\n    v1 = handle u64 local.a\n"
                    "    store u64 arg(G).p, v1\n    call G\n"
                    "    v2 = handle u64 local.m.speed\n    store u64 arg(G).p, v2\n    call G\n"
                    "    v3 = load i16 local.a\n    v4 = load i16 local.m.speed\n"
                    "    v5 = add i16 v3, v4\n    store i16 local.F, v5\n    return\n"));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.r"), "42");
}

// An in-out has the handle of what is bound to it: here a local of the caller.
TEST(References, AnInOutHasTheHandleOfItsTarget) {
  Rig rig(main_with("  member local r : INT\n  member local same : BOOL\n",
                    "  b0:\n    call F\n    v0 = load i16 arg(F).F\n    store i16 self.r, v0\n"
                    "    v1 = address addr self.r\n    store addr arg(H).io, v1\n    call H\n"
                    "    v2 = load u64 arg(H).H\n    v3 = handle u64 self.r\n"
                    "    v4 = eq u64 v2, v3\n    store bool self.same, v4\n    return\n",
                    "pou function H\n  local in_out io : INT\n  local return H : PInt\n  b0:\n"
                    "    v0 = handle u64 local.io^\n    store u64 local.H, v0\n"
                    "    v1 = load i16 target(v0 : INT)\n    v2 = const i16 5\n"
                    "    v3 = add i16 v1, v2\n    store i16 target(v0 : INT), v3\n    return\n"
                    "pou function F\n  local return F : INT\n  local temp a : INT\n  b0:\n"
                    "    v0 = const i16 10\n    store i16 local.a, v0\n"
                    "    v1 = address addr local.a\n    store addr arg(H).io, v1\n    call H\n"
                    "    v2 = load i16 local.a\n    store i16 local.F, v2\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.r"), "20");
  EXPECT_EQ(rig.value("Main.same"), "TRUE");
}

TEST(References, InstancesAreCalledAndEnteredThroughAPointer) {
  Rig rig(
      main_with("  member local fb : Fb\n  member local p : PFb\n  member local y : INT\n"
                "  member local box : Box\n  member local a : INT\n",
                "  b0:\n    v0 = handle u64 self.fb\n    store u64 self.p, v0\n"
                "    v1 = load u64 self.p\n    v2 = const i16 21\n"
                "    store i16 target(v1 : Fb)!.x, v2\n    call_instance target(v1 : Fb)\n"
                "    v3 = load i16 target(v1 : Fb)!.y\n    store i16 self.y, v3\n"
                "    v4 = handle u64 self.box\n    v5 = const i16 3\n"
                "    store i16 target(v4 : Box).fb!.x, v5\n"
                "    call_instance target(v4 : Box).fb\n"
                "    v6 = load i16 target(v4 : Box).fb!.y\n    store i16 self.a, v6\n"
                "    v7 = handle u64 target(v4 : Box).fb\n    store u64 self.p, v7\n"
                "    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.y"), "42");
  EXPECT_EQ(rig.value("Main.a"), "6");
  EXPECT_EQ(rig.value("Main.p"), "Main.box.fb");
}

TEST(References, ThisIsTheHandleOfTheOwnInstance) {
  Rig rig(main_with("  member local y : INT\n  member local same : BOOL\n",
                    "  b0:\n    v0 = handle u64 self\n    v1 = const i16 9\n"
                    "    store i16 self.y, v1\n    v2 = handle u64 self.y\n"
                    "    v3 = const u64 18446744069414584320\n    v4 = and u64 v2, v3\n"
                    "    v5 = eq u64 v0, v4\n    store bool self.same, v5\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.same"), "TRUE");
}

// Through 32 bits and back, with arithmetic on the number in between.
TEST(References, FlatAddressesLeadBack) {
  Rig rig(
      main_with("  member local t : Words\n  member local d : DWORD\n  member local w : WORD\n"
                "  member local n : DWORD\n",
                "  b0:\n    v0 = handle u64 self.t\n    v1 = flat u32 v0\n"
                "    v2 = const u32 4\n    v3 = add u32 v1, v2\n    store u32 self.d, v3\n"
                "    v4 = load u32 self.d\n    v5 = unflat u64 v4\n    v6 = const u16 5\n"
                "    store u16 target(v5 : WORD), v6\n    v7 = const u64 0\n"
                "    v8 = flat u32 v7\n    store u32 self.n, v8\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.t[2]"), "16#0005");
  EXPECT_EQ(rig.value("Main.n"), "16#00000000");
}

TEST(References, AnExposedLocalHasAFlatAddressToo) {
  Rig rig(main_with("  member local r : INT\n",
                    "  b0:\n    call F\n    v0 = load i16 arg(F).F\n    store i16 self.r, v0\n"
                    "    return\n",
                    "pou function F\n  local return F : INT\n  local temp a : Words\n  b0:\n"
                    "    init local.a\n    v0 = handle u64 local.a\n    v1 = flat u32 v0\n"
                    "    v2 = const u32 2\n    v3 = add u32 v1, v2\n    v4 = unflat u64 v3\n"
                    "    v5 = const i16 77\n    store i16 target(v4 : INT), v5\n"
                    "    v6 = load u16 local.a[1]\n    v7 = wrap i16 v6\n"
                    "    store i16 local.F, v7\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.r"), "77");
}

TEST(References, SizeOfIsWhatIsLaidOut) {
  Rig rig(main_with("  member local a : UDINT\n  member local b : UDINT\n  member local fb : Fb\n",
                    "  b0:\n    v0 = size_of u32 Motor\n    store u32 self.a, v0\n"
                    "    v1 = size_of u32 Fb\n    store u32 self.b, v1\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.a"), "16");
  EXPECT_EQ(rig.value("Main.b"), "8");
}

TEST(Unions, MembersAreTheSameBytes) {
  Rig rig(main_with("  member local u : Raw\n  member local v : Raw\n  member local d : DWORD\n",
                    "  b0:\n    v0 = const f32 2.5\n    store f32 self.u.real, v0\n"
                    "    v1 = load u32 self.u.dword\n    store u32 self.d, v1\n"
                    "    v2 = const u16 16672\n    store u16 self.u.words[1], v2\n"
                    "    copy self.v, self.u\n    return\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.d"), "16#40200000");
  EXPECT_EQ(rig.value("Main.u.real"), "10.0");
  EXPECT_EQ(rig.value("Main.v.real"), "10.0");
  EXPECT_EQ(rig.value("Main.v.flag"), "FALSE");
}

// A value kept for later must not be taken from memory that another member has changed since.
TEST(Unions, AStoreToOneMemberChangesTheOthers) {
  Rig rig(main_with("  member local u : Raw\n  member local d : DWORD\n",
                    "  b0:\n    v0 = load u32 self.u.dword\n    v1 = const f32 2.5\n"
                    "    store f32 self.u.real, v1\n    v2 = load u32 self.u.dword\n"
                    "    v3 = sub u32 v2, v0\n    store u32 self.d, v3\n    call F\n    return\n",
                    "pou function F\n  local temp u : Raw\n  b0:\n    init local.u\n"
                    "    v0 = load u32 local.u.dword\n    v1 = const f32 2.5\n"
                    "    store f32 local.u.real, v1\n    v2 = load u32 local.u.dword\n"
                    "    v3 = sub u32 v2, v0\n    store u32 global.gD, v3\n    return\n",
                    "  member global gD : DWORD\n"));
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("gD"), "16#40200000");
}

TEST(Unions, StringsInsideAreBytesToo) {
  Rig rig(main_with("  member local u : Raw\n  member local w : WORD\n  member local n : INT\n",
                    "  b0:\n    copy self.u.text, const(#0 : S10)\n"
                    "    v0 = load u16 self.u.words[0]\n    store u16 self.w, v0\n"
                    "    v1 = string str self.u.text\n    v2 = native i32 LEN/i:S v1\n"
                    "    v3 = wrap i16 v2\n    store i16 self.n, v3\n    return\n") +
          "const #0 = 'AB'\n");
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("Main.w"), "16#4241");
  EXPECT_EQ(rig.value("Main.n"), "2");
  EXPECT_EQ(rig.value("Main.u.text"), "'AB'");
}

TEST(Unions, TheInitialValueIsThatOfTheMemberThatIsNamed) {
  Rig rig(linker::simple("  member global u : Raw init #1\n  member global v : Two\n", "",
                         std::string(kTypes) + "type Two = union\n  member local a : DWORD\n"
                                               "  member local b : WORD init #2\n",
                         kFbPou) +
          "const #0 = 1092616192\nconst #1 = {1 = #0}\nconst #2 = 513\n");
  EXPECT_EQ(rig.scan(), "");
  EXPECT_EQ(rig.value("u.real"), "10.0");
  EXPECT_EQ(rig.value("v.a"), "16#00000201");
}

}  // namespace
}  // namespace references
