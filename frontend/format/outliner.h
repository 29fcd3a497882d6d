// Inside of the outline: one pass over the tokens with a stack of open blocks. Members are spread
// over blocks.cc (the stack, ends), heads.cc (POUs and their like), statements.cc, declarations.cc.
#pragma once

#include <initializer_list>
#include <vector>

#include "frontend/format/outline.h"

namespace frontend::formatting {

class Outliner {
 public:
  Outliner(const Text& text, uint32_t indent) : text_(text), indent_(indent) {
    out_.soft_keywords.resize(text.token_count());
    out_.lines.reserve(text.token_count() / 6 + 8);
  }
  Outline run();

 private:
  enum class BlockKind : uint8_t { kBody, kGroup, kProperty, kDeclarations, kCase, kStatements };
  struct Block {
    TokenKind end = TokenKind::kEnd;
    BlockKind kind = BlockKind::kGroup;
    uint32_t outer = 0;  // level of its head
    uint32_t inner = 0;
    uint32_t id = 0;
    uint32_t head = 0;          // line
    uint32_t label_levels = 0;  // of an instruction list: what its labels take
    bool instructions = false;
    bool pou = false;
  };

  // --- blocks.cc
  void follow_conditions();
  TokenKind kind(uint32_t ahead = 0) const { return text_.kind(at_ + ahead); }
  Block& top() { return blocks_.back(); }
  void push(TokenKind end, BlockKind kind, uint32_t inner);
  Line& add(LineKind kind, uint32_t end, uint32_t level);
  Line& add_head(uint32_t end) {
    Line& line = add(LineKind::kHead, end, top().inner);
    line.opens = true;
    return line;
  }
  void close();
  uint32_t before_diagram(uint32_t end) const;
  uint32_t behind_semicolons(uint32_t end) const;
  void soft_keyword(uint32_t i) { out_.soft_keywords[i] = true; }

  // --- heads.cc
  bool head();
  bool soft_head();
  bool has_priority(uint32_t i) const;
  bool begins_member(uint32_t i) const;
  void pou(TokenKind end, BlockKind kind);
  void named_group(TokenKind end, BlockKind kind);
  void property_part(TokenKind end);
  void step(TokenKind end);
  void transition();
  void test();
  bool mock_function();
  bool setup(TokenKind end);
  uint32_t behind_modifiers(uint32_t i);
  uint32_t behind_name(uint32_t i) const;
  uint32_t behind_bases(uint32_t i);
  uint32_t behind_type(uint32_t i);
  uint32_t behind_group(uint32_t i) const;  // `i` is an opening bracket

  // --- statements.cc
  void statement_level();
  bool control();
  void condition(TokenKind until, TokenKind end, BlockKind kind);
  void branch(TokenKind until);
  void repeat();
  void until();
  bool exception_handling();
  bool case_label();
  void simple_statement();

  // --- instructions.cc
  bool instruction_list();
  void instruction();
  uint32_t label_levels() const;
  uint32_t behind_labels(uint32_t i) const;
  uint32_t behind_row(uint32_t i, bool& nested) const;
  bool is_deferred(uint32_t i) const;

  // --- declarations.cc
  bool declaration_block();
  void variables();
  void types();
  void declaration();
  bool opens_structure(uint32_t i) const;
  void mark_declaration_words(uint32_t from, uint32_t end);

  const Text& text_;
  uint32_t indent_;
  Outline out_;
  std::vector<Block> blocks_;
  std::vector<std::vector<Block>> conditions_;  // blocks open at each open {IF ...}
  uint32_t at_ = 0;
  uint32_t next_id_ = 1;
};

// A word that begins or ends a construct, so that no statement goes past it.
bool is_structural(TokenKind kind);
bool is_variable_section(TokenKind kind);
bool is_block_end(TokenKind kind);
bool is_opening(TokenKind kind);
bool is_closing_bracket(TokenKind kind);

}  // namespace frontend::formatting
