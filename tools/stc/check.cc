// stc check: diagnostics only.
#include "ir/lower/lower.h"
#include "linker/link.h"
#include "tools/stc/commands.h"
#include "tools/stc/online_base.h"
#include "tools/stc/session.h"

namespace stc {
namespace {

constexpr tools::OptionRow kCheckOptions[] = {STC_SOURCE_OPTIONS, STC_ONLINE_OPTIONS};
constexpr tools::Command kCheckCommand{"check", "[PATHS...]", "Reports errors and warnings.",
                                       kCheckOptions};

int run_check(const tools::Options& options) {
  auto format = diagnostic_format(options);
  if (!format.ok()) return tools::refuse("stc", format.error());
  base::Result<std::optional<OnlineBase>> online = OnlineBase::of(options);
  if (!online.ok()) return tools::refuse("stc", online.error());
  base::Result<Project> project = open_project(options, options.arguments());
  if (!project.ok()) return tools::refuse("stc", project.error());
  base::Diagnostics diagnostics = diagnostics_of(*project);
  // Linking too: recursion and memory limits are findings of a check.
  const BuildOptions build_options{*online ? &(*online)->original() : nullptr};
  auto versions = build_resources(*project, build_options, diagnostics);
  if (!versions.ok()) return finish(*project, diagnostics, *format, versions.error());
  if (*online) (*online)->check(*project, (*online)->matching(*versions).version, diagnostics);
  const bool good = !diagnostics.has_errors();
  return finish(*project, diagnostics, *format,
                good ? base::Status(base::Ok{}) : source_errors(diagnostics));
}

}  // namespace

const Entry kCheck{&kCheckCommand, run_check};

}  // namespace stc
