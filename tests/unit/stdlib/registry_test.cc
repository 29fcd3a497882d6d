// The table of the library and the sources of the library say the same.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/parse/parse.h"
#include "stdlib/registry.h"
#include "stdlib/sources.h"

namespace stdlib::testing {
namespace {

struct Library {
  base::SourceMap sources;
  frontend::Tree tree;
  base::Diagnostics diagnostics;

  // Of the standard's own dialect, or else of the others.
  explicit Library(bool iec) {
    for (const LibrarySource& source : library_sources()) {
      if (!is_of_dialect(source, iec)) continue;
      sources.add(std::string(source.name), std::string(source.text));
    }
    for (uint32_t file = 0; file < sources.file_count(); ++file) {
      frontend::parse(sources, file, tree, diagnostics);
    }
  }
  std::string_view text(base::SourceSpan span) const {
    const uint32_t file = sources.file_of(span.begin);
    const std::string_view all = sources.text(file);
    return all.substr(span.begin.offset - sources.begin(file).offset,
                      span.end.offset - span.begin.offset);
  }
  // "CU R : BOOL; PV : INT" of the variables of those sections.
  std::string variables(const frontend::PouDecl& pou,
                        std::set<frontend::VarSection> sections) const {
    std::string out;
    std::string last_type;
    for (const frontend::VarBlock& block : pou.blocks) {
      if (!sections.contains(block.section)) continue;
      for (const frontend::VarDecl& decl : block.vars) {
        const std::string type(text(tree[decl.spec].span));
        for (const frontend::Name& name : decl.names) {
          if (!last_type.empty()) out += type == last_type ? " " : " : " + last_type + "; ";
          out += name.text;
          last_type = type;
        }
      }
    }
    return last_type.empty() ? out : out + " : " + last_type;
  }
  std::string interface(const frontend::PouDecl& pou) const {
    using frontend::VarSection;
    std::string in = variables(pou, {VarSection::kInput, VarSection::kInOut});
    if (in.empty() && pou.result.valid()) return "-> " + std::string(text(tree[pou.result].span));
    if (pou.result.valid()) return in + " -> " + std::string(text(tree[pou.result].span));
    return in + " => " + variables(pou, {VarSection::kOutput});
  }
};

// The row of a block or of one of its variants: CTU for CTU_DINT.
const PageRow* row_of(std::string_view name, bool iec = true) {
  for (; !name.empty(); name = name.substr(0, name.rfind('_') == name.npos ? 0 : name.rfind('_'))) {
    for (const PageRow& row : page_rows()) {
      if (row.name == name && are_of_dialect(row.dialects, iec)) return &row;
    }
  }
  return nullptr;
}

class RegistryOf : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Dialects, RegistryOf, ::testing::Bool(),
                         [](const auto& iec) { return iec.param ? "iec" : "vendors"; });

TEST_P(RegistryOf, LibrarySourcesParse) {
  Library library(GetParam());
  EXPECT_FALSE(library.diagnostics.has_errors());
  EXPECT_GT(library.tree.pous.size(), 40u);
}

TEST_P(RegistryOf, EveryBlockHasARowWithItsInterface) {
  Library library(GetParam());
  for (const frontend::PouDecl& pou : library.tree.pous) {
    const PageRow* row = row_of(pou.name.text, GetParam());
    ASSERT_NE(row, nullptr) << pou.name.text;
    // Counters have another type with vendors, which the text of the row says.
    const bool stands_for_iec = !GetParam() && row->dialects == LibraryDialects::kAll;
    if (row->name != pou.name.text || stands_for_iec) continue;
    EXPECT_EQ(library.interface(pou), row->interface) << row->name;
  }
}

TEST_P(RegistryOf, EveryRowHasABlock) {
  Library library(GetParam());
  std::set<std::string> names;
  for (const frontend::PouDecl& pou : library.tree.pous) names.insert(std::string(pou.name.text));
  for (const PageRow& row : page_rows()) {
    if (!row.in_st || !are_of_dialect(row.dialects, GetParam())) continue;
    EXPECT_TRUE(names.contains(std::string(row.name))) << row.name;
  }
}

TEST(Registry, AliasesNameParameters) {
  for (const AliasRow& alias : alias_rows()) {
    const PageRow* row = row_of(alias.block);
    ASSERT_NE(row, nullptr) << alias.block;
    const std::string words = " " + std::string(row->interface) + " ";
    EXPECT_NE(words.find(" " + std::string(alias.parameter) + " "), std::string::npos)
        << alias.block << "." << alias.parameter;
    EXPECT_EQ(words.find(" " + std::string(alias.name) + " "), std::string::npos)
        << alias.block << "." << alias.name << " hides a parameter";
  }
}

TEST(Registry, NamesAreUniqueAndRowsComplete) {
  for (const bool iec : {true, false}) {
    std::set<std::string_view> names;
    for (const PageRow& row : page_rows()) {
      if (!are_of_dialect(row.dialects, iec)) continue;
      EXPECT_TRUE(names.insert(row.name).second) << row.name;
      EXPECT_EQ(row.interface.empty(), row.meaning.empty()) << row.name;
    }
  }
}

TEST(Registry, SignaturesTakeApart) {
  for (const FunctionRow& row : function_rows()) {
    if (row.name == "ADD_TOD_TIME") {
      EXPECT_EQ(operand_type(row, 0), "TOD");
      EXPECT_EQ(operand_type(row, 1), "TIME");
      EXPECT_EQ(operand_type(row, 2), "");
      EXPECT_EQ(result_type(row), "TOD");
    }
    if (row.name == "SPLIT_DATE") {
      EXPECT_EQ(operand_type(row, 0), "DATE");
      EXPECT_EQ(result_type(row), "");
    }
  }
}

}  // namespace
}  // namespace stdlib::testing
