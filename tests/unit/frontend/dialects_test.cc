// Every row of dialects.def is true.
#include <gtest/gtest.h>

#include <set>

#include "frontend/compile.h"
#include "frontend/dialect.h"

namespace frontend {
namespace {

// Codes of what the compiler says to the example; "nothing is used" is no concern here.
std::set<std::string> codes_for(const DialectRule& rule, Dialect dialect) {
  base::SourceMap sources;
  sources.add("a.st",
              "FUNCTION_BLOCK Fb\n" + std::string(rule.example) +
                  "\nEND_FUNCTION_BLOCK\nPROGRAM p VAR fb : Fb; END_VAR fb(); END_PROGRAM\n");
  base::Diagnostics diagnostics;
  CompileOptions options;
  options.dialect = dialect;
  compile(sources, options, diagnostics);
  std::set<std::string> out;
  for (const base::Diagnostic& message : diagnostics.all()) {
    const base::DiagnosticRow& row = base::diagnostic_row(message.code);
    bool matters = row.severity == base::Severity::kError ||
                   message.code == base::DiagnosticCode::kImplicitNarrowing ||
                   message.code == base::DiagnosticCode::kSignChanged ||
                   message.code == base::DiagnosticCode::kConditionConstant ||
                   message.code == base::DiagnosticCode::kCutBeforeUse;
    if (matters) out.insert(std::string(row.code));
  }
  return out;
}

std::set<std::string> expected(std::string_view code) {
  return code.empty() ? std::set<std::string>{} : std::set<std::string>{std::string(code)};
}

TEST(DialectTable, EveryRuleHolds) {
  for (const DialectRule& rule : dialect_rules()) {
    EXPECT_EQ(codes_for(rule, Dialect::kIec), expected(rule.iec)) << rule.what;
    EXPECT_EQ(codes_for(rule, Dialect::kCodesys), expected(rule.others)) << rule.what;
    EXPECT_EQ(codes_for(rule, Dialect::kTwincat), expected(rule.others)) << rule.what;
    EXPECT_NE(rule.iec, rule.others) << rule.what;
  }
}

TEST(DialectTable, Names) {
  EXPECT_EQ(dialect_from_name("iec"), Dialect::kIec);
  EXPECT_EQ(dialect_from_name("twincat"), Dialect::kTwincat);
  EXPECT_EQ(dialect_from_name("IEC"), std::nullopt);
  EXPECT_EQ(unknown_dialect("x"), "unknown dialect `x`; known are iec, codesys, twincat");
}

}  // namespace
}  // namespace frontend
