// stc check: diagnostics only.
#include "ir/lower/lower.h"
#include "linker/link.h"
#include "tools/stc/commands.h"
#include "tools/stc/session.h"

namespace stc {
namespace {

constexpr tools::OptionRow kCheckOptions[] = {STC_SOURCE_OPTIONS};
constexpr tools::Command kCheckCommand{"check", "[PATHS...]", "Reports errors and warnings.",
                                       kCheckOptions};

int run_check(const tools::Options& options) {
  auto format = diagnostic_format(options);
  if (!format.ok()) return tools::refuse("stc", format.error());
  base::Result<Project> project = open_project(options, options.arguments());
  if (!project.ok()) return tools::refuse("stc", project.error());
  base::Diagnostics diagnostics = diagnostics_of(*project);
  // Linking too: recursion and memory limits are findings of a check.
  auto versions = build_resources(*project, {}, diagnostics);
  return finish(*project, diagnostics, *format,
                versions.ok() ? base::Status(base::Ok{}) : versions.error());
}

}  // namespace

const Entry kCheck{&kCheckCommand, run_check};

}  // namespace stc
