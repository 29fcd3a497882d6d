// An image after edits is the image that a build from nothing makes, byte for byte, with the same
// messages: the golden files, which have everything that the language has, edited at random.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/unit/workspace/edited_project.h"

namespace {

uint32_t number_of(const char* name, uint32_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : static_cast<uint32_t>(std::strtoul(text, nullptr, 10));
}

// Names the file, the edit and both texts' place when they differ.
void expect_same(const std::string& path, uint32_t edit, const std::string& text,
                 const test::Outcome& again, const test::Outcome& clean) {
  EXPECT_EQ(again.messages, clean.messages) << path << " edit " << edit << "\n" << text;
  EXPECT_EQ(again.refusal, clean.refusal) << path << " edit " << edit << "\n" << text;
  EXPECT_EQ(again.image.has_value(), clean.image.has_value()) << path << " edit " << edit;
  EXPECT_TRUE(again.image == clean.image) << path << " edit " << edit << ": another image\n"
                                          << text;
}

// What a CONFIGURATION says (connections, tasks of blocks, VAR_CONFIG, VAR_ACCESS) is kept from
// edit to edit beside the bodies. Few files have one, so each of them takes part, with many edits.
bool has_configuration(const std::string& text) {
  for (const char* word : {"CONFIGURATION", "VAR_CONFIG", "VAR_ACCESS"}) {
    if (text.find(word) != std::string::npos) return true;
  }
  return false;
}

// STC_EDITS: edits of each file; STC_SEED: other ones; STC_FILES: one file in so many.
TEST(RandomEdits, PerformanceIncrementalBuildsEqualBuildsFromNothing) {
  const uint32_t edits = number_of("STC_EDITS", 4);
  const uint32_t every = number_of("STC_FILES", 3);
  const uint32_t seed = number_of("STC_SEED", 1);
  uint64_t followed = 0;
  uint64_t with_configuration = 0;
  uint64_t whole = 0;
  uint32_t number = 0;
  for (const std::string& path : test::sources_below("tests/golden")) {
    const std::string original = test::read_file(path);
    const bool configured = has_configuration(original);
    if (++number % every != 0 && !configured) continue;
    test::Random random(seed + test::seed_of(path));
    workspace::Settings settings;
    const test::Outcome first = test::build_from_nothing(test::one_file(original), settings);
    if (!first.image) continue;
    ir::Image base;
    if (random.below(2) == 0) {  // against a running version
      base = std::move(*ir::decode(*first.image));
      settings.link.base = &base;
    }
    if (random.below(8) == 0) settings.passes = ir::PassSet::none();
    workspace::IncrementalBuild build(settings);
    std::string text = original;
    if (!test::build_again(build, test::one_file(text)).image) continue;  // several RESOURCEs
    for (uint32_t edit = 0; edit < (configured ? 6 * edits : edits); ++edit) {
      text = test::edited(random.below(6) == 0 ? original : text, random);
      const base::SourceMap sources = test::one_file(text);
      const test::Outcome clean = test::build_from_nothing(sources, settings);
      const test::Outcome again = test::build_again(build, sources);
      if (again.refusal.find("several RESOURCEs") != std::string::npos) {  // not its affair
        text = original;
        continue;
      }
      expect_same(path, edit, text, again, clean);
      if (::testing::Test::HasFailure()) return;
      if (!clean.image && random.below(2) == 0) text = original;
    }
    followed += build.counts().edits;
    if (configured) with_configuration += build.counts().edits;
    whole += build.counts().whole;
  }
  // Otherwise nothing was tested.
  EXPECT_GT(followed, 100u);
  EXPECT_GT(with_configuration, 100u);
  RecordProperty("followed", static_cast<int>(followed));
  RecordProperty("whole", static_cast<int>(whole));
}

// The corpus has many times the expressions that are given back at once; the resident compiler
// keeps them all (frontend/finished_bodies.h).
TEST(RandomEdits, PerformanceBodiesThatAreGivenBackAreNotMissed) {
  base::SourceMap sources;
  for (const std::string& path : test::sources_below("tests/corpus")) {
    sources.add(path, test::read_file(path));
  }
  const workspace::Settings settings;
  workspace::IncrementalBuild build(settings);
  const test::Outcome again = test::build_again(build, sources);
  ASSERT_TRUE(again.image.has_value()) << again.messages << again.refusal;
  EXPECT_TRUE(again == test::build_from_nothing(sources, settings));
}

}  // namespace
