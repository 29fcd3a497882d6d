// Sources of an image (X9) as files of a folder. Nothing outside of the folder is written, whatever
// the image says and whatever links lie in the folder: each part of a path is opened in the one
// before it, and links are not followed.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/embedded_sources.h"

namespace tools {

enum class SourceState : uint8_t {
  kNew,
  kSame,  // it was there
  kReplaced,
};
const char* source_state_name(SourceState state);

// What became of each. The folder is made. Without `overwrite` files that differ refuse all before
// anything is written. Errors: kFileUnwritable.
base::Result<std::vector<SourceState>> write_sources(const std::vector<ir::SourceText>& sources,
                                                     const std::string& folder, bool overwrite);

}  // namespace tools
