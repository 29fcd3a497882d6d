#include "frontend/format/outliner.h"

namespace frontend::formatting {

bool Outliner::declaration_block() {
  if (is_variable_section(kind())) {
    variables();
  } else if (kind() == TokenKind::kType) {
    types();
  } else {
    return false;
  }
  return true;
}

// A section of a POU stands at the level of the POU; elsewhere at that of its neighbours.
void Outliner::variables() {
  uint32_t i = at_ + 1;
  for (; text_.kind(i) >= kFirstSoft;
       ++i) {  // CONSTANT, RETAIN, ... unless it is a variable's name
    TokenKind next = text_.kind(i + 1);
    if (next == TokenKind::kColon || next == TokenKind::kComma || next == TokenKind::kAt) break;
    soft_keyword(i);
  }
  bool of_pou = top().kind == BlockKind::kBody;
  Line& line = add(LineKind::kHead, i, of_pou ? top().outer : top().inner);
  line.opens = true;
  push(TokenKind::kEndVar, BlockKind::kDeclarations, line.level + 1);
}

// `TYPE Name : STRUCT` in one row, as people write a file per type, keeps its members one level in.
void Outliner::types() {
  uint32_t head = at_;
  add_head(at_ + 1);
  bool joined = is_name(kind()) && text_.row(at_) == text_.row(head);
  push(TokenKind::kEndType, BlockKind::kDeclarations, top().inner + 1);
  if (!joined) return;
  uint32_t i = at_;
  while (text_.kind(i) != TokenKind::kSemicolon && text_.kind(i) != TokenKind::kEnd &&
         !is_structural(text_.kind(i)) && !opens_structure(i)) {
    ++i;
  }
  bool structure = opens_structure(i);
  if (text_.kind(i) == TokenKind::kSemicolon || structure) ++i;
  uint32_t behind = i;
  if (structure) {
    while (text_.kind(behind) != TokenKind::kEnd && text_.kind(behind) != TokenKind::kEndStruct &&
           text_.kind(behind) != TokenKind::kEndUnion) {
      ++behind;
    }
    behind = behind_semicolons(behind + 1);
  }
  if (text_.kind(behind) != TokenKind::kEndType) return;  // more than one type
  mark_declaration_words(at_, i);
  Line& line = out_.lines.back();
  line.end = at_ = i;
  top().inner = top().outer;
  if (!structure) {
    line.kind = LineKind::kDeclaration;
    line.opens = false;
    return;
  }
  push(text_.kind(behind - 1) == TokenKind::kEndUnion ||
               (text_.kind(behind - 1) == TokenKind::kSemicolon &&
                text_.kind(behind - 2) == TokenKind::kEndUnion)
           ? TokenKind::kEndUnion
           : TokenKind::kEndStruct,
       BlockKind::kDeclarations, top().inner + 1);
}

bool Outliner::opens_structure(uint32_t i) const {
  if (text_.kind(i) == TokenKind::kStruct) return true;
  return text_.kind(i) == TokenKind::kUnion && i != 0 &&
         (text_.kind(i - 1) == TokenKind::kColon || text_.kind(i - 1) == TokenKind::kOf);
}

void Outliner::declaration() {
  if (is_block_end(kind())) return close();
  // A section whose end is missing: what follows is no declaration.
  if (is_structural(kind()) && !opens_structure(at_)) {
    blocks_.pop_back();
    return;
  }
  uint32_t from = at_;
  uint32_t i = at_;
  while (text_.kind(i) != TokenKind::kSemicolon && text_.kind(i) != TokenKind::kEnd &&
         !opens_structure(i) && !is_structural(text_.kind(i))) {
    ++i;
  }
  mark_declaration_words(from, i);
  if (!opens_structure(i)) {
    add(LineKind::kDeclaration, behind_semicolons(i), top().inner);
    return;
  }
  bool is_union = text_.kind(i) == TokenKind::kUnion;
  if (is_union) soft_keyword(i);
  if (text_.kind(i + 1) == TokenKind::kOverlap && text_.kind(i + 2) != TokenKind::kColon) {
    soft_keyword(++i);
  }
  Line& line = add(LineKind::kDeclaration, i + 1, top().inner);
  line.opens = true;
  push(is_union ? TokenKind::kEndUnion : TokenKind::kEndStruct, BlockKind::kDeclarations,
       top().inner + 1);
}

// Words that are keywords because of what stands beside them.
void Outliner::mark_declaration_words(uint32_t from, uint32_t end) {
  bool in_type = false;
  for (uint32_t i = from; i < end; ++i) {
    TokenKind before = i == from ? TokenKind::kSemicolon : text_.kind(i - 1);
    TokenKind k = text_.kind(i);
    in_type = (in_type || k == TokenKind::kColon) && k != TokenKind::kAssign;
    bool type_begins = before == TokenKind::kColon || before == TokenKind::kOf ||
                       before == TokenKind::kTo || before == TokenKind::kRefTo;
    switch (k) {
      case TokenKind::kAt:
        if (text_.kind(i + 1) == TokenKind::kDirect) soft_keyword(i);
        break;
      case TokenKind::kPointer:
      case TokenKind::kReference:
        if (text_.kind(i + 1) == TokenKind::kTo) soft_keyword(i);
        break;
      case TokenKind::kRefTo:
      case TokenKind::kStringType:
      case TokenKind::kWideStringType:
      case TokenKind::kUnicodeStringType:
        if (in_type && type_begins) soft_keyword(i);
        break;
      case TokenKind::kRisingEdge:
      case TokenKind::kFallingEdge:
      case TokenKind::kReadOnly:
      case TokenKind::kReadWrite:
        if (in_type && !type_begins) soft_keyword(i);
        break;
      case TokenKind::kExtends:
        if (!in_type && i != from) soft_keyword(i);
        break;
      default:
        break;
    }
  }
}

}  // namespace frontend::formatting
