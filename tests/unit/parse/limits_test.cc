// Every construct that nests, at the limit and above it: refused with one message, and what
// follows is understood; a hundred thousand levels cost no stack.
#include <gtest/gtest.h>

#include "base/limits.h"
#include "frontend/lex/lexer.h"
#include "tests/unit/parse/parsed.h"

namespace frontend::test {
namespace {

std::string repeated(const std::string& text, size_t n) {
  std::string out;
  for (size_t i = 0; i < n; ++i) out += text;
  return out;
}

// `beyond`: how many levels of `open` are the first too many.
void expect_limit(const std::string& head, const std::string& open, const std::string& middle,
                  const std::string& close, const std::string& tail, size_t beyond) {
  auto source = [&](size_t n) {
    return head + repeated(open, n) + middle + repeated(close, n) + tail;
  };
  EXPECT_EQ(codes(source(beyond - 1)), "") << open;
  Parsed parsed = parse_text(source(beyond) + "\nPROGRAM last x := 1; END_PROGRAM");
  EXPECT_NE(parsed.codes.find("E6001"), std::string::npos) << open;
  EXPECT_NE(parsed.text.find("PROGRAM last\n  x := 1\n"), std::string::npos) << open;
  EXPECT_NE(codes(source(100000)).find("E6001"), std::string::npos) << open;
}

TEST(Limits, Types) {
  expect_limit("TYPE t : ", "POINTER TO ", "INT", "", "; END_TYPE", base::kMaxNesting);
  expect_limit("TYPE t : ", "REF_TO ", "INT", "", "; END_TYPE", base::kMaxNesting);
  expect_limit("TYPE t : ", "ARRAY[*] OF ", "INT", "", "; END_TYPE", base::kMaxNesting);
  expect_limit("TYPE t : ", "STRUCT m : ", "INT;", " END_STRUCT", "; END_TYPE", base::kMaxNesting);
  expect_limit("TYPE t : ", "UNION m : ", "INT;", " END_UNION", "; END_TYPE", base::kMaxNesting);
}

TEST(Limits, Statements) {
  std::string head = "PROGRAM p ";
  std::string tail = " END_PROGRAM";
  expect_limit(head, "__TRY ", "a := 1;", " __CATCH __ENDTRY ", tail, base::kMaxNesting - 1);
  expect_limit(head, "a := ", "1;", "", tail, base::kMaxNesting);
  expect_limit(head, "a S= ", "1;", "", tail, base::kMaxNesting);
}

TEST(Limits, Expressions) {
  std::string head = "PROGRAM p x := ";
  std::string tail = "; END_PROGRAM";
  expect_limit(head + "1 + ", "(a := ", "1", ")", tail, base::kMaxNesting - 2);
  expect_limit(head, "f(", "1", ")", tail, base::kMaxNesting - 1);
  expect_limit(head, "f(a := ", "1", ")", tail, base::kMaxNesting - 1);
  expect_limit(head, "a[", "1", "]", tail, base::kMaxNesting - 1);
  expect_limit(head, "(m := ", "1", ", n := 2)", tail, base::kMaxNesting - 1);
  expect_limit(head, "SIZEOF(ARRAY[0..", "1", "] OF INT)", tail, base::kMaxNesting / 3 + 1);
}

TEST(Limits, Namespaces) {
  expect_limit("", "NAMESPACE n ", "", " END_NAMESPACE", "", base::kMaxNesting + 1);
}

TEST(Limits, Conditions) {
  auto source = [](size_t n) {
    return "{IF " + repeated("(", n) + "defined(A)" + repeated(")", n) + "} {END_IF}";
  };
  EXPECT_EQ(codes(source(base::kMaxNesting - 1)), "");
  EXPECT_NE(codes(source(base::kMaxNesting)).find("E0014"), std::string::npos);
  EXPECT_NE(codes(source(100000)).find("E0014"), std::string::npos);
  EXPECT_EQ(codes("{IF " + repeated("NOT ", 100000) + "defined(A)} {END_IF}"), "");
  EXPECT_EQ(codes(repeated("{IF defined(A)}", 100000) + repeated("{END_IF}", 100000)), "");
}

// A thousand contacts in front of a wire with a thousand coils are a million links.
TEST(Limits, LinksOfARung) {
  auto rung = [](size_t count) {
    std::string out = "PROGRAM p\nLADDER\n";
    for (size_t i = 0; i < count; ++i) out += "|--[ a ]--+--+--( b )--|\n";
    return out + "END_LADDER\nEND_PROGRAM\n";
  };
  EXPECT_EQ(codes(rung(1000)), "4:2 E1050\n4:19 W0035\n");
  EXPECT_EQ(codes(rung(1025)), "3:4 E6003\n4:2 E1050\n");
  EXPECT_EQ(codes(rung(100000)), "3:4 E6003\n4:2 E1050\n");
}

}  // namespace
}  // namespace frontend::test
