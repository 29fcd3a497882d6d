// Files that may be signed (online_change/package/signed_file.h), for tools that use what is in
// them: a controller checks signatures, and `stc key verify` does.
#pragma once

#include <string>

#include "online_change/package/signed_file.h"

namespace tools {

// It begins as a signed file of that kind does.
bool is_signed_as(const std::string& path, online_change::SignedKind kind);
// The whole file, without its signature. Errors: those of read_bytes() and open_signed().
base::Result<base::Bytes> read_content(const std::string& path);

}  // namespace tools
