// A source without what conditional compilation leaves out, for who reads pieces of its text.
#pragma once

#include <optional>
#include <string>

#include "frontend/lex/lexer.h"

namespace frontend {

// The text of the file, as long as it is and with its lines: blanks stand where {IF ...} leaves
// something out, and where those pragmas and comments between them stood. nullopt where no {IF ...}
// stands: the text is all active.
std::optional<std::string> active_text(const base::SourceMap& sources, uint32_t file,
                                       const LexOptions& options);

}  // namespace frontend
