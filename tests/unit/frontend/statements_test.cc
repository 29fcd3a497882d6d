#include <gtest/gtest.h>

#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

TEST(If, TakesTheFirstTrueBranch) {
  Controlled run("x, y : INT;",
                 "IF x > 10 THEN y := 1; ELSIF x > 5 THEN y := 2; ELSE y := 3; END_IF");
  run.scan();
  EXPECT_EQ(run.number("P.y"), 3);
  run.set("P.x", 7);
  run.scan();
  EXPECT_EQ(run.number("P.y"), 2);
  run.set("P.x", 11);
  run.scan();
  EXPECT_EQ(run.number("P.y"), 1);
}

TEST(For, EndsAtTheLimitOfItsType) {
  Controlled run("s : SINT; n : INT; u : USINT; m : INT;",
                 "n := 0; FOR s := 120 TO 127 DO n := n + 1; END_FOR\n"
                 "m := 0; FOR u := 3 TO 0 BY -1 DO m := m + 1; END_FOR");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.n"), 8);
  EXPECT_EQ(run.number("P.s"), 127);
  EXPECT_EQ(run.number("P.m"), 4);
  EXPECT_EQ(run.number("P.u"), 0);
}

TEST(For, VariableIsLastPlusStepAfterwards) {
  Controlled run("i, j, k : INT;",
                 "FOR i := 1 TO 10 BY 3 DO ; END_FOR\n"
                 "FOR j := 5 TO 1 DO ; END_FOR\n"
                 "FOR k := 10 TO 1 BY -4 DO ; END_FOR");
  run.scan();
  EXPECT_EQ(run.number("P.i"), 13);
  EXPECT_EQ(run.number("P.j"), 5);
  EXPECT_EQ(run.number("P.k"), -2);
}

TEST(For, StepMayBeAVariable) {
  Controlled run("i, step, n : INT;", "n := 0; FOR i := 0 TO 6 BY step DO n := n + 1; END_FOR");
  run.set("P.step", 2);
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.n"), 4);
  EXPECT_EQ(run.number("P.i"), 8);
  run.set("P.step", 20000);
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.n"), 1);
  run.set("P.step", -1);
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.n"), 0);
  run.set("P.step", 0);
  EXPECT_EQ(run.scan(), "for-step");
}

TEST(For, VariableStepStopsAtTheLimit) {
  Controlled run("i : SINT; u : USINT; step : SINT := 100; n, m : INT;",
                 "n := 0; FOR i := -100 TO 127 BY step DO n := n + 1; END_FOR\n"
                 "step := -100; m := 0; FOR u := 255 TO 0 BY step DO m := m + 1; END_FOR\n"
                 "step := 100;");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.n"), 3);
  EXPECT_EQ(run.number("P.i"), 100);
  EXPECT_EQ(run.number("P.m"), 3);
  EXPECT_EQ(run.number("P.u"), 55);
}

TEST(For, BoundsAreEvaluatedOnce) {
  Controlled run("i, top, n : INT;",
                 "top := 3; n := 0; FOR i := 1 TO top DO top := 100; n := n + 1; END_FOR");
  run.scan();
  EXPECT_EQ(run.number("P.n"), 3);
}

TEST(For, SubrangeStaysInside) {
  Controlled run("i : INT(0..10); n : INT;", "n := 0; FOR i := 0 TO 10 DO n := n + 1; END_FOR");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.n"), 11);
  EXPECT_EQ(run.number("P.i"), 10);
}

TEST(Loops, ExitAndContinue) {
  Controlled run("i, odd, w, r : INT;",
                 "odd := 0; FOR i := 1 TO 100 DO IF i MOD 2 = 0 THEN CONTINUE; END_IF\n"
                 "IF i > 9 THEN EXIT; END_IF odd := odd + 1; END_FOR\n"
                 "w := 0; WHILE TRUE DO w := w + 1; IF w = 4 THEN EXIT; END_IF END_WHILE\n"
                 "r := 0; REPEAT r := r + 2; UNTIL r >= 5 END_REPEAT");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.odd"), 5);
  EXPECT_EQ(run.number("P.i"), 11);
  EXPECT_EQ(run.number("P.w"), 4);
  EXPECT_EQ(run.number("P.r"), 6);
}

TEST(Case, ManyLabelsBecomeATree) {
  Controlled run("x, y : INT;",
                 "CASE x OF -5: y := 1; 1, 3: y := 2; 10..20: y := 3; 21: y := 4; 30: y := 5;"
                 "40: y := 6; 50: y := 7; 60..70: y := 8; ELSE y := 0; END_CASE");
  const std::pair<int, int> kExpected[] = {{-5, 1}, {1, 2},  {3, 2},  {2, 0},  {10, 3}, {15, 3},
                                           {20, 3}, {21, 4}, {22, 0}, {30, 5}, {40, 6}, {50, 7},
                                           {60, 8}, {70, 8}, {71, 0}, {-6, 0}};
  for (auto [x, y] : kExpected) {
    run.set("P.x", x);
    run.scan();
    EXPECT_EQ(run.number("P.y"), y) << x;
  }
}

TEST(Case, EnumerationsAndUnsigned) {
  Controlled run(
      "TYPE Color : (Red, Green := 5, Blue); END_TYPE\n"
      "PROGRAM P VAR c : Color := Blue; y : INT; u : ULINT := 18446744073709551615; z : INT; "
      "END_VAR\n"
      "CASE c OF Red: y := 1; Color#Green: y := 2; Color.Blue: y := 3; END_CASE\n"
      "CASE u OF 0..10: z := 1; 18446744073709551000..18446744073709551615: z := 2; END_CASE\n"
      "END_PROGRAM");
  run.scan();
  EXPECT_EQ(run.number("P.y"), 3);
  EXPECT_EQ(run.number("P.z"), 2);
  EXPECT_EQ(run.number("P.c"), 6);
}

TEST(Return, LeavesThePou) {
  Controlled run("x : INT;", "x := 1; IF x = 1 THEN RETURN; END_IF x := 2;");
  run.scan();
  EXPECT_EQ(run.number("P.x"), 1);
}

TEST(Unreachable, CodeIsDroppedButChecked) {
  Compiled good = compile("PROGRAM P VAR x : INT; END_VAR RETURN; x := 1; END_PROGRAM");
  EXPECT_EQ(good.errors(), "");
  EXPECT_EQ(good.warnings(), "W0004");
  Compiled bad = compile("PROGRAM P VAR x : INT; END_VAR RETURN; x := nothing; END_PROGRAM");
  EXPECT_EQ(bad.errors(), "E2001");
}

}  // namespace
}  // namespace frontend_test
