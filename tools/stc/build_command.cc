// stc build: sources -> image file.
#include <cstdio>

#include "base/hash.h"
#include "tools/common/files.h"
#include "tools/stc/commands.h"
#include "tools/stc/session.h"

namespace stc {
namespace {

constexpr tools::OptionRow kOptions[] = {
    STC_SOURCE_OPTIONS,
    {"--output|-o", "FILE", "image to write (default: NAME.img in this folder)"},
    {"--base", "IMAGE", "running version: what lives on keeps its place"},
    {"--quiet|-q", nullptr, "no line about the image"},
    {"--move-all", nullptr, "with --base: give every instance a new place (a test of changes)"},
};
constexpr tools::Command kCommand{"build", "PATHS...", "Compiles and links sources to an image.",
                                  kOptions, 1};

int run(const tools::Options& options) {
  auto format = diagnostic_format(options);
  if (!format.ok()) return tools::refuse("stc", format.error());
  base::Result<Project> project = open_project(options, options.arguments());
  if (!project.ok()) return tools::refuse("stc", project.error());
  std::optional<Version> base_version;
  if (options.has("--base")) {
    base::Result<Version> read = read_image(options.text("--base"));
    if (!read.ok()) return tools::refuse("stc", read.error());
    base_version = std::move(*read);
  }
  BuildOptions build_options{base_version ? &base_version->image : nullptr,
                             options.has("--move-all")};
  base::Diagnostics diagnostics;
  base::Result<Version> version = build(*project, build_options, diagnostics);
  report(*project, diagnostics, *format);
  if (!version.ok()) return tools::refuse("stc", version.error());
  std::string output = options.text("--output", project->name + ".img");
  base::Status written = tools::write_file(output, version->bytes);
  if (!written.ok()) return tools::refuse("stc", written.error());
  if (*format == base::DiagnosticFormat::kText && !options.has("--quiet")) {
    std::fprintf(stderr, "%s: %zu POUs, %zu bytes, hash %s\n", output.c_str(),
                 version->image.pous.size(), version->bytes.size(),
                 base::short_hex(ir::digest(version->bytes)).c_str());
  }
  return tools::kOk;
}

}  // namespace

const Entry kBuild{&kCommand, run};

}  // namespace stc
