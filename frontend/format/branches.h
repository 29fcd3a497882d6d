// Branches of conditional compilation ({IF ...}, {ELSIF ...}, {ELSE}, {END_IF}), of which the
// formatter sees all: in the pragmas between tokens.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "frontend/format/text.h"
#include "ir/types/types.h"

namespace frontend::formatting {

// The first word of each pragma in front of token `i`.
template <class Visit>
void for_each_pragma(const Text& text, uint32_t i, Visit visit) {
  const Gap& gap = text.gap(i);
  for (uint32_t p = gap.first; p < gap.first + gap.count; ++p) {
    const Piece& piece = text.piece(p);
    if (piece.kind != PieceKind::kPragma) continue;
    std::string_view word = text.piece_text(piece).substr(1);
    word.remove_prefix(std::min(word.find_first_not_of(" \t\r\n"), word.size()));
    visit(word.substr(0, word.find_first_of(" \t\r\n}(")));
  }
}

inline bool begins_other_branch(std::string_view word) {
  return ir::same_name(word, "ELSE") || ir::same_name(word, "ELSIF");
}

// Does a branch end in front of token `i`?
bool ends_branch(const Text& text, uint32_t i);

// The first token behind the end of a branch; the number of tokens: there is none.
uint32_t first_branch_end(const Text& text);

// The token of a bracket that is open where its branch ends, and not where another branch of the
// same {IF ...} does; the number of tokens: there is none. O(tokens).
uint32_t open_in_branch(const Text& text);

}  // namespace frontend::formatting
