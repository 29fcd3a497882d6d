#include "tools/stc/session.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "base/parallel.h"
#include "base/visible_text.h"
#include "frontend/warning_pragmas.h"
#include "tools/common/terminal.h"
#include "tools/stc/defines.h"
#include "tools/stc/edit_version.h"
#include "tools/stc/run_report.h"
#include "tools/stc/warning_settings.h"

namespace stc {
namespace {

base::Result<std::optional<frontend::Dialect>> dialect_option(const tools::Options& options) {
  if (!options.has("--dialect")) return std::optional<frontend::Dialect>();
  std::string name = options.text("--dialect");
  auto dialect = frontend::dialect_from_name(name);
  if (!dialect) return base::Error{base::Refusal::kUsage, frontend::unknown_dialect(name)};
  return dialect;
}

base::Result<ir::PassSet> passes_option(const tools::Options& options) {
  if (options.has("--no-opt")) return ir::PassSet::none();
  return ir::PassSet::parse(options.text("--passes", "all"));
}

base::Result<uint32_t> jobs_option(const tools::Options& options) {
  if (!options.has("--jobs")) return base::usable_cores();
  auto jobs = options.number("--jobs", 0);
  if (!jobs.ok()) return jobs.error();
  if (*jobs >= 1 && *jobs <= base::kMaxJobs) return static_cast<uint32_t>(*jobs);
  return base::Error{base::Refusal::kUsage, "--jobs " + std::to_string(*jobs) + " is not 1 to " +
                                                std::to_string(base::kMaxJobs)};
}

// What else the image depends on, beside files; a folder's name, too.
std::vector<std::string> build_options_of(const tools::Options& options, const Project& project) {
  std::vector<std::string> out;
  for (const char* name : {"--dialect", "--resource", "--passes"}) {
    if (options.has(name)) out.push_back(std::string(name) + "=" + options.text(name));
  }
  for (const char* flag : {"--no-opt", "--embed-sources"}) {
    if (options.has(flag)) out.emplace_back(flag);
  }
  for (const std::string& define : options.all("--define")) out.push_back("--define=" + define);
  if (options.has("--name") || !project.named) out.push_back("--name=" + project.name);
  return out;
}

}  // namespace

// Where nothing is named, the project that this folder is in is meant.
static base::Result<std::string> project_here() {
  const std::string nearest = tools::nearest_project_file(".");
  if (nearest.empty()) {
    return base::Error{base::Refusal::kUsage,
                       "needs PATHS...: there is no stc.toml in this folder or above it"};
  }
  const std::string folder = std::filesystem::path(nearest).parent_path().string();
  return folder.empty() ? "." : folder;
}

base::Status apply_compile_options(const tools::Options& options, Project& project) {
  if (options.has("--resource")) {
    project.compile.resource = options.text("--resource");
    project.compile.resource_at = {};
  }
  if (const auto mistake = mistake_in(options.all("--define"))) {
    return base::Error{base::Refusal::kUsage, "--define: " + mistake->what};
  }
  for (std::string& define : options.all("--define")) {
    project.compile.defines.push_back(std::move(define));
  }
  if (options.has("--name")) {
    project.name = options.text("--name");
    if (base::has_control(project.name)) {
      return base::Error{base::Refusal::kUsage, "--name: a name has no control characters"};
    }
    project.compile.name = project.name;
  }
  auto jobs = jobs_option(options);
  if (!jobs.ok()) return jobs.error();
  project.jobs = *jobs;
  return apply_warning_options(options, project.warnings);
}

base::Result<Project> open_project(const tools::Options& options,
                                   const std::vector<std::string>& paths) {
  if (paths.empty()) {
    base::Result<std::string> here = project_here();
    return here.ok() ? open_project(options, std::vector<std::string>{*here}) : here.error();
  }
  auto dialect = dialect_option(options);
  if (!dialect.ok()) return dialect.error();
  base::Result<Project> project = load_project(paths, *dialect);
  if (!project.ok()) return project;
  if (auto set = apply_compile_options(options, *project); !set.ok()) return set.error();
  silence_warnings(*project);
  auto passes = passes_option(options);
  if (!passes.ok()) return passes.error();
  project->passes = *passes;
  if (options.has("--embed-sources")) project->embed_sources = true;
  project->build_options = build_options_of(options, *project);
  return project;
}

void silence_warnings(Project& project) {
  project.warning_mistakes =
      frontend::silence_warnings(project.sources, project.compile, project.warnings);
}

base::Diagnostics diagnostics_of(const Project& project) {
  base::Diagnostics out(project.warnings);
  for (const base::Diagnostic& mistake : project.warning_mistakes) out.add(mistake);
  return out;
}

base::Result<base::DiagnosticFormat> diagnostic_format(const tools::Options& options) {
  std::string name = options.text("--format", "text");
  if (name == "text") return base::DiagnosticFormat::kText;
  if (name == "json") return base::DiagnosticFormat::kJson;
  if (name == "sarif") return base::DiagnosticFormat::kSarif;
  if (name == "github") return base::DiagnosticFormat::kGithub;
  return base::Error{base::Refusal::kUsage,
                     "unknown format `" + name + "`; known are text, json, sarif, github"};
}

static void print(const Project& project, base::Diagnostics& diagnostics,
                  base::DiagnosticFormat format, const base::Error* refused) {
  diagnostics.sort();
  const bool text = format == base::DiagnosticFormat::kText;
  const bool colour = text && tools::has_colour(STDERR_FILENO);
  const std::string out = rendered(diagnostics, project.sources, format, colour, refused);
  std::fputs(out.c_str(), text ? stderr : stdout);
}

void report(const Project& project, base::Diagnostics& diagnostics, base::DiagnosticFormat format) {
  print(project, diagnostics, format, nullptr);
}

int finish(const Project& project, base::Diagnostics& diagnostics, base::DiagnosticFormat format,
           const base::Status& ended) {
  const bool apart = !ended.ok() && ended.error().refusal != base::Refusal::kSourceErrors;
  print(project, diagnostics, format, apart ? &ended.error() : nullptr);
  return ended.ok() ? tools::kOk : tools::refuse_reported("stc", ended.error());
}

base::Result<Version> open_version(const tools::Options& options,
                                   const std::vector<std::string>& paths,
                                   const BuildOptions& build_options) {
  if (paths.size() == 1 && is_image(paths[0])) return read_image(paths[0]);
  if (paths.size() == 1 && is_fleet_file(paths[0])) return edited_version(paths[0], build_options);
  base::Result<Project> project = open_project(options, paths);
  if (!project.ok()) return project.error();
  base::Diagnostics diagnostics = diagnostics_of(*project);
  base::Result<Version> version = build(*project, build_options, diagnostics);
  // What a command says in its own form, it says when there are no errors.
  base::Result<base::DiagnosticFormat> format = diagnostic_format(options);
  const bool text = !format.ok() || !diagnostics.has_errors();
  report(*project, diagnostics, text ? base::DiagnosticFormat::kText : *format);
  return version;
}

}  // namespace stc
