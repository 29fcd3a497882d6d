// LADDER ... END_LADDER and FBD ... END_FBD as the body of a POU.
#include "frontend/fbd/read.h"
#include "frontend/ladder/read.h"
#include "frontend/parse/diagram.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

// The lexer has left out the drawing; without its end, a rung tells.
bool Parser::at_diagram() const {
  bool ladder = kind() == TokenKind::kLadder;
  if (!ladder && kind() != TokenKind::kFbd) return false;
  const Token& end = peek(1);
  if (end.kind == (ladder ? TokenKind::kEndLadder : TokenKind::kEndFbd)) return true;
  size_t from = current_->begin + current_->length - base_;
  std::string_view between = text_.substr(from, end.begin - base_ - from);
  return ladder && between.find("|--") != std::string_view::npos;
}

void Parser::parse_diagram(PouDecl& pou) {
  const Token opening = take();
  bool ladder = opening.kind == TokenKind::kLadder;
  TokenKind end = ladder ? TokenKind::kEndLadder : TokenKind::kEndFbd;
  base::SourcePos begin{opening.begin + opening.length};
  std::string_view text = text_.substr(begin.offset - base_, current_->begin - begin.offset);
  network::Body body = ladder ? ladder::read(text, begin, diagnostics_, declarations_)
                              : fbd::read(text, begin, diagnostics_);
  Diagram(*this, pou).run(body);
  pou.diagram = static_cast<uint32_t>(tree_.diagrams.size());
  tree_.diagrams.push_back(std::move(body));
  if (!accept(end)) report_missing_end(opening, end);
  accept(TokenKind::kSemicolon);
  panic_ = false;
}

// A drawing outside of any POU.
bool Parser::skip_stray_diagram() {
  if (!at_diagram()) return false;
  note_only(Code::kDiagramAndStatements, current_->span(),
            describe(*current_) + " stands outside of any POU",
            "put the drawing into a PROGRAM, FUNCTION_BLOCK or FUNCTION");
  take();
  if (kind() == TokenKind::kEndLadder || kind() == TokenKind::kEndFbd) take();
  return true;
}

void Parser::report_mixed_body() {
  note_only(Code::kDiagramAndStatements, current_->span(),
            describe(*current_) + " stands beside a drawing, or a drawing beside it",
            "put one of them into an ACTION or POU of its own");
}

// What edges in an action remember lives in its owner.
void Parser::move_memory(PouDecl& action, PouDecl& owner) {
  if (action.kind != PouKind::kAction) return;
  for (VarBlock& block : action.blocks) owner.blocks.push_back(std::move(block));
  action.blocks.clear();
}

}  // namespace frontend
