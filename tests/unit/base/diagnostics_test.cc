#include "base/diagnostics.h"

#include <gtest/gtest.h>

#include <set>

namespace base {
namespace {

struct Fixture {
  SourceMap sources;
  Diagnostics diagnostics;
  SourcePos begin;

  explicit Fixture(std::string text, std::string name = "pump.st")
      : begin(sources.add(std::move(name), std::move(text))) {}
  SourceSpan span(uint32_t from, uint32_t to) const {
    return {{begin.offset + from}, {begin.offset + to}};
  }
  std::string render(DiagnosticFormat format, bool colour = false) const {
    return base::render(diagnostics, sources, format, colour);
  }
};

char letter_of(Severity severity) { return severity == Severity::kError ? 'E' : 'W'; }

TEST(Registry, CodesAreUniqueAndFitTheirSeverity) {
  std::set<std::string_view> codes;
  for (uint32_t i = 0; i < diagnostic_count(); ++i) {
    const DiagnosticRow& row = diagnostic_row(static_cast<DiagnosticCode>(i));
    EXPECT_TRUE(codes.insert(row.code).second) << row.code << " occurs twice";
    EXPECT_EQ(row.code.size(), 5u) << row.code;
    EXPECT_EQ(row.code[0], letter_of(row.severity)) << row.code;
    EXPECT_FALSE(row.title.empty()) << row.code;
    EXPECT_FALSE(diagnostic_page(static_cast<DiagnosticCode>(i)).empty()) << row.code;
  }
  EXPECT_EQ(diagnostic_row(DiagnosticCode::kMissingEnd).code, "E1003");
}

TEST(Sink, CountsBySeverityAndSorts) {
  Fixture f("abc\ndef\n");
  f.diagnostics.add(DiagnosticCode::kUnusedVariable, f.span(4, 7), "unused");
  EXPECT_FALSE(f.diagnostics.has_errors());
  f.diagnostics.add(DiagnosticCode::kUnknownName, f.span(0, 3), "first");
  f.diagnostics.add(DiagnosticCode::kUnknownName, f.span(0, 3), "the same again");
  EXPECT_EQ(f.diagnostics.error_count(), 2u);
  EXPECT_EQ(f.diagnostics.warning_count(), 1u);
  f.diagnostics.sort();
  ASSERT_EQ(f.diagnostics.all().size(), 2u);
  EXPECT_EQ(f.diagnostics.all()[0].text, "first");
  EXPECT_EQ(f.diagnostics.all()[1].text, "unused");
}

TEST(Sink, KeepsAtMostItsLimit) {
  Diagnostics diagnostics(3);
  for (uint32_t i = 0; i < 10; ++i) diagnostics.add(DiagnosticCode::kUnknownName, {{i}, {i}}, "x");
  EXPECT_EQ(diagnostics.all().size(), 3u);
  EXPECT_EQ(diagnostics.error_count(), 10u);
}

TEST(Text, SnippetNotesAndFix) {
  Fixture f("PROGRAM p\n  speed := 5\nEND_PROGRAM\n");
  f.diagnostics.add({DiagnosticCode::kUnknownName,
                     f.span(12, 17),
                     "`speed` is not declared",
                     "declare it",
                     {{f.span(0, 7), "in this program"}}});
  EXPECT_EQ(f.render(DiagnosticFormat::kText),
            "pump.st:2:3: error[E2001]: `speed` is not declared\n"
            "    2 |   speed := 5\n"
            "      |   ^~~~~\n"
            "pump.st:1:1: note: in this program\n"
            "    1 | PROGRAM p\n"
            "      | ^~~~~~~\n"
            "   help: declare it\n"
            "1 error\n");
}

TEST(Text, ColourOnlyWhenAsked) {
  Fixture f("a\n");
  f.diagnostics.add(DiagnosticCode::kUnusedVariable, f.span(0, 1), "unused");
  EXPECT_EQ(f.render(DiagnosticFormat::kText, false).find('\033'), std::string::npos);
  EXPECT_NE(f.render(DiagnosticFormat::kText, true).find("\033[1;35mwarning[W0003]\033[0m"),
            std::string::npos);
}

TEST(Text, CaretsCountCharactersAndKeepTabs) {
  Fixture f("\t'\xC3\xA4' x\n");
  f.diagnostics.add(DiagnosticCode::kUnknownName, f.span(6, 7), "x");
  EXPECT_EQ(f.render(DiagnosticFormat::kText),
            "pump.st:1:6: error[E2001]: x\n"
            "    1 | \t'\xC3\xA4' x\n"
            "      | \t    ^\n"
            "1 error\n");
}

// The caret stands where the reader sees its place: the escape is wider than what it stands for.
TEST(Text, WhatTurnsTheDirectionIsAnEscape) {
  Fixture f("a\u202e b\n");
  f.diagnostics.add(DiagnosticCode::kUnknownName, f.span(5, 6), "b");
  EXPECT_EQ(f.render(DiagnosticFormat::kText),
            "pump.st:1:4: error[E2001]: b\n"
            "    1 | a\\u202e b\n"
            "      |         ^\n"
            "1 error\n");
}

TEST(Text, SourceBytesCannotSteerTheTerminal) {
  Fixture f("a \033[2J \x9B \xE4 b\n");
  f.diagnostics.add(DiagnosticCode::kBadCharacter, f.span(2, 3), "`\033` is no character");
  std::string out = f.render(DiagnosticFormat::kText);
  EXPECT_EQ(out.find('\033'), std::string::npos);
  EXPECT_NE(out.find("a ?[2J ? \xC3\xA4 b"), std::string::npos);
}

TEST(Text, LongLinesAreWindowed) {
  Fixture f(std::string(100000, 'a') + "X" + std::string(100000, 'b'));
  f.diagnostics.add(DiagnosticCode::kUnknownName, f.span(100000, 100001), "x");
  std::string out = f.render(DiagnosticFormat::kText);
  EXPECT_LT(out.size(), 1000u);
  EXPECT_NE(out.find("aXb"), std::string::npos);
}

TEST(Text, SpanOverSeveralLinesEndsWithItsFirst) {
  Fixture f("abc\ndef\n");
  f.diagnostics.add(DiagnosticCode::kUnknownName, f.span(1, 6), "x");
  EXPECT_NE(f.render(DiagnosticFormat::kText).find("      |  ^~\n"), std::string::npos);
}

TEST(Text, WithoutAPlace) {
  Diagnostics diagnostics;
  diagnostics.add(DiagnosticCode::kNoPrograms, {}, "nothing to run");
  EXPECT_EQ(render(diagnostics, SourceMap(), DiagnosticFormat::kText, false),
            "error[E5005]: nothing to run\n1 error\n");
}

TEST(Text, EndOfFile) {
  Fixture f("a");
  f.diagnostics.add(DiagnosticCode::kMissingSemicolon, f.span(1, 2), "missing");
  EXPECT_EQ(f.render(DiagnosticFormat::kText),
            "pump.st:1:2: error[E1002]: missing\n    1 | a\n      |  ^\n1 error\n");
}

TEST(Json, Fields) {
  Fixture f("\xE4 := \"x\";\n", "a\"b.st");
  f.diagnostics.add({DiagnosticCode::kUnknownName,
                     f.span(0, 1),
                     "say \"\xE4\"\n\t\\",
                     "fix",
                     {{f.span(5, 8), "note"}}});
  EXPECT_EQ(f.render(DiagnosticFormat::kJson),
            "{\"diagnostics\":[\n"
            "{\"code\":\"E2001\",\"severity\":\"error\",\"message\":\"say "
            "\\\"\xC3\xA4\\\"\\n\\u0009\\\\\",\"fix\":\"fix\",\"file\":\"a\\\"b.st\",\"line\":1,"
            "\"column\":1,\"endLine\":1,\"endColumn\":2,\"notes\":[{\"message\":\"note\","
            "\"file\":\"a\\\"b.st\",\"line\":1,\"column\":6,\"endLine\":1,\"endColumn\":9}]}\n"
            "],\"errors\":1,\"warnings\":0,\"notes\":0}\n");
}

TEST(Json, Empty) {
  EXPECT_EQ(render(Diagnostics(), SourceMap(), DiagnosticFormat::kJson, false),
            "{\"diagnostics\":[\n],\"errors\":0,\"warnings\":0,\"notes\":0}\n");
}

TEST(Sarif, ResultRuleAndPlace) {
  Fixture f("abc\n", "src/a b.st");
  f.diagnostics.add(DiagnosticCode::kUnusedVariable, f.span(1, 3), "unused", "remove it");
  std::string out = f.render(DiagnosticFormat::kSarif);
  EXPECT_NE(out.find("\"version\":\"2.1.0\""), std::string::npos);
  EXPECT_NE(out.find("\"rules\":[{\"id\":\"W0003\""), std::string::npos);
  EXPECT_NE(out.find("{\"ruleId\":\"W0003\",\"ruleIndex\":0,\"level\":\"warning\",\"message\":{"
                     "\"text\":\"unused "
                     "(remove it)\"},\"locations\":[{\"physicalLocation\":{\"artifactLocation\":"
                     "{\"uri\":\"src/a%20b.st\"},\"region\":{\"startLine\":1,\"startColumn\":2,"
                     "\"endLine\":1,\"endColumn\":4}}}],\"partialFingerprints\":{"
                     "\"lineOfCode/v1\":\"6ff87c630c92a67d:1\"}}"),
            std::string::npos)
      << out;
}

TEST(Github, WorkflowCommand) {
  Fixture f("abc\n", "a,b.st");
  f.diagnostics.add(DiagnosticCode::kUnknownName, f.span(0, 3), "100% wrong: x", "fix");
  EXPECT_EQ(f.render(DiagnosticFormat::kGithub),
            "::error file=a%2Cb.st,line=1,endLine=1,col=1,endColumn=4,title=E2001::100%25 wrong: "
            "x%0Ahelp: fix\n");
}

}  // namespace
}  // namespace base
