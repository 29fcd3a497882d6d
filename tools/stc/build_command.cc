// stc build: sources -> image file.
#include <cstdio>
#include <filesystem>

#include "base/hash.h"
#include "tools/common/files.h"
#include "tools/stc/commands.h"
#include "tools/stc/session.h"

namespace stc {
namespace {

constexpr tools::OptionRow kOptions[] = {
    STC_SOURCE_OPTIONS,
    STC_CODE_OPTIONS,
    {"--output|-o", "FILE",
     "image to write (default: NAME.img in this folder); of several RESOURCEs "
     "FILE.RESOURCE.img each, or RESOURCE.img in the folder FILE"},
    {"--base", "IMAGE", "running version: what lives on keeps its place"},
    {"--quiet|-q", nullptr, "no line about the image"},
    {"--move-all", nullptr, "with --base: give every instance a new place (a test of changes)"},
};
constexpr tools::Command kCommand{"build", "PATHS...", "Compiles and links sources to an image.",
                                  kOptions, 1};

// DIR/NAME.img when `output` is a folder, or ends with a slash; of several resources DIR/Line.img,
// or plant.Line.img beside plant.img.
base::Result<std::string> image_path(const std::string& output, const std::string& resource,
                                     const std::string& project) {
  const std::filesystem::path path(output);
  std::error_code error;
  if (path.filename().empty()) std::filesystem::create_directories(path, error);
  if (error) return base::Error{base::Refusal::kFileUnwritable, output + ": " + error.message()};
  if (std::filesystem::is_directory(path, error)) {
    const bool usable = project.find('/') == std::string::npos;
    const std::string alone = usable ? project : "program";
    return (path / ((resource.empty() ? alone : resource) + ".img")).string();
  }
  if (resource.empty()) return output;
  const std::string name = path.stem().string() + "." + resource + path.extension().string();
  return (path.parent_path() / name).string();
}

base::Status write_images(const std::vector<ResourceVersion>& versions, const std::string& output,
                          const std::string& project, bool with_line) {
  for (const ResourceVersion& made : versions) {
    const std::string resource = versions.size() > 1 ? made.resource : std::string();
    base::Result<std::string> path = image_path(output, resource, project);
    if (!path.ok()) return path.error();
    base::Status written = tools::write_file(*path, made.version.bytes);
    if (!written.ok()) return written;
    if (!with_line) continue;
    std::fprintf(stderr, "%s: %zu POUs, %zu bytes, hash %s\n", path->c_str(),
                 made.version.image.pous.size(), made.version.bytes.size(),
                 base::short_hex(ir::digest(made.version.bytes)).c_str());
  }
  return base::Ok{};
}

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
  auto versions = build_resources(*project, build_options, diagnostics);
  report(*project, diagnostics, *format);
  if (!versions.ok()) return tools::refuse("stc", versions.error());
  if (versions->size() > 1 && base_version) {
    return tools::refuse("stc", {base::Refusal::kUsage,
                                 "--base is one program, but there are several RESOURCEs; say "
                                 "which one is meant: --resource NAME"});
  }
  const bool with_line = *format == base::DiagnosticFormat::kText && !options.has("--quiet");
  base::Status written = write_images(*versions, options.text("--output", project->name + ".img"),
                                      project->name, with_line);
  return written.ok() ? tools::kOk : tools::refuse("stc", written.error());
}

}  // namespace

const Entry kBuild{&kCommand, run};

}  // namespace stc
