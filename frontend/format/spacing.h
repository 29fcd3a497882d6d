// Where a blank stands between two tokens of one line, and what the brackets and operators of an
// expression are. Decided by the neighbours alone, so that flat text has one form.
#pragma once

#include <cstdint>

#include "frontend/format/outline.h"

namespace frontend::formatting {

// From loosest to tightest; where a long line is broken first.
enum class Binding : uint8_t {
  kAssign,
  kComma,
  kOr,
  kXor,
  kAnd,
  kCompare,
  kAdd,
  kMultiply,
  kPower,
  kNone,
};

// What token `i` is as an operator between two operands; kNone for signs and everything else.
// `first` is the line's first token.
Binding binding(const Text& text, uint32_t i, uint32_t first);

// `S=`, `R=` and `REF=` are two tokens that mean something else when they stand apart. Is token `i`
// the second of them?
bool is_set_assignment(const Text& text, uint32_t i);

// Does a blank stand in front of token `i`, which is not the first of `line`?
bool blank_before(const Text& text, const Line& line, uint32_t i);

enum class GroupKind : uint8_t {
  kList,   // parameters, initial values, enumerators: an element per line when too long
  kParen,  // part of an expression
  kIndex,  // indices and bounds
};
// The kind of the bracket at `open`, whose partner is at `close`.
GroupKind group_kind(const Text& text, uint32_t open, uint32_t close, uint32_t first);

// Is it the operator `&N` of an instruction list, and more follows in front of `end`?
bool is_and_not(const Text& text, uint32_t i, uint32_t end);

}  // namespace frontend::formatting
