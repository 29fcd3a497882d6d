// The version that an edit is made on: sources, an image, or what a controller runs.
#pragma once

#include <string>

#include "base/result.h"
#include "tools/stc/session.h"

namespace stc {

// What runs at a controller: a state directory, or a host to ssh to. Fetched by the stvm beside
// this tool.
base::Result<Version> running_version(const std::string& place);
// `place` is sources, a project, an image, or a controller: a folder with the socket of one, or
// what is no file, and has no name of one.
base::Result<Version> open_original(const tools::Options& options, const std::string& place);

}  // namespace stc
