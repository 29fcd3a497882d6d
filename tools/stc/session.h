// What the commands share: options for sources, and how diagnostics reach people.
#pragma once

#include "base/diagnostics.h"
#include "tools/common/exit.h"
#include "tools/common/option_rows.h"
#include "tools/stc/build.h"

namespace stc {

#define STC_SOURCE_OPTIONS TOOLS_COMPILE_OPTIONS, tools::kDiagnosticFormatOption

#define STC_CODE_OPTIONS                                                        \
  {"--no-opt", nullptr, "compile without optimising", "", "--passes"}, {        \
    "--passes", "LIST", "optimise with these passes only; `stc explain passes`" \
  }

#define STC_EMBED_OPTION \
  { "--embed-sources", nullptr, "the sources travel with the image (`embed_sources = true`)" }

// Loads the project named by `paths` with the options above.
base::Result<Project> open_project(const tools::Options& options,
                                   const std::vector<std::string>& paths);
// What TOOLS_COMPILE_OPTIONS say, but for the dialect, which the sources are found with.
base::Status apply_compile_options(const tools::Options& options, Project& project);
// Warnings are what the project makes of them; the project must outlive the answer.
base::Diagnostics diagnostics_of(const Project& project);
// Reads anew where the sources silence warnings: after a file was replaced.
void silence_warnings(Project& project);
base::Result<base::DiagnosticFormat> diagnostic_format(const tools::Options& options);
// Text goes to stderr, machine formats to stdout.
void report(const Project& project, base::Diagnostics& diagnostics, base::DiagnosticFormat format);

// How a command ends that reports what the compiler finds: the report and, in the forms for
// programs, as one more error of it what refused the run; the exit code.
int finish(const Project& project, base::Diagnostics& diagnostics, base::DiagnosticFormat format,
           const base::Status& ended);

// Builds from sources or reads an image, whatever `paths` name. Reports diagnostics to stderr.
base::Result<Version> open_version(const tools::Options& options,
                                   const std::vector<std::string>& paths,
                                   const BuildOptions& build_options);

}  // namespace stc
