// Recursive descent with recovery: tokens of one file -> nodes added to a Tree. Any
// bytes give diagnostics, never a crash; nesting is limited (limits.def).
#pragma once

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/lex/lexer.h"
#include "frontend/parse/tree.h"

namespace frontend {

// Parses file number `file` of `sources` into `tree`.
void parse(const base::SourceMap& sources, uint32_t file, Tree& tree,
           base::Diagnostics& diagnostics, const LexOptions& options = {});

}  // namespace frontend
