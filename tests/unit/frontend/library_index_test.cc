// A small project parses what it needs of the standard library, and is compiled as with all of it.
#include "frontend/lex/library_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "base/diagnostics.h"
#include "frontend/compile.h"
#include "frontend/parse/parse.h"
#include "stdlib/sources.h"

namespace {

using frontend::LibraryIndex;

// Of one file of the library: what the parser says that it declares.
struct DeclaredNames {
  std::set<std::string> pous;
  std::set<std::string> others;  // types and enumerators
};

DeclaredNames declared_by(const stdlib::LibrarySource& library) {
  base::SourceMap sources;
  sources.add(std::string(library.name), std::string(library.text));
  frontend::Tree tree;
  base::Diagnostics diagnostics;
  frontend::parse(sources, 0, tree, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << library.name;
  DeclaredNames names;
  for (const frontend::PouDecl& pou : tree.pous) names.pous.emplace(pou.name.text);
  for (const frontend::TypeDecl& type : tree.types) {
    names.others.emplace(type.name.text);
    for (const frontend::Enumerator& one : tree[type.spec].enumerators) {
      names.others.emplace(one.name.text);
    }
  }
  return names;
}

std::vector<uint32_t> needed(bool iec, const std::string& text) {
  base::SourceMap sources;
  sources.add("a.st", text);
  return LibraryIndex::of(iec).needed(sources);
}

bool contains(const std::vector<uint32_t>& files, uint32_t file) {
  return std::find(files.begin(), files.end(), file) != files.end();
}

class LibraryIndexOf : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Dialects, LibraryIndexOf, ::testing::Bool(),
                         [](const auto& iec) { return iec.param ? "iec" : "vendors"; });

TEST_P(LibraryIndexOf, EachNameThatIsDeclaredBringsItsFile) {
  const auto library = stdlib::library_sources();
  for (uint32_t file = 0; file < library.size(); ++file) {
    if (!stdlib::is_of_dialect(library[file], GetParam())) continue;
    const DeclaredNames names = declared_by(library[file]);
    for (const std::set<std::string>* some : {&names.pous, &names.others}) {
      for (const std::string& name : *some) {
        EXPECT_TRUE(contains(needed(GetParam(), "x:=" + name + ";"), file)) << name;
      }
    }
  }
}

TEST_P(LibraryIndexOf, PousAreThoseThatTheParserFinds) {
  const auto library = stdlib::library_sources();
  std::set<std::string> parsed;
  for (const uint32_t file : LibraryIndex::of(GetParam()).all()) {
    parsed.merge(declared_by(library[file]).pous);
  }
  const std::vector<std::string_view>& pous = LibraryIndex::of(GetParam()).pous();
  EXPECT_EQ(std::set<std::string>(pous.begin(), pous.end()), parsed);
}

TEST_P(LibraryIndexOf, WhatNeedsNothingGetsAlmostNothing) {
  EXPECT_EQ(needed(GetParam(), "PROGRAM p VAR a : INT; END_VAR a := a + 1; END_PROGRAM").size(),
            2u);
}

TEST(LibraryIndex, TheCaseOfANameDoesNotMatter) {
  EXPECT_EQ(needed(false, "t : tOn;"), needed(false, "t : TON;"));
  EXPECT_GT(needed(false, "t : tOn;").size(), 2u);
}

// Each file of the library alone, whose own text is no part of the project.
TEST(LibraryIndex, AFileBringsWhatItNeedsItself) {
  const auto library = stdlib::library_sources();
  for (const bool iec : {true, false}) {
    for (const uint32_t file : LibraryIndex::of(iec).all()) {
      const DeclaredNames names = declared_by(library[file]);
      if (names.pous.empty()) continue;
      const std::vector<uint32_t> files = needed(iec, "x := " + *names.pous.begin() + "();");
      const std::vector<uint32_t> by_text = needed(iec, std::string(library[file].text));
      EXPECT_TRUE(std::includes(files.begin(), files.end(), by_text.begin(), by_text.end()))
          << library[file].name;
    }
  }
}

// Also a block of a file that the project does not need.
TEST(LibraryIndex, AMisspeltBlockHasItsWayOut) {
  base::SourceMap sources;
  sources.add("a.st", "PROGRAM p VAR t : CTUDD; END_VAR END_PROGRAM");
  EXPECT_EQ(LibraryIndex::of(false).needed(sources).size(), 2u);
  base::Diagnostics diagnostics;
  EXPECT_FALSE(frontend::compile(sources, {}, diagnostics).has_value());
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(diagnostics.all()[0].fix, "did you mean `CTUD`?");
}

TEST(LibraryIndex, LargeSourcesGetAll) {
  EXPECT_EQ(needed(false, std::string(300 * 1024, ' ')), LibraryIndex::of(false).all());
}

}  // namespace
