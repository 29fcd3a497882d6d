#include "frontend/lex/lexer.h"

#include <gtest/gtest.h>

#include "base/limits.h"
#include "frontend/lex/keywords.h"

namespace frontend {
namespace {

struct Lexed {
  std::string kinds;  // token texts, separated by blanks
  std::string codes;
  size_t pragmas = 0;
};

Lexed lexed(const std::string& source) {
  base::SourceMap sources;
  sources.add("t.st", source);
  base::Diagnostics diagnostics;
  TokenList list = lex(sources, 0, diagnostics);
  Lexed out;
  out.pragmas = list.pragmas.size();
  for (const Token& token : list.tokens) {
    if (token.kind == TokenKind::kEnd) continue;
    out.kinds += (out.kinds.empty() ? "" : " ") + std::string(token_text(token.kind));
  }
  for (const base::Diagnostic& d : diagnostics.all()) {
    out.codes += (out.codes.empty() ? "" : " ") + std::string(base::diagnostic_row(d.code).code);
  }
  return out;
}

std::string kinds(const std::string& source) { return lexed(source).kinds; }
std::string codes(const std::string& source) { return lexed(source).codes; }

TEST(Lexer, EveryKeywordIsFound) {
#define KEYWORD(id, text) EXPECT_EQ(keyword(text), TokenKind::id);
#define SOFT(id, text) EXPECT_EQ(keyword(text), TokenKind::id);
#include "frontend/lex/tokens.def"
  EXPECT_EQ(keyword("eNd_fUnCtIoN_bLoCk"), TokenKind::kEndFunctionBlock);
  EXPECT_EQ(keyword("END_FUNCTION_BLOCKS"), TokenKind::kName);
  EXPECT_EQ(keyword("I"), TokenKind::kName);
  EXPECT_EQ(keyword("IG"), TokenKind::kName);
}

TEST(Lexer, Punctuation) {
  EXPECT_EQ(kinds("( ) [ ] , ; : := => . .. ^ ** * / + - < <= > >= = <> &"),
            "( ) [ ] , ; : := => . .. ^ ** * / + - < <= > >= = <> &");
  EXPECT_EQ(kinds("a:=b**-c<>d"), "name := name ** - name <> name");
}

TEST(Lexer, Numbers) {
  EXPECT_EQ(
      kinds("1 1_000 16#FF 2#10 1.5 1E6 1.5e-3 1..5 a.1.2"),
      "integer integer integer integer real number real number real number integer .. integer "
      "name . integer . integer");
  EXPECT_EQ(kinds("12abc"), "integer");
}

TEST(Lexer, TypedLiterals) {
  EXPECT_EQ(kinds("INT#5 T#5s TIME#-1d_2h LT#1.5ms T#1s..T#2s"),
            "type prefix integer duration duration duration duration .. duration");
  EXPECT_EQ(kinds("D#2024-01-02 TOD#12:30:00.5 DT#2024-01-02-12:30:00 LDT#1970-01-01-00:00"),
            "date date date date");
  EXPECT_EQ(kinds("TOD#12:30:00: x"), "date : name");
  EXPECT_EQ(kinds("D#Red T#Blue Color#Red"), "type prefix name type prefix name type prefix name");
}

TEST(Lexer, StringsAndAddresses) {
  EXPECT_EQ(kinds("'a$'b' \"x$\"y\" '' %IX0.3 %QW4 %I* a.%X3"),
            "string wide string string direct address direct address direct address name . "
            "direct address");
  EXPECT_EQ(codes("'abc\n'ok'"), "E0003");
  EXPECT_EQ(codes("'abc$"), "E0003");
  EXPECT_EQ(codes("\"abc\r\n"), "E0003");
}

TEST(Lexer, Comments) {
  EXPECT_EQ(kinds("a (* x (* y *) z *) b // c\nd /* e /* f */ g */ h"), "name name name name");
  EXPECT_EQ(kinds("(* /* *) a"), "name");
  EXPECT_EQ(codes("a (* (* *)"), "E0002");
  EXPECT_EQ(codes("a /* b"), "E0002");
  EXPECT_EQ(codes("a /*"), "E0002");
  EXPECT_EQ(codes("(*)"), "E0002");
}

TEST(Lexer, CommentDepthIsLimited) {
  auto nested = [](size_t n) {
    std::string out;
    for (size_t i = 0; i < n; ++i) out += "(*";
    for (size_t i = 0; i < n; ++i) out += "*)";
    return out + "a";
  };
  EXPECT_EQ(codes(nested(base::kMaxNesting)), "");
  EXPECT_EQ(codes(nested(base::kMaxNesting + 1)), "E6001");
  EXPECT_EQ(kinds(nested(base::kMaxNesting + 1)), "name");
}

TEST(Lexer, Pragmas) {
  Lexed out = lexed("{attribute 'x'} a {x}");
  EXPECT_EQ(out.kinds, "name");
  EXPECT_EQ(out.pragmas, 2u);
  EXPECT_EQ(codes("a {b"), "E0004");
}

TEST(Lexer, NamesInAnyEncoding) {
  EXPECT_EQ(kinds("\xEF\xBB\xBF"
                  "a \xC3\xA4rger \xE4rger _x"),
            "name name name name");
  EXPECT_EQ(codes("\xC3\xA4rger \xE4rger"), "");
  EXPECT_EQ(codes(std::string(base::kMaxIdentifier, 'a')), "");
  EXPECT_EQ(codes(std::string(base::kMaxIdentifier + 1, 'a')), "E6002");
}

TEST(Lexer, WhatTheLanguageDoesNotKnow) {
  EXPECT_EQ(kinds("a @@ \\ b"), "name name");
  EXPECT_EQ(codes("a @@ \\ b"), "E0001 E0001");
  EXPECT_EQ(codes(std::string("a \0\1 b", 6)), "E0001");
  EXPECT_EQ(kinds("a == b != c && d || !e += f"), "name = name <> name & name OR NOT name := name");
  EXPECT_EQ(codes("a == b != c && d || !e += f"), "E1016 E1016 E1016 E1016 E1016 E1016");
}

TEST(Lexer, LadderIsSkipped) {
  EXPECT_EQ(kinds("LADDER\n (* c *) |--[ a ]--( b )--|\n end_ladder c"), "LADDER END_LADDER name");
  EXPECT_EQ(kinds("ladder := 1"), "LADDER := integer");
}

TEST(Lexer, Print) {
  base::SourceMap sources;
  sources.add("t.st", "IF step\n  x := INT#5;");
  base::Diagnostics diagnostics;
  EXPECT_EQ(print_tokens(lex(sources, 0, diagnostics), sources),
            "1:1 keyword IF\n1:4 soft keyword step\n2:3 name x\n2:5 :=\n2:8 type prefix INT#\n"
            "2:12 integer 5\n2:13 ;\n2:14 end of file\n");
}

}  // namespace
}  // namespace frontend
