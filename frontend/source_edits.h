// What edits of source files leave as it is. A resident tree (resident.h) keeps the nodes of every
// declaration, and takes new statements for a POU from the file's new text, when nothing else but
// comments and spaces differs in that file. The new text is parsed as one more file; positions in
// the older ones are followed to where their text stands now (base::SourceMap::Piece).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/source.h"
#include "frontend/parse/tree.h"

namespace frontend {

// From line `from` of the last text on, lines have moved by `by`.
struct LineShift {
  uint32_t from = 0;
  int64_t by = 0;
};

// The statements of one POU in a text.
struct CodePlace {
  PouDecl* pou;
  uint32_t begin;  // offsets in the text
  uint32_t end;
};
// The places of code of all POUs and members in `pous` whose statements are one piece of text, by
// position. Positions are those of file `file` of `sources`.
std::vector<CodePlace> code_places(std::vector<PouDecl>& pous, const base::SourceMap& sources,
                                   uint32_t file);

struct BodyEdits {
  std::vector<size_t> changed;  // indices into the places
  std::vector<LineShift> lines;
  // What is as it was: where it begins in the last text, how long it is, where it begins now.
  struct Kept {
    uint32_t begin;
    uint32_t size;
    uint32_t to;
  };
  std::vector<Kept> kept;
};
// nullopt when something else than statements, comments and spaces differs, or statements in a way
// that reaches beyond them: pragmas, Latin-1, an END that does not begin its line.
std::optional<BodyEdits> compare_bodies(std::string_view before, const std::vector<CodePlace>& old,
                                        std::string_view after, const std::vector<CodePlace>& now);

}  // namespace frontend
