// Sets of token kinds on which parsing of a list ends or recovery stops.
#pragma once

#include "frontend/lex/token.h"
#include "frontend/parse/tree.h"

namespace frontend {

// END_IF, ELSE, UNTIL, ...: closes or continues something that was opened.
constexpr bool is_closing(TokenKind kind) {
  return (kind >= TokenKind::kEndAction && kind <= TokenKind::kEndWhile) ||
         kind == TokenKind::kElse || kind == TokenKind::kElsif || kind == TokenKind::kUntil ||
         kind == TokenKind::kCatch || kind == TokenKind::kFinally || kind == TokenKind::kEndTry;
}

constexpr bool is_pou_start(TokenKind kind) {
  return kind == TokenKind::kFunction || kind == TokenKind::kFunctionBlock ||
         kind == TokenKind::kProgram;
}

constexpr bool is_pou_end(TokenKind kind) {
  return kind == TokenKind::kEndFunction || kind == TokenKind::kEndFunctionBlock ||
         kind == TokenKind::kEndProgram || kind == TokenKind::kEndClass ||
         kind == TokenKind::kEndInterface;
}

// Ends of members of POUs and of the parts of a test file.
constexpr bool is_member_end(TokenKind kind) {
  return kind == TokenKind::kEndMethod || kind == TokenKind::kEndAction ||
         kind == TokenKind::kEndProperty || kind == TokenKind::kEndTest ||
         kind == TokenKind::kEndSetup || kind == TokenKind::kEndTeardown ||
         kind == TokenKind::kEndMockFunction;
}

constexpr bool is_specifier(TokenKind kind) {
  return is_access(kind) || kind == TokenKind::kAbstract || kind == TokenKind::kFinal ||
         kind == TokenKind::kOverride;
}

constexpr Access access_of(TokenKind kind) {
  return kind == TokenKind::kPublic      ? Access::kPublic
         : kind == TokenKind::kPrivate   ? Access::kPrivate
         : kind == TokenKind::kProtected ? Access::kProtected
         : kind == TokenKind::kInternal  ? Access::kInternal
                                         : Access::kDefault;
}

constexpr bool is_var_start(TokenKind kind) {
  return kind >= TokenKind::kVar && kind <= TokenKind::kVarTemp;
}

// INT, TIME, ...; STRING is a keyword.
bool is_elementary_name(std::string_view name);

// Keywords that begin a declaration at file level and cannot stand in a body.
constexpr bool is_file_level_start(TokenKind kind) {
  return is_pou_start(kind) || kind == TokenKind::kType || kind == TokenKind::kConfiguration ||
         kind == TokenKind::kVarGlobal || kind == TokenKind::kVarConfig;
}

constexpr bool is_statement_keyword(TokenKind kind) {
  return kind == TokenKind::kIf || kind == TokenKind::kCase || kind == TokenKind::kFor ||
         kind == TokenKind::kWhile || kind == TokenKind::kRepeat || kind == TokenKind::kExit ||
         kind == TokenKind::kReturn;
}

// Where skipping inside a statement stops, besides its semicolon.
constexpr bool is_statement_boundary(TokenKind kind) {
  return kind == TokenKind::kEnd || is_closing(kind) || is_statement_keyword(kind) ||
         is_var_start(kind) || is_file_level_start(kind);
}

}  // namespace frontend
