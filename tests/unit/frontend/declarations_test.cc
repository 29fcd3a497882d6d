#include <gtest/gtest.h>

#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

TEST(Declarations, OrderAndFilesDoNotMatter) {
  Compiled compiled = compile_files(
      {"PROGRAM P VAR b : Block; r : Rec; END_VAR b(); r.a[Top] := Twice(Half); END_PROGRAM",
       "FUNCTION_BLOCK Block VAR inner : Inner; END_VAR inner(); END_FUNCTION_BLOCK "
       "FUNCTION Twice : INT VAR_INPUT x : INT; END_VAR Twice := x * 2; END_FUNCTION",
       "TYPE Rec : STRUCT a : ARRAY[0..Top] OF INT; END_STRUCT END_TYPE "
       "FUNCTION_BLOCK Inner END_FUNCTION_BLOCK "
       "VAR_GLOBAL CONSTANT Top : INT := Half + 2; Half : INT := 3; END_VAR"});
  EXPECT_EQ(compiled.errors(), "") << compiled.text;
  ASSERT_TRUE(compiled.program);
  EXPECT_TRUE(compiled.program->find_pou("twice").valid());
}

TEST(Declarations, OnlyUsedLibraryBlocksEnterTheProgram) {
  Compiled compiled = compile("PROGRAM P VAR t : TON; END_VAR t(); END_PROGRAM");
  ASSERT_TRUE(compiled.program);
  EXPECT_EQ(compiled.program->pous.size(), 2u);
  EXPECT_TRUE(compiled.program->find_pou("TON").valid());
  EXPECT_FALSE(compiled.program->find_pou("TOF").valid());
}

TEST(Declarations, ProjectMayReplaceALibraryBlock) {
  Controlled run(
      "FUNCTION_BLOCK TON VAR_OUTPUT Mine : INT; END_VAR Mine := 7; END_FUNCTION_BLOCK\n"
      "PROGRAM P VAR t : TON; END_VAR t(); END_PROGRAM");
  run.scan();
  EXPECT_EQ(run.number("P.t.Mine"), 7);
}

TEST(InitialValues, ScalarsArraysStructuresInstances) {
  Controlled run(
      "TYPE Pair : STRUCT a : INT := 5; b : ARRAY[0..1] OF BYTE; s : STRING[4] := 'ab'; END_STRUCT;"
      " Speed : INT := 50; Level : INT(3..9); Quick : Pair := (a := 8); END_TYPE\n"
      "FUNCTION_BLOCK F VAR_INPUT k : INT := 2; END_VAR VAR inner : INT := 4; END_VAR\n"
      "END_FUNCTION_BLOCK\n"
      "PROGRAM P VAR p : Pair := (b := [1, 2]); q : Quick; v : Speed; l : Level; f : F := (k := 9);"
      " a : ARRAY[1..2, 1..3] OF INT := [1, 2(5), 3(7)]; ps : ARRAY[0..1] OF Pair := [(a := 1), "
      "(a := 2)]; vs : ARRAY[0..1] OF Speed; END_VAR\n"
      "f(); END_PROGRAM");
  EXPECT_EQ(run.number("P.p.a"), 5);
  EXPECT_EQ(run.number("P.p.b[1]"), 2);
  EXPECT_EQ(run.text("P.p.s"), "ab");
  EXPECT_EQ(run.number("P.q.a"), 8);
  EXPECT_EQ(run.number("P.v"), 50);
  EXPECT_EQ(run.number("P.l"), 3);
  EXPECT_EQ(run.number("P.f.k"), 9);
  EXPECT_EQ(run.number("P.f.inner"), 4);
  EXPECT_EQ(run.number("P.a[1,1]"), 1);
  EXPECT_EQ(run.number("P.a[1,3]"), 5);
  EXPECT_EQ(run.number("P.a[2,3]"), 7);
  EXPECT_EQ(run.number("P.ps[1].a"), 2);
  EXPECT_EQ(run.number("P.vs[1]"), 50);
}

TEST(InitialValues, LocalsStartAnewAtEachCall) {
  Controlled run(
      "FUNCTION F : INT VAR_INPUT x : INT; END_VAR VAR n : INT := x + 1; m : INT; a : ARRAY[0..1] "
      "OF "
      "INT := [3, 4]; END_VAR m := m + n + a[0]; a[0] := 100; F := m; END_FUNCTION\n"
      "PROGRAM P VAR y : INT; n : INT; END_VAR VAR_TEMP t : INT := 5; END_VAR\n"
      "y := F(1); y := F(2); t := t + 1; n := t; END_PROGRAM");
  run.scan(2);
  EXPECT_EQ(run.number("P.y"), 6);
  EXPECT_EQ(run.number("P.n"), 6);
}

TEST(Enumerations, SameLiteralInTwoTypes) {
  Controlled run(
      "TYPE A : (Off, On); B : (On := 3, Off := 7); END_TYPE\n"
      "PROGRAM P VAR a : A; b : B; x : BOOL; END_VAR a := On; b := Off; x := b = Off; END_PROGRAM");
  run.scan();
  EXPECT_EQ(run.number("P.a"), 1);
  EXPECT_EQ(run.number("P.b"), 7);
  EXPECT_EQ(run.number("P.x"), 1);
}

TEST(Subranges, AreChecked) {
  Controlled run("s : INT(0..10); i : INT;", "s := i;");
  run.set("P.i", 10);
  EXPECT_EQ(run.scan(), "");
  run.set("P.i", 11);
  EXPECT_EQ(run.scan(), "subrange");
}

TEST(Globals, WithAndWithoutExternal) {
  Controlled run(
      "VAR_GLOBAL g : INT; h : INT := 3; END_VAR\n"
      "PROGRAM P VAR_EXTERNAL g : INT; END_VAR g := g + h; %QX0.1 := TRUE; %MW4 := 5; END_PROGRAM");
  run.scan(2);
  EXPECT_EQ(run.number("g"), 6);
}

TEST(DirectAddresses, AreTheDeclaredVariableThere) {
  Compiled compiled = compile(
      "VAR_GLOBAL lamp AT %QX0.1 : BOOL; END_VAR\n"
      "PROGRAM P %QX0.1 := TRUE; %QX0.2 := %QX0.1; END_PROGRAM");
  ASSERT_TRUE(compiled.program) << compiled.text;
  const auto& globals = compiled.program->types[compiled.program->globals].members;
  ASSERT_EQ(globals.size(), 2u);
  EXPECT_EQ(globals[0].name, "lamp");
  EXPECT_EQ(globals[1].name, "%QX0.2");
}

TEST(Configuration, TasksAndPrograms) {
  Compiled compiled = compile(
      "CONFIGURATION Plant VAR_GLOBAL g : INT; END_VAR RESOURCE R ON CPU\n"
      "TASK fast(INTERVAL := T#5ms, PRIORITY := 1); TASK slow(INTERVAL := T#100ms, PRIORITY := "
      "2);\n"
      "PROGRAM a WITH fast : Worker(x := 4); PROGRAM b WITH slow : Worker; END_RESOURCE "
      "END_CONFIGURATION\n"
      "PROGRAM Worker VAR_INPUT x : INT; END_VAR g := x; END_PROGRAM");
  ASSERT_TRUE(compiled.program) << compiled.text;
  const ir::Program& program = *compiled.program;
  EXPECT_EQ(program.name, "Plant");
  ASSERT_EQ(program.tasks.size(), 2u);
  EXPECT_EQ(program.tasks[0].period_ns, 5'000'000);
  EXPECT_EQ(program.tasks[1].priority, 2u);
  ASSERT_EQ(program.instances.size(), 2u);
  EXPECT_EQ(program.instances[1].task, 1u);
  EXPECT_TRUE(program.instances[0].init.valid());
  EXPECT_FALSE(program.instances[1].init.valid());
}

}  // namespace
}  // namespace frontend_test
