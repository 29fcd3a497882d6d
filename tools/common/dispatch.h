// A tool's main: find the command, parse its options, run it; help, version and usage errors on the
// way. `help` and `version` are commands of every tool.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/common/exit.h"
#include "tools/common/options.h"
#include "tools/common/version.h"

namespace tools {

struct Entry {
  const Command* command;
  int (*run)(const Options& options);  // the exit code
};

// How the refusals of a command come in the form that --format names.
struct NamedForm {
  const char* name;  // "json"
  RefusalForm form;
};

struct Tool {
  const char* name;
  const char* purpose;
  std::span<const Entry* const> entries;
  std::vector<VersionFact> facts;  // after version and commit
  std::string notes;               // at the end of the overview
  std::vector<NamedForm> forms;
  const char* program = nullptr;  // as `--version` calls it, when it has another name
};

int dispatch(const Tool& tool, int argc, char** argv);

}  // namespace tools
