// Source text -> the same source text, laid out. Works on tokens and on what stands between them
// (comments, pragmas, blank lines); blocks are found by their keywords, so that a construct the
// parser does not know yet is laid out as well.
//
// Guarantees: the tokens and the comments of the result are those of the source, in the same order
// (checked before it is returned; keywords may change their case); formatting the result again
// changes nothing; byte order mark, line endings and charset stay. A text with lexical or syntax
// errors is not formatted, nor one whose branches of conditional compilation are no sound text.
// What stands between `(* stc:off *)` and `(* stc:on *)` stays as it is, and so do instruction
// lists. Ladder is drawn again, as network/write.h says; there comments stand in front of their
// rung. A drawing that cannot be drawn stays as it is.
#pragma once

#include <cstdint>
#include <string>

#include "base/diagnostics.h"
#include "base/result.h"
#include "base/source.h"

namespace frontend {

struct FormatOptions {
  uint32_t indent = 2;   // columns of one level
  bool tabs = false;     // a tab per level instead; it counts as `indent` columns
  uint32_t width = 100;  // columns that a line should not exceed
  bool upper_keywords = true;
  bool align_declarations = true;  // `:` and `:=` of neighbouring declarations
  bool align_arguments = true;     // `:=` and `=>` of parameter lists with a line for each
  bool align_assignments = false;  // `:=` of neighbouring statements
  bool align_comments = true;      // comments after neighbouring lines
};

// Formats file number `file`. kSourceErrors when `diagnostics` got errors, kInternal when the
// result would not have been the same program. Time is linear in the size of the text.
base::Result<std::string> format(const base::SourceMap& sources, uint32_t file,
                                 const FormatOptions& options, base::Diagnostics& diagnostics);

// The same without the parser: any text whose tokens are sound, also a piece of a program.
base::Result<std::string> format_tokens(const base::SourceMap& sources, uint32_t file,
                                        const FormatOptions& options,
                                        base::Diagnostics& diagnostics);

}  // namespace frontend
