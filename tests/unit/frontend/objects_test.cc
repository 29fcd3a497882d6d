// Objects in Structured Text, run by the evaluator.
#include <gtest/gtest.h>

#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

const char* const kCounter = R"(FUNCTION_BLOCK Counter
VAR_INPUT step : INT := 1; END_VAR
VAR_OUTPUT total : DINT; END_VAR
VAR calls : INT; END_VAR
total := total + step;
ACTION Reset: total := 0; calls := calls + 1; END_ACTION
METHOD Add : DINT
VAR_INPUT x : DINT; factor : DINT := 2; END_VAR
VAR_OUTPUT big : BOOL; END_VAR
VAR_IN_OUT log : DINT; END_VAR
VAR local : DINT := 5; END_VAR
VAR_INST kept : INT; END_VAR
local := local + x * factor;
kept := kept + 1;
THIS^.total := total + local;
big := total > 100;
log := log + 1;
Add := local;
Count();
END_METHOD
METHOD PRIVATE Count calls := calls + 10; END_METHOD
PROPERTY Level : DINT
GET Level := total * 2; END_GET
SET total := Level / 2; END_SET
END_PROPERTY
END_FUNCTION_BLOCK
)";

TEST(Methods, ParametersLocalsAndInstanceVariables) {
  Controlled run(std::string(kCounter) +
                 "PROGRAM P VAR c, d : Counter; n, r : DINT; b : BOOL; END_VAR\n"
                 "r := c.Add(4, log := n, big => b); c.Add(x := 200, log := n, big => b);\n"
                 "d.Add(1, 1, n); END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.r"), 13);
  EXPECT_EQ(run.number("P.c.total"), 13 + 405);
  EXPECT_EQ(run.number("P.b"), 1);
  EXPECT_EQ(run.number("P.n"), 3);
  EXPECT_EQ(run.number("P.c.calls"), 20);
  EXPECT_EQ(run.number("P.c.Add#kept"), 2);
  EXPECT_EQ(run.number("P.d.Add#kept"), 1);
}

TEST(Methods, ActionsOfBlocksAndPrograms) {
  Controlled run(
      std::string(kCounter) +
      "PROGRAM P VAR c : Counter; n : INT; END_VAR\n"
      "c(step := 5); Act; c.Reset; Act(); Q.Other(); ACTION Act: n := n + 1; END_ACTION\n"
      "END_PROGRAM\n"
      "PROGRAM Q VAR n : INT; END_VAR n := n + 1;\n"
      "ACTION Other: n := n + 10; END_ACTION END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.c.total"), 0);
  EXPECT_EQ(run.number("P.n"), 2);
  EXPECT_EQ(run.number("Q.n"), 11);
}

TEST(Methods, ThroughArraysPointersReferencesAndInOuts) {
  Controlled run(std::string(kCounter) +
                 "FUNCTION Twice VAR_IN_OUT c : Counter; END_VAR VAR n : DINT; END_VAR\n"
                 "c.Add(1, 1, n); c.Level := c.Level + 4; END_FUNCTION\n"
                 "PROGRAM P VAR a : ARRAY[1..3] OF Counter; p : POINTER TO Counter;\n"
                 "r : REFERENCE TO Counter; i : INT := 2; n : DINT; END_VAR\n"
                 "a[i].Add(1, 1, n); p := ADR(a[3]); p^.Add(2, 1, n); p[0].Reset();\n"
                 "r REF= a[1]; r.Level := 500; Twice(a[2]); END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.a[1].total"), 250);
  EXPECT_EQ(run.number("P.a[2].total"), 14);
  EXPECT_EQ(run.number("P.a[3].total"), 0);
  EXPECT_EQ(run.number("P.a[3].calls"), 11);
}

TEST(Properties, ReadWrittenAndChained) {
  Controlled run(
      "TYPE Pair : STRUCT a, b : INT; END_STRUCT END_TYPE\n"
      "FUNCTION_BLOCK F VAR p : Pair; w : WORD; s : STRING[10]; END_VAR\n"
      "PROPERTY Both : Pair GET Both := p; END_GET SET p := Both; END_SET END_PROPERTY\n"
      "PROPERTY Bits : WORD GET Bits := w; END_GET SET w := Bits; END_SET END_PROPERTY\n"
      "PROPERTY Text : STRING[10] GET Text := s; END_GET SET s := Text; END_SET END_PROPERTY\n"
      "PROPERTY Place : REFERENCE TO WORD GET Place REF= w; END_GET END_PROPERTY\n"
      "METHOD Split VAR_OUTPUT one : WORD; both : Pair; END_VAR one := 7; both := p; END_METHOD\n"
      "Bits := Bits + 1; THIS^.Bits.15 := TRUE; END_FUNCTION_BLOCK\n"
      "PROGRAM P VAR f, g : F; q : Pair; x, y : WORD; t : STRING[10]; n : INT; END_VAR\n"
      "q.a := 3; q.b := 4; f.Both := q; n := f.Both.b; f(); g.Bits := f.Bits := f.Bits + 1;\n"
      "f.Text := 'abc'; t := CONCAT(f.Text, 'd'); g.Place := 5; x := g.Place;\n"
      "f.Split(one => g.Bits, both => g.Both); y := g.Bits; END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.n"), 4);
  EXPECT_EQ(run.number("P.f.w"), 0x8002);
  EXPECT_EQ(run.text("P.t"), "abcd");
  EXPECT_EQ(run.number("P.x"), 5);
  EXPECT_EQ(run.number("P.y"), 7);
  EXPECT_EQ(run.number("P.g.p.b"), 4);
}

const char* const kShapes = R"(INTERFACE IShape
METHOD Area : DINT VAR_INPUT scale : DINT := 1; END_VAR END_METHOD
PROPERTY Name : STRING[20] GET END_GET SET END_SET END_PROPERTY
END_INTERFACE
INTERFACE ISolid EXTENDS IShape
METHOD Volume : DINT END_METHOD
METHOD Me : IShape END_METHOD
END_INTERFACE
FUNCTION_BLOCK ABSTRACT Shape IMPLEMENTS IShape
VAR PROTECTED text : STRING[20] := 'none'; END_VAR
VAR_INPUT w : DINT := 2; END_VAR
VAR_OUTPUT calls : INT; END_VAR
METHOD ABSTRACT Area : DINT VAR_INPUT scale : DINT := 1; END_VAR END_METHOD
METHOD Twice : DINT Twice := Area(2) + THIS^.Area(); END_METHOD
PROPERTY Name : STRING[20] GET Name := text; END_GET SET text := Name; END_SET END_PROPERTY
calls := calls + 1;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Square EXTENDS Shape
METHOD OVERRIDE Area : DINT VAR_INPUT scale : DINT := 1; END_VAR Area := w * w * scale; END_METHOD
SUPER^();
calls := calls + 10;
END_FUNCTION_BLOCK
FUNCTION_BLOCK FINAL Cube EXTENDS Square IMPLEMENTS ISolid
VAR_INPUT h : DINT := 3; END_VAR
METHOD OVERRIDE Area : DINT VAR_INPUT scale : DINT := 1; END_VAR
Area := SUPER^.Area(scale) * 6; END_METHOD
METHOD Volume : DINT Volume := SUPER.Area() * h; END_METHOD
METHOD Me : IShape Me := THIS^; END_METHOD
SUPER^(w := 4);
END_FUNCTION_BLOCK
)";

TEST(Inheritance, VariablesBodiesAndVirtualMethods) {
  Controlled run(std::string(kShapes) +
                 "FUNCTION Use : DINT VAR_IN_OUT s : Shape; END_VAR Use := s.Twice(); s();\n"
                 "END_FUNCTION\n"
                 "PROGRAM P VAR sq : Square := (w := 5); cu : Cube; a, b, c, d : DINT;\n"
                 "p : POINTER TO Shape; r : REFERENCE TO Shape; END_VAR\n"
                 "a := sq.Twice(); b := Use(cu); p := ADR(cu); c := p^.Area(); r REF= sq;\n"
                 "d := r.Area(3); END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.a"), 75);
  EXPECT_EQ(run.number("P.b"), 72);
  EXPECT_EQ(run.number("P.c"), 96);
  EXPECT_EQ(run.number("P.d"), 75);
  EXPECT_EQ(run.number("P.cu.calls"), 11);
  EXPECT_EQ(run.number("P.cu.w"), 4);
}

TEST(Interfaces, DispatchChainsAndComparison) {
  Controlled run(
      std::string(kShapes) +
      "FUNCTION Use : DINT VAR_INPUT s : IShape; END_VAR Use := s.Area(10); END_FUNCTION\n"
      "PROGRAM P VAR sq : Square; cu : Cube; i : IShape; so : ISolid; a, b, c, v : DINT;\n"
      "all : ARRAY[0..1] OF IShape; x : INT; ok, no, same : BOOL; END_VAR\n"
      "i := sq; i.Name := 'square'; a := i.Area(); so := cu; v := so.Volume();\n"
      "b := so.Me().Area(scale := 2); c := Use(cu); all[0] := sq; all[1] := so;\n"
      "same := all[0] = i; FOR x := 0 TO 1 DO all[x].Name := 'both'; END_FOR\n"
      "ok := i <> 0; i := 0; no := i <> NULL; END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.a"), 4);
  EXPECT_EQ(run.number("P.v"), 12);
  EXPECT_EQ(run.number("P.b"), 48);
  EXPECT_EQ(run.number("P.c"), 240);
  EXPECT_EQ(run.text("P.cu.text"), "both");
  EXPECT_EQ(run.number("P.ok"), 1);
  EXPECT_EQ(run.number("P.no"), 0);
  EXPECT_EQ(run.number("P.same"), 1);
}

TEST(Interfaces, CallsOfNothingTrap) {
  Controlled run(std::string(kShapes) + "PROGRAM P VAR i : IShape; END_VAR i.Area(); END_PROGRAM");
  EXPECT_EQ(run.scan(), "reference");
}

TEST(Classes, MethodsThatReturnReferencesAreChained) {
  Controlled run(
      "CLASS Box VAR PUBLIC n : INT; END_VAR\n"
      "METHOD PUBLIC Put : REFERENCE TO Box VAR_INPUT v : INT; END_VAR n := n * 10 + v;\n"
      "Put REF= THIS^; END_METHOD END_CLASS\n"
      "PROGRAM P VAR b : Box; k : INT; END_VAR b.Put(1).Put(2).Put(3); k := b.n; b.n := 9;\n"
      "END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.k"), 123);
  EXPECT_EQ(run.number("P.b.n"), 9);
}

TEST(Recursion, IsDeclaredForFunctionsAndMethods) {
  Controlled run(
      "{attribute 'recursion_depth' := '20'}\n"
      "FUNCTION Fact : DINT VAR_INPUT n : DINT; END_VAR\n"
      "IF n < 2 THEN Fact := 1; ELSE Fact := n * Fact(n - 1); END_IF END_FUNCTION\n"
      "FUNCTION_BLOCK F VAR d : DINT; END_VAR\n"
      "{attribute 'recursion_depth' := '5'}\n"
      "METHOD Down : DINT VAR_INPUT n : DINT; END_VAR d := d + 1;\n"
      "IF n > 0 THEN Down := Down(n - 1) + 1; END_IF END_METHOD END_FUNCTION_BLOCK\n"
      "PROGRAM P VAR f : F; a, b : DINT; END_VAR a := Fact(5); b := f.Down(4); END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.a"), 120);
  EXPECT_EQ(run.number("P.b"), 4);
  EXPECT_EQ(run.number("P.f.d"), 5);
}

TEST(Recursion, DeeperThanDeclaredTraps) {
  Controlled run(
      "{attribute 'recursion_depth' := '4'}\n"
      "FUNCTION Fact : DINT VAR_INPUT n : DINT; END_VAR\n"
      "IF n < 2 THEN Fact := 1; ELSE Fact := n * Fact(n - 1); END_IF END_FUNCTION\n"
      "PROGRAM P VAR a : DINT; END_VAR a := Fact(5); END_PROGRAM");
  EXPECT_EQ(run.scan(), "stack");
}

TEST(Names, UnusedVariablesOfMethodsAndBlocks) {
  EXPECT_EQ(
      compile("FUNCTION_BLOCK F VAR PUBLIC shown : INT; END_VAR VAR used, never : INT; END_VAR "
              "METHOD m : INT VAR local, lost : INT; END_VAR m := used + local; END_METHOD "
              "END_FUNCTION_BLOCK PROGRAM P VAR f : F; END_VAR f.m(); END_PROGRAM")
          .warnings(),
      "W0003 W0003");
}

TEST(Names, AddressesAsStatementsAreHarmless) {
  EXPECT_EQ(compile("PROGRAM P VAR x : INT; END_VAR ADR(x); END_PROGRAM").errors(), "");
}

TEST(Names, AMethodAndAPropertyOfOneNameAreRefused) {
  EXPECT_EQ(compile("INTERFACE I PROPERTY m : INT GET END_GET END_PROPERTY METHOD m END_METHOD "
                    "END_INTERFACE FUNCTION_BLOCK F IMPLEMENTS I METHOD m END_METHOD PROPERTY m : "
                    "INT GET m := 1; END_GET END_PROPERTY END_FUNCTION_BLOCK "
                    "PROGRAM p VAR f : F; END_VAR f(); END_PROGRAM")
                .errors(),
            "E2002 E7004 E2002");
}

TEST(Interfaces, TheSystemsOwnParentAddsNothing) {
  Controlled run(
      "INTERFACE A EXTENDS __SYSTEM.IQueryInterface METHOD m : INT END_METHOD END_INTERFACE\n"
      "INTERFACE B EXTENDS __System.IQueryInterface END_INTERFACE\n"
      "FUNCTION_BLOCK F IMPLEMENTS A METHOD m : INT m := 5; END_METHOD END_FUNCTION_BLOCK\n"
      "PROGRAM P VAR f : F; a : A; b : B; yes, no : BOOL; END_VAR a := f;\n"
      "yes := __QUERYINTERFACE(f, a); no := __QUERYINTERFACE(a, b); END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.yes"), 1);
  EXPECT_EQ(run.number("P.no"), 0);
}

// Parents that share parents: every interface is looked at once.
TEST(Interfaces, ManyWaysToOneParentTakeNoTime) {
  std::string source =
      "INTERFACE I0 METHOD m : INT END_METHOD END_INTERFACE\n"
      "INTERFACE I1 EXTENDS I0 END_INTERFACE\n";
  for (int i = 2; i <= 100; ++i) {
    source += "INTERFACE I" + std::to_string(i) + " EXTENDS I" + std::to_string(i - 1) + ", I" +
              std::to_string(i - 2) + " END_INTERFACE\n";
  }
  Controlled run(source +
                 "FUNCTION_BLOCK F IMPLEMENTS I100 METHOD m : INT m := 5; END_METHOD "
                 "END_FUNCTION_BLOCK\n"
                 "PROGRAM P VAR f : F; i : I100; n : INT; END_VAR i := f; n := i.m(); END_PROGRAM");
  EXPECT_EQ(run.scan(), "");
  EXPECT_EQ(run.number("P.n"), 5);
  EXPECT_EQ(compile(source + "PROGRAM P VAR i : I100; END_VAR i.none(); END_PROGRAM").errors(),
            "E2004");
}

TEST(Inheritance, EndlessChainsAreRefused) {
  std::string source = "FUNCTION_BLOCK F0 END_FUNCTION_BLOCK\n";
  for (int i = 1; i <= 1000; ++i) {
    source += "FUNCTION_BLOCK F" + std::to_string(1000 - i) + "x EXTENDS F" +
              std::to_string(1001 - i) + "x END_FUNCTION_BLOCK\n";
  }
  source += "FUNCTION_BLOCK F1000x END_FUNCTION_BLOCK PROGRAM P END_PROGRAM";
  EXPECT_TRUE(compile(source).has("E6001"));
}

}  // namespace
}  // namespace frontend_test
