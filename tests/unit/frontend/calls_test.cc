#include <gtest/gtest.h>

#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

const char* const kScale =
    "FUNCTION Scale : INT VAR_INPUT x : INT; k : INT := 2; END_VAR VAR_OUTPUT over : BOOL; END_VAR "
    "VAR_IN_OUT n : DINT; END_VAR Scale := x * k; over := Scale > 100; n := n + 1; END_FUNCTION\n";

TEST(Functions, FormalPositionalMixedDefaults) {
  Controlled run(
      std::string(kScale) +
      "PROGRAM P VAR a, b, c : INT; o : BOOL; n : DINT; w : WORD; END_VAR\n"
      "a := Scale(x := 10, n := n); b := Scale(30, 4, o, n); c := Scale(5, n := n, over => w.3);\n"
      "Scale(n := n, x := 1); END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.a"), 20);
  EXPECT_EQ(run.number("P.b"), 120);
  EXPECT_EQ(run.number("P.c"), 10);
  EXPECT_EQ(run.number("P.o"), 1);
  EXPECT_EQ(run.number("P.n"), 4);
  EXPECT_EQ(run.number("P.w"), 0);
}

TEST(Functions, NestedCallsKeepTheirArguments) {
  Controlled run(
      "FUNCTION Add : INT VAR_INPUT a, b : INT; END_VAR Add := a + b; END_FUNCTION\n"
      "PROGRAM P VAR x : INT; END_VAR x := Add(Add(1, 2), Add(Add(3, 4), 5)) * Add(1, 1);\n"
      "END_PROGRAM");
  run.scan();
  EXPECT_EQ(run.number("P.x"), 30);
}

TEST(Functions, StringsAndStructures) {
  Controlled run(
      "TYPE Pair : STRUCT a, b : INT; END_STRUCT END_TYPE\n"
      "FUNCTION Make : Pair VAR_INPUT a : INT; t : STRING[10]; END_VAR Make.a := a; Make.b := "
      "LEN(t); "
      "END_FUNCTION\n"
      "FUNCTION Greet : STRING[20] VAR_INPUT who : STRING := 'you'; END_VAR\n"
      "Greet := CONCAT('hi ', who); END_FUNCTION\n"
      "PROGRAM P VAR p : Pair; s, t : STRING; n : INT; END_VAR\n"
      "p := Make(3, 'four'); s := Greet('me'); t := CONCAT(Greet(), '!'); n := Make(9, '').a;\n"
      "END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.p.a"), 3);
  EXPECT_EQ(run.number("P.p.b"), 4);
  EXPECT_EQ(run.text("P.s"), "hi me");
  EXPECT_EQ(run.text("P.t"), "hi you!");
  EXPECT_EQ(run.number("P.n"), 9);
}

TEST(Functions, ArgumentsAreEvaluatedInOrder) {
  Controlled run(
      "VAR_GLOBAL s : STRING := 'a'; END_VAR\n"
      "FUNCTION Change : STRING s := 'changed'; Change := 'b'; END_FUNCTION\n"
      "FUNCTION Join : STRING VAR_INPUT x, y : STRING; END_VAR Join := CONCAT(x, y); END_FUNCTION\n"
      "PROGRAM P VAR r : STRING; END_VAR r := Join(s, Change()); END_PROGRAM");
  run.scan();
  EXPECT_EQ(run.text("P.r"), "ab");
}

TEST(Blocks, OmittedInputsKeepTheirValue) {
  Controlled run(
      "FUNCTION_BLOCK Sum VAR_INPUT a, b : INT; END_VAR VAR_OUTPUT s : INT; END_VAR s := a + b; "
      "END_FUNCTION_BLOCK\n"
      "PROGRAM P VAR f : Sum; x, y : INT; END_VAR f(a := 1, b := 2, s => x); f(a := 10); y := f.s; "
      "f.b := 100; f(); END_PROGRAM");
  run.scan();
  EXPECT_EQ(run.number("P.x"), 3);
  EXPECT_EQ(run.number("P.y"), 12);
  EXPECT_EQ(run.number("P.f.s"), 110);
}

TEST(Blocks, InOutsArraysAndNesting) {
  Controlled run(
      "FUNCTION_BLOCK Inc VAR_IN_OUT v : ARRAY[0..1] OF INT; END_VAR v[1] := v[1] + 1; "
      "END_FUNCTION_BLOCK\n"
      "FUNCTION_BLOCK Outer VAR i : ARRAY[1..2] OF Inc; n : INT; END_VAR VAR_IN_OUT d : "
      "ARRAY[0..1] OF "
      "INT; END_VAR FOR n := 1 TO 2 DO i[n](v := d); END_FOR END_FUNCTION_BLOCK\n"
      "FUNCTION_BLOCK User VAR_IN_OUT t : Inc; data : ARRAY[0..1] OF INT; END_VAR t(v := data); "
      "END_FUNCTION_BLOCK\n"
      "PROGRAM P VAR o : Outer; u : User; i : Inc; data : ARRAY[0..1] OF INT; END_VAR\n"
      "o(d := data); u(t := i, data := data); END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.data[1]"), 3);
}

TEST(Blocks, NegatedOutput) {
  Controlled run(
      "FUNCTION_BLOCK B VAR_OUTPUT q : BOOL; END_VAR q := FALSE; END_FUNCTION_BLOCK\n"
      "PROGRAM P VAR b : B; x : BOOL; END_VAR b(NOT q => x); END_PROGRAM");
  run.scan();
  EXPECT_EQ(run.number("P.x"), 1);
}

TEST(Arrays, IndexOutsideTraps) {
  Controlled run("a : ARRAY[1..3] OF INT; i : INT;", "a[i] := 1;");
  EXPECT_EQ(run.scan(), "index");
  run.set("P.i", 3);
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.a[3]"), 1);
}

TEST(Blocks, ListsAsArguments) {
  Controlled run(
      "FUNCTION_BLOCK Acc VAR_INPUT arr : ARRAY[0..2] OF INT; END_VAR VAR_OUTPUT o : INT; END_VAR\n"
      "VAR CONSTANT k : INT := 3; tab : ARRAY[0..2] OF INT := [k(4)]; END_VAR\n"
      "o := arr[1] + tab[2]; END_FUNCTION_BLOCK\n"
      "PROGRAM P VAR a : Acc; END_VAR a(arr := [1, 2, 3]); END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.a.o"), 6);
}

TEST(Arrays, OfArraysAndStructures) {
  Controlled run(
      "TYPE Cell : STRUCT v : ARRAY[0..1] OF INT; END_STRUCT END_TYPE\n"
      "PROGRAM P VAR a, b : ARRAY[0..1] OF ARRAY[1..2] OF Cell; i : INT := 1; END_VAR\n"
      "a[i][2].v[1] := 5; b := a; b[1][1] := a[1][2]; END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.b[1][2].v[1]"), 5);
  EXPECT_EQ(run.number("P.b[1][1].v[1]"), 5);
}

}  // namespace
}  // namespace frontend_test
