// Characters that make an editor show code in another order than it has (W0040).
#pragma once

#include <cstdint>
#include <string_view>

#include "base/diagnostics.h"

namespace frontend {

// Warns of the first one in each line of a source in UTF-8. Embeddings, overrides and isolates
// count; the marks that words of right-to-left scripts have in texts for people do not. `begin` is
// the position of the text in its SourceMap.
void warn_of_directions(std::string_view text, uint32_t begin, base::Diagnostics& diagnostics);

}  // namespace frontend
