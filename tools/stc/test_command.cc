// stc test: the TEST blocks of a project.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/common/outputs.h"
#include "tools/common/terminal.h"
#include "tools/stc/commands.h"
#include "tools/stc/coverage_output.h"
#include "tools/stc/session.h"
#include "tools/stc/test_order.h"
#include "tools/stc/test_report.h"
#include "tools/stc/test_watch.h"

namespace stc {
namespace {

constexpr tools::OptionRow kTestOptions[] = {
    {"--filter|-f", "PATTERN", "only tests whose name matches; * and ? are wildcards"},
    {"--shuffle", nullptr, "run them in a random order; the seed of it is printed"},
    {"--seed", "N", "run them in the order of the run that printed this seed"},
    {"--timeout", "N",
     "calls and rounds of loops that a test may take (default: 100000000); whatever the machine, "
     "the same test is stopped at the same place"},
    {"--format", "FORM", "text (default), tap, junit or json", "text|tap|junit|json"},
    {"--output|-o", "FILE", "write this format to a file, and text to the terminal"},
    {"--list", nullptr, "names and places of the tests, nothing is run"},
    {"--watch", nullptr, "stay, and run them again whenever a source is saved", "",
     "--list|--output|--coverage|--fail-under"},
    {"--coverage", "DIR", "write into this folder what the tests reach"},
    {"--coverage-format", "FORM", "which files: lcov, cobertura or html (default: all)",
     "lcov|cobertura|html"},
    {"--fail-under", "PERCENT", "exit code 1 when the tests reach less"},
    TOOLS_COMPILE_OPTIONS,
    STC_CODE_OPTIONS,
};
constexpr tools::Command kTestCommand{"test", "[PATHS...]", "Runs the TEST blocks on virtual time.",
                                      kTestOptions};

base::Result<uint64_t> fuel_option(const tools::Options& options) {
  base::Result<uint64_t> fuel = options.number("--timeout", kTestFuel);
  if (!fuel.ok() || *fuel != 0) return fuel;
  return base::Error{base::Refusal::kUsage, "--timeout 0: no test could run; the least is 1"};
}

base::Result<TestRun> run_all(const TestVersion& tests, const Project& project,
                              const tools::Options& options, bool text,
                              std::vector<uint64_t>* hits) {
  base::Result<uint64_t> fuel = fuel_option(options);
  if (!fuel.ok()) return fuel.error();
  base::Result<TestOrder> order = order_tests(tests.cases, options);
  if (!order.ok()) return order.error();
  base::Result<ir::VerifiedImage> image = ir::verify(tests.version.bytes);
  if (!image.ok()) return image.error();
  const bool colour = tools::has_colour(STDOUT_FILENO);
  TestRun run;
  run.seed = order->seed;
  for (const frontend::TestCase& test : order->cases) {
    base::Result<TestResult> result = run_test(*image, test, *fuel, hits);
    if (!result.ok()) return result.error();
    run.results.push_back(std::move(*result));
    if (!text) continue;
    std::fputs(test_text(run.results.back(), project.sources, colour).c_str(), stdout);
    std::fflush(stdout);
  }
  if (!text || run.results.empty()) return run;
  std::fputs(summary_text(run.results, colour).c_str(), stdout);
  if (run.seed) {
    std::printf("this order again: --seed %llu\n", static_cast<unsigned long long>(*run.seed));
  }
  return run;
}

std::string machine_form(const std::string& format, const Project& project, const TestRun& run) {
  if (format == "tap") return tap_text(run);
  if (format == "junit") return junit_text(project.name, run);
  if (format == "json") return json_text(run);
  std::string out;
  for (const TestResult& result : run.results) out += test_text(result, project.sources, false);
  return run.ran ? out + summary_text(run.results, false) : out;
}

base::Status put_out_form(const tools::Options& options, const Project& project,
                          const TestRun& run) {
  const std::string format = options.text("--format", "text");
  const std::string form = machine_form(format, project, run);
  if (options.has("--output")) {
    return tools::write_file(options.text("--output"), base::as_bytes(form));
  }
  if (format != "text") std::fputs(form.c_str(), stdout);
  return base::Ok{};
}

// Nothing was run. Who reads a file with the form would find that of the run before there.
base::Error not_run(const tools::Options& options, const Project& project, const TestRun& why,
                    const base::Error& error) {
  const bool in_form = options.has("--output") || options.text("--format", "text") != "json";
  if (!in_form || options.has("--list")) return error;  // JSON has the messages themselves
  base::Status written = put_out_form(options, project, why);
  return written.ok() ? error : written.error();
}

void print_list(const std::vector<frontend::TestCase>& cases, bool json) {
  tools::JsonWriter out;
  out.begin_object().key("tests").begin_array();
  for (const frontend::TestCase& test : cases) {
    if (!json) std::printf("%s:%u: %s\n", test.file.c_str(), test.line, test.name.c_str());
    out.begin_object().field("name", test.name).field("file", test.file);
    out.field("line", test.line).end_object();
  }
  out.end_array().end_object();
  if (json) std::fputs(out.finish().c_str(), stdout);
}

base::Result<int> watch_tests(const tools::Options& options) {
  if (options.text("--format", "text") != "text") {
    return base::Error{base::Refusal::kUsage, "test: --watch shows text; leave --format out"};
  }
  if (options.arguments().empty()) {
    return base::Error{base::Refusal::kUsage, "test: --watch needs PATHS..."};
  }
  base::Result<uint64_t> fuel = fuel_option(options);
  if (!fuel.ok()) return fuel.error();
  WatchedTests target(options, *fuel);
  return watch(options, false, base::DiagnosticFormat::kText, target);
}

base::Result<int> run_tests(const tools::Options& options) {
  if (options.has("--watch")) return watch_tests(options);
  const std::string format = options.text("--format", "text");
  base::Result<CoverageWishes> wishes = coverage_wishes(options);
  if (!wishes.ok()) return wishes.error();
  base::Result<Project> project = open_project(options, options.arguments());
  if (!project.ok()) {
    return not_run(options, {}, run_of_mistake(project.error()), project.error());
  }
  base::Status free = tools::check_output(options.text("--output"), project->read_files());
  if (!free.ok()) return free.error();
  frontend::Coverage coverage;
  if (wishes->counts()) project->compile.coverage = &coverage;
  base::Diagnostics diagnostics = diagnostics_of(*project);
  base::Result<TestVersion> tests = build_tests(*project, diagnostics);
  const bool json = format == "json" && diagnostics.has_errors() && !options.has("--output");
  report(*project, diagnostics,
         json ? base::DiagnosticFormat::kJson : base::DiagnosticFormat::kText);
  if (!tests.ok()) {
    const TestRun why = diagnostics.has_errors() ? run_of_mistakes(diagnostics, project->sources)
                                                 : run_of_mistake(tests.error());
    return not_run(options, *project, why, tests.error());
  }
  if (options.has("--list")) {
    base::Result<TestOrder> order = order_tests(tests->cases, options);
    if (!order.ok()) return order.error();
    print_list(order->cases, format == "json");
    return tools::kOk;
  }
  const bool text = format == "text" || options.has("--output");
  std::vector<uint64_t> hits;
  base::Result<TestRun> run =
      run_all(*tests, *project, options, text, wishes->counts() ? &hits : nullptr);
  if (!run.ok()) return not_run(options, *project, run_of_mistake(run.error()), run.error());
  const CoverageReport reached = coverage_report(coverage.sites(), hits, project->sources);
  if (wishes->counts()) run->coverage = &reached;
  if (base::Status put = put_out_form(options, *project, *run); !put.ok()) return put.error();
  if (run->results.empty()) {
    std::fprintf(stderr, "stc: no test%s; a test is written TEST 'name' ... END_TEST\n",
                 options.has("--filter") ? " matches the filter" : " in these sources");
    return tools::kFindings;
  }
  base::Result<bool> enough = put_out(reached, *wishes, project->name, text);
  if (!enough.ok()) return enough.error();
  const TestTally sum = tally(run->results);
  return sum.failed + sum.errors == 0 && *enough ? tools::kOk : tools::kFindings;
}

int run_test(const tools::Options& options) {
  base::Result<int> code = run_tests(options);
  return code.ok() ? *code : tools::refuse("stc", code.error());
}

}  // namespace

const Entry kTest{&kTestCommand, run_test};

}  // namespace stc
