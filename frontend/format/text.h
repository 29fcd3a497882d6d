// One source text as the formatter sees it: tokens, and in front of each token a gap with the
// pieces that the lexer skips. Owns nothing of the text; offsets count from the beginning of the
// file.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/source.h"
#include "frontend/lex/lexer.h"
#include "frontend/parse/il_operators.h"

namespace frontend::formatting {

enum class PieceKind : uint8_t {
  kLineComment,   // `// ...`
  kBlockComment,  // `(* ... *)`, `/* ... */`
  kPragma,
  kForeign,  // what the lexer skips without being one of these: rungs
};

struct Piece {
  uint32_t begin = 0;
  uint32_t end = 0;
  uint32_t newlines_before = 0;
  PieceKind kind = PieceKind::kLineComment;
};

// Everything between a token and the one in front of it.
struct Gap {
  uint32_t first = 0;  // of Text::pieces
  uint32_t count = 0;
  uint32_t newlines_after = 0;  // after the last piece
};

class Text {
 public:
  Text(const base::SourceMap& sources, uint32_t file, const TokenList& list);

  std::string_view text() const { return text_; }
  uint32_t token_count() const { return static_cast<uint32_t>(tokens_.size()); }  // with kEnd
  // kEnd for everything after the last token.
  TokenKind kind(uint32_t i) const {
    return i < tokens_.size() ? tokens_[i].kind : TokenKind::kEnd;
  }
  std::string_view token(uint32_t i) const { return text_.substr(begin(i), tokens_[i].length); }
  uint32_t begin(uint32_t i) const { return tokens_[i].begin - base_; }
  uint32_t end(uint32_t i) const { return begin(i) + tokens_[i].length; }
  uint32_t row(uint32_t i) const { return rows_[i]; }  // 0-based line in the source
  const Gap& gap(uint32_t i) const { return gaps_[i]; }
  const Piece& piece(uint32_t p) const { return pieces_[p]; }
  const std::vector<Piece>& pieces() const { return pieces_; }
  std::string_view piece_text(const Piece& piece) const {
    return text_.substr(piece.begin, piece.end - piece.begin);
  }
  IlTokens il_tokens() const { return {tokens_.data(), tokens_.size(), text_, base_, false}; }
  // Is token `i` the word `upper`, without regard to case?
  bool is_word(uint32_t i, std::string_view upper) const;
  bool has_byte_order_mark() const { return mark_; }
  // Columns that `part` takes: characters of the source's charset.
  uint32_t columns(std::string_view part) const;
  // Where the line of `offset` begins when only blanks stand before it there; otherwise `offset`.
  uint32_t with_indentation(uint32_t offset) const;
  // Column of an offset, 0-based; kUnknownColumn when tabs stand before it.
  static constexpr uint32_t kUnknownColumn = 0xffffffffu;
  uint32_t column_of(uint32_t offset) const;

 private:
  void scan_gap(uint32_t from, uint32_t to);
  uint32_t end_of_piece(uint32_t at, uint32_t to, PieceKind& kind) const;
  uint32_t end_of_block_comment(uint32_t at, uint32_t to) const;

  std::string_view text_;
  uint32_t base_;
  const std::vector<Token>& tokens_;
  std::vector<Gap> gaps_;
  std::vector<uint32_t> rows_;
  std::vector<Piece> pieces_;
  bool mark_ = false;
  bool plain_ = true;  // a column per byte: ASCII or Latin-1
};

}  // namespace frontend::formatting
