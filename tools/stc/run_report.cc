#include "tools/stc/run_report.h"

#include <filesystem>

#include "base/diagnostics_render.h"
#include "tools/common/refusal_text.h"
#include "tools/common/version.h"

namespace stc {
namespace {

std::string folder_of_run() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::current_path(error);
  return folder == folder.root_path() ? std::string() : folder.string();
}

// Columns of the forms count characters.
uint32_t column_of(const std::string& line, uint32_t column) {
  return base::character_count(std::string_view(line).substr(0, column - 1)) + 1;
}

base::Region region_of(const tools::Refused& what) {
  if (what.file.empty()) return {};
  base::Region region{what.file, what.line, what.column, what.line, what.column + 1};
  if (what.end_column == 0) return region;
  region.column = column_of(what.line_text, what.column);
  region.end_column = column_of(what.line_text, what.end_column);
  return region;
}

std::string only_refused(const base::Error& error, base::DiagnosticFormat format) {
  return rendered(base::Diagnostics(), {}, format, false, &error);
}

}  // namespace

std::string rendered(const base::Diagnostics& diagnostics, const base::SourceMap& sources,
                     base::DiagnosticFormat format, bool colour, const base::Error* refused) {
  const std::string root = folder_of_run();
  base::RunFacts facts{tools::kVersion, root, tools::kDocumentation, nullptr};
  tools::Refused what;
  base::RefusedRun run;
  if (refused != nullptr) {
    what = tools::refused(*refused);
    run = {what.code, base::refusal_title(refused->refusal), what.text, what.help, region_of(what)};
    facts.refused = &run;
  }
  switch (format) {
    case base::DiagnosticFormat::kText:
      return base::render_text(diagnostics, sources, colour);
    case base::DiagnosticFormat::kJson:
      return base::render_json(diagnostics, sources, facts);
    case base::DiagnosticFormat::kSarif:
      return base::render_sarif(diagnostics, sources, facts);
    case base::DiagnosticFormat::kGithub:
      return base::render_github(diagnostics, sources, facts);
  }
  return {};
}

std::string refusal_json(const base::Error& error) {
  return only_refused(error, base::DiagnosticFormat::kJson);
}
std::string refusal_sarif(const base::Error& error) {
  return only_refused(error, base::DiagnosticFormat::kSarif);
}
std::string refusal_github(const base::Error& error) {
  return only_refused(error, base::DiagnosticFormat::kGithub);
}

}  // namespace stc
