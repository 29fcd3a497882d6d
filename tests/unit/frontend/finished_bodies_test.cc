// The expressions of a body go when it is lowered (frontend/finished_bodies.h).
#include "frontend/finished_bodies.h"

#include <gtest/gtest.h>

#include <string>

#include "frontend/analysis.h"

namespace {

// `count` blocks of 33 expressions each, one of which is in a declaration.
std::string many_blocks(uint32_t count, const std::string& section,
                        const std::string& kind = "FUNCTION_BLOCK") {
  std::string text;
  for (uint32_t i = 0; i < count; ++i) {
    text += kind + " Block" + std::to_string(i) + "\n" + section +
            "VAR a : DINT := 5; b : DINT; END_VAR\n";
    for (int line = 0; line < 4; ++line) text += "a := a + b * (a - 1);\n";
    text += "END_" + kind + "\n";
  }
  return text + "PROGRAM Main VAR x : DINT; END_VAR x := x + 1; END_PROGRAM\n";
}

struct Chunks {
  size_t at_first = 0;
  size_t most_left = 0;  // at the end of the bodies
  size_t expressions = 0;
};

size_t held(const frontend::Tree& tree) {
  size_t expressions = 0;
  tree.exprs.each([&](const frontend::Expr&) { ++expressions; });
  return expressions;
}

Chunks lower(const std::string& text,
             frontend::LibraryExtent extent = frontend::LibraryExtent::kNeeded) {
  base::SourceMap sources;
  sources.add("blocks.st", text);
  base::Diagnostics diagnostics;
  const frontend::CompileOptions options;
  auto parsed = frontend::parse_project(sources, options, extent, diagnostics);
  frontend::Sema sema(parsed->sources, parsed->tree, parsed->library_file, options,
                      frontend::Purpose::kRun, diagnostics);
  frontend::declare_all(sema);
  Chunks out;
  out.at_first = held(parsed->tree);
  out.expressions = parsed->tree.exprs.size();
  frontend::FinishedBodies finished(sema, parsed->tree);
  for (uint32_t pou = 0; pou < sema.declared.pous.size(); ++pou) {
    frontend::lower_body(sema, pou);
    finished.finish(pou);
  }
  frontend::check_whole(sema);
  EXPECT_FALSE(diagnostics.has_errors());
  out.most_left = held(parsed->tree);
  return out;
}

TEST(FinishedBodies, PerformanceExpressionsOfBodiesAreGivenBack) {
  // So many blocks get the whole library.
  const Chunks few = lower(many_blocks(1, ""), frontend::LibraryExtent::kWhole);
  const Chunks many = lower(many_blocks(2000, ""));
  EXPECT_EQ(many.at_first, many.expressions);
  EXPECT_GT(many.at_first - few.at_first, 60000u);
  // What stays: the declarations, and bodies in a chunk with those of the library.
  EXPECT_LT(many.most_left, few.most_left + 2000 + 2 * frontend::ExprStore::kChunk);
}

// A call may need such a body once more, for a longer string.
TEST(FinishedBodies, PerformanceWhatMayHaveInstancesStays) {
  const Chunks many = lower(many_blocks(2000, "VAR_IN_OUT s : STRING[20]; END_VAR\n", "FUNCTION"));
  EXPECT_EQ(many.most_left, many.expressions);
}

}  // namespace
