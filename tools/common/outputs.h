// An output never takes the place of what the same command reads, nor of a source.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "tools/common/options.h"

namespace tools {

// Refuses an output that is one of these files, by whatever spelling or link, and, if wanted, every
// source and stc.toml that is there: no command but `stc fmt` and `stc import` writes such files.
// What is not there, empty or no plain file is free. Errors: kFileUnwritable.
base::Status check_output(const std::string& output, const std::vector<std::string>& inputs,
                          bool any_source = true);
// Of what the options name, against what the command line names to be read. dispatch() asks it for
// every command; those that read more than they name ask check_output(). With --force a command
// decides itself which source it replaces. `in_place`: the file itself may be written again,
// signed.
base::Status check_outputs(const Options& options, bool in_place);

// By its extension.
bool is_source_name(const std::string& path);

}  // namespace tools
