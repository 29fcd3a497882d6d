// The table [format] of stc.toml (docs/PROJECT.md): how `stc fmt` lays sources out.
#pragma once

#include <string>

#include "base/result.h"
#include "frontend/format/format.h"
#include "tools/common/project_file.h"

namespace stc {

// Of a file whose keys are checked.
frontend::FormatOptions format_options(const tools::ProjectFile& file);
// From the nearest stc.toml: in the folder `path` or that of the file `path`, or above it; the
// defaults without one.
base::Result<frontend::FormatOptions> format_settings(const std::string& path);

}  // namespace stc
