// FUNCTION, FUNCTION_BLOCK, PROGRAM.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

void Parser::parse_pou(PouKind pou_kind, TokenKind end) {
  const Token opening = take();
  PouDecl pou;
  pou.kind = pou_kind;
  parse_pou_header(pou);
  if (panic_) {  // the rest of the head line is lost, the body is not
    while (!on_new_line() && !is_statement_boundary(kind())) take();
    panic_ = false;
  }
  while (at_var_block() || kind() == TokenKind::kSemicolon) {
    if (accept(TokenKind::kSemicolon)) continue;
    // Behind a POU whose end is missing, VAR_GLOBAL begins something new.
    if (kind() == TokenKind::kVarGlobal && pou_kind != PouKind::kProgram) break;
    parse_var_block(pou.blocks);
  }
  pou.body = parse_statements();
  close_pou(opening, end);
  pou.span = span_from({opening.begin});
  if (!pou.name.empty()) tree_.pous.push_back(std::move(pou));
}

void Parser::parse_pou_header(PouDecl& pou) {
  skip_access_specifiers();
  const char* what = pou.kind == PouKind::kFunction        ? "function"
                     : pou.kind == PouKind::kFunctionBlock ? "function block"
                                                           : "program";
  pou.name = parse_name(what);
  if (panic_) return;
  parse_inheritance();
  if (kind() != TokenKind::kColon) return;
  const Token colon = take();
  SpecId result = parse_spec();
  if (pou.kind == PouKind::kFunction) {
    pou.result = result;
  } else {
    note_only(Code::kExpected, colon.span(), std::string("a ") + what + " has no result type",
              "declare VAR_OUTPUT variables instead");
  }
}

void Parser::skip_access_specifiers() {
  auto is_specifier = [](TokenKind kind) {
    return kind == TokenKind::kPublic || kind == TokenKind::kPrivate ||
           kind == TokenKind::kProtected || kind == TokenKind::kInternal ||
           kind == TokenKind::kAbstract || kind == TokenKind::kFinal;
  };
  while (is_specifier(kind()) && is_name(next_kind()) && peek(1).kind != TokenKind::kExtends) {
    not_supported(take().span(), "access specifiers, ABSTRACT and FINAL are", "leave it out");
  }
}

void Parser::parse_inheritance() {
  while ((kind() == TokenKind::kExtends || kind() == TokenKind::kImplements) &&
         is_name(next_kind())) {
    not_supported(take().span(), "EXTENDS and IMPLEMENTS are");
    do {
      parse_name("type");
    } while (!panic_ && (accept(TokenKind::kComma) || accept(TokenKind::kDot)));
  }
}

void Parser::close_pou(const Token& opening, TokenKind end) {
  if (accept(end)) {
    accept(TokenKind::kSemicolon);
    return;
  }
  if (!is_pou_end(kind())) return report_missing_end(opening, end);
  const Token wrong = take();
  base::Diagnostic diagnostic{
      Code::kUnexpectedEnd,
      wrong.span(),
      describe(wrong) + " closes a " + std::string(token_text(opening.kind)),
      "write `" + std::string(token_text(end)) + '`',
      {}};
  diagnostic.notes.push_back({opening.span(), "it was opened here"});
  diagnostics_.add(std::move(diagnostic));
  accept(TokenKind::kSemicolon);
}

}  // namespace frontend
