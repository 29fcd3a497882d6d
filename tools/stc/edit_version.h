// A version that is an edit from a fleet file, made in the program that runs (E-09).
#pragma once

#include <string>

#include "tools/stc/build.h"

namespace stc {

// Does the file begin as a fleet file does?
bool is_fleet_file(const std::string& path);
// kUsage without a running version in `options.base`.
base::Result<Version> edited_version(const std::string& path, const BuildOptions& options);

}  // namespace stc
