// The formatter on what golden files cannot show: bytes, line endings, charsets, every source of
// the repository, and its speed in the large.
#include "frontend/format/format.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "frontend/format/same_program.h"
#include "tests/source_path.h"

namespace frontend {
namespace {

std::string formatted(const std::string& text, const FormatOptions& options = {}) {
  base::SourceMap sources;
  sources.add("a.st", text);
  base::Diagnostics diagnostics;
  base::Result<std::string> out = format(sources, 0, options, diagnostics);
  return out.ok() ? *out : "refused: " + base::to_string(out.error());
}

constexpr const char* kLoose = "program p var a:int;end_var\na:=1;\n\n\n\nb:=2;end_program";
constexpr const char* kTidy =
    "PROGRAM p\nVAR a : int; END_VAR\n  a := 1;\n\n  b := 2;\nEND_PROGRAM\n";

std::string with_line_ends(std::string text) {
  for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) {
    text.replace(at, 1, "\r\n");
  }
  return text;
}

TEST(Format, NormalisesAndEndsWithOneNewline) {
  EXPECT_EQ(formatted(kLoose), kTidy);
  EXPECT_EQ(formatted(kTidy), kTidy);
  EXPECT_EQ(formatted(std::string("\n\n") + kLoose + "\n\n\n"), kTidy);
}

TEST(Format, EmptyStaysEmpty) {
  EXPECT_EQ(formatted(""), "");
  EXPECT_EQ(formatted("\n \n"), "");
  EXPECT_EQ(formatted("  // only this  \n"), "// only this\n");
}

TEST(Format, KeepsLineEndings) {
  EXPECT_EQ(formatted(with_line_ends(kLoose)), with_line_ends(kTidy));
  EXPECT_EQ(formatted(with_line_ends("(* a\n   b *)\nPROGRAM p\nEND_PROGRAM\n")),
            with_line_ends("(* a\n   b *)\nPROGRAM p\nEND_PROGRAM\n"));
}

TEST(Format, KeepsByteOrderMark) {
  EXPECT_EQ(formatted(std::string("\xEF\xBB\xBF") + kLoose), std::string("\xEF\xBB\xBF") + kTidy);
}

TEST(Format, KeepsLatin1AndCountsItsCharacters) {
  std::string text =
      "VAR_GLOBAL\n  h\xF6he  : INT; // \xE4\n  a     : INT; // b\n  breite : INT; // c\nEND_VAR\n";
  EXPECT_EQ(formatted(text),
            "VAR_GLOBAL\n  h\xF6he   : INT;  // \xE4\n  a      : INT;  // b\n"
            "  breite : INT;  // c\nEND_VAR\n");
}

TEST(Format, CountsCharactersOfUtf8) {
  std::string text = "VAR_GLOBAL\n  h\xC3\xB6he : INT;\n  hohe : INT;\nEND_VAR\n";
  EXPECT_EQ(formatted(text), text);
}

TEST(Format, LeavesTextsWithErrorsAlone) {
  EXPECT_EQ(formatted("PROGRAM p a := ; END_PROGRAM"), "refused: R0505: a.st: 1 error(s)");
  EXPECT_EQ(formatted("PROGRAM p (* END_PROGRAM").substr(0, 8), "refused:");
}

TEST(Format, SameProgramSeesEveryDifference) {
  auto same = [](const std::string& a, const std::string& b) {
    base::SourceMap sources;
    sources.add("a.st", a);
    sources.add("b.st", b);
    return formatting::same_program(sources, 0, sources, 1).ok();
  };
  EXPECT_TRUE(same("a := 1; // x", "a\n:=\n1  ; // x"));
  EXPECT_TRUE(same("if a then", "IF a THEN"));
  EXPECT_TRUE(same("(* a\n  b *)", "  (* a\n      b *)"));
  EXPECT_FALSE(same("a := 1;", "A := 1;;"));
  EXPECT_FALSE(same("a := 16#ff;", "a := 16#FF;"));
  EXPECT_FALSE(same("a := 'x';", "a := 'X';"));
  EXPECT_FALSE(same("a S= b;", "a S = b;"));
  EXPECT_FALSE(same("a; // x", "a;"));
  EXPECT_FALSE(same("a; // x", "// x\na;"));
  EXPECT_FALSE(same("(* a b *)", "(* a  b *)"));
  EXPECT_FALSE(same("(* a\nb *)", "(* a b *)"));
  EXPECT_FALSE(same("{a}", "(*a*)"));
}

TEST(Format, DeepNestingIsNotRecursionWithoutEnd) {
  std::string text = "a := " + std::string(20000, '(') + "1" + std::string(20000, ')') + ";";
  base::SourceMap sources;
  sources.add("a.st", text);
  base::Diagnostics diagnostics;
  EXPECT_TRUE(format_tokens(sources, 0, {}, diagnostics).ok());
}

// Of text that is no program: what ends a block in front of a branch's first token takes no token,
// so the branch must not begin its blocks anew for ever.
TEST(Format, ABlockThatEndsInFrontOfAnotherBranch) {
  base::SourceMap sources;
  sources.add(
      "a.st",
      "PROGRAM VAR\n{IF defined(FAST)}\nLD (1\n{ELSE}\n  VAR level : RE\nLD 2\n{END_IF}\nST n\n"
      "END_PROGRAM\n");
  base::Diagnostics diagnostics;
  (void)format_tokens(sources, 0, {}, diagnostics).ok();
  EXPECT_FALSE(format(sources, 0, {}, diagnostics).ok());
}

// What opens something outside of POUs is a function in an instruction list.
TEST(Format, WordsOfHeadsAreFunctionsInAnInstructionList) {
  for (const char* word : {"SETUP", "TEARDOWN", "RESOURCE", "EXTENDS", "IMPLEMENTS", "RESOURCE n",
                           "SETUP n", "TEARDOWN n", "EXTENDS n"}) {
    base::SourceMap sources;
    sources.add("a.st",
                std::string("PROGRAM P\nVAR\n  n : INT;\nEND_VAR\n         LD  n\n         ") +
                    word + "\nlabel1:\n         ST  n\nEND_PROGRAM\n");
    base::Diagnostics diagnostics;
    base::Result<std::string> text = format(sources, 0, {}, diagnostics);
    ASSERT_TRUE(text.ok()) << word << ": " << text.error().text;
    EXPECT_NE(text->find("\n  label1:\n    ST    n\n"), std::string::npos) << *text;
  }
}

// `&N` is one operator where more follows, also within the parentheses of another instruction.
TEST(Format, AndNotStaysOneOperatorInParentheses) {
  base::SourceMap sources;
  sources.add("a.st", "PROGRAM P\nld a\nandn(\nldn b &N c\n)\nst a\nEND_PROGRAM\n");
  base::Diagnostics diagnostics;
  base::Result<std::string> text = format(sources, 0, {}, diagnostics);
  ASSERT_TRUE(text.ok()) << text.error().text;
  EXPECT_NE(text->find("b &N c"), std::string::npos) << *text;
}

std::string read(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// Token equality is checked inside; a text with lexical errors is refused, and few may be.
void check_source(const std::filesystem::path& path, const FormatOptions& options, int& refused) {
  base::SourceMap sources;
  sources.add(path.string(), read(path));
  base::Diagnostics diagnostics;
  base::Result<std::string> once = format_tokens(sources, 0, options, diagnostics);
  if (!once.ok()) {
    EXPECT_EQ(once.error().refusal, base::Refusal::kSourceErrors) << once.error().text;
    ++refused;
    return;
  }
  sources.add(path.string(), *once);
  base::Result<std::string> twice = format_tokens(sources, 1, options, diagnostics);
  ASSERT_TRUE(twice.ok()) << path;
  EXPECT_EQ(*twice, *once) << path;
}

TEST(Format, EverySourceOfTheRepositoryTwiceIsOnce) {
  FormatOptions narrow;
  narrow.width = 40;
  narrow.indent = 4;
  narrow.align_assignments = true;
  int files = 0;
  int refused = 0;
  for (const char* folder :
       {"tests/golden", "tests/corpus", "tests/fuzz/corpus/format", "examples", "stdlib"}) {
    std::filesystem::path root = tests::source_path(folder);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
      if (entry.path().extension() != ".st") continue;
      check_source(entry.path(), {}, refused);
      check_source(entry.path(), narrow, refused);
      ++files;
    }
  }
  EXPECT_GT(files, 80);
  EXPECT_LT(refused, files / 4);
}

TEST(Format, ExamplesAreFormatted) {
  std::filesystem::path root = tests::source_path("examples");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".st") continue;
    std::string text = read(entry.path());
    EXPECT_TRUE(formatted(text) == text) << entry.path() << ": run `stc fmt examples`";
  }
}

}  // namespace
}  // namespace frontend
