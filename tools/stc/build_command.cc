// stc build: sources -> image file.
#include "tools/stc/commands.h"
#include "tools/stc/image_output.h"
#include "tools/stc/online_base.h"
#include "tools/stc/session.h"
#include "tools/stc/watch_image.h"

namespace stc {
namespace {

constexpr tools::OptionRow kBuildOptions[] = {
    STC_SOURCE_OPTIONS,
    STC_CODE_OPTIONS,
    STC_EMBED_OPTION,
    {"--output|-o", "FILE",
     "image to write (default: NAME.img in this folder); of several RESOURCEs "
     "FILE.RESOURCE.img each, or RESOURCE.img in the folder FILE"},
    {"--base", "IMAGE", "running version: what lives on keeps its place"},
    {"--watch", nullptr, "stay, and build again whenever a source is saved"},
    STC_ONLINE_OPTIONS,
    {"--move-all", nullptr, "with --base: give every instance a new place (a test of changes)"},
};
constexpr tools::Command kBuildCommand{"build", "[PATHS...]",
                                       "Compiles and links sources to an image.", kBuildOptions};

// What may be done online is checked of an image that is linked against the running one; the image
// that is written is linked as the options say.
base::Status check_online(const OnlineBase& online, const Project& project,
                          base::Diagnostics& diagnostics) {
  base::Diagnostics said;  // of the sources: they are in `diagnostics` already
  auto versions = build_resources(project, {&online.original()}, said);
  if (!versions.ok()) return versions.error();
  online.check(project, online.matching(*versions).version, diagnostics);
  return diagnostics.has_errors() ? base::Status(source_errors(diagnostics)) : base::Ok{};
}

int run_build(const tools::Options& options) {
  auto format = diagnostic_format(options);
  if (!format.ok()) return tools::refuse("stc", format.error());
  std::shared_ptr<const ir::Image> base_image;
  if (options.has("--base")) {
    base::Result<Version> read = read_image(options.text("--base"));
    if (!read.ok()) return tools::refuse("stc", read.error());
    base_image = std::make_shared<const ir::Image>(std::move(read->image));
  }
  base::Result<std::optional<OnlineBase>> online = OnlineBase::of(options);
  if (!online.ok()) return tools::refuse("stc", online.error());
  const bool with_line = *format == base::DiagnosticFormat::kText && !options.has("--quiet");
  BuildOptions build_options{base_image.get(), options.has("--move-all")};
  if (options.has("--watch")) {
    if (options.arguments().empty()) {
      return tools::refuse("stc", {base::Refusal::kUsage, "build: --watch needs PATHS..."});
    }
    WatchedImage target(options.text("--output"), with_line, base_image, std::move(*online));
    return watch(options, build_options.move_all, *format, target);
  }
  base::Result<Project> project = open_project(options, options.arguments());
  if (!project.ok()) return tools::refuse("stc", project.error());
  base::Diagnostics diagnostics = diagnostics_of(*project);
  auto versions = build_resources(*project, build_options, diagnostics);
  if (!versions.ok()) return finish(*project, diagnostics, *format, versions.error());
  if (versions->size() > 1 && base_image) {
    const base::Error several{base::Refusal::kUsage,
                              "--base is one program, but there are several RESOURCEs; say which "
                              "one is meant: --resource NAME"};
    return finish(*project, diagnostics, *format, several);
  }
  if (*online) {
    base::Status taken = check_online(**online, *project, diagnostics);
    if (!taken.ok()) return finish(*project, diagnostics, *format, taken);
  }
  // People read what was found before the line about the image.
  const bool text = *format == base::DiagnosticFormat::kText;
  if (text) report(*project, diagnostics, *format);
  base::Status written = write_images(*versions, options.text("--output", project->name + ".img"),
                                      *project, with_line);
  if (!text) return finish(*project, diagnostics, *format, written);
  return written.ok() ? tools::kOk : tools::refuse("stc", written.error());
}

}  // namespace

const Entry kBuild{&kBuildCommand, run_build};

}  // namespace stc
