// a build for coverage runs as any other does, and counts what ran, whatever the optimiser
// did: every golden file of runs and of the corpus, with and without.
#include "frontend/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "frontend/compile.h"
#include "ir/lower/lower.h"
#include "ir/opt/optimise.h"
#include "linker/link.h"
#include "tests/source_path.h"
#include "tests/unit/exec/machine.h"
#include "tests/unit/sanitized.h"

namespace {

namespace fs = std::filesystem;
using frontend::Coverage;
using frontend::SiteKind;

std::string coverage_text_of(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// The file, and what its USE lines name.
base::SourceMap coverage_sources(const fs::path& path) {
  base::SourceMap sources;
  const std::string text = coverage_text_of(path);
  sources.add(path.filename().string(), text);
  std::istringstream lines(text);
  constexpr std::string_view kUse = "// USE: ";
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(kUse)) continue;
    const fs::path used(tests::source_path(line.substr(kUse.size())));
    if (used.filename() != "*.st") {
      sources.add(used.filename().string(), coverage_text_of(used));
      continue;
    }
    std::set<fs::path> files;
    for (const auto& entry : fs::directory_iterator(used.parent_path())) files.insert(entry.path());
    for (const fs::path& file : files) sources.add(file.string(), coverage_text_of(file));
  }
  return sources;
}

// The counters, and addresses as numbers: behind the counters they are others.
bool lies_elsewhere(const std::string& line) {
  return line.starts_with(frontend::kCoverageCounters) || line.starts_with("Memory.d=");
}

// Runs all programs, one behind the other, and keeps what is to be compared.
struct Ran {
  bool compiled = false;
  std::string states;  // after each scan, and traps
  std::vector<uint32_t> hits;
};
Ran run_covered(const base::SourceMap& sources, Coverage* coverage, const ir::PassSet& passes) {
  constexpr int kScans = 4;
  Ran out;
  frontend::CompileOptions options;
  options.coverage = coverage;
  base::Diagnostics diagnostics;
  auto program = frontend::compile(sources, options, diagnostics);
  if (!program) return out;
  EXPECT_TRUE(ir::optimise(*program, passes, true).ok());
  auto objects = ir::lower_all(*program, {}, 1);
  EXPECT_TRUE(objects.ok());
  if (!objects.ok()) return out;
  auto image = linker::link(*program, *objects, {});
  if (!image.ok()) return out;
  out.compiled = true;
  auto verified = ir::verify(ir::encode(*image));
  EXPECT_TRUE(verified.ok()) << (verified.ok() ? "" : verified.error().text);
  if (!verified.ok()) return out;
  vm::Memory memory = std::move(vm::Memory::reserve()).value();
  vm::write_initial_data(*image, memory.data());
  const auto generation = vm::Generation::build(*verified, 0, memory.data());
  vm::Execution execution(image->call_depth);
  for (int scan = 0; scan < kScans; ++scan) {
    for (uint32_t id = 1; id < image->instances.size(); ++id) {
      const ir::Instance& row = image->instances[id];
      if (!row.live || row.parent != 0) continue;
      execution.start(*generation, memory.data(), id, ir::kStackBegin, scan * 10'000'000);
      const vm::Exit exit = execution.run(1'000'000);
      if (exit == vm::Exit::kTrap) out.states += vm::describe(*image, execution.trap()).text + "\n";
    }
    std::istringstream lines(ir::state_text(*image, memory.view()));
    for (std::string line; std::getline(lines, line);) {
      if (!lies_elsewhere(line)) out.states += line + "\n";
    }
  }
  const auto counters = ir::find_symbol(*image, frontend::kCoverageCounters);
  EXPECT_EQ(counters.ok(), coverage != nullptr);
  if (counters.ok()) {
    out.hits.resize(image->types[counters->type].dims[0].count());
    std::memcpy(out.hits.data(), memory.data() + counters->data, out.hits.size() * 4);
  }
  return out;
}

TEST(Coverage, R11_ABuildThatCountsRunsAsOneThatDoesNot) {
  std::set<fs::path> files;
  for (const char* folder : {"run", "corpus", "sfc", "ladder", "fbd", "il", "objects"}) {
    const fs::path in(tests::source_path(std::string("tests/golden/") + folder));
    for (const auto& entry : fs::directory_iterator(in)) {
      if (entry.path().extension() == ".st") files.insert(entry.path());
    }
  }
  size_t compared = 0;
  size_t sites = 0;
  size_t hit = 0;
  size_t number = 0;
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.string());
    if (number++ % kOneOf != 0) continue;
    if (!coverage_text_of(file).starts_with("// MODE: run")) continue;
    const base::SourceMap sources = coverage_sources(file);
    Coverage optimised;
    Coverage plain;
    const Ran without = run_covered(sources, nullptr, ir::PassSet::all());
    if (!without.compiled) continue;
    const Ran with = run_covered(sources, &optimised, ir::PassSet::all());
    const Ran as_written = run_covered(sources, &plain, ir::PassSet::none());
    ASSERT_TRUE(with.compiled);
    ASSERT_EQ(without.states, with.states);
    ASSERT_EQ(without.states, as_written.states);
    ASSERT_EQ(optimised.sites().size(), plain.sites().size());
    ASSERT_EQ(with.hits, as_written.hits);  // no pass loses a site, or counts one twice
    ++compared;
    sites += with.hits.size();
    hit += with.hits.size() - std::count(with.hits.begin(), with.hits.end(), 0u);
  }
  EXPECT_GT(compared, 150u / kOneOf);
  EXPECT_GT(hit, sites / 2);
  RecordProperty("programs", static_cast<int>(compared));
  std::printf("%zu programs, %zu sites, %zu hit\n", compared, sites, hit);
}

// Kind, line, name, count of each site.
std::string counts_of(const std::string& source) {
  base::SourceMap sources;
  sources.add("test.st", source);
  Coverage coverage;
  const Ran ran = run_covered(sources, &coverage, ir::PassSet::all());
  std::string text;
  for (size_t i = 0; i < coverage.sites().size(); ++i) {
    const frontend::Site& site = coverage.sites()[i];
    constexpr const char* kKinds[] = {"pou", "statement", "branch", "rung", "step", "transition"};
    text += std::string(kKinds[static_cast<size_t>(site.kind)]) + " " + std::to_string(site.line) +
            (site.name.empty() ? "" : " " + site.name) + " = " + std::to_string(ran.hits.at(i)) +
            "\n";
  }
  return text;
}

TEST(Coverage, R11_ChartsAndDiagramsByTheirElements) {
  EXPECT_EQ(counts_of("PROGRAM Main VAR a, b, q, s : BOOL; END_VAR\n"
                      "LADDER\n"
                      "|--[/ a ]----( b )--|\n"
                      "|--[ a ]----(S s)--|\n"
                      "END_LADDER\n"
                      "END_PROGRAM\n"
                      "PROGRAM Second VAR a, b, q : BOOL; END_VAR\n"
                      "  INITIAL_STEP Rest: END_STEP\n"
                      "  TRANSITION FROM Rest TO Work := TRUE; END_TRANSITION\n"
                      "  STEP Work: END_STEP\n"
                      "  TRANSITION FROM Work TO Rest := q; END_TRANSITION\n"
                      "END_PROGRAM\n"),
            "pou 1 Main = 4\n"
            "rung 3 1 = 4\n"
            "branch 3 power: TRUE = 4\n"
            "branch 3 power: FALSE = 0\n"
            "rung 4 2 = 4\n"
            "branch 4 power: TRUE = 0\n"
            "branch 4 power: FALSE = 4\n"
            "pou 7 Second = 4\n"
            "transition 11 Work to Rest = 0\n"
            "transition 9 Rest to Work = 1\n"
            "step 8 Rest = 1\n"
            "step 10 Work = 3\n");
}

TEST(Coverage, R11_BothSidesOfEachDecision) {
  EXPECT_EQ(counts_of("PROGRAM Main VAR n : INT; END_VAR\n"
                      "  n := n + 1;\n"
                      "  IF n > 1 AND_THEN n < 4 THEN\n"
                      "    ;\n"
                      "  END_IF\n"
                      "  CASE n OF\n"
                      "    1: n := 1;\n"
                      "    9: n := 9;\n"
                      "  END_CASE\n"
                      "  FOR n := n TO 2 DO ; END_FOR\n"
                      "  WHILE n > 3 DO n := n - 1; END_WHILE\n"
                      "END_PROGRAM\n"),
            "pou 1 Main = 4\n"
            "statement 2 = 4\n"
            "statement 3 = 4\n"
            "branch 3 left of AND_THEN: TRUE = 3\n"
            "branch 3 left of AND_THEN: FALSE = 1\n"
            "branch 3 IF: TRUE = 0\n"
            "branch 3 IF: FALSE = 4\n"
            "statement 6 = 4\n"
            "branch 6 CASE: line 7 = 1\n"
            "statement 7 = 1\n"
            "branch 6 CASE: line 8 = 0\n"
            "statement 8 = 0\n"
            "branch 6 CASE: ELSE = 3\n"
            "statement 10 = 4\n"
            "branch 10 FOR: some rounds = 1\n"
            "branch 10 FOR: no round = 3\n"
            "statement 11 = 4\n"
            "branch 11 WHILE: TRUE = 3\n"
            "branch 11 WHILE: FALSE = 4\n"
            "statement 11 = 3\n");
}

}  // namespace
