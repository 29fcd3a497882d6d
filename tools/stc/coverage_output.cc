#include "tools/stc/coverage_output.h"

#include <charconv>
#include <cstdio>
#include <filesystem>

#include "tools/common/files.h"

namespace stc {
namespace {

namespace fs = std::filesystem;

base::Status write_forms(const CoverageReport& report, const CoverageWishes& wishes,
                         const std::string& project) {
  std::error_code error;
  fs::create_directories(wishes.folder, error);
  if (!tools::is_folder(wishes.folder)) {
    return base::Error{base::Refusal::kFileUnwritable, wishes.folder + ": no folder can be made" +
                                                           (error ? ": " + error.message() : "")};
  }
  struct Form {
    const char* name;
    const char* file;
    std::string text;
  };
  const Form forms[] = {{"html", "index.html", coverage_page(report, project)},
                        {"lcov", "lcov.info", lcov_text(report)},
                        {"cobertura", "cobertura.xml", cobertura_text(report)}};
  for (const Form& form : forms) {
    if (!wishes.format.empty() && wishes.format != form.name) continue;
    const std::string path = (fs::path(wishes.folder) / form.file).string();
    base::Status written = tools::write_file(path, base::as_bytes(form.text));
    if (!written.ok()) return written;
  }
  return base::Ok{};
}

}  // namespace

base::Result<CoverageWishes> coverage_wishes(const tools::Options& options) {
  CoverageWishes wishes{options.text("--coverage"), options.text("--coverage-format"), {}};
  if (options.has("--coverage") && wishes.folder.empty()) {
    return base::Error{base::Refusal::kUsage, "--coverage needs the name of a folder"};
  }
  if (!wishes.format.empty() && wishes.folder.empty()) {
    return base::Error{base::Refusal::kUsage,
                       "--coverage-format says how --coverage DIR writes; name a folder, too"};
  }
  if (!options.has("--fail-under")) return wishes;
  const std::string text = options.text("--fail-under");
  double least = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), least);
  if (code != std::errc() || end != text.data() + text.size() || !(least >= 0 && least <= 100)) {
    return base::Error{base::Refusal::kUsage,
                       "--fail-under needs a number from 0 to 100, not `" + text + "`"};
  }
  wishes.least = least;
  return wishes;
}

base::Result<bool> put_out(const CoverageReport& report, const CoverageWishes& wishes,
                           const std::string& project, bool text) {
  if (!wishes.counts()) return true;
  if (report.files.empty()) {
    std::fputs("stc: nothing is counted: each file has a TEST; put tests into files of their own\n",
               stderr);
  } else if (text) {
    std::fputs(("\n" + coverage_text(report)).c_str(), stdout);
    std::fflush(stdout);  // in front of what is missing
  }
  if (!wishes.folder.empty()) {
    base::Status written = write_forms(report, wishes, project);
    if (!written.ok()) return written.error();
  }
  if (wishes.least && report.files.empty()) return false;
  if (!wishes.least || report.total.percent() >= *wishes.least) return true;
  char least[32];
  std::snprintf(least, sizeof least, "%g", *wishes.least);
  std::fprintf(stderr, "stc: the tests reach %s %% of the places, less than --fail-under %s\n",
               percent_text(report.total).c_str(), least);
  return false;
}

}  // namespace stc
