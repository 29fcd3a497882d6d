// What a run of tests looks like: for people, and for the tools of continuous integration
// (TAP version 13, JUnit XML as Jenkins and GitLab read it, JSON).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "base/source.h"
#include "tools/stc/coverage_report.h"
#include "tools/stc/test_run.h"

namespace stc {

struct TestRun {
  std::vector<TestResult> results;  // in the order in which they ran
  std::optional<uint64_t> seed;     // of that order, where it was drawn
  const CoverageReport* coverage = nullptr;
  bool ran = true;  // else the results are mistakes, for which nothing was run
};

// Each mistake is a test with an error, so that nobody takes that for a pass.
TestRun run_of_mistakes(const base::Diagnostics& diagnostics, const base::SourceMap& sources);
TestRun run_of_mistake(const base::Error& error);

struct TestTally {
  uint32_t passed = 0;
  uint32_t failed = 0;
  uint32_t errors = 0;
  double seconds = 0;
};
TestTally tally(const std::vector<TestResult>& results);

// One test, as its lines appear while the run goes on. `sources` give the line that failed.
std::string test_text(const TestResult& result, const base::SourceMap& sources, bool colour);
std::string summary_text(const std::vector<TestResult>& results, bool colour);
std::string tap_text(const TestRun& run);
std::string junit_text(const std::string& suite, const TestRun& run);
std::string json_text(const TestRun& run);

}  // namespace stc
