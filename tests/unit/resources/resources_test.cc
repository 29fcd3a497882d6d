// Several resources of a CONFIGURATION in one process: each with its own cycle, changed by itself,
// and their globals exchanged at the boundaries.
#include "tests/unit/allocations.h"
#include "tests/unit/resources/rig.h"

namespace resources_test {
namespace {

constexpr size_t kLine = 0;
constexpr size_t kPack = 1;

// `line` and `pack`: declarations and statements of the programs. Line's cycle is 10 ms, Pack's 15.
std::string plant(const std::string& globals, const std::string& line, const std::string& pack) {
  return "PROGRAM PLine " + line + " END_PROGRAM PROGRAM PPack " + pack +
         " END_PROGRAM CONFIGURATION Plant VAR_GLOBAL " + globals +
         " END_VAR RESOURCE Line ON cpu TASK t (INTERVAL := T#10ms); PROGRAM p WITH t : PLine; "
         "END_RESOURCE RESOURCE Pack ON cpu TASK t (INTERVAL := T#15ms); PROGRAM p WITH t : PPack; "
         "END_RESOURCE END_CONFIGURATION";
}

constexpr const char* kBlock = "n : DINT; a : ARRAY[0..99] OF DINT;";
constexpr const char* kWritesBlock =
    "VAR i : INT; END_VAR n := n + 1; FOR i := 0 TO 99 DO a[i] := n; END_FOR";
constexpr const char* kReadsBlock =
    "VAR i : INT; torn, seen : DINT; END_VAR seen := n; "
    "FOR i := 0 TO 99 DO IF a[i] <> seen THEN torn := torn + 1; END_IF END_FOR";

void expect_whole_blocks(const std::string& source) {
  Rig rig(source);
  ASSERT_TRUE(rig.ok()) << rig.error;
  // Line runs at 0, 10, 20, ...; at equal instants before Pack, which runs at 0, 15, 30, ...
  std::vector<std::string> seen;
  rig.run_to(60, [&](size_t resource) {
    if (resource == kPack) seen.push_back(rig.get(kPack, "p.seen"));
  });
  EXPECT_EQ(seen, (std::vector<std::string>{"1", "2", "4", "5", "7"}));
  rig.run_to(3000);
  EXPECT_EQ(rig.get(kPack, "p.torn"), "0");
  EXPECT_EQ(rig.get(kPack, "p.seen"), "301");
  EXPECT_EQ(rig.status(kPack)[0].name, "Line");
  EXPECT_EQ(rig.status(kPack)[0].exchanges, 201u);
}

TEST(Resources, ExchangeWholeBlocksAtTheirBoundaries) {
  expect_whole_blocks(plant(kBlock, kWritesBlock, kReadsBlock));
}

// Blocks are taken when a cycle begins, whatever it begins with (B2).
TEST(Resources, B2_TheOtherScheduleExchangesTheSameBlocks) {
  std::string source = plant(kBlock, kWritesBlock, kReadsBlock);
  for (const char* resource : {" RESOURCE Line", " RESOURCE Pack"}) {
    source.insert(source.find(resource), " {attribute 'schedule' := 'run_first'}");
  }
  expect_whole_blocks(source);
}

// Both ways, structures with holes, texts, and what only one of them knows.
TEST(Resources, ExchangeEveryPlainType) {
  Rig rig(
      "TYPE Colour : (red, green); Part : STRUCT b : BYTE; d : LREAL; s : STRING[7]; END_STRUCT; "
      "U : UNION w : WORD; b : ARRAY[0..1] OF BYTE; END_UNION; END_TYPE " +
      plant("parts : ARRAY[0..2] OF Part; c : Colour; u : U; t : TIME; w : WSTRING[5]; "
            "level : INT(0..9); back : LINT; alone : INT;",
            "parts[2].s := 'seven77'; parts[2].d := 2.5; parts[1].b := 7; c := green; u.b[1] := "
            "16#12; t := T#3s; w := \"abc\"; level := 4; alone := 1;",
            "VAR d : LREAL; s : STRING[7]; k : Colour; x : WORD; u1 : TIME; v : WSTRING[5]; "
            "l : INT; q : BYTE; END_VAR back := back + 1; d := parts[2].d; s := parts[2].s; "
            "k := c; x := u.w; u1 := t; v := w; l := level; q := parts[1].b;"));
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(60);
  EXPECT_EQ(rig.get(kPack, "p.d"), "2.5");
  EXPECT_EQ(rig.get(kPack, "p.s"), "'seven77'");
  EXPECT_EQ(rig.get(kPack, "p.k"), "green");
  EXPECT_EQ(rig.get(kPack, "p.x"), "16#1200");
  EXPECT_EQ(rig.get(kPack, "p.u1"), "T#3s");
  EXPECT_EQ(rig.get(kPack, "p.v"), "\"abc\"");
  EXPECT_EQ(rig.get(kPack, "p.l"), "4");
  EXPECT_EQ(rig.get(kPack, "p.q"), "16#07");
  EXPECT_EQ(rig.get(kLine, "alone"), "1");
  EXPECT_EQ(rig.get(kPack, "alone"), "0");
}

// B3: a scan of many cycles, with the writer's cycles and the reader's faster task in between.
TEST(Resources, B3_AScanSeesOneBlockFromItsStartToItsEnd) {
  const std::string source =
      "PROGRAM W n := n + 1; END_PROGRAM PROGRAM Fast VAR k : DINT; END_VAR k := k + 1; "
      "END_PROGRAM "
      "PROGRAM Slow VAR i : DINT; first, changed, scans : DINT; END_VAR first := n; FOR i := 1 TO "
      "45000 DO IF n <> first THEN changed := changed + 1; END_IF END_FOR scans := scans + 1; "
      "END_PROGRAM CONFIGURATION Plant VAR_GLOBAL n : DINT; END_VAR RESOURCE Line ON cpu TASK t "
      "(INTERVAL := T#1ms); PROGRAM p WITH t : W; END_RESOURCE RESOURCE Pack ON cpu TASK f "
      "(INTERVAL "
      ":= T#5ms, PRIORITY := 1); TASK s (INTERVAL := T#100ms, PRIORITY := 5); PROGRAM f WITH f : "
      "Fast; PROGRAM s WITH s : Slow; END_RESOURCE END_CONFIGURATION";
  Rig rig(source, 1000);  // a round takes a microsecond, so a scan nine cycles
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(1000);
  EXPECT_EQ(rig.get(kPack, "s.changed"), "0");
  EXPECT_EQ(rig.get(kPack, "s.scans"), "10");
  EXPECT_GT(std::stoi(rig.get(kPack, "s.first")), 890);
  EXPECT_EQ(rig.controller(kPack).missed_releases(), 0u);
}

TEST(Resources, WhatAnotherWritesReleasesATask) {
  Rig rig(
      "PROGRAM W VAR k : INT; END_VAR k := k + 1; wake := k MOD 5 = 0; END_PROGRAM "
      "PROGRAM R VAR runs : INT; END_VAR runs := runs + 1; END_PROGRAM CONFIGURATION Plant "
      "VAR_GLOBAL wake : BOOL; END_VAR RESOURCE Line ON cpu TASK t (INTERVAL := T#10ms); PROGRAM "
      "p WITH t : W; END_RESOURCE RESOURCE Pack ON cpu TASK e (SINGLE := wake); TASK b (INTERVAL "
      ":= T#5ms); PROGRAM p WITH e : R; PROGRAM q WITH b : R; END_RESOURCE END_CONFIGURATION");
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(195);  // 20 cycles of Line: 5, 10, 15, 20
  EXPECT_EQ(rig.get(kPack, "p.runs"), "4");
}

// Nothing that one resource does to itself delays the other.
TEST(Resources, OneIsChangedWhileTheOtherRuns) {
  Rig rig(plant(kBlock, kWritesBlock, kReadsBlock));
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(300);
  const std::string next = plant(
      "before : LREAL; a : ARRAY[0..99] OF DINT; between : STRING[77]; n : DINT;",
      "VAR i : INT; END_VAR n := n + 1000; FOR i := 0 TO 99 DO a[i] := n; END_FOR", kReadsBlock);
  ASSERT_TRUE(rig.change(kLine, next).ok());
  rig.run_to(600);
  EXPECT_EQ(rig.get(kPack, "p.seen"), "30031");  // 31 cycles of the first version, 30 of the second
  ASSERT_TRUE(rig.change(kPack, next).ok());
  rig.run_to(900);
  EXPECT_EQ(rig.get(kPack, "p.seen"), "60031");
  rig.undo(kLine);
  rig.run_to(1200);
  EXPECT_EQ(rig.get(kPack, "p.seen"), "60061");
  rig.accept(kPack);
  rig.run_to(1500);
  EXPECT_EQ(rig.get(kPack, "p.seen"), "60091");
  EXPECT_EQ(rig.get(kPack, "p.torn"), "0");
  EXPECT_EQ(rig.controller(kLine).missed_releases(), 0u);
  EXPECT_EQ(rig.controller(kPack).missed_releases(), 0u);
  EXPECT_EQ(rig.complaint(kPack), "");
}

// A structure whose layout differs between the two, since one of them has grown it in place.
TEST(Resources, LayoutsMayDiffer) {
  const std::string types = "TYPE S : STRUCT a : BYTE; b : LINT; END_STRUCT; END_TYPE ";
  const std::string grown = "TYPE S : STRUCT c : BYTE; a : BYTE; b : LINT; END_STRUCT; END_TYPE ";
  const std::string line = "s[1].a := s[1].a + 1; s[2].b := s[2].b + 1;";
  const std::string pack = "VAR a : BYTE; b : LINT; END_VAR a := s[1].a; b := s[2].b;";
  Rig rig(types + plant("s : ARRAY[1..2] OF S;", line, pack));
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(60);
  ASSERT_TRUE(rig.change(kLine, grown + plant("s : ARRAY[1..2] OF S;", line, pack)).ok());
  rig.run_to(120);
  EXPECT_EQ(rig.get(kPack, "p.b"), "7");
  EXPECT_EQ(rig.complaint(kPack),
            "`s` is another ARRAY[1..2] OF S in RESOURCE `Line`: not exchanged until both are the "
            "same");
  ASSERT_TRUE(rig.change(kPack, grown + plant("x : INT; s : ARRAY[1..2] OF S;", line, pack)).ok());
  rig.run_to(180);
  EXPECT_EQ(rig.complaint(kPack), "");
  EXPECT_EQ(rig.get(kPack, "p.b"), "19");
  EXPECT_EQ(rig.get(kPack, "p.a"), "16#13");
}

TEST(Resources, ATypeThatDiffersIsNeverRead) {
  const std::string pack = "VAR v, w : DINT; END_VAR v := speed; w := other;";
  const std::string line = "speed := speed + 1; other := other + 1;";
  Rig rig(plant("speed : INT; other : INT;", line, pack));
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(90);
  EXPECT_EQ(rig.get(kPack, "p.v"), "10");
  const std::string wider = plant("speed : DINT := 5; other : INT;",
                                  "speed := speed + 100000; other := other + 1;", pack);
  ASSERT_TRUE(rig.change(kLine, wider).ok());
  rig.run_to(180);
  EXPECT_EQ(rig.get(kPack, "p.v"), "10");  // the last value stays
  EXPECT_EQ(rig.get(kPack, "p.w"), "19");  // others go on
  EXPECT_EQ(
      rig.complaint(kPack),
      "`speed` is INT here and DINT in RESOURCE `Line`: not exchanged until both are the same");
  EXPECT_EQ(rig.status(kPack)[0].errors, 1u);
  ASSERT_TRUE(rig.change(kPack, wider).ok());
  rig.run_to(270);
  EXPECT_EQ(rig.get(kPack, "p.v"), "1800010");
  EXPECT_EQ(rig.complaint(kPack), "");
  rig.undo(kLine);
  rig.run_to(360);
  EXPECT_EQ(rig.get(kPack, "p.v"), "1800010");
  EXPECT_EQ(rig.get(kPack, "p.w"), "37");
  EXPECT_NE(rig.complaint(kPack), "");
}

TEST(Resources, AChangeThatWouldWriteWhatAnotherWritesIsRefused) {
  const std::string reads = "VAR v : INT; END_VAR v := speed;";
  Rig rig(plant("speed : INT; one, two : INT;", "speed := speed + 1;", reads));
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(60);
  const std::string moved = plant("speed : INT; one, two : INT;",
                                  "VAR v : INT; END_VAR v := speed;", "speed := speed - 1;");
  base::Status refused = rig.change(kPack, moved);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kTwoWriters);  // R0314
  EXPECT_NE(refused.error().text.find("`speed` would be written by RESOURCE `Pack`, but RESOURCE "
                                      "`Line` writes it"),
            std::string::npos);
  rig.run_to(120);
  EXPECT_EQ(rig.get(kPack, "p.v"), "13");
  // First Line gives it up for good, then Pack takes it.
  ASSERT_TRUE(rig.change(kLine, moved).ok());
  EXPECT_FALSE(rig.change(kPack, moved).ok());
  rig.accept(kLine);
  const base::Status taken = rig.change(kPack, moved);
  ASSERT_TRUE(taken.ok()) << base::to_string(taken.error());
  rig.run_to(180);
  EXPECT_EQ(rig.get(kLine, "p.v"), "10");  // 13, and three cycles of Pack since
}

TEST(Resources, ATrapInTheWriterLeavesTheLastWholeBlock) {
  const std::string line =
      "VAR i, zero : INT; END_VAR n := n + 1; FOR i := 0 TO 99 DO a[i] := n; "
      "IF n = 8 AND i = 50 THEN zero := 1 / zero; END_IF END_FOR";
  Rig rig(plant(kBlock, line, kReadsBlock));
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(600);
  EXPECT_TRUE(rig.controller(kLine).faulted());
  EXPECT_EQ(rig.get(kLine, "n"), "8");
  EXPECT_FALSE(rig.controller(kPack).faulted());
  EXPECT_EQ(rig.get(kPack, "p.seen"), "7");
  EXPECT_EQ(rig.get(kPack, "p.torn"), "0");
  EXPECT_GE(rig.status(kPack)[0].age_ns, 500 * kMs);
  EXPECT_EQ(rig.controller(kPack).tasks()[0].scans, 41u);
  ASSERT_TRUE(rig.controller(kLine).restart(vm::Restart::kCold, kMs).ok());
  rig.run_to(660);
  EXPECT_EQ(rig.get(kPack, "p.torn"), "0");
  EXPECT_LT(std::stoi(rig.get(kPack, "p.seen")), 8);
}

TEST(Resources, AForceOfTheWriterIsSeenAndOneOfTheReaderIsItsOwn) {
  Rig rig(plant("speed : INT;", "speed := speed + 1;", "VAR v : INT; END_VAR v := speed;"));
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(30);
  ASSERT_TRUE(rig.controller(kLine).force("speed", "500").ok());
  rig.run_to(60);
  EXPECT_EQ(rig.get(kPack, "p.v"), "500");
  ASSERT_TRUE(rig.controller(kPack).force("speed", "-1").ok());
  rig.run_to(90);
  EXPECT_EQ(rig.get(kPack, "p.v"), "-1");
  EXPECT_EQ(rig.get(kLine, "speed"), "500");
  ASSERT_TRUE(rig.controller(kPack).unforce("speed").ok());
  ASSERT_TRUE(rig.controller(kLine).unforce("speed").ok());
  rig.run_to(120);
  EXPECT_EQ(rig.get(kPack, "p.v"), "503");
}

// What the writer starts with is there before the reader's first scan, whoever comes first.
TEST(Resources, InitialValuesAreThereFromTheFirstScan) {
  Rig rig(
      "PROGRAM R VAR v, w : INT; END_VAR IF v = 0 THEN v := speed; END_IF w := w + speed; "
      "END_PROGRAM PROGRAM W speed := speed; END_PROGRAM CONFIGURATION Plant VAR_GLOBAL speed : "
      "INT := 3; END_VAR RESOURCE First ON cpu TASK t (INTERVAL := T#10ms); PROGRAM p WITH t : "
      "R; END_RESOURCE RESOURCE Second ON cpu TASK t (INTERVAL := T#10ms); PROGRAM p WITH t : W; "
      "END_RESOURCE END_CONFIGURATION");
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(0);
  EXPECT_EQ(rig.get(0, "p.v"), "3");
  EXPECT_EQ(rig.status(0)[0].exchanges, 1u);
}

TEST(Resources, NothingIsAllocatedInACycle) {
  Rig rig(plant(kBlock, kWritesBlock, kReadsBlock));
  ASSERT_TRUE(rig.ok()) << rig.error;
  rig.run_to(100);
  const uint64_t before = tests::allocations();
  rig.run_to(500);
  EXPECT_EQ(tests::allocations(), before);
  EXPECT_EQ(rig.get(kPack, "p.seen"), "50");
}

}  // namespace
}  // namespace resources_test
