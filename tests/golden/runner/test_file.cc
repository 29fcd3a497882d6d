#include "tests/golden/runner/test_file.h"

#include <filesystem>
#include <sstream>

#include "tests/golden/runner/used_sources.h"
#include "tools/common/files.h"

namespace golden {
namespace {

constexpr std::string_view kMode = "// MODE: ";
constexpr std::string_view kVersion = "// --- v";
constexpr std::string_view kCommand = "// > ";
constexpr std::string_view kCheck = "// CHECK:";
constexpr std::string_view kScan = "SCAN ";

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> out;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) out.push_back(part);
  return out;
}

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) out.push_back(word);
  return out;
}

std::string strip_blank(std::string_view text) {
  return std::string(text.substr(0, 1) == " " ? text.substr(1) : text);
}

// "3: p.c.CV=1 p.q=FALSE"
ScanCheck parse_scan(const std::string& text, size_t line) {
  ScanCheck out;
  out.line = line;
  size_t colon = text.find(':');
  out.scan = std::stoull(text.substr(0, colon));
  out.expected = strip_blank(std::string_view(text).substr(colon + 1));
  for (const std::string& word : words(out.expected)) {
    if (size_t equals = word.find('='); equals != std::string::npos) {
      out.names.push_back(word.substr(0, equals));
    }
  }
  return out;
}

void take_check(TestFile& test, std::string_view rest, size_t line) {
  if (rest.substr(0, kScan.size()) == kScan) {
    test.scans.push_back(parse_scan(std::string(rest.substr(kScan.size())), line));
  } else {
    test.steps.back().expected.push_back(strip_blank(rest));
  }
}

void take_line(TestFile& test, size_t index) {
  std::string_view line = test.lines[index];
  if (line.substr(0, kVersion.size()) == kVersion) {
    // Blank lines in front keep the line numbers of the whole file.
    test.versions.emplace_back(index, '\n');
    std::vector<std::string> parts = words(std::string(line.substr(kVersion.size())));
    test.version_options.emplace_back(parts.begin() + (parts.empty() ? 0 : 1), parts.end());
  } else if (line.substr(0, kMode.size()) == kMode) {
    std::vector<std::string> parts = words(std::string(line.substr(kMode.size())));
    test.mode = parts.empty() ? "" : parts[0];
    test.options.assign(parts.begin() + (parts.empty() ? 0 : 1), parts.end());
  } else if (line.substr(0, kCommand.size()) == kCommand) {
    test.steps.push_back({std::string(line.substr(kCommand.size())), {}, index});
  } else if (line.substr(0, kCheck.size()) == kCheck) {
    take_check(test, line.substr(kCheck.size()), index);
  }
  test.versions.back() += test.lines[index] + "\n";
}

std::string value_of(const std::vector<std::string>& options, const std::string& wanted,
                     const std::string& otherwise) {
  for (size_t i = 0; i + 1 < options.size(); ++i) {
    if (options[i] == wanted) return options[i + 1];
  }
  return otherwise;
}

bool is_output(std::string_view line) {
  return line.substr(0, kCheck.size()) == kCheck &&
         line.substr(kCheck.size(), kScan.size()) != kScan;
}

void append_outputs(std::string& text, const std::vector<std::string>& output) {
  for (const std::string& line : output)
    text += line.empty() ? "// CHECK:\n" : "// CHECK: " + line + "\n";
}

}  // namespace

bool TestFile::has_option(const std::string& wanted) const {
  for (const std::string& option : options) {
    if (option == wanted) return true;
  }
  return false;
}

std::string TestFile::option(const std::string& wanted, const std::string& otherwise) const {
  return value_of(options, wanted, otherwise);
}

std::string TestFile::option_of(size_t version, const std::string& wanted,
                                const std::string& otherwise) const {
  const std::string of_all = option(wanted, otherwise);
  if (version >= version_options.size()) return of_all;  // a test that no file has
  return value_of(version_options[version], wanted, of_all);
}

base::Result<TestFile> read_test(const std::string& path) {
  base::Result<std::string> text = tools::read_text(path);
  if (!text.ok()) return text.error();
  TestFile test;
  test.path = path;
  test.name = std::filesystem::path(path).filename().string();
  test.lines = split(*text, '\n');
  test.versions.emplace_back();
  test.version_options.emplace_back();
  test.steps.push_back({});
  for (size_t i = 0; i < test.lines.size(); ++i) take_line(test, i);
  base::Status used = read_used_sources(test);
  if (!used.ok()) return used.error();
  if (test.mode.empty()) {
    return base::Error{base::Refusal::kBadProject, path + ": no `// MODE:` line"};
  }
  return test;
}

std::string updated(const TestFile& test, const std::vector<std::vector<std::string>>& outputs,
                    const std::vector<std::string>& scans) {
  std::string text;
  size_t step = 1;
  size_t scan = 0;
  for (size_t i = 0; i < test.lines.size(); ++i) {
    if (is_output(test.lines[i])) continue;
    if (scan < test.scans.size() && test.scans[scan].line == i) {
      text += "// CHECK:SCAN " + std::to_string(test.scans[scan].scan) + ": " + scans[scan] + "\n";
      ++scan;
      continue;
    }
    text += test.lines[i] + "\n";
    if (step < test.steps.size() && test.steps[step].line == i)
      append_outputs(text, outputs[step++]);
  }
  append_outputs(text, outputs[0]);
  return text;
}

}  // namespace golden
