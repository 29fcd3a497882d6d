// Questions to the resident front end: after edits they have the answers that a compilation from
// nothing gives, and asking changes nothing of what is built.
#include "frontend/questions/questions.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "frontend/questions/compilation.h"
#include "tests/unit/sanitized.h"
#include "tests/unit/workspace/edited_project.h"

namespace {

using frontend::questions::Compilation;
using frontend::questions::Index;
using frontend::questions::Occurrence;
using frontend::questions::Questions;

// Every name of the project with its place and what it means, a line each.
std::string answers(frontend::Sema& sema) {
  Questions questions(sema);
  const Index& index = questions.index();
  std::string all;
  for (const Occurrence& one : index.occurrences) {
    const base::SourceLocation at = questions.locate(one.span.begin);
    const frontend::questions::Symbol& symbol = index.symbols[one.symbol];
    const base::SourceLocation defined = questions.locate(symbol.defined.begin);
    all += std::to_string(at.line) + ':' + std::to_string(at.column) + ' ' +
           std::to_string(static_cast<int>(one.role)) + ' ' + symbol.name + ' ' +
           std::string(defined.file) + ':' + std::to_string(defined.line) + ' ' +
           questions.signature_of(symbol).documentation + '\n';
  }
  return all;
}

std::string answers_from_nothing(const base::SourceMap& sources) {
  Compilation compilation(sources, frontend::CompileOptions());
  return answers(*compilation.sema());
}

TEST(QuestionsAfterEdits, L01_AreAnsweredAsFromNothingAndChangeNothing) {
  uint64_t followed = 0;
  uint64_t names = 0;
  uint32_t number = 0;
  for (const std::string& path : test::sources_below("tests/golden")) {
    const std::string original = test::read_file(path);
    if (++number % (7 * kOneOf) != 0) continue;
    test::Random random(test::seed_of(path));
    workspace::Settings settings;
    workspace::IncrementalBuild build(settings);
    std::string text = original;
    if (!test::build_again(build, test::one_file(text)).image) continue;
    for (uint32_t edit = 0; edit < 4; ++edit) {
      answers(*build.frontend()->sema());  // which changes nothing of the next build
      text = test::edited(text, random);
      const base::SourceMap sources = test::one_file(text);
      const test::Outcome clean = test::build_from_nothing(sources, settings);
      const test::Outcome again = test::build_again(build, sources);
      ASSERT_TRUE(again == clean) << path << "\n" << text;
      if (!again.image) {
        text = original;
        if (!test::build_again(build, test::one_file(text)).image) break;
        continue;
      }
      const std::string now = answers(*build.frontend()->sema());
      ASSERT_EQ(now, answers_from_nothing(sources)) << path << " edit " << edit << "\n" << text;
      names += static_cast<uint64_t>(std::count(now.begin(), now.end(), '\n'));
    }
    followed += build.counts().edits;
  }
  EXPECT_GT(followed, 20u / kOneOf);  // otherwise nothing was tested
  EXPECT_GT(names, 2000u / kOneOf);
}

}  // namespace
