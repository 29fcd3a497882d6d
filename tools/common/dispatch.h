// A tool's main: find the command, parse its options, run it; help and usage errors on the way.
#pragma once

#include <span>

#include "tools/common/options.h"

namespace tools {

struct Entry {
  const Command* command;
  int (*run)(const Options& options);  // the exit code
};

// `notes` end the overview.
int dispatch(const char* tool, const char* purpose, std::span<const Entry* const> entries, int argc,
             char** argv, const std::string& notes = {});

}  // namespace tools
