// The operators of instruction lists (IEC 61131-3, tables 68 and 70), and how a body in this
// language is told from one in Structured Text. An instruction ends with its row, so both need
// the text between the tokens.
#pragma once

#include <span>
#include <string_view>

#include "frontend/lex/token.h"
#include "frontend/parse/code_nodes.h"

namespace frontend {

enum class IlAction : uint8_t {
  kLoad,
  kStore,
  kSet,    // S and R: of a BOOL, or an input of a function block
  kInput,  // S1 R1 CU CD CLK IN: sets the input of an instance and calls it
  kValue,  // PT PV: sets the input only
  kBinary,
  kNot,
  kJump,
  kCall,
  kReturn,
};

struct IlOperator {
  std::string_view word;
  IlAction action;
  BinaryOp binary = BinaryOp::kAnd;
  bool negated = false;      // modifier N
  bool conditional = false;  // modifier C
};

std::span<const IlOperator> il_operators();
const IlOperator* find_il_operator(std::string_view word);  // without case; null: none
// One whose word differs in one letter.
const IlOperator* similar_il_operator(std::string_view word);

// Tokens [0, count) of one file, the last of them kEnd.
struct IlTokens {
  const Token* tokens;
  size_t count;
  std::string_view text;
  uint32_t base;  // SourcePos of the text's beginning
  // False: for the formatter, whose decision must not depend on what it changes. It then takes
  // more for instructions, but nothing that could be a statement.
  bool rows_count = true;

  const Token& at(size_t i) const { return tokens[i < count ? i : count - 1]; }
  std::string_view word(size_t i) const { return text.substr(at(i).begin - base, at(i).length); }
  bool begins_row(size_t i) const;  // is token `i` the first of its row?
  // An operator with what it needs: an operand, a parenthesis, or the end of the row.
  bool is_instruction(size_t i) const;
  // Is the body whose first token is `i` an instruction list? It is when its first instruction,
  // after labels, has an operator of this language, which no statement of Structured Text can
  // begin with; or when calls and unknown words fill the rows in front of such an instruction and
  // neither `;` nor `:=` ends or makes a statement of them.
  bool is_instruction_list(size_t i) const;
};

}  // namespace frontend
