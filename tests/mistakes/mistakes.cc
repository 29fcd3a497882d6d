#include "tests/mistakes/mistakes.h"

#include <algorithm>

#include "ir/types/types.h"

namespace mistakes {
namespace {

using frontend::TokenKind;

std::function<bool(const Original&, size_t)> is(TokenKind kind) {
  return [kind](const Original& original, size_t token) { return original.kind(token) == kind; };
}

std::function<std::string(const Original&, size_t)> by(std::string text) {
  return [text](const Original&, size_t) { return text; };
}

bool ends_statement(const Original& original, size_t token) {
  switch (original.kind(token)) {
    case TokenKind::kEndIf:
    case TokenKind::kEndCase:
    case TokenKind::kEndFor:
    case TokenKind::kEndWhile:
    case TokenKind::kEndRepeat:
      return true;
    default:
      return false;
  }
}

bool ends_unit(const Original& original, size_t token) {
  switch (original.kind(token)) {
    case TokenKind::kEndVar:
    case TokenKind::kEndType:
    case TokenKind::kEndStruct:
    case TokenKind::kEndFunction:
    case TokenKind::kEndFunctionBlock:
    case TokenKind::kEndProgram:
      return true;
    default:
      return false;
  }
}

// The real end of a statement, not one that real code leaves out: behind END_IF it may be missing.
bool needed_semicolon(const Original& original, size_t token) {
  return original.kind(token) == TokenKind::kSemicolon && token > 0 &&
         original.kind(token - 1) != TokenKind::kSemicolon && !ends_statement(original, token - 1);
}

// A name that stands somewhere else too, so that it is one mistake and not another name.
bool long_name(const Original& original, size_t token) {
  if (original.kind(token) != TokenKind::kName || original.word(token).size() < 3) return false;
  for (size_t i = 0; i < original.tokens.size(); ++i) {
    if (i != token && ir::same_name(original.word(i), original.word(token))) return true;
  }
  return false;
}

// Two letters change places; the same letters twice: one goes.
std::string misspelt(const Original& original, size_t token) {
  std::string word(original.word(token));
  size_t at = word.size() / 2;
  if (word[at] == word[at - 1]) {
    word.erase(at, 1);
  } else {
    std::swap(word[at], word[at - 1]);
  }
  return word;
}

bool operand_behind(const Original& original, size_t token) {
  switch (original.kind(token)) {
    case TokenKind::kPlus:
    case TokenKind::kStar:
    case TokenKind::kAnd:
    case TokenKind::kOr:
    case TokenKind::kLess:
    case TokenKind::kGreater:
      return true;
    default:
      return false;
  }
}

bool control_word(const Original& original, size_t token) {
  switch (original.kind(token)) {
    case TokenKind::kIf:
    case TokenKind::kThen:
    case TokenKind::kDo:
    case TokenKind::kOf:
    case TokenKind::kFor:
    case TokenKind::kWhile:
    case TokenKind::kElsif:
    case TokenKind::kCase:
      return true;
    default:
      return ends_statement(original, token) || ends_unit(original, token);
  }
}

// `:=` of a statement: what stands in front is a variable, behind which a value follows.
bool assigns(const Original& original, size_t token) {
  return original.kind(token) == TokenKind::kAssign;
}

bool string_literal(const Original& original, size_t token) {
  return original.kind(token) == TokenKind::kString ||
         original.kind(token) == TokenKind::kWideString;
}

bool colon_of_declaration(const Original& original, size_t token) {
  return original.kind(token) == TokenKind::kColon && token > 0 &&
         original.kind(token - 1) == TokenKind::kName &&
         frontend::is_name(original.kind(token + 1));
}

}  // namespace

const std::vector<Operator>& operators() {
  static const std::vector<Operator> kOperators = {
      {"; left out", needed_semicolon, by("")},
      {"; for ,", is(TokenKind::kComma), by(";")},
      {", left out", is(TokenKind::kComma), by(" ")},
      {"END of a statement left out", ends_statement, by("")},
      {"END of a unit left out", ends_unit, by("")},
      {"END twice", ends_statement,
       [](const Original& original, size_t token) {
         return std::string(original.word(token)) + "; " + std::string(original.word(token));
       }},
      {"THEN left out", is(TokenKind::kThen), by("")},
      {"DO left out", is(TokenKind::kDo), by("")},
      {"OF left out", is(TokenKind::kOf), by("")},
      {"keyword misspelt", control_word, misspelt},
      {"name misspelt", long_name, misspelt},
      {"= for :=", assigns, by("=")},
      {": for :=", assigns, by(":")},
      {":= for =", is(TokenKind::kEqual), by(":=")},
      {"== for =", is(TokenKind::kEqual), by("==")},
      {"!= for <>", is(TokenKind::kNotEqual), by("!=")},
      {"&& for AND", is(TokenKind::kAnd), by("&&")},
      {"|| for OR", is(TokenKind::kOr), by("||")},
      {"( left out", is(TokenKind::kLeftParen), by(" ")},
      {") left out", is(TokenKind::kRightParen), by(" ")},
      {") twice", is(TokenKind::kRightParen), by("))")},
      {"[ left out", is(TokenKind::kLeftBracket), by(" ")},
      {"] left out", is(TokenKind::kRightBracket), by(" ")},
      {": left out", colon_of_declaration, by(" ")},
      {"operand left out", operand_behind,
       [](const Original& original, size_t token) {
         return std::string(original.word(token)) + " ;";
       }},
      {"operator left out", operand_behind, by(" ")},
      {"string not closed", string_literal,
       [](const Original& original, size_t token) {
         std::string_view word = original.word(token);
         return std::string(word.substr(0, word.size() - 1));
       }},
      {"comment not closed", needed_semicolon, by("; (* note")},
      {"text for a number", is(TokenKind::kInteger), by("'many'")},
      {"type misspelt",
       [](const Original& original, size_t token) {
         return token > 0 && original.kind(token - 1) == TokenKind::kColon &&
                long_name(original, token);
       },
       misspelt},
  };
  return kOperators;
}

Mistaken apply(const Operator& op, const Original& original, size_t token) {
  const frontend::Token& place = original.tokens[token];
  Mistaken out;
  out.text = original.text.substr(0, place.begin) + op.replacement(original, token) +
             original.text.substr(place.begin + place.length);
  out.at = place.begin;
  return out;
}

Original read(std::string text) {
  base::SourceMap sources;
  sources.add("original.st", text);
  base::Diagnostics diagnostics;
  Original out;
  out.tokens = frontend::lex(sources, 0, diagnostics).tokens;
  out.text = std::move(text);
  return out;
}

}  // namespace mistakes
