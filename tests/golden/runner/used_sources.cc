#include "tests/golden/runner/used_sources.h"

#include <algorithm>
#include <filesystem>

#include "tools/common/files.h"

namespace golden {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kUse = "// USE: ";

fs::path root_above(const fs::path& test, const fs::path& used) {
  fs::path folder = fs::absolute(test).parent_path();
  while (folder != folder.root_path() && !fs::exists(folder / *used.begin())) {
    folder = folder.parent_path();
  }
  return folder;
}

std::vector<fs::path> files_of(const fs::path& pattern) {
  if (pattern.filename() != "*.st") return {pattern};
  std::vector<fs::path> out;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(pattern.parent_path(), ignored)) {
    if (entry.path().extension() == ".st") out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

base::Status read_one(TestFile& test, const std::string& line) {
  fs::path used = line.substr(kUse.size());
  std::vector<fs::path> files = files_of(root_above(test.path, used) / used);
  if (files.empty()) return base::Error{base::Refusal::kBadProject, line + ": no such files"};
  for (const fs::path& file : files) {
    base::Result<std::string> text = tools::read_text(file.string());
    if (!text.ok()) return text.error();
    test.used.push_back({file.filename().string(), std::move(*text)});
  }
  return base::Ok{};
}

}  // namespace

base::Status read_used_sources(TestFile& test) {
  for (const std::string& line : test.lines) {
    if (line.substr(0, kUse.size()) != kUse) continue;
    base::Status read = read_one(test, line);
    if (!read.ok()) return read;
  }
  return base::Ok{};
}

}  // namespace golden
