// The formatter's last check: two texts with the same tokens, comments and pragmas, but for white
// space and the case of keywords.
#pragma once

#include "base/result.h"
#include "base/source.h"

namespace frontend::formatting {

// kInternal, with the place of the first difference in the first text.
base::Status same_program(const base::SourceMap& before, uint32_t before_file,
                          const base::SourceMap& after, uint32_t after_file);

}  // namespace frontend::formatting
