// One wrong source for each message of the front end's meaning.
#include <gtest/gtest.h>

#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

struct Wrong {
  const char* code;
  const char* source;
};

std::string program(const std::string& vars, const std::string& body) {
  return "PROGRAM P VAR " + vars + " END_VAR " + body + " END_PROGRAM";
}

class Rejects : public testing::TestWithParam<Wrong> {};

TEST_P(Rejects, WithItsCode) {
  Compiled compiled = compile(GetParam().source);
  EXPECT_EQ(compiled.errors(), GetParam().code) << GetParam().source << "\n" << compiled.text;
}

const Wrong kWhole[] = {
    {"E2002", "VAR_GLOBAL a : INT; A : BOOL; END_VAR PROGRAM P END_PROGRAM"},
    {"E2002", "TYPE T : INT; T : BOOL; END_TYPE"},
    {"E2002", "FUNCTION_BLOCK F END_FUNCTION_BLOCK FUNCTION_BLOCK f END_FUNCTION_BLOCK"},
    {"E2002", "TYPE S : STRUCT a : INT; a : INT; END_STRUCT END_TYPE"},
    {"E2002", "TYPE E : (a, b, a); END_TYPE"},
    {"E2003", "PROGRAM P VAR x : Nonsense; END_VAR x(); END_PROGRAM"},
    {"E2005", "TYPE S : STRUCT a : ARRAY[0..1] OF S; END_STRUCT END_TYPE"},
    {"E2005", "FUNCTION_BLOCK F VAR f : F; END_VAR f(); END_FUNCTION_BLOCK"},
    {"E2005",
     "FUNCTION_BLOCK F VAR g : ARRAY[0..1] OF G; END_VAR g[0](); END_FUNCTION_BLOCK "
     "FUNCTION_BLOCK G VAR f : F; END_VAR f(); END_FUNCTION_BLOCK"},
    {"E2007", "VAR_GLOBAL CONSTANT A : INT := B; B : INT := A; END_VAR"},
    {"E2009", "TYPE T : ARRAY[5..1] OF INT; END_TYPE"},
    {"E2009", "TYPE T : INT(5..1); END_TYPE"},
    {"E2010", "TYPE A : (x, y); B : (y, x); END_TYPE VAR_GLOBAL v : INT := y; END_VAR"},
    {"E2011", "TYPE S : STRUCT a : INT; END_STRUCT END_TYPE VAR_GLOBAL s : S := 5; END_VAR"},
    {"E2012", "VAR_GLOBAL a : ARRAY[0..1] OF INT := [1, 2, 3]; END_VAR"},
    {"E2012", "VAR_GLOBAL a : ARRAY[0..1] OF INT := [3(1)]; END_VAR"},
    {"E2013", "TYPE A : (x, y); END_TYPE VAR_GLOBAL v : A := A#z; END_VAR"},
    {"E2014", "VAR_GLOBAL v AT %QX0.0 : INT; END_VAR"},
    {"E2014",
     "TYPE Mode : (off, on); END_TYPE VAR_GLOBAL v AT %MW0 : INT; w AT %MW0 : Mode; END_VAR"},
    {"E2015",
     "VAR_GLOBAL g : INT; END_VAR PROGRAM P VAR_EXTERNAL g : BOOL; END_VAR g := TRUE; "
     "END_PROGRAM"},
    {"E2001", "PROGRAM P VAR_EXTERNAL g : BOOL; END_VAR END_PROGRAM"},
    {"E2016", "FUNCTION F : INT VAR_INPUT t : TON; END_VAR END_FUNCTION"},
    {"E3001", "PROGRAM Q END_PROGRAM PROGRAM P VAR q : Q; END_VAR END_PROGRAM"},
    {"E3002", "TYPE E : BYTE (a := 255, b); END_TYPE"},
    {"E6005", "VAR_GLOBAL a : ARRAY[0..1000000, 0..1000000] OF INT; END_VAR"},
    {"E6006", "VAR_GLOBAL a : ARRAY[0..1,0..1,0..1,0..1,0..1,0..1,0..1,0..1,0..1] OF INT; END_VAR"},
    {"E5005",
     "CONFIGURATION C RESOURCE R ON X TASK t(INTERVAL := T#1ms, PRIORITY := 1); END_RESOURCE "
     "END_CONFIGURATION PROGRAM Q END_PROGRAM"},
    {"E5003",
     "CONFIGURATION C RESOURCE R ON X TASK t(INTERVAL := T#1ms, PRIORITY := 1); TASK u(INTERVAL := "
     "T#1ms, PRIORITY := 2); PROGRAM p WITH t : A; PROGRAM q WITH u : B; END_RESOURCE "
     "END_CONFIGURATION PROGRAM A %QX0.0 := TRUE; END_PROGRAM PROGRAM B VAR f : F; END_VAR f(); "
     "END_PROGRAM FUNCTION_BLOCK F VAR_EXTERNAL lamp : BOOL; END_VAR lamp := TRUE; "
     "END_FUNCTION_BLOCK VAR_GLOBAL lamp AT %QX0.7 : BOOL; END_VAR"},
    {"E6007", "VAR_GLOBAL a : STRING[0]; END_VAR"},
    {"E4001",
     "FUNCTION_BLOCK F VAR_OUTPUT q : INT; END_VAR END_FUNCTION_BLOCK "
     "PROGRAM P VAR f : F; END_VAR f.q := 1; END_PROGRAM"},
    {"E4001",
     "FUNCTION_BLOCK F VAR q : INT; END_VAR q := 1; END_FUNCTION_BLOCK "
     "PROGRAM P VAR f : F; END_VAR f.q := 1; END_PROGRAM"},
    {"E4018", "FUNCTION F : INT F := F(); END_FUNCTION"},
    {"E4014",
     "FUNCTION F VAR_INPUT x : INT; END_VAR END_FUNCTION PROGRAM P VAR x : INT; END_VAR "
     "x := F(1); END_PROGRAM"},
    {"E4009",
     "FUNCTION F : INT VAR_IN_OUT x : INT; END_VAR END_FUNCTION PROGRAM P F(); END_PROGRAM"},
    {"E4012",
     "FUNCTION F : INT VAR_IN_OUT x : INT; END_VAR END_FUNCTION PROGRAM P VAR d : DINT; END_VAR "
     "F(x := d); END_PROGRAM"},
    {"E4001",
     "FUNCTION F : INT VAR_IN_OUT x : INT; END_VAR END_FUNCTION PROGRAM P F(x := 5); END_PROGRAM"},
    {"E5001",
     "CONFIGURATION C RESOURCE R ON X TASK t(INTERVAL := T#1ms, PRIORITY := 1); PROGRAM p WITH u : "
     "Q; END_RESOURCE END_CONFIGURATION PROGRAM Q END_PROGRAM"},
    {"E5002",
     "CONFIGURATION C RESOURCE R ON X TASK t(INTERVAL := T#0ms, PRIORITY := 1); PROGRAM p WITH t : "
     "Q; END_RESOURCE END_CONFIGURATION PROGRAM Q END_PROGRAM"},
    {"E5004",
     "CONFIGURATION C RESOURCE R ON X TASK t(INTERVAL := T#1ms, PRIORITY := 1); PROGRAM p WITH t : "
     "R; END_RESOURCE END_CONFIGURATION PROGRAM Q END_PROGRAM"},
    {"E5007",
     "CONFIGURATION C RESOURCE R ON X TASK t(INTERVAL := T#1ms, PRIORITY := -1); PROGRAM p WITH t "
     ": Q; END_RESOURCE END_CONFIGURATION PROGRAM Q END_PROGRAM"},
};
INSTANTIATE_TEST_SUITE_P(Declarations, Rejects, testing::ValuesIn(kWhole));

struct WrongBody {
  const char* code;
  const char* vars;
  const char* body;
};
class RejectsBody : public testing::TestWithParam<WrongBody> {};

TEST_P(RejectsBody, WithItsCode) {
  Compiled compiled = compile(program(GetParam().vars, GetParam().body));
  EXPECT_EQ(compiled.errors(), GetParam().code) << GetParam().body << "\n" << compiled.text;
}

const WrongBody kBodies[] = {
    {"E2001", "x : INT;", "x := y;"},
    {"E2001", "x : INT;", "x := Foo(1);"},
    {"E2004", "t : TON;", "t.ETT := T#1s;"},
    {"E2006", "x : INT; y : ARRAY[0..x] OF INT;", "y[0] := 1;"},
    {"E2008", "x : INT;", "x := TON;"},
    {"E3001", "x : INT;", "x := 'a';"},
    {"E3001", "x : BOOL; y : INT;", "x := y;"},
    {"E3001", "x : TIME; y : INT;", "x := y;"},
    {"E3001", "a : ARRAY[0..1] OF INT; b : ARRAY[0..2] OF INT;", "a := b;"},
    {"E3001", "s : STRING; w : WSTRING;", "s := w;"},
    {"E3002", "x : USINT;", "x := 256;"},
    {"E3002", "x : ULINT; b : BOOL;", "b := x = -1;"},
    {"E3002", "x : INT(0..5);", "x := 6;"},
    {"E3003", "x : REAL;", "x := x MOD 2.0;"},
    {"E3003", "x : STRING; b : BOOL; y : BOOL;", "b := NOT x = y;"},
    {"E3004", "x : TIME; y : BOOL;", "y := x = y;"},
    {"E3005", "x : INT;", "x[1] := 2;"},
    {"E3006", "x : ARRAY[0..1] OF INT;", "x[1, 1] := 2;"},
    {"E3007", "x : ARRAY[0..1] OF INT;", "x[2] := 2;"},
    {"E3008", "x : ARRAY[0..1] OF INT; r : REAL;", "x[r] := 2;"},
    {"E3009", "x : INT;", "IF x THEN x := 1; END_IF"},
    {"E3010", "x : INT;", "x.a := 1;"},
    {"E3011", "x : BYTE;", "x.8 := TRUE;"},
    {"E3012", "x : INT;", "x := 1 / 0;"},
    {"E4001", "x : INT;", "(x + 1) := 2;"},
    {"E4002", "x : INT;", "%IX0.0 := TRUE; x := x;"},
    {"E4004", "x : INT;", "x := 1; EXIT;"},
    {"E4005", "x : INT;", "CASE x OF 1..5: x := 1; 5: x := 2; END_CASE"},
    {"E4007", "t : TON;", "t(INN := TRUE);"},
    {"E4008", "t : TON;", "t(IN := TRUE, IN := FALSE);"},
    {"E4010", "x : REAL;", "x := SQRT(x, x);"},
    {"E4010", "t : TON; b : BOOL; u : TIME;", "t(b, u, b, u, b);"},
    {"E4011", "x : INT;", "x();"},
    {"E4013", "t : TON; b : BOOL;", "t(Q := b);"},
    {"E4014", "t : TON; b : BOOL;", "b := t();"},
    {"E4015", "r : REAL;", "FOR r := 1 TO 2 DO ; END_FOR"},
    {"E4016", "i : INT;", "FOR i := 1 TO 2 BY 0 DO ; END_FOR"},
    {"E4017", "r : REAL;", "CASE r OF 1: r := 1; END_CASE"},
    {"E4019", "x : INT;", "TON(); x := x;"},
    {"E4020", "t : TON; b : BOOL;", "t(IN := b, T#1s);"},
    {"E3001", "t : TON; u : TOF;", "t := u; u();"},
    {"E4006", "x : REAL;", "x := SIN('a');"},
};
INSTANTIATE_TEST_SUITE_P(Bodies, RejectsBody, testing::ValuesIn(kBodies));

TEST(Rejecting, ConstantsCannotBeAssigned) {
  Compiled compiled = compile("PROGRAM P VAR CONSTANT c : INT := 1; END_VAR c := 2; END_PROGRAM");
  EXPECT_EQ(compiled.errors(), "E4003");
}

TEST(Dialects, NarrowingWarnsOrFails) {
  std::string source = program("x : INT; y : DINT; r : REAL;", "x := y; r := y;");
  EXPECT_EQ(compile(source).warnings(), "W0001 W0001");
  EXPECT_EQ(compile(source, frontend::Dialect::kIec).errors(), "E3001 E3001");
  EXPECT_EQ(
      compile(program("x : DINT; y : INT; r : LREAL;", "x := y; r := x;"), frontend::Dialect::kIec)
          .errors(),
      "");
}

TEST(Dialects, IntegersAreNoBitsInIec) {
  std::string source = program("x, y : INT; w : WORD;", "x := x AND y; w := w + 1;");
  EXPECT_EQ(compile(source).errors(), "");
  EXPECT_EQ(compile(source, frontend::Dialect::kIec).errors(), "E3003 E3003");
}

TEST(Dialects, InputsAreReadOnlyInIec) {
  std::string source = "FUNCTION F : INT VAR_INPUT x : INT; END_VAR x := 1; F := x; END_FUNCTION";
  EXPECT_EQ(compile(source).errors(), "");
  EXPECT_EQ(compile(source, frontend::Dialect::kIec).errors(), "E4002");
}

TEST(Warnings, EachHasItsCause) {
  EXPECT_EQ(compile(program("x, unused : INT;", "x := 1;")).warnings(), "W0003");
  EXPECT_EQ(compile(program("x : INT;", "FOR x := 1 TO 3 DO x := 2; END_FOR")).warnings(), "W0005");
  EXPECT_EQ(compile(program("x : INT;", "IF x <> 0 AND 10 / x > 1 THEN x := 1; END_IF")).warnings(),
            "W0002");
  EXPECT_EQ(
      compile(program("x : INT;", "IF x <> 0 AND_THEN 10 / x > 1 THEN x := 1; END_IF")).warnings(),
      "");
  EXPECT_EQ(compile(program("r : REAL; b : BOOL;", "b := r = 0.3 OR r <> 0.0;")).warnings(),
            "W0006");
  EXPECT_EQ(
      compile(program("x : INT;", "IF TRUE THEN x := 1; END_IF WHILE TRUE DO EXIT; END_WHILE"))
          .warnings(),
      "W0008");
  Compiled labels = compile(program("e : (a, b, c);", "CASE e OF a: e := b; c: e := a; END_CASE"));
  EXPECT_TRUE(labels.has("W0009")) << labels.text;
  EXPECT_NE(labels.text.find("no label for `b`"), std::string::npos) << labels.text;
  EXPECT_EQ(compile(program("s : STRING[2] := 'abc';", "s := 'x';")).warnings(), "W0007");
}

TEST(Suggestions, NameTheNearest) {
  Compiled compiled = compile(program("speed : INT;", "sped := 1;"));
  ASSERT_EQ(compiled.messages.size(), 1u);
  EXPECT_NE(compiled.text.find("did you mean `speed`?"), std::string::npos) << compiled.text;
  Compiled type = compile("PROGRAM P VAR t : TOM; END_VAR t(); END_PROGRAM");
  EXPECT_NE(type.text.find("did you mean `T"), std::string::npos) << type.text;
}

// Perhaps the mistake is where the name is declared.
TEST(Suggestions, WhatMayBeMeantIsShownWhereItIsDeclared) {
  const auto said = [](const std::string& source, const std::string& text) {
    const Compiled compiled = compile(source);
    EXPECT_NE(compiled.text.find(text), std::string::npos) << compiled.text;
  };
  said("FUNCTION_BLOCK Plup\nEND_FUNCTION_BLOCK\nPROGRAM M VAR p : Pulp; END_VAR p(); END_PROGRAM",
       ":1:16: note: `Plup` is declared here");
  said("PROGRAM M\nVAR dod : INT; END_VAR\nodd := 1; END_PROGRAM",
       ":2:5: note: `dod` is declared here");
  said("VAR_GLOBAL\ntakn : INT; END_VAR\nPROGRAM M tank := 1; END_PROGRAM",
       ":2:1: note: `takn` is declared here");
  said(
      "FUNCTION Sacle : INT Sacle := 1; END_FUNCTION\nPROGRAM M VAR n : INT; END_VAR\n"
      "n := Scale(); END_PROGRAM",
      ":1:10: note: `Sacle` is declared here");
  const Compiled member = compile(
      "TYPE S : STRUCT a : INT; END_STRUCT; END_TYPE\n"
      "PROGRAM M VAR s : S; low : INT; END_VAR s.lwo := low; END_PROGRAM");
  EXPECT_EQ(member.text.find("note:"), std::string::npos) << member.text;
  const Compiled library = compile("PROGRAM M VAR t : TOM; END_VAR END_PROGRAM");
  EXPECT_EQ(library.text.find("note:"), std::string::npos) << library.text;
}

TEST(Rejecting, DeepExpressionsAreAnswered) {
  std::string sum = "1";
  for (int i = 0; i < 20000; ++i) sum += " + 1";
  EXPECT_FALSE(compile(program("x : DINT;", "x := " + sum + ";")).errors().empty());
}

TEST(Rejecting, LongChainsOfTypesAreAnswered) {
  std::string source = "TYPE T0 : INT;";
  for (int i = 20000; i > 0; --i) {
    source += " T" + std::to_string(i) + " : T" + std::to_string(i - 1) + ";";
  }
  compile(source + " END_TYPE");
  std::string constants = "VAR_GLOBAL CONSTANT c0 : INT := 1;";
  for (int i = 20000; i > 0; --i) {
    constants += " c" + std::to_string(i) + " : INT := c" + std::to_string(i - 1) + ";";
  }
  compile(constants + " END_VAR");
}

}  // namespace
}  // namespace frontend_test
