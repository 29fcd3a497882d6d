#include <gtest/gtest.h>

#include "tests/unit/parse/parsed.h"

namespace frontend::test {
namespace {

TEST(Statement, AssignmentsAndCalls) {
  EXPECT_EQ(statements("a := 1; b.c[2] := a; %QX0.1 := TRUE; f(x := 1); t.run();"),
            "  a := 1\n  b.c[2] := a\n  %QX0.1 := TRUE\n  CALL f(x := 1)\n  CALL t.run()\n");
}

TEST(Statement, If) {
  EXPECT_EQ(statements("IF a THEN b := 1; ELSIF c THEN b := 2; ELSE b := 3; END_IF;"),
            "  IF a\n    b := 1\n  ELSIF c\n    b := 2\n  ELSE\n    b := 3\n");
}

TEST(Statement, EmptyBranchesAndStraySemicolons) {
  EXPECT_EQ(statements(";; IF a THEN ; ELSE END_IF ;; b := 1;;"), "  IF a\n  ELSE\n  b := 1\n");
}

TEST(Statement, SemicolonBehindEndIsOptional) {
  EXPECT_EQ(statements("IF a THEN b := 1; END_IF FOR i := 1 TO 2 DO END_FOR c := 1;"),
            "  IF a\n    b := 1\n  FOR i := 1 TO 2\n  c := 1\n");
}

TEST(Statement, Case) {
  EXPECT_EQ(statements("CASE n OF\n"
                       " 1: a := 1;\n"
                       " 2, 4..6, -3: a := 2; b := 3;\n"
                       " Mode#On, Mode.Off: IF x THEN a := 4; END_IF\n"
                       " kLow..kHigh: ;\n"
                       " kBase + 1: c.d := 5;\n"
                       "ELSE a := 0;\n"
                       "END_CASE"),
            "  CASE n\n    1:\n      a := 1\n    2, 4..6, (-3):\n      a := 2\n      b := 3\n"
            "    Mode#On, Mode.Off:\n      IF x\n        a := 4\n    kLow..kHigh:\n"
            "    (kBase + 1):\n      c.d := 5\n    ELSE\n      a := 0\n");
}

TEST(Statement, Loops) {
  EXPECT_EQ(statements("FOR i := 10 TO 1 BY -1 DO EXIT; END_FOR;\n"
                       "WHILE a < b DO CONTINUE; END_WHILE;\n"
                       "REPEAT a := a + 1; UNTIL a > 5 END_REPEAT;\n"
                       "REPEAT UNTIL TRUE; END_REPEAT RETURN;"),
            "  FOR i := 10 TO 1 BY (-1)\n    EXIT\n  WHILE (a < b)\n    CONTINUE\n"
            "  REPEAT\n    a := (a + 1)\n  UNTIL (a > 5)\n  REPEAT\n  UNTIL TRUE\n  RETURN\n");
}

TEST(Statement, KeywordsWithoutCase) {
  EXPECT_EQ(statements("if A then b := not C; End_If;"), "  IF A\n    b := (NOT C)\n");
}

TEST(Statement, SoftKeywordsAsVariables) {
  EXPECT_EQ(statements("continue := 1; action := 2; step(x := 1); method.a := 3; test := 4;"),
            "  continue := 1\n  action := 2\n  CALL step(x := 1)\n  method.a := 3\n  test := 4\n");
}

TEST(Statement, CommentsAndPragmasVanish) {
  EXPECT_EQ(
      statements("a (* x (* nested *) *) := /* y /* z */ */ 1; // rest\n{pragma 'x'} b := 2;"),
      "  a := 1\n  b := 2\n");
}

TEST(Statement, DeepNestingIsRefused) {
  auto nested = [](size_t n) {
    std::string out = "PROGRAM p ";
    for (size_t i = 0; i < n; ++i) out += "IF a THEN ";
    for (size_t i = 0; i < n; ++i) out += "END_IF ";
    return out + "END_PROGRAM";
  };
  EXPECT_EQ(codes(nested(base::kMaxNesting - 1)), "");
  EXPECT_NE(codes(nested(base::kMaxNesting + 1)).find("E6001"), std::string::npos);
  EXPECT_NE(codes(nested(50000)).find("E6001"), std::string::npos);
}

TEST(Statement, SpanOfHead) {
  Parsed parsed = parse_text("PROGRAM p IF a THEN b := 1; END_IF END_PROGRAM");
  const Stmt& stmt = parsed.tree.stmts[1];
  ASSERT_EQ(stmt.kind, StmtKind::kIf);
  EXPECT_EQ(stmt.span.begin.offset, 10u);
  EXPECT_EQ(stmt.span.end.offset, 19u);
}

}  // namespace
}  // namespace frontend::test
