#include <gtest/gtest.h>

#include "tests/unit/parse/parsed.h"

namespace frontend::test {
namespace {

TEST(Expression, PrecedenceFollowsTable71) {
  EXPECT_EQ(expression("a OR b XOR c AND d"), "(a OR (b XOR (c AND d)))");
  EXPECT_EQ(expression("a AND b = c"), "(a AND (b = c))");
  EXPECT_EQ(expression("a = b < c"), "(a = (b < c))");
  EXPECT_EQ(expression("a < b + c * d"), "(a < (b + (c * d)))");
  EXPECT_EQ(expression("a * b ** c"), "(a * (b ** c))");
  EXPECT_EQ(expression("NOT a = b"), "((NOT a) = b)");
}

TEST(Expression, UnaryBindsTighterThanPower) {
  EXPECT_EQ(expression("-a ** 2"), "((-a) ** 2)");
  EXPECT_EQ(expression("a ** -b"), "(a ** (-b))");
  EXPECT_EQ(expression("NOT NOT a"), "(NOT (NOT a))");
}

TEST(Expression, BinaryOperatorsGroupFromTheLeft) {
  EXPECT_EQ(expression("a - b - c"), "((a - b) - c)");
  EXPECT_EQ(expression("a ** b ** c"), "((a ** b) ** c)");
  EXPECT_EQ(expression("a / b MOD c * d"), "(((a / b) MOD c) * d)");
  EXPECT_EQ(expression("a & b and_then c"), "((a AND b) AND_THEN c)");
  EXPECT_EQ(expression("a or_else b OR c"), "((a OR_ELSE b) OR c)");
}

TEST(Expression, ParenthesesGroup) {
  EXPECT_EQ(expression("(a + b) * c"), "((a + b) * c)");
  Parsed parsed = parse_text("PROGRAM p x := (a + b); END_PROGRAM");
  const Expr& value = parsed.tree[parsed.tree.stmts[0].value];
  EXPECT_TRUE(value.parenthesised);
  EXPECT_EQ(value.span.end.offset - value.span.begin.offset, 7u);
}

TEST(Expression, Variables) {
  EXPECT_EQ(expression("a.b[1, i + 1].c^.d"), "a.b[1, (i + 1)].c^.d");
  EXPECT_EQ(expression("w.3"), "w.3");
  EXPECT_EQ(expression("w.%X3 + w.%B1 + w.%W1 + w.%D0"), "(((w.3 + w.%B1) + w.%W1) + w.%D0)");
  EXPECT_EQ(expression("%IX2.3"), "%IX2.3");
  EXPECT_EQ(expression("%qw4"), "%QW4");
  EXPECT_EQ(expression("a[i][j]"), "a[i][j]");
}

TEST(Expression, Calls) {
  EXPECT_EQ(expression("f()"), "f()");
  EXPECT_EQ(expression("f(1, g(x), y)"), "f(1, g(x), y)");
  EXPECT_EQ(expression("f(IN := a, Q => b, NOT R => c)"), "f(IN := a, Q => b, NOT R => c)");
  EXPECT_EQ(expression("f(IN := , Q => )"), "f(IN := , Q => )");
  EXPECT_EQ(expression("AND(a, b)"), "AND(a, b)");
  EXPECT_EQ(expression("MOD(a, b) + 1"), "(MOD(a, b) + 1)");
  EXPECT_EQ(expression("o.m(1).k"), "o.m(1).k");
}

TEST(Expression, TypedLiteralsAndEnumerations) {
  EXPECT_EQ(expression("INT#-5"), "INT#-5");
  EXPECT_EQ(expression("WORD#16#AF"), "WORD#175u");
  EXPECT_EQ(expression("BOOL#1"), "BOOL#1");
  EXPECT_EQ(expression("BOOL#TRUE"), "BOOL#TRUE");
  EXPECT_EQ(expression("REAL#3.5"), "REAL#3.5");
  EXPECT_EQ(expression("STRING#'x'"), "STRING#'x'");
  EXPECT_EQ(expression("Color#Red"), "Color#Red");
  EXPECT_EQ(expression("T#Red"), "T#Red");
}

TEST(Expression, SoftKeywordsAreNames) {
  EXPECT_EQ(expression("step + ON + tp + ltime + Retain + task + at"),
            "((((((step + ON) + tp) + ltime) + Retain) + task) + at)");
}

TEST(Expression, AggregateInitialisers) {
  EXPECT_EQ(expression("[1, 2, 3(7), 2(1, 2)]"), "[1, 2, 3(7), 2(1, 2)]");
  EXPECT_EQ(expression("[(a := 1, b := [2]), (a := 3)]"), "[(a := 1, b := [2]), (a := 3)]");
}

TEST(Expression, DeepNestingIsRefused) {
  auto nested = [](size_t n) { return std::string(n, '(') + "1" + std::string(n, ')'); };
  // A statement and its right side are levels of their own.
  EXPECT_EQ(expression(nested(base::kMaxNesting - 2)), "1");
  EXPECT_EQ(codes("PROGRAM p x := " + nested(base::kMaxNesting - 1) + "; END_PROGRAM"),
            "1:215 E6001\n");
  EXPECT_EQ(codes("PROGRAM p x := " + nested(100000) + "; END_PROGRAM"), "1:215 E6001\n");
  EXPECT_EQ(codes("PROGRAM p x := " + std::string(100000, '-') + "1; END_PROGRAM"),
            "1:214 E6001\n");
}

TEST(Expression, HighTreesAreRefused) {
  auto chain = [](size_t n) {
    std::string out = "1";
    for (size_t i = 0; i < n; ++i) out += "+1";
    return "PROGRAM p x := " + out + "; END_PROGRAM";
  };
  EXPECT_EQ(codes(chain(base::kMaxExpressionHeight - 1)), "");
  EXPECT_EQ(codes(chain(base::kMaxExpressionHeight)), "1:16 E6003\n");
  std::string members = "a";
  for (size_t i = 0; i < 5000; ++i) members += ".a";
  EXPECT_EQ(codes("PROGRAM p " + members + " := 1; END_PROGRAM"), "1:11 E6003\n");
}

}  // namespace
}  // namespace frontend::test
