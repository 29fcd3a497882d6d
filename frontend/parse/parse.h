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

// Is one of the messages from number `first` on that of a comment without end? Then the file's
// tree ends there, its parser reported nothing, and what follows from the tree is not worth saying.
bool has_open_comment(const base::Diagnostics& diagnostics, size_t first = 0);

}  // namespace frontend
