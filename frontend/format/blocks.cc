#include <algorithm>
#include <string_view>

#include "base/limits.h"
#include "frontend/format/branches.h"
#include "frontend/format/diagrams.h"
#include "frontend/format/outliner.h"
#include "ir/types/types.h"

namespace frontend::formatting {

Outline outline(const Text& text, uint32_t indent) { return Outliner(text, indent).run(); }

Outline Outliner::run() {
  blocks_.push_back({});
  for (uint32_t followed = UINT32_MAX; kind() != TokenKind::kEnd;) {
    // Once for each token: what ends a block in front of it takes no token.
    if (followed != at_) follow_conditions();
    followed = at_;
    if (top().kind == BlockKind::kDeclarations) {
      declaration();
    } else {
      statement_level();
    }
  }
  Line& last = add(LineKind::kEnd, at_ + 1, 0);
  last.comment_level = top().inner;
  return std::move(out_);
}

// Branches of conditional compilation begin with the same open blocks, as only one of them counts.
void Outliner::follow_conditions() {
  for_each_pragma(text_, at_, [this](std::string_view word) {
    if (ir::same_name(word, "IF")) {
      if (conditions_.size() < base::kMaxNesting) conditions_.push_back(blocks_);
    } else if (conditions_.empty()) {
      return;
    } else if (begins_other_branch(word)) {
      blocks_ = conditions_.back();
    } else if (ir::same_name(word, "END_IF")) {
      conditions_.pop_back();
    }
  });
}

void Outliner::push(TokenKind end, BlockKind kind, uint32_t inner) {
  const Line& line = out_.lines.back();
  uint32_t head = static_cast<uint32_t>(out_.lines.size()) - 1;
  blocks_.push_back({end, kind, line.level, inner, next_id_++, head, 0, false, false});
}

// What begins and ends a diagram stands in a row of its own, whatever is around it.
uint32_t Outliner::before_diagram(uint32_t end) const {
  for (uint32_t i = at_; i < end; ++i) {
    bool word = text_.kind(i) == TokenKind::kLadder || text_.kind(i) == TokenKind::kFbd;
    if (!word || i + 1 >= text_.token_count()) continue;
    const Gap& gap = text_.gap(i + 1);
    bool drawn = ends_diagram(text_.kind(i), text_.kind(i + 1));
    for (uint32_t p = gap.first; p < gap.first + gap.count; ++p) {
      drawn = drawn || text_.piece(p).kind == PieceKind::kForeign;
    }
    if (drawn) return i == at_ ? i + 1 : i;
  }
  return end;
}

// The line of tokens [at_, end), at least one.
Line& Outliner::add(LineKind kind, uint32_t end, uint32_t level) {
  end = before_diagram(end);
  Line line;
  line.first = at_;
  line.end = end > at_ ? end : at_ + 1;
  line.level = line.comment_level = level;
  line.block = top().id;
  line.kind = kind;
  at_ = line.end;
  out_.lines.push_back(line);
  return out_.lines.back();
}

// An END_... word; one that closes nothing open stands where it stands.
void Outliner::close() {
  TokenKind end = kind();
  size_t match = blocks_.size() - 1;
  while (match != 0 && blocks_[match].end != end) --match;
  uint32_t inner = top().inner;
  Block closed = match != 0 ? blocks_[match] : Block{};
  if (match != 0) blocks_.resize(match);
  uint32_t behind = at_ + 1;
  // `END_STRUCT := (a := 1);` and the priority of a structure's variable.
  if (end == TokenKind::kEndStruct && text_.kind(behind) == TokenKind::kAssign) {
    while (text_.kind(behind) != TokenKind::kSemicolon && !is_structural(text_.kind(behind)) &&
           text_.kind(behind) != TokenKind::kEnd) {
      ++behind;
    }
  }
  uint32_t level = match != 0 ? closed.outer : top().inner;
  bool one_row = match != 0 && closed.kind == BlockKind::kDeclarations &&
                 text_.row(out_.lines[closed.head].first) == text_.row(at_);
  Line& line = add(LineKind::kEnd, behind_semicolons(behind), level);
  line.comment_level = match != 0 ? inner : level;
  line.closes = true;
  line.ends_pou = closed.pou;
  if (one_row) {
    out_.lines[closed.head].row_end = static_cast<uint32_t>(out_.lines.size()) - 1;
  }
}

uint32_t Outliner::behind_semicolons(uint32_t end) const {
  if (text_.kind(end) == TokenKind::kSemicolon) ++end;
  while (text_.kind(end) == TokenKind::kSemicolon && text_.gap(end).count == 0 &&
         text_.row(end) == text_.row(end - 1)) {
    ++end;
  }
  return end;
}

bool is_block_end(TokenKind kind) {
  return kind == TokenKind::kEndTry || (is_keyword(kind) && token_text(kind).starts_with("END_"));
}

bool is_variable_section(TokenKind kind) {
  return is_keyword(kind) && token_text(kind).starts_with("VAR");
}

bool is_opening(TokenKind kind) {
  return kind == TokenKind::kLeftParen || kind == TokenKind::kLeftBracket;
}

bool is_closing_bracket(TokenKind kind) {
  return kind == TokenKind::kRightParen || kind == TokenKind::kRightBracket;
}

bool is_structural(TokenKind kind) {
  if (!is_keyword(kind)) return false;
  switch (kind) {
    case TokenKind::kCase:
    case TokenKind::kCatch:
    case TokenKind::kConfiguration:
    case TokenKind::kElse:
    case TokenKind::kElsif:
    case TokenKind::kFinally:
    case TokenKind::kFor:
    case TokenKind::kFunction:
    case TokenKind::kFunctionBlock:
    case TokenKind::kIf:
    case TokenKind::kProgram:
    case TokenKind::kRepeat:
    case TokenKind::kStruct:
    case TokenKind::kType:
    case TokenKind::kUntil:
    case TokenKind::kWhile:
      return true;
    default:
      return is_block_end(kind) || is_variable_section(kind);
  }
}

}  // namespace frontend::formatting
