// The table [format] of stc.toml (docs/PROJECT.md): how `stc fmt` lays sources out.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "frontend/format/format.h"
#include "tools/common/toml.h"

namespace stc {

inline constexpr std::string_view kFormatTable = "format.";

// Sets what `key` ("format.width") names. kBadProject for unknown keys and wrong values.
base::Status apply_format_key(const std::string& file, const std::string& key,
                              const tools::TomlValue& value, frontend::FormatOptions& options);

// From the nearest stc.toml: in the folder `path` or that of the file `path`, or above it; the
// defaults without one.
base::Result<frontend::FormatOptions> format_settings(const std::string& path);

}  // namespace stc
