#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

TEST(Literals, TakeTheTypeOfTheirContext) {
  Controlled run(
      "b : BYTE; r : REAL; l : LREAL; u : USINT; i : LINT;",
      "b := 16#FF; r := 2; l := 1; u := u + 255; i := -9223372036854775808; l := l / 4;");
  run.scan();
  EXPECT_EQ(run.number("P.b"), 255);
  EXPECT_EQ(run.real("P.r"), 2.0);
  EXPECT_EQ(run.lreal("P.l"), 0.25);
  EXPECT_EQ(run.number("P.i"), INT64_MIN);
}

// Where it is stored (run/width_codesys).
TEST(Arithmetic, WrapsInTheDeclaredWidth) {
  Controlled run("a : INT := 32767; b : USINT; c : LINT; d : INT := -7;",
                 "c := a + 1; a := a + 1; b := b - 1; d := d / 2;");
  run.scan();
  EXPECT_EQ(run.number("P.a"), -32768);
  EXPECT_EQ(run.number("P.c"), 32768);
  EXPECT_EQ(run.number("P.b"), 255);
  EXPECT_EQ(run.number("P.d"), -3);
}

TEST(Arithmetic, MixedIntegersMeetInATypeThatHoldsBoth) {
  Controlled run("i : INT := -1; u : UINT := 65535; d : DINT; b : BOOL; w : WORD := 16#FFFF;",
                 "d := i + u; b := i < u; d := d + w;");
  run.scan();
  EXPECT_EQ(run.number("P.d"), 65534 + 65535);
  EXPECT_EQ(run.number("P.b"), 1);
}

TEST(Arithmetic, DivisionByZeroTraps) {
  Controlled run("a, b : INT;", "a := 1 / b;");
  EXPECT_EQ(run.scan(), "division-by-zero");
}

TEST(Arithmetic, PowerAndModulo) {
  Controlled run("r : REAL; l : LREAL; m : INT := -7; i : INT := 3;",
                 "r := 2.0 ** 3; l := i ** 2; m := m MOD 3;");
  run.scan();
  EXPECT_EQ(run.real("P.r"), 8.0);
  EXPECT_EQ(run.lreal("P.l"), 9.0);
  EXPECT_EQ(run.number("P.m"), -1);
}

TEST(Times, Arithmetic) {
  Controlled run(
      "t : TIME; u : TIME := T#1s; d : DT := DT#2026-01-31-23:59:59; e : DT; s : TIME;"
      "x : TOD := TOD#12:00:00; k : INT := 3; r : REAL := 0.5; l : LTIME;",
      "t := u * k + T#5ms; e := d + T#1s; s := e - d; x := x - T#1h; u := u * r;"
      "l := u / 2; t := t + 2 * T#1ms;");
  run.scan();
  EXPECT_EQ(run.number("P.t"), 3'007'000'000);
  EXPECT_EQ(run.number("P.s"), 1'000'000'000);
  EXPECT_EQ(run.number("P.x"), int64_t{11} * 3600 * 1'000'000'000);
  EXPECT_EQ(run.number("P.u"), 500'000'000);
  EXPECT_EQ(run.number("P.l"), 250'000'000);
}

TEST(Bits, ReadAndWrite) {
  Controlled run(
      "w : WORD; i : INT := -1; b : BOOL; y : BYTE; d : DWORD := 16#12345678; a : ARRAY[0..1] "
      "OF BYTE;",
      "w.15 := TRUE; w.0 := TRUE; b := i.15; i.15 := FALSE; y := d.%B1; d.%W0 := 16#ABCD;"
      "a[1].3 := TRUE; w.%B0 := 16#81;");
  run.scan();
  EXPECT_EQ(run.number("P.w"), 0x8081);
  EXPECT_EQ(run.number("P.b"), 1);
  EXPECT_EQ(run.number("P.i"), 32767);
  EXPECT_EQ(run.number("P.y"), 0x56);
  EXPECT_EQ(run.number("P.d"), 0x1234ABCD);
  EXPECT_EQ(run.number("P.a[1]"), 8);
}

TEST(Logic, BothSidesOrOne) {
  Controlled run(
      "VAR_GLOBAL n : INT; END_VAR\n"
      "FUNCTION F : BOOL n := n + 1; F := TRUE; END_FUNCTION\n"
      "PROGRAM P VAR a, b, c, d : BOOL; END_VAR\n"
      "a := FALSE AND F(); b := TRUE OR F(); c := FALSE AND_THEN F(); d := TRUE OR_ELSE F();\n"
      "END_PROGRAM");
  run.scan();
  EXPECT_EQ(run.number("n"), 2);
  EXPECT_EQ(run.number("P.a"), 0);
  EXPECT_EQ(run.number("P.b"), 1);
  EXPECT_EQ(run.number("P.c"), 0);
  EXPECT_EQ(run.number("P.d"), 1);
}

TEST(Comparison, StringsAndBools) {
  Controlled run("s : STRING := 'abc'; a, b, c, d : BOOL;",
                 "a := s = 'abc'; b := s < 'abd'; c := FALSE < TRUE; d := 'b' <= s;");
  run.scan();
  EXPECT_EQ(run.number("P.a"), 1);
  EXPECT_EQ(run.number("P.b"), 1);
  EXPECT_EQ(run.number("P.c"), 1);
  EXPECT_EQ(run.number("P.d"), 0);
}

TEST(Constants, FoldExactly) {
  Controlled run(
      "VAR_GLOBAL CONSTANT N : INT := M * 2; M : INT := 3; S : STRING := 'x'; END_VAR\n"
      "PROGRAM P VAR CONSTANT K : DINT := N + 1; END_VAR VAR a : ARRAY[1..N] OF INT; x : INT := K; "
      "b : BOOL := N > 5 AND M = 3; r : REAL := 1.0 / 4; w : WORD := NOT 0; t : TIME := T#1s * 2; "
      "s1 : STRING[3] := S; END_VAR\n"
      "a[N] := 1; END_PROGRAM");
  run.scan();
  EXPECT_EQ(run.number("P.a[6]"), 1);
  EXPECT_EQ(run.number("P.x"), 7);
  EXPECT_EQ(run.number("P.b"), 1);
  EXPECT_EQ(run.real("P.r"), 0.25);
  EXPECT_EQ(run.number("P.w"), 65535);
  EXPECT_EQ(run.number("P.t"), 2'000'000'000);
  EXPECT_EQ(run.text("P.s1"), "x");
}

TEST(Conversions, Explicit) {
  Controlled run(
      "i : INT; s : SINT; d : DINT; r : REAL := 2.5; l : LREAL; b : BOOL; t : TIME; w : WORD;"
      "k : INT; lt : LTIME; dt1 : DT := DT#1970-01-02-00:00:01; da : DATE; to1 : TOD; u : UDINT;",
      "i := REAL_TO_INT(r); s := DINT_TO_SINT(300); d := TRUNC(-2.7); l := INT_TO_LREAL(i);"
      "b := INT_TO_BOOL(i); t := INT_TO_TIME(1500); w := TO_WORD(-1); k := TIME_TO_INT(T#2s);"
      "lt := TO_LTIME(5); da := DT_TO_DATE(dt1); to1 := DT_TO_TOD(dt1); u := DT_TO_UDINT(dt1);");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.i"), 2);
  EXPECT_EQ(run.number("P.s"), 44);
  EXPECT_EQ(run.number("P.d"), -2);
  EXPECT_EQ(run.lreal("P.l"), 2.0);
  EXPECT_EQ(run.number("P.b"), 1);
  EXPECT_EQ(run.number("P.t"), 1'500'000'000);
  EXPECT_EQ(run.number("P.w"), 65535);
  EXPECT_EQ(run.number("P.k"), 2000);
  EXPECT_EQ(run.number("P.lt"), 5);
  EXPECT_EQ(run.number("P.da"), int64_t{86400} * 1'000'000'000);
  EXPECT_EQ(run.number("P.to1"), 1'000'000'000);
  EXPECT_EQ(run.number("P.u"), 86401);
}

TEST(Conversions, OutOfRangeTraps) {
  Controlled run("i : INT; r : REAL := 40000.0;", "i := REAL_TO_INT(r);");
  EXPECT_EQ(run.scan(), "conversion");
}

TEST(Conversions, Strings) {
  Controlled run("s, t, u : STRING; i : INT; r : REAL; w : WSTRING;",
                 "s := INT_TO_STRING(-42); t := REAL_TO_STRING(2.5); u := TO_STRING(T#1s500ms);"
                 "i := STRING_TO_INT('123'); r := STRING_TO_REAL('1.5'); w := STRING_TO_WSTRING(s);"
                 "s := CONCAT(WSTRING_TO_STRING(w), BOOL_TO_STRING(TRUE));");
  run.scan();
  EXPECT_EQ(run.text("P.s"), "-42TRUE");
  EXPECT_EQ(run.text("P.t"), "2.5");
  EXPECT_EQ(run.text("P.u"), "T#1s500ms");
  EXPECT_EQ(run.number("P.i"), 123);
  EXPECT_EQ(run.real("P.r"), 1.5);
}

TEST(Standard, Numeric) {
  Controlled run(
      "i : INT := -5; r : REAL := 4.0; l : LREAL; a : REAL; m, x, q, z : INT; b : BOOL; t : TIME;",
      "i := ABS(i); r := SQRT(r); l := ATAN2(1.0, 0.0); a := LN(EXP(1.0)); m := MAX(1, i, 3);"
      "x := LIMIT(0, 12, 10); q := MUX(2, 10, 20, 30); z := SEL(G := TRUE, IN0 := 1, IN1 := 2);"
      "b := GT(3, 2, 1); t := MAX(T#1s, T#2s); x := x + MUX(7, 1, 2);");
  run.scan();
  EXPECT_EQ(run.number("P.i"), 5);
  EXPECT_EQ(run.real("P.r"), 2.0);
  EXPECT_DOUBLE_EQ(run.lreal("P.l"), M_PI / 2);
  EXPECT_FLOAT_EQ(static_cast<float>(run.real("P.a")), 1.0f);
  EXPECT_EQ(run.number("P.m"), 5);
  EXPECT_EQ(run.number("P.x"), 12);
  EXPECT_EQ(run.number("P.q"), 30);
  EXPECT_EQ(run.number("P.z"), 2);
  EXPECT_EQ(run.number("P.b"), 1);
  EXPECT_EQ(run.number("P.t"), 2'000'000'000);
}

TEST(Standard, OperatorsAsFunctions) {
  Controlled run(
      "a : INT; b : REAL; w : WORD := 16#F0; t : TIME; s : INT := -1; c : BOOL;",
      "a := ADD(1, 2, 3); b := DIV(1.0, 4.0); w := SHL(w, 4) OR SHR(w, 4); t := ADD(T#1s, T#1s);"
      "a := SUB(a, 10); w := ROL(w, 4); s := SHR(s, 15); c := AND(TRUE, NOT(FALSE), XOR(TRUE, "
      "FALSE)); b := EXPT(b, 2.0);");
  run.scan();
  EXPECT_EQ(run.number("P.a"), -4);
  EXPECT_EQ(run.real("P.b"), 0.0625);
  EXPECT_EQ(run.number("P.w"), 0xF0F0);
  EXPECT_EQ(run.number("P.t"), 2'000'000'000);
  EXPECT_EQ(run.number("P.s"), 1);
  EXPECT_EQ(run.number("P.c"), 1);
}

TEST(Standard, Strings) {
  Controlled run(
      "s, t : STRING := 'hello'; n, f : INT; sel : STRING[3]; w : WSTRING := \"ab\"; k : INT;",
      "n := LEN(s); f := FIND(s, 'l'); s := CONCAT(LEFT(s, 2), MID(t, 2, 3), RIGHT(t, 1));"
      "t := REPLACE(INSERT(DELETE(t, 1, 1), 'XY', 2), 'Z', 1, 1); sel := SEL(TRUE, 'no', 'yes!');"
      "w := CONCAT(w, \"c\"); k := LEN(w);");
  run.scan();
  EXPECT_EQ(run.number("P.n"), 5);
  EXPECT_EQ(run.number("P.f"), 3);
  EXPECT_EQ(run.text("P.s"), "hello");
  EXPECT_EQ(run.text("P.t"), "ZlXYlo");
  EXPECT_EQ(run.text("P.sel"), "yes");
  EXPECT_EQ(run.number("P.k"), 3);
}

}  // namespace
}  // namespace frontend_test
