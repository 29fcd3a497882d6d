// The file level.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

void Parser::parse_file() {
  while (kind() != TokenKind::kEnd) {
    parse_declaration();
    panic_ = false;
  }
}

void Parser::parse_declaration() {
  switch (kind()) {
    case TokenKind::kSemicolon:
      take();
      return;
    case TokenKind::kType:
      return parse_types();
    case TokenKind::kVarGlobal:
      return parse_var_block(tree_.globals);
    case TokenKind::kFunction:
      return parse_pou(PouKind::kFunction, TokenKind::kEndFunction);
    case TokenKind::kFunctionBlock:
      return parse_pou(PouKind::kFunctionBlock, TokenKind::kEndFunctionBlock);
    case TokenKind::kProgram:
      return parse_pou(PouKind::kProgram, TokenKind::kEndProgram);
    case TokenKind::kConfiguration:
      return parse_configuration();
    default:
      break;
  }
  if (kind() == TokenKind::kVarAccess || kind() == TokenKind::kVarConfig) {
    std::vector<VarBlock> none;
    return parse_var_block(none);
  }
  if (is_var_start(kind())) {
    report_here(Code::kWrongSection,
                describe(*current_) + " belongs into a POU; outside of POUs there is VAR_GLOBAL");
    skip_block(TokenKind::kEndVar);
    return;
  }
  if (skip_unsupported_block()) return;
  if (kind() == TokenKind::kUsing && is_name(next_kind())) {
    not_supported(current_->span(), "USING is");
    return skip_to_statement_end();
  }
  report_here(is_closing(kind()) ? Code::kUnexpectedEnd : Code::kExpectedDeclaration,
              is_closing(kind())
                  ? describe(*current_) + " stands here, but nothing that it belongs to is open"
                  : "expected a declaration such as PROGRAM or TYPE, found " + describe(*current_));
  skip_to_next_declaration();
}

void Parser::skip_to_next_declaration() {
  do {
    take();
  } while (kind() != TokenKind::kEnd && !is_file_level_start(kind()));
}

}  // namespace frontend
