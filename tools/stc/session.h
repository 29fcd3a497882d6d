// What the commands share: options for sources, and how diagnostics reach people.
#pragma once

#include "base/diagnostics.h"
#include "tools/common/exit.h"
#include "tools/common/options.h"
#include "tools/stc/build.h"

namespace stc {

#define STC_SOURCE_OPTIONS                                                       \
  {"--dialect", "NAME", "iec, codesys (default) or twincat"},                    \
      {"--resource", "NAME", "the RESOURCE to compile, when there are several"}, \
      {"--define", "NAME", "for {IF defined(NAME)}; NAME=VALUE for hasvalue; repeatable", "", "", \
       tools::Times::kMany},                                                     \
      {"--format", "FORM", "text (default), json, sarif or github", "text|json|sarif|github"}, { \
    "--name", "NAME", "name of the program, instead of the folder's or file's"   \
  }

#define STC_CODE_OPTIONS                                                                \
  {"--no-opt", nullptr, "compile without optimising", "", "--passes"},                  \
      {"--passes", "LIST", "optimise with these passes only; `stc explain passes`"}, {  \
    "--jobs|-j", "N", "threads at most (default: one per core); the result is the same" \
  }

#define STC_EMBED_OPTION                                                                     \
  {                                                                                          \
    "--embed-sources", nullptr, "the sources travel with the image (`embed_sources = true`)" \
  }

#define STC_RESTRICTED_OPTION \
  { "--restricted", nullptr, "refuse when the interface of a POU is edited" }

// Loads the project named by `paths` with the options above.
base::Result<Project> open_project(const tools::Options& options,
                                   const std::vector<std::string>& paths);
base::Result<base::DiagnosticFormat> diagnostic_format(const tools::Options& options);
// Text goes to stderr, machine formats to stdout.
void report(const Project& project, base::Diagnostics& diagnostics, base::DiagnosticFormat format);

// Builds from sources or reads an image, whatever `paths` name. Reports diagnostics to stderr.
base::Result<Version> open_version(const tools::Options& options,
                                   const std::vector<std::string>& paths,
                                   const BuildOptions& build_options);

}  // namespace stc
