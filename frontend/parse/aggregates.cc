// Enumerations and structures.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

// After a base type: `(A, ...`, `(A)`, `(A := ...` are literals, anything else a subrange.
bool Parser::at_enumerators() const {
  TokenKind behind = peek(2).kind;
  return is_name(peek(1).kind) &&
         (behind == TokenKind::kComma || behind == TokenKind::kRightParen ||
          behind == TokenKind::kAssign);
}

// `(A, B := 5)`, with the base type in front (`base`) or after.
SpecId Parser::parse_enum(SpecId base, base::SourcePos begin) {
  const Token open = take();
  Spec spec;
  spec.kind = SpecKind::kEnum;
  spec.element = base;
  if (kind() == TokenKind::kRightParen) {
    note_only(Code::kEmptyList, {{open.begin}, {current_->begin + 1}},
              "an enumeration has at least one literal");
  } else {
    do {
      spec.enumerators.push_back(parse_enumerator());
    } while (!panic_ && accept(TokenKind::kComma));
  }
  close_bracket(TokenKind::kRightParen, open);
  if (!panic_ && !base.valid() && is_name(kind())) spec.element = parse_type_name();
  if (panic_ && spec.enumerators.empty()) return error_spec(begin);
  spec.span = span_from(begin);
  return add_spec(std::move(spec));
}

Enumerator Parser::parse_enumerator() {
  Enumerator out;
  out.attributes = take_attributes();
  out.name = parse_name("enumeration literal");
  if (panic_) return out;
  if (kind() == TokenKind::kEqual) {
    note_only(Code::kAssignEquals, current_->span(), "`=` compares; a value is given by `:=`",
              "write `:=`");
    take();
    out.value = parse_expression();
  } else if (accept(TokenKind::kAssign)) {
    out.value = parse_expression();
  }
  return out;
}

// STRUCT [OVERLAP] ... END_STRUCT, UNION ... END_UNION
SpecId Parser::parse_struct() {
  const Token opening = take();
  bool is_union = opening.kind == TokenKind::kUnion;
  TokenKind end = is_union ? TokenKind::kEndUnion : TokenKind::kEndStruct;
  Spec spec;
  spec.kind = is_union ? SpecKind::kUnion : SpecKind::kStruct;
  bool overlap = kind() == TokenKind::kOverlap && next_kind() != TokenKind::kColon &&
                 next_kind() != TokenKind::kComma && next_kind() != TokenKind::kAt;
  if (overlap) {
    spec.overlap = !is_union;
    take();
  }
  if (kind() == TokenKind::kExtends && is_name(next_kind())) {
    take();
    spec.element = parse_type_name();
  }
  const size_t mark = var_stack_.size();
  while (kind() != end) {
    if (accept(TokenKind::kSemicolon)) continue;
    if (kind() == TokenKind::kEnd || is_closing(kind()) || is_file_level_start(kind()) ||
        is_var_start(kind())) {
      break;
    }
    parse_variable_declaration();
  }
  spec.fields = take_variables(mark);
  if (!accept(end)) {
    report_missing_end(opening, end);
    panic_ = true;  // the declaration around it has no end either
  }
  spec.span = span_from({opening.begin});
  return add_spec(std::move(spec));
}

}  // namespace frontend
