// What is said about damaged sources: the right message, at the right place, once.
#include <gtest/gtest.h>

#include "tests/unit/parse/parsed.h"

namespace frontend::test {
namespace {

std::string in_program(const std::string& statements) {
  return codes("PROGRAM p\n" + statements + "\nEND_PROGRAM");
}

TEST(Recovery, MissingSemicolonIsReportedBehindTheStatement) {
  EXPECT_EQ(in_program("a := 1\n\n\nb := 2;"), "2:7 E1002\n");
  EXPECT_EQ(in_program("a := 1 b := 2;"), "2:7 E1002\n");
  EXPECT_EQ(in_program("a := 1 2 3; b := = 2;"), "2:7 E1002\n2:18 E1005\n");
  EXPECT_EQ(in_program("IF a THEN b := 1 END_IF"), "2:17 E1002\n");
}

TEST(Recovery, EqualsForAssignment) {
  Parsed parsed = parse_text("PROGRAM p\na = 5;\nEND_PROGRAM");
  EXPECT_EQ(parsed.codes, "2:3 E1004\n");
  EXPECT_EQ(parsed.text, "PROGRAM p\n  a := 5\n");
  EXPECT_EQ(codes("PROGRAM p VAR a : INT = 5; END_VAR END_PROGRAM"), "1:23 E1004\n");
  EXPECT_EQ(in_program("FOR i = 1 TO 3 DO END_FOR"), "2:7 E1004\n");
}

TEST(Recovery, AssignmentForEquals) {
  Parsed parsed = parse_text("PROGRAM p IF a := 5 THEN b := 1; END_IF END_PROGRAM");
  EXPECT_EQ(parsed.codes, "1:16 E1014\n");
  EXPECT_EQ(parsed.text, "PROGRAM p\n  IF (a = 5)\n    b := 1\n");
  EXPECT_EQ(in_program("WHILE (a := 5) DO END_WHILE"), "");  // a structure value: rejected later
}

TEST(Recovery, MissingEndIsReportedAtItsOpening) {
  EXPECT_EQ(in_program("IF a THEN\n b := 1;"), "2:1 E1003\n");
  EXPECT_EQ(in_program("WHILE a DO\n FOR i := 1 TO 2 DO\n b := 1;\nEND_WHILE"), "3:2 E1003\n");
  EXPECT_EQ(in_program("CASE a OF 1: IF b THEN c := 1; END_CASE"), "2:14 E1003\n");
  EXPECT_EQ(in_program("REPEAT IF a THEN b := 1; UNTIL c END_REPEAT"), "2:8 E1003\n");
  EXPECT_EQ(codes("PROGRAM p\na := 1;\nPROGRAM q END_PROGRAM"), "1:1 E1003\n");
  EXPECT_EQ(codes("PROGRAM p\na := 1;"), "1:1 E1003\n");
  EXPECT_EQ(codes("TYPE a : INT;\nPROGRAM q END_PROGRAM"), "1:1 E1003\n");
  EXPECT_EQ(codes("TYPE a : STRUCT b : INT; END_TYPE"), "1:10 E1003\n");
  EXPECT_EQ(codes("CONFIGURATION c RESOURCE r ON x END_CONFIGURATION"), "1:17 E1003\n");
}

TEST(Recovery, MissingEndVar) {
  EXPECT_EQ(codes("PROGRAM p\nVAR a : INT;\na := 1; f(2); b.c := 3;\nEND_PROGRAM"), "2:1 E1003\n");
  EXPECT_EQ(codes("PROGRAM p\nVAR a : INT;\nVAR b : INT; END_VAR\nEND_PROGRAM"), "2:1 E1003\n");
  EXPECT_EQ(codes("PROGRAM p\nVAR a := 1; b : INT; END_VAR\nEND_PROGRAM"), "2:7 E1001\n");
}

TEST(Recovery, NoteNamesTheConstruct) {
  Parsed parsed = parse_text("PROGRAM p\nIF a THEN\nEND_PROGRAM");
  ASSERT_EQ(parsed.diagnostics.all().size(), 1u);
  const base::Diagnostic& d = parsed.diagnostics.all()[0];
  EXPECT_EQ(d.text, "`IF` has no `END_IF`");
  ASSERT_EQ(d.notes.size(), 1u);
  EXPECT_EQ(d.notes[0].text, "`END_IF` was expected before `END_PROGRAM`");
}

TEST(Recovery, StrayEnds) {
  EXPECT_EQ(in_program("a := 1; END_IF; b := 2;"), "2:9 E1010\n");
  EXPECT_EQ(in_program("ELSE b := 2; END_WHILE"), "2:1 E1010\n2:14 E1010\n");
  EXPECT_EQ(in_program("ELSIF a > 2 THEN b := 2;"), "2:1 E1010\n");
  EXPECT_EQ(in_program("IF a THEN ELSE b := 1; ELSIF c THEN d := 2; END_IF"), "2:24 E1010\n");
  EXPECT_EQ(codes("FUNCTION f : INT\nEND_FUNCTION_BLOCK\nPROGRAM q END_PROGRAM"), "2:1 E1010\n");
  EXPECT_EQ(codes("END_PROGRAM PROGRAM q END_PROGRAM"), "1:1 E1010\n");
}

TEST(Recovery, HeadsKeepTheirBodies) {
  Parsed parsed = parse_text(
      "PROGRAM p\nIF a\n b := 1;\nEND_IF\nWHILE c d := 1; END_WHILE\n"
      "FOR i 1 TO 3 DO e := 1; END_FOR\nCASE x\n 1: f := 1;\nEND_CASE\nEND_PROGRAM");
  EXPECT_EQ(parsed.codes, "2:5 E1001\n5:9 E1001\n6:7 E1001\n7:7 E1001\n");
  EXPECT_EQ(parsed.text,
            "PROGRAM p\n  IF a\n    b := 1\n  WHILE c\n  FOR i := <error> TO <error>\n"
            "    e := 1\n  CASE x\n    1:\n      f := 1\n");
}

TEST(Recovery, Brackets) {
  EXPECT_EQ(in_program("a := (b + c;\nd[1 := 2;\nf(1, 2;\ng := 3;"),
            "2:12 E1011\n3:5 E1011\n4:7 E1011\n");
}

TEST(Recovery, Names) {
  EXPECT_EQ(codes("PROGRAM 1st END_PROGRAM"), "1:9 E1008\n");
  EXPECT_EQ(codes("PROGRAM p VAR a, for : INT; b : INT; END_VAR END_PROGRAM"), "1:18 E1009\n");
  EXPECT_EQ(codes("TYPE : INT; END_TYPE"), "1:6 E1008\n");
}

TEST(Recovery, Types) {
  EXPECT_EQ(codes("PROGRAM p VAR a : ; b : INT; END_VAR END_PROGRAM"), "1:19 E1007\n");
  EXPECT_EQ(codes("PROGRAM p VAR a : ARRAY 1..2 OF INT; b : INT; END_VAR END_PROGRAM"),
            "1:25 E1001\n");
  EXPECT_EQ(codes("PROGRAM p VAR a : INT(1 2); b : ARRAY[1] OF INT; END_VAR END_PROGRAM"),
            "1:25 E1001\n1:40 E1001\n");
  EXPECT_EQ(codes("TYPE E : (); F : (A B); END_TYPE"), "1:10 E1017\n1:21 E1011\n");
}

TEST(Recovery, StatementsWithoutSense) {
  // `a;` may call an action: lowering says more.
  EXPECT_EQ(in_program("a;\nb + 1;\n5;\nc d;\n);\nf(x) + 1;"),
            "3:1 E1015\n4:1 E1015\n5:3 E1001\n6:1 E1006\n7:1 E1015\n");
}

TEST(Recovery, UnterminatedStringIsOneMessage) {
  EXPECT_EQ(in_program("a := 'abc;\nb := 1;"), "2:6 E0003\n");
}

TEST(Recovery, CaseWithoutLabels) {
  EXPECT_EQ(in_program("CASE a OF b := 1; c := 2; 1: d := 3; END_CASE"), "2:11 E1001\n");
  EXPECT_EQ(in_program("CASE a OF 1 b := 1; 2: c := 2; END_CASE d := 1;"), "2:13 E1001\n");
}

TEST(Recovery, TypedLiterals) {
  EXPECT_EQ(in_program("a := INT#;\nb := INT#-x;\nc := INT#5;"), "2:6 E0012\n3:6 E0012\n");
}

TEST(Recovery, FileLevel) {
  EXPECT_EQ(codes("a := 1;\nPROGRAM p END_PROGRAM"), "1:1 E1012\n");
  EXPECT_EQ(codes("VAR_INPUT a : INT; END_VAR PROGRAM p END_PROGRAM"), "1:1 E1018\n");
  EXPECT_EQ(codes("PROGRAM p a := 1; VAR b : INT; END_VAR b := 1; END_PROGRAM"), "1:19 E1018\n");
  EXPECT_EQ(codes("PROGRAM p VAR CONSTANT RETAIN a : INT; END_VAR END_PROGRAM"), "1:24 E1013\n");
}

TEST(Recovery, Configuration) {
  EXPECT_EQ(codes("CONFIGURATION c TASK t(PERIOD := 1); TASK u(PRIORITY := 1, PRIORITY := 2);\n"
                  "foo; VAR a : INT; END_VAR PROGRAM p t : M; END_CONFIGURATION"),
            "1:24 E5008\n1:60 E5008\n2:1 E1001\n2:6 E1018\n2:37 E1001\n");
}

TEST(Recovery, DrawingInOneLineOrWithoutEnd) {
  Parsed line = parse_text("PROGRAM b LADDER |--[ a ]--( b )--| END_LADDER END_PROGRAM\n"
                           "PROGRAM last x := 1; END_PROGRAM");
  EXPECT_EQ(line.diagnostics.error_count(), 0u) << messages(line);
  EXPECT_NE(line.text.find("PROGRAM last\n  x := 1\n"), std::string::npos);
  Parsed open = parse_text("PROGRAM b\nLADDER\n|--[ a ]--( b )--|\nEND_PROGRAM\n"
                           "PROGRAM last x := 1; END_PROGRAM");
  EXPECT_EQ(open.codes, "2:1 E1003\n") << messages(open);
  EXPECT_NE(open.text.find("PROGRAM last\n  x := 1\n"), std::string::npos);
}

// One mistake in each of twenty statements.
TEST(Recovery, TwentyMistakesGiveTwentyMessages) {
  const char* const kMistakes[] = {
      "a = 1;",        "a := ;",    "a := (1;",
      "a := 1 +;",     "f(1,);",    "a := b[1;",
      "a + 1;",        "a := 2#3;", "a := T#5;",
      "a := 1 2;",     "IF a THEN", "END_IF",
      "a := b.;",      "END_WHILE", "FOR i 1 TO 2 DO END_FOR",
      "a := D#1-1-1;", "a == 1;",   "CASE a OF END_CASE ELSE",
      "a := '$';",     "a @ := 1;",
  };
  std::string source;
  for (const char* mistake : kMistakes) source += std::string(mistake) + '\n';
  Parsed parsed = parse_text("PROGRAM p\n" + source + "END_PROGRAM");
  EXPECT_GE(parsed.diagnostics.error_count(), 18u) << messages(parsed);
  EXPECT_LE(parsed.diagnostics.error_count(), 22u) << messages(parsed);
}

}  // namespace
}  // namespace frontend::test
