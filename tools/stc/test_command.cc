// stc test: the TEST blocks of a project.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/common/pattern.h"
#include "tools/common/terminal.h"
#include "tools/stc/commands.h"
#include "tools/stc/session.h"
#include "tools/stc/test_report.h"

namespace stc {
namespace {

constexpr tools::OptionRow kTestOptions[] = {
    {"--filter|-f", "PATTERN", "only tests whose name matches; * and ? are wildcards"},
    {"--format", "FORM", "text (default), tap, junit or json", "text|tap|junit|json"},
    {"--output|-o", "FILE", "write that form to a file, and text to the terminal"},
    {"--list", nullptr, "names and places of the tests, nothing is run"},
    TOOLS_COMPILE_OPTIONS,
    STC_CODE_OPTIONS,
};
constexpr tools::Command kTestCommand{"test", "[PATHS...]", "Runs the TEST blocks on virtual time.",
                                      kTestOptions};

bool selected(const tools::Options& options, const std::string& name) {
  if (!options.has("--filter")) return true;
  const std::string pattern = options.text("--filter");
  const bool wild = pattern.find_first_of("*?") != std::string::npos;
  return tools::matches(wild ? pattern : "*" + pattern + "*", name);
}

base::Result<std::vector<TestResult>> run_all(const TestVersion& tests, const Project& project,
                                              const tools::Options& options, bool text) {
  base::Result<ir::VerifiedImage> image = ir::verify(tests.version.bytes);
  if (!image.ok()) return image.error();
  const bool colour = tools::has_colour(STDOUT_FILENO);
  std::vector<TestResult> results;
  for (const frontend::TestCase& test : tests.cases) {
    if (!selected(options, test.name)) continue;
    base::Result<TestResult> result = run_test(*image, test);
    if (!result.ok()) return result.error();
    results.push_back(std::move(*result));
    if (!text) continue;
    std::fputs(test_text(results.back(), project.sources, colour).c_str(), stdout);
    std::fflush(stdout);
  }
  if (text && !results.empty()) std::fputs(summary_text(results, colour).c_str(), stdout);
  return results;
}

base::Result<std::string> machine_form(const std::string& format, const Project& project,
                                       const std::vector<TestResult>& results) {
  if (format == "tap") return tap_text(results);
  if (format == "junit") return junit_text(project.name, results);
  if (format == "json") return json_text(results);
  if (format == "text") {
    std::string out;
    for (const TestResult& result : results) out += test_text(result, project.sources, false);
    return out + summary_text(results, false);
  }
  return base::Error{base::Refusal::kUsage,
                     "unknown format `" + format + "`; known are text, tap, junit, json"};
}

void print_list(const std::vector<frontend::TestCase>& cases, const tools::Options& options,
                bool json) {
  tools::JsonWriter out;
  out.begin_object().key("tests").begin_array();
  for (const frontend::TestCase& test : cases) {
    if (!selected(options, test.name)) continue;
    if (!json) std::printf("%s:%u: %s\n", test.file.c_str(), test.line, test.name.c_str());
    out.begin_object().field("name", test.name).field("file", test.file);
    out.field("line", test.line).end_object();
  }
  out.end_array().end_object();
  if (json) std::fputs(out.finish().c_str(), stdout);
}

base::Result<int> run_tests(const tools::Options& options) {
  const std::string format = options.text("--format", "text");
  base::Result<Project> project = open_project(options, options.arguments());
  if (!project.ok()) return project.error();
  auto known = machine_form(format, *project, {});
  if (!known.ok()) return known.error();
  base::Diagnostics diagnostics = diagnostics_of(*project);
  base::Result<TestVersion> tests = build_tests(*project, diagnostics);
  const bool json = format == "json" && diagnostics.has_errors() && !options.has("--output");
  report(*project, diagnostics,
         json ? base::DiagnosticFormat::kJson : base::DiagnosticFormat::kText);
  if (!tests.ok()) return tests.error();
  if (options.has("--list")) {
    print_list(tests->cases, options, format == "json");
    return tools::kOk;
  }
  const bool text = format == "text" || options.has("--output");
  base::Result<std::vector<TestResult>> results = run_all(*tests, *project, options, text);
  if (!results.ok()) return results.error();
  auto form = machine_form(format, *project, *results);
  if (options.has("--output")) {
    base::Status written = tools::write_file(options.text("--output"), base::as_bytes(*form));
    if (!written.ok()) return written.error();
  } else if (!text) {
    std::fputs(form->c_str(), stdout);
  }
  if (results->empty()) {
    std::fprintf(stderr, "stc: no test%s; a test is written TEST 'name' ... END_TEST\n",
                 options.has("--filter") ? " matches the filter" : " in these sources");
    return tools::kFindings;
  }
  const TestTally sum = tally(*results);
  return sum.failed + sum.errors == 0 ? tools::kOk : tools::kFindings;
}

int run_test(const tools::Options& options) {
  base::Result<int> code = run_tests(options);
  return code.ok() ? *code : tools::refuse("stc", code.error());
}

}  // namespace

const Entry kTest{&kTestCommand, run_test};

}  // namespace stc
