// Tokens -> logical lines: each statement, declaration, label, head and end of a block, with its
// level. Found by keywords alone, and for any token sequence: every token is in exactly one line.
#pragma once

#include <cstdint>
#include <vector>

#include "frontend/format/text.h"

namespace frontend::formatting {

enum class LineKind : uint8_t {
  kStatement,
  kDeclaration,
  kCondition,    // IF ... THEN, CASE ... OF, UNTIL ...: a word, an expression, a word
  kHead,         // opens a block
  kEnd,          // closes one
  kLabel,        // of a CASE branch or a jump
  kInstruction,  // of an instruction list; ends with its row
  kVerbatim,     // the same, with instructions in an argument
};

struct Line {
  uint32_t first = 0;  // tokens [first, end)
  uint32_t end = 0;
  uint32_t level = 0;
  uint32_t comment_level = 0;  // of comments on lines of their own in front of it
  uint32_t block = 0;          // the block that it stands in, to tell neighbours
  uint32_t row_end = 0;        // head of a block that stood in one row: the line that ends it
  uint32_t label_end = 0;      // a label with its statement: first token after the label
  uint32_t operand = 0;        // kInstruction: its first operand; 0: there is none
  uint32_t label_levels = 0;   // kInstruction with a label: from its column to the operator's
  LineKind kind = LineKind::kStatement;
  bool one_row = false;   // kInstruction: its brackets are not broken either
  bool closes = false;    // no blank line in front of it
  bool opens = false;     // no blank line after it
  bool ends_pou = false;  // always a blank line after it
};

struct Outline {
  std::vector<Line> lines;
  std::vector<bool> soft_keywords;  // by token: a name elsewhere, a keyword here
};

// `indent`: columns of a level.
Outline outline(const Text& text, uint32_t indent);

}  // namespace frontend::formatting
