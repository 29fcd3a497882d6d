#include "tools/stc/test_report.h"

#include <cstdio>

#include "tools/common/json.h"
#include "tools/stc/markup.h"

namespace stc {
namespace {

constexpr const char* kGreen = "\x1b[32m";
constexpr const char* kRed = "\x1b[31m";
constexpr const char* kPlain = "\x1b[0m";

const char* verdict_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPassed:
      return "PASS ";
    case Verdict::kFailed:
      return "FAIL ";
    default:
      return "ERROR";
  }
}

std::string place(const std::string& file, uint32_t line) {
  return file + ":" + std::to_string(line);
}

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6f", seconds);
  return text;
}

std::string cause(const TestResult& result) {
  return (result.file.empty() ? "" : place(result.file, result.line) + ": ") + result.text;
}

std::string trimmed_line(const base::SourceMap& sources, const std::string& file, uint32_t line) {
  for (uint32_t i = 0; i < sources.file_count(); ++i) {
    if (sources.file_name(i) != file) continue;
    std::string_view text = sources.text(i);
    for (uint32_t at = 1; at < line; ++at) {
      const size_t end = text.find('\n');
      if (end == std::string_view::npos) return {};
      text.remove_prefix(end + 1);
    }
    text = text.substr(0, text.find('\n'));
    const size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    const size_t last = text.find_last_not_of(" \t\r");
    return std::string(text.substr(first, last - first + 1));
  }
  return {};
}

// A description in TAP must not contain what begins a directive.
std::string tap_name(std::string_view name) {
  std::string out;
  for (char c : name) {
    if (c == '#' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

void coverage_json(tools::JsonWriter& json, const CoverageReport& report) {
  const auto reached = [&](const char* name, const Reached& of) {
    json.key(name).begin_object().field("reached", of.hit).field("all", of.all).end_object();
  };
  const auto kind = [&](frontend::SiteKind of) { return report.kinds[static_cast<size_t>(of)]; };
  json.key("coverage").begin_object().field("percent", report.total.percent());
  reached("statements", kind(frontend::SiteKind::kStatement));
  reached("branches", kind(frontend::SiteKind::kBranch));
  reached("rungs", kind(frontend::SiteKind::kRung));
  reached("steps", kind(frontend::SiteKind::kStep));
  reached("transitions", kind(frontend::SiteKind::kTransition));
  json.end_object();
}

}  // namespace

TestRun run_of_mistakes(const base::Diagnostics& diagnostics, const base::SourceMap& sources) {
  TestRun run;
  run.ran = false;
  for (const base::Diagnostic& mistake : diagnostics.all()) {
    if (mistake.severity != base::Severity::kError) continue;
    const base::SourceLocation at = sources.locate(mistake.span.begin);
    TestResult result;
    result.verdict = Verdict::kError;
    result.file = std::string(at.file);
    result.line = at.line;
    result.test = {place(result.file, at.line) + " compiles", result.file, at.line, {}};
    result.trap = diagnostic_row(mistake.code).code;
    result.text = mistake.text;
    run.results.push_back(std::move(result));
  }
  return run;
}

TestRun run_of_mistake(const base::Error& error) {
  TestResult result;
  result.verdict = Verdict::kError;
  result.test.name = "tests are run";
  result.trap = base::refusal_code(error.refusal);
  result.text = error.text;
  return {{std::move(result)}, {}, nullptr, false};
}

TestTally tally(const std::vector<TestResult>& results) {
  TestTally out;
  for (const TestResult& result : results) {
    out.passed += result.verdict == Verdict::kPassed;
    out.failed += result.verdict == Verdict::kFailed;
    out.errors += result.verdict == Verdict::kError;
    out.seconds += result.seconds;
  }
  return out;
}

std::string test_text(const TestResult& result, const base::SourceMap& sources, bool colour) {
  const bool passed = result.verdict == Verdict::kPassed;
  std::string out;
  if (colour) out += passed ? kGreen : kRed;
  out += verdict_word(result.verdict);
  if (colour) out += kPlain;
  out += "  " + result.test.name + "  (" + place(result.test.file, result.test.line) + ")\n";
  if (passed) return out;
  out += "       " + cause(result) + "\n";
  const std::string line = trimmed_line(sources, result.file, result.line);
  if (!line.empty()) out += "       | " + line + "\n";
  return out;
}

std::string summary_text(const std::vector<TestResult>& results, bool colour) {
  const TestTally sum = tally(results);
  const bool good = sum.failed + sum.errors == 0;
  char time[32];
  std::snprintf(time, sizeof time, "%.3f s", sum.seconds);
  std::string out;
  if (colour) out += good ? kGreen : kRed;
  out += std::to_string(sum.passed) + " passed, " + std::to_string(sum.failed) + " failed";
  if (sum.errors != 0) out += ", " + std::to_string(sum.errors) + " stopped by a trap";
  if (colour) out += kPlain;
  return out + "  (" + time + ")\n";
}

std::string tap_text(const TestRun& run) {
  const std::vector<TestResult>& results = run.results;
  std::string out = "TAP version 13\n1.." + std::to_string(results.size()) + "\n";
  if (run.seed) out += "# seed " + std::to_string(*run.seed) + "\n";
  for (size_t i = 0; i < results.size(); ++i) {
    const TestResult& result = results[i];
    const bool passed = result.verdict == Verdict::kPassed;
    out += std::string(passed ? "ok " : "not ok ") + std::to_string(i + 1) + " - " +
           tap_name(result.test.name) + "\n";
    if (passed) continue;
    tools::JsonWriter message;  // a JSON string is a YAML string
    message.value(result.text);
    tools::JsonWriter at;
    at.value(place(result.file, result.line));
    out += "  ---\n  message: " + message.finish() + "  at: " + at.finish();
    out += "  trap: " + result.trap + "\n  ...\n";
  }
  return out;
}

std::string junit_text(const std::string& suite, const TestRun& run) {
  const std::vector<TestResult>& results = run.results;
  const TestTally sum = tally(results);
  const std::string counts =
      " tests=\"" + std::to_string(results.size()) + "\" failures=\"" + std::to_string(sum.failed) +
      "\" errors=\"" + std::to_string(sum.errors) + "\" time=\"" + seconds_text(sum.seconds) + "\"";
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" + counts +
                    ">\n  <testsuite name=\"" + markup_text(suite) + "\"" + counts + ">\n";
  if (run.seed) {
    out += "    <properties>\n      <property name=\"seed\" value=\"" + std::to_string(*run.seed) +
           "\"/>\n    </properties>\n";
  }
  for (const TestResult& result : results) {
    const std::string file = markup_text(result.test.file);
    out += "    <testcase name=\"" + markup_text(result.test.name) + "\" classname=\"" + file +
           "\" file=\"" + file + "\" line=\"" + std::to_string(result.test.line) + "\" time=\"" +
           seconds_text(result.seconds) + "\"";
    if (result.verdict == Verdict::kPassed) {
      out += "/>\n";
      continue;
    }
    const char* element = result.verdict == Verdict::kFailed ? "failure" : "error";
    out += std::string(">\n      <") + element + " type=\"" + markup_text(result.trap) +
           "\" message=\"" + markup_text(result.text) + "\">" + markup_text(cause(result)) + "</" +
           element + ">\n    </testcase>\n";
  }
  return out + "  </testsuite>\n</testsuites>\n";
}

std::string json_text(const TestRun& run) {
  const std::vector<TestResult>& results = run.results;
  const TestTally sum = tally(results);
  tools::JsonWriter json;
  json.begin_object().field("passed", sum.passed).field("failed", sum.failed);
  json.field("errors", sum.errors);
  if (run.seed) json.field("seed", *run.seed);
  if (run.coverage != nullptr) coverage_json(json, *run.coverage);
  json.key("tests").begin_array();
  for (const TestResult& result : results) {
    json.begin_object().field("name", result.test.name).field("file", result.test.file);
    json.field("line", result.test.line).field("passed", result.verdict == Verdict::kPassed);
    json.field("seconds", result.seconds);
    if (result.verdict != Verdict::kPassed) {
      json.field("trap", result.trap).field("text", result.text);
      json.field("at", place(result.file, result.line));
    }
    json.end_object();
  }
  json.end_array().end_object();
  return json.finish();
}

}  // namespace stc
