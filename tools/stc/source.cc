// stc source: the sources that travel with an image file (X9).
#include <cstdio>

#include "tools/common/source_command.h"
#include "tools/stc/commands.h"
#include "tools/stc/session.h"

namespace stc {
namespace {

constexpr tools::OptionRow kSourceOptions[] = {TOOLS_SOURCE_OPTIONS, tools::kFormatOption};
constexpr tools::Command kSourceCommand{
    "source", "IMAGE", "Brings back the sources that travel with an image.", kSourceOptions, 1, 1};

base::Result<std::string> bring(const tools::Options& options) {
  auto format = diagnostic_format(options);
  if (!format.ok()) return format.error();
  const std::string& path = options.arguments()[0];
  base::Result<Version> version = read_image(path);
  if (!version.ok()) return version.error();
  return tools::bring_sources(version->bytes, version->image.name, options,
                              *format == base::DiagnosticFormat::kJson);
}

int run_source(const tools::Options& options) {
  base::Result<std::string> text = bring(options);
  if (!text.ok()) return tools::refuse("stc", text.error());
  std::fputs(text->c_str(), stdout);
  return tools::kOk;
}

}  // namespace

const Entry kSource{&kSourceCommand, run_source};

}  // namespace stc
