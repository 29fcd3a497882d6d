#include "tests/golden/runner/format_mode.h"

#include <sstream>

#include "frontend/format/format.h"
#include "tests/golden/runner/compile.h"

namespace golden {
namespace {

frontend::FormatOptions options_of(const TestFile& test) {
  frontend::FormatOptions options;
  options.width = static_cast<uint32_t>(std::stoul(test.option("--width", "100")));
  options.indent = static_cast<uint32_t>(std::stoul(test.option("--indent", "2")));
  options.tabs = test.has_option("--tabs");
  options.upper_keywords = !test.has_option("--keep-case");
  options.align_declarations = !test.has_option("--no-align-declarations");
  options.align_arguments = !test.has_option("--no-align-arguments");
  options.align_comments = !test.has_option("--no-align-comments");
  options.align_assignments = test.has_option("--align-assignments");
  return options;
}

// What stands between the MODE line and the expectations.
std::string source_of(const TestFile& test) {
  const std::string& all = test.versions[0];
  size_t begin = all.find('\n') + 1;
  return all.substr(begin, all.find("// CHECK:") - begin);
}

}  // namespace

void produce_format(const TestFile& test, Actual& actual) {
  base::SourceMap sources;
  uint32_t first = 0;
  sources.add(test.name, source_of(test));
  base::Diagnostics diagnostics;
  base::Result<std::string> text = frontend::format(sources, first, options_of(test), diagnostics);
  if (!text.ok()) {
    if (text.error().refusal != base::Refusal::kSourceErrors) {
      actual.failures.push_back(base::to_string(text.error()));
    }
    actual.outputs[0] = messages_of(sources, diagnostics);
    return;
  }
  sources.add(test.name, *text);
  base::Result<std::string> again = frontend::format(sources, 1, options_of(test), diagnostics);
  if (!again.ok() || *again != *text) {
    actual.failures.push_back("formatting the result again changes it:\n" +
                              (again.ok() ? *again : base::to_string(again.error())));
  }
  std::istringstream stream(*text);
  for (std::string line; std::getline(stream, line);) actual.outputs[0].push_back(line);
}

}  // namespace golden
