// golden [--update] [--dialect NAME] PATHS...: runs golden files (folders recursively), prints what
// differs, ends with "N passed, N failed". The dialect is that of files which name none.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "tests/golden/runner/modes.h"
#include "tests/golden/runner/script.h"
#include "tools/common/files.h"

namespace {

namespace fs = std::filesystem;

std::vector<std::string> tests_below(const std::string& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.path().extension() == ".st") out.push_back(entry.path().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

void print_difference(const std::vector<std::string>& expected,
                      const std::vector<std::string>& actual) {
  size_t count = std::max(expected.size(), actual.size());
  for (size_t i = 0; i < count; ++i) {
    const std::string* want = i < expected.size() ? &expected[i] : nullptr;
    const std::string* got = i < actual.size() ? &actual[i] : nullptr;
    if (want != nullptr && got != nullptr && *want == *got) continue;
    if (want != nullptr) std::printf("    - %s\n", want->c_str());
    if (got != nullptr) std::printf("    + %s\n", got->c_str());
  }
}

// `fail_` in the name if and only if the file expects an error.
bool name_fits(const golden::TestFile& test) {
  if (test.mode != "check" && test.mode != "format") return true;
  bool expects = false;
  for (const std::string& line : test.steps[0].expected) {
    expects = expects || line.find(": error[") != std::string::npos;
  }
  return (test.name.rfind("fail_", 0) == 0) == expects;
}

// What expects nothing says nothing: whoever deletes its expectations, or never wrote any, would
// see it pass for ever.
bool expects_something(const golden::TestFile& test) {
  const auto expects = [](const golden::Step& step) { return !step.expected.empty(); };
  return !test.scans.empty() || std::any_of(test.steps.begin(), test.steps.end(), expects);
}

// How often `part` stands in the lines.
size_t times_in(const std::vector<std::string>& lines, const std::string& part) {
  size_t count = 0;
  for (const std::string& line : lines) {
    for (size_t at = line.find(part); at != std::string::npos; at = line.find(part, at + 1)) {
      ++count;
    }
  }
  return count;
}

// Names that the script shows and the program does not have. Where that is meant, its author writes
// it: an update would make a mistyped name an expectation.
bool names_nothing_new(const golden::TestFile& test, const golden::Actual& actual) {
  bool good = true;
  const auto look = [&](const std::vector<std::string>& expected,
                        const std::vector<std::string>& lines, size_t line) {
    if (times_in(lines, golden::kNoSuchVariable) <= times_in(expected, golden::kNoSuchVariable)) {
      return;
    }
    std::printf("    line %zu shows a variable that is not there; if that is meant, write `%s`\n",
                line + 1, golden::kNoSuchVariable);
    good = false;
  };
  for (size_t i = 0; i < test.steps.size(); ++i) {
    look(test.steps[i].expected, actual.outputs[i], test.steps[i].line);
  }
  for (size_t i = 0; i < test.scans.size(); ++i) {
    look({test.scans[i].expected}, {actual.scans[i]}, test.scans[i].line);
  }
  return good;
}

bool passes(const golden::TestFile& test, const golden::Actual& actual) {
  bool good = actual.failures.empty();
  for (const std::string& failure : actual.failures) std::printf("    %s\n", failure.c_str());
  for (size_t i = 0; i < test.steps.size(); ++i) {
    if (test.steps[i].expected == actual.outputs[i]) continue;
    if (i != 0) std::printf("    after `%s`:\n", test.steps[i].command.c_str());
    print_difference(test.steps[i].expected, actual.outputs[i]);
    good = false;
  }
  for (size_t i = 0; i < test.scans.size(); ++i) {
    if (test.scans[i].expected == actual.scans[i]) continue;
    std::printf("    scan %llu:\n", static_cast<unsigned long long>(test.scans[i].scan));
    print_difference({test.scans[i].expected}, {actual.scans[i]});
    good = false;
  }
  if (!expects_something(test)) {
    std::printf("    no `// CHECK` line: the file expects nothing\n");
    good = false;
  }
  if (!name_fits(test)) {
    std::printf("    the name begins with fail_ if and only if errors are expected\n");
    good = false;
  }
  return good;
}

bool run_one(const std::string& path, bool update, const std::string& dialect) {
  base::Result<golden::TestFile> test = golden::read_test(path);
  if (!test.ok()) {
    std::printf("FAIL %s\n    %s\n", path.c_str(), base::to_string(test.error()).c_str());
    return false;
  }
  if (!dialect.empty()) test->options.insert(test->options.end(), {"--dialect", dialect});
  golden::Actual actual = golden::produce(*test);
  if (update && actual.failures.empty() && names_nothing_new(*test, actual)) {
    std::string text = golden::updated(*test, actual.outputs, actual.scans);
    if (!tools::write_file(path, base::as_bytes(text)).ok()) return false;
    test = golden::read_test(path);
  }
  std::printf("%s\n", path.c_str());
  return passes(*test, actual);
}

}  // namespace

int main(int argc, char** argv) {
  bool update = false;
  std::string dialect;
  int passed = 0;
  int failed = 0;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--update") == 0) {
      update = true;
      continue;
    }
    if (std::strcmp(argv[i], "--dialect") == 0 && i + 1 < argc) {
      dialect = argv[++i];
      continue;
    }
    for (const std::string& path : tests_below(argv[i])) {
      bool good = run_one(path, update, dialect);
      if (!good) std::printf("FAIL %s\n", path.c_str());
      (good ? passed : failed) += 1;
    }
  }
  std::printf("%d passed, %d failed\n", passed, failed);
  return failed == 0 && passed > 0 ? 0 : 1;
}
