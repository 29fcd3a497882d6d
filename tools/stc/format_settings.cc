#include "tools/stc/format_settings.h"

#include "tools/common/project_file.h"

namespace stc {
namespace {

using Options = frontend::FormatOptions;

constexpr std::pair<const char*, uint32_t Options::*> kNumbers[] = {
    {"format.indent", &Options::indent},
    {"format.width", &Options::width},
};
constexpr std::pair<const char*, bool Options::*> kSwitches[] = {
    {"format.tabs", &Options::tabs},
    {"format.align_declarations", &Options::align_declarations},
    {"format.align_arguments", &Options::align_arguments},
    {"format.align_assignments", &Options::align_assignments},
    {"format.align_comments", &Options::align_comments},
};

}  // namespace

frontend::FormatOptions format_options(const tools::ProjectFile& file) {
  Options options;
  for (const auto& [key, member] : kNumbers) file.take<int64_t>(key, options.*member);
  for (const auto& [key, member] : kSwitches) file.take<bool>(key, options.*member);
  std::string keyword_case;
  if (file.take<std::string>("format.keyword_case", keyword_case)) {
    options.upper_keywords = keyword_case == "upper";
  }
  return options;
}

base::Result<frontend::FormatOptions> format_settings(const std::string& path) {
  const std::string nearest = tools::nearest_project_file(path);
  if (nearest.empty()) return Options();
  base::Result<tools::ProjectFile> file = tools::read_checked_project_file(nearest);
  if (!file.ok()) return file.error();
  return format_options(*file);
}

}  // namespace stc
