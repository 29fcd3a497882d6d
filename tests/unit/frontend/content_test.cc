// What a POU is known by, whatever its layout (E-02, E-03).
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "base/hash.h"
#include "tests/unit/frontend/harness.h"

namespace {

using frontend_test::compile;
using frontend_test::Compiled;
using Contents = std::map<std::string, base::Digest>;

Contents contents(const std::string& source) {
  const Compiled compiled = compile(source);
  EXPECT_TRUE(compiled.program) << source << "\n" << compiled.text;
  Contents out;
  if (!compiled.program) return out;
  for (const ir::Pou& pou : compiled.program->pous) out[pou.name] = pou.content.identity;
  return out;
}

base::Digest pump(const std::string& source) { return contents(source)["Pump"]; }

// A block with `variables` and `body`.
std::string block(const std::string& variables, const std::string& body = "y := x;") {
  return "TYPE Point : STRUCT a, b : INT; END_STRUCT END_TYPE\nFUNCTION_BLOCK Pump " + variables +
         " " + body + " END_FUNCTION_BLOCK\n";
}

const std::string kVariables =
    "VAR_INPUT x : INT; s : STRING[20]; END_VAR VAR_OUTPUT y : INT; END_VAR "
    "VAR t : ARRAY[1..4] OF INT := [1, 2]; unused : INT := 5; END_VAR";

TEST(Content, E02_LayoutCommentsAndTheCaseOfWordsAreNoPartOfIt) {
  const base::Digest before = pump(block(kVariables, "IF x > 1 THEN y := x; END_IF"));
  EXPECT_NE(before, base::Digest{});
  for (const char* body :
       {"if X>1 then\n\n  Y := x;\nend_if", "IF (* why *) x > 1 THEN // so\n y:=x; END_IF",
        "IF x > 1 THEN {warning off W0003} y := x; END_IF"}) {
    EXPECT_EQ(pump("(* first *)\n\n" + block(kVariables, body)), before) << body;
  }
  const std::string other = "FUNCTION Other : INT Other := 1; END_FUNCTION\n";
  EXPECT_EQ(pump(other + block(kVariables, "IF x > 1 THEN y := x; END_IF")), before);
}

TEST(Content, E02_WhatItSaysIs) {
  const base::Digest before = pump(block(kVariables));
  const auto differs = [&](const std::string& from, const std::string& to) {
    std::string variables = kVariables;
    const size_t at = variables.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    variables.replace(at, from.size(), to);
    EXPECT_NE(pump(block(variables)), before) << to;
  };
  differs("x : INT", "x : SINT");
  differs("VAR_INPUT x : INT; s : STRING[20];", "VAR_INPUT s : STRING[20]; x : INT;");
  differs("VAR_OUTPUT", "VAR_IN_OUT");
  differs("STRING[20]", "STRING[21]");
  differs("1..4", "1..5");
  differs("[1, 2]", "[1, 3]");
  differs("unused : INT", "unused : UINT");
  differs("VAR t", "VAR RETAIN t");
  differs("t : ARRAY", "{attribute 'x' := 'y'} t : ARRAY");
  EXPECT_NE(pump(block(kVariables, "y := x + 0;")), before);
  EXPECT_NE(pump(block(kVariables, "y := x; s := 'A';")),
            pump(block(kVariables, "y := x; s := 'a';")));
}

TEST(Content, E02_ARenameSaysWhereAValueComesFromOnce) {
  const std::string body = "VAR_INPUT x : INT; END_VAR VAR_OUTPUT y : INT; END_VAR VAR ";
  EXPECT_EQ(pump(block(body + "{renamed from := 'm'} n : INT; END_VAR")),
            pump(block(body + "n : INT; END_VAR")));
}

TEST(Content, E02_AMemberIsOfItsOwn) {
  const auto with = [&](const std::string& method) {
    return contents("FUNCTION_BLOCK Pump VAR_INPUT x : INT; END_VAR " + method +
                    " END_FUNCTION_BLOCK\n");
  };
  Contents before = with("METHOD Start : INT Start := x; END_METHOD");
  Contents after = with("METHOD Start : INT Start := x + 1; END_METHOD");
  EXPECT_EQ(before["Pump"], after["Pump"]);
  EXPECT_NE(before["Pump.Start"], after["Pump.Start"]);
}

// Names of POUs whose identity differs.
std::string other_ones(const std::string& before, const std::string& after) {
  std::string out;
  const Contents now = contents(after);
  for (const auto& [name, identity] : contents(before)) {
    EXPECT_TRUE(now.contains(name)) << name;
    if (now.contains(name) && now.at(name) != identity) out += name + ' ';
  }
  return out;
}

TEST(Content, E02_AnAccessorIsOfItsOwn) {
  const auto with = [](const std::string& type, const std::string& get, const std::string& set) {
    return "FUNCTION_BLOCK Pump VAR n : INT; END_VAR PROPERTY Speed : " + type + " GET " + get +
           " END_GET SET " + set + " END_SET END_PROPERTY END_FUNCTION_BLOCK\n";
  };
  const std::string before = with("INT", "Speed := n;", "n := Speed;");
  EXPECT_EQ(other_ones(before, with("INT", "Speed := n + 1;", "n := Speed;")), "Pump.Speed.GET ");
  EXPECT_EQ(other_ones(before, with("INT", "Speed := n;", "n := Speed + 1;")), "Pump.Speed.SET ");
  EXPECT_EQ(other_ones(before, with("INT", "(* it *) speed:=N;", "n := Speed;")), "");
  const std::string both = "Pump Pump.Speed.GET Pump.Speed.SET ";
  EXPECT_EQ(other_ones(before, with("SINT", "Speed := n;", "n := Speed;")), both);
}

TEST(Content, E02_TheCaseOfStringsCountsOfEveryKind) {
  const auto differ = [](const std::string& type, const std::string& one, const std::string& two) {
    const std::string variable = "VAR_OUTPUT s : " + type + "; END_VAR";
    const std::string drawing = "\nFBD\ns := ";
    EXPECT_NE(pump(block(variable, "s := " + one + ";")),
              pump(block(variable, "s := " + two + ";")))
        << one;
    EXPECT_NE(pump(block(variable, drawing + one + ";\nEND_FBD\n")),
              pump(block(variable, drawing + two + ";\nEND_FBD\n")))
        << one;
  };
  differ("WSTRING", "\"stop\"", "\"STOP\"");
  differ("WSTRING", "WSTRING#\"stop\"", "WSTRING#\"STOP\"");
  differ("STRING", "STRING#'stop'", "STRING#'STOP'");
  differ("STRING", "'it$'s ab'", "'it$'s AB'");
  differ("STRING", "'$$'", "'$$ '");
  differ("WCHAR", "WCHAR#\"a\"", "WCHAR#\"A\"");
  const std::string variable = "VAR_OUTPUT s : WSTRING; END_VAR";
  EXPECT_EQ(pump(block(variable, "s := WSTRING#\"a\";")),
            pump(block(variable, "S:=wstring#\"a\";")));
}

TEST(Content, E02_BlanksInOperandsAreNoPartOfIt) {
  const auto with = [](const std::string& row) {
    return pump(block(kVariables, "\nFBD\n" + row + "\nEND_FBD\n"));
  };
  EXPECT_EQ(with("y := MAX(x, 1);"), with("y := MAX( x,1 );"));
  EXPECT_EQ(with("y := t[1] + x;"), with("y := t[ 1 ]+x;"));
  EXPECT_NE(with("y := x MOD 2;"), with("y := x * 2;"));
}

TEST(Content, E02_OfADrawingCountsWhatItMeans) {
  const auto rung = [](const std::string& drawing) {
    return "FUNCTION_BLOCK Pump VAR_INPUT a, b : BOOL; END_VAR VAR_OUTPUT y : BOOL; END_VAR\n"
           "LADDER\n" +
           drawing + "END_LADDER\nEND_FUNCTION_BLOCK\n";
  };
  const base::Digest before = pump(rung("|--[ a ]--[ b ]--( y )--|\n"));
  EXPECT_EQ(pump(rung("(* both *)\n|----[ A ]------[ b ]-----( y )--|\n")), before);
  EXPECT_NE(pump(rung("|--[ b ]--[ a ]--( y )--|\n")), before);
  EXPECT_NE(pump(rung("|--[ a ]--[/ b ]--( y )--|\n")), before);
  EXPECT_NE(pump(rung("|--[ a ]--+--( y )--|\n|--[ b ]--+\n")), before);
}

TEST(Content, E02_OfWhatIsLeftOutNothingCounts) {
  const auto with = [](const std::string& inactive) {
    return pump(block(kVariables, "{IF defined (Nothing)} " + inactive + " {END_IF} y := x;"));
  };
  EXPECT_EQ(with("y := 1;"), with("y := 2;"));
}

}  // namespace
