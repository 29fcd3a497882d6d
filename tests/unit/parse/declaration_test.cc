#include <gtest/gtest.h>

#include "tests/unit/parse/parsed.h"

namespace frontend::test {
namespace {

TEST(Declaration, Pous) {
  EXPECT_EQ(
      declarations("FUNCTION f : INT VAR_INPUT a : INT; END_VAR f := a; END_FUNCTION\n"
                   "FUNCTION g END_FUNCTION;\n"
                   "FUNCTION_BLOCK b VAR_OUTPUT q : BOOL; END_VAR END_FUNCTION_BLOCK\n"
                   "PROGRAM p VAR x : b; END_VAR x(); END_PROGRAM"),
      "FUNCTION f : INT\n  VAR_INPUT\n    a : INT\n  f := a\nFUNCTION g\n"
      "FUNCTION_BLOCK b\n  VAR_OUTPUT\n    q : BOOL\nPROGRAM p\n  VAR\n    x : b\n  CALL x()\n");
}

TEST(Declaration, SectionsAndQualifiers) {
  EXPECT_EQ(
      declarations("PROGRAM p\n"
                   "VAR_INPUT a : INT; END_VAR VAR_OUTPUT b : INT; END_VAR\n"
                   "VAR_IN_OUT c : INT; END_VAR VAR_TEMP d : INT; END_VAR\n"
                   "VAR_EXTERNAL e : INT; END_VAR VAR CONSTANT f : INT := 1; END_VAR\n"
                   "VAR RETAIN g : INT; END_VAR VAR PERSISTENT h : INT; END_VAR\n"
                   "VAR NON_RETAIN i : INT; END_VAR VAR RETAIN PERSISTENT j : INT; END_VAR\n"
                   "VAR retain : INT; constant, k : INT; END_VAR\n"
                   "END_PROGRAM\n"
                   "VAR_GLOBAL CONSTANT m : INT := 2; END_VAR"),
      "VAR_GLOBAL CONSTANT\n  m : INT := 2\nPROGRAM p\n  VAR_INPUT\n    a : INT\n"
      "  VAR_OUTPUT\n    b : INT\n  VAR_IN_OUT\n    c : INT\n  VAR_TEMP\n    d : INT\n"
      "  VAR_EXTERNAL\n    e : INT\n  VAR CONSTANT\n    f : INT := 1\n  VAR RETAIN\n"
      "    g : INT\n  VAR RETAIN\n    h : INT\n  VAR NON_RETAIN\n    i : INT\n  VAR RETAIN\n    j : INT\n"
      "  VAR\n    retain : INT\n    constant, k : INT\n");
}

TEST(Declaration, Variables) {
  EXPECT_EQ(
      declarations("PROGRAM p VAR\n"
                   "a, b AT %QX0.3 : BOOL := TRUE;\n"
                   "c : ARRAY[1..2, 0..n - 1] OF ARRAY[1..3] OF INT := [1, 2(3)];\n"
                   "d : STRING[20] := 'x'; e : STRING(20); f : WSTRING; g : INT (0..10) := 5;\n"
                   "h : (Off, On := 5) := On; i : STRUCT x : INT; y : REAL; END_STRUCT;\n"
                   "j : TON := (PT := T#1s); k : ARRAY[0..2] OF INT := 1, 2(5);\n"
                   "END_VAR END_PROGRAM"),
      "PROGRAM p\n  VAR\n    a, b AT %QX0.3 : BOOL := TRUE\n"
      "    c : ARRAY[1..2, 0..(n - 1)] OF ARRAY[1..3] OF INT := [1, 2(3)]\n"
      "    d : STRING[20] := 'x'\n    e : STRING[20]\n    f : WSTRING\n"
      "    g : INT(0..10) := 5\n    h : (Off, On := 5) := On\n"
      "    i : STRUCT{x : INT; y : REAL}\n    j : TON := (PT := T#1000000000ns)\n"
      "    k : ARRAY[0..2] OF INT := [1, 2(5)]\n");
}

TEST(Declaration, Types) {
  EXPECT_EQ(declarations("TYPE Color : (Red, Green := 5, Blue) INT := Green; END_TYPE\n"
                         "TYPE E : INT (A, B); S : INT (-5..5) := 1; L : INT (kLow .. 7);\n"
                         "  Row : ARRAY[1..3] OF REAL := [3(1.5)]; Name : STRING[8];\n"
                         "  Point : STRUCT x, y : REAL := 0.0; END_STRUCT\n"
                         "  Alias : Point; One : DINT (Only);\n"
                         "END_TYPE"),
            "TYPE Color : (Red, Green := 5, Blue) INT := Green\nTYPE E : (A, B) INT\n"
            "TYPE S : INT((-5)..5) := 1\nTYPE L : INT(kLow..7)\n"
            "TYPE Row : ARRAY[1..3] OF REAL := [3(1.5)]\nTYPE Name : STRING[8]\n"
            "TYPE Point : STRUCT{x, y : REAL := 0.0}\nTYPE Alias : Point\n"
            "TYPE One : (Only) DINT\n");
}

TEST(Declaration, Configuration) {
  EXPECT_EQ(declarations("CONFIGURATION c\n"
                         "VAR_GLOBAL g : INT; END_VAR\n"
                         "RESOURCE r ON PLC\n"
                         "  VAR_GLOBAL h : BOOL; END_VAR\n"
                         "  TASK fast(INTERVAL := T#10ms, PRIORITY := 1);\n"
                         "  TASK edge(SINGLE := h, PRIORITY := 2);\n"
                         "  PROGRAM a WITH fast : Main(in := g, out => h);\n"
                         "  PROGRAM b : Idle;\n"
                         "END_RESOURCE\nEND_CONFIGURATION"),
            "CONFIGURATION c\n  VAR_GLOBAL\n    g : INT\n  RESOURCE r ON PLC\n    VAR_GLOBAL\n"
            "      h : BOOL\n    TASK fast INTERVAL T#10000000ns PRIORITY 1\n"
            "    TASK edge SINGLE h PRIORITY 2\n    PROGRAM a WITH fast : Main(in := g, out => h)\n"
            "    PROGRAM b : Idle\n");
}

TEST(Declaration, ConfigurationWithoutResource) {
  EXPECT_EQ(declarations("CONFIGURATION c TASK t(INTERVAL := T#1s, PRIORITY := 0);\n"
                         "PROGRAM p WITH t : Main; END_CONFIGURATION"),
            "CONFIGURATION c\n  RESOURCE\n    TASK t INTERVAL T#1000000000ns PRIORITY 0\n"
            "    PROGRAM p WITH t : Main\n");
}

TEST(Declaration, SeveralFilesShareOneTree) {
  base::SourceMap sources;
  sources.add("a.st", "PROGRAM a x := 1; END_PROGRAM");
  sources.add("b.st", "PROGRAM b y := 2; END_PROGRAM");
  base::Diagnostics diagnostics;
  Tree tree;
  parse(sources, 0, tree, diagnostics);
  parse(sources, 1, tree, diagnostics);
  EXPECT_EQ(print(tree), "PROGRAM a\n  x := 1\nPROGRAM b\n  y := 2\n");
  EXPECT_EQ(sources.locate(tree.pous[1].name.span.begin).file, "b.st");
}

}  // namespace
}  // namespace frontend::test
