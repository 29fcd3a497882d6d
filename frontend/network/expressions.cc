#include "frontend/network/expressions.h"

#include <unordered_map>

#include "frontend/lex/lexer.h"
#include "ir/types/types.h"

namespace frontend::network {

std::vector<FreeName> free_names(std::string_view expression) {
  base::Diagnostics unheard;
  const TokenList list = lex(expression, base::SourcePos{0}, unheard);
  const std::vector<Token>& tokens = list.tokens;
  std::vector<FreeName> out;
  const auto end_of = [](const Token& token) { return size_t{token.begin} + token.length; };
  for (size_t i = 0; i < tokens.size() && tokens[i].kind != TokenKind::kEnd; ++i) {
    if (!is_name(tokens[i].kind)) continue;
    const TokenKind before = i == 0 ? TokenKind::kEnd : tokens[i - 1].kind;
    const TokenKind behind = tokens[i + 1].kind;
    const bool part = before == TokenKind::kDot || before == TokenKind::kTypePrefix;
    const bool other = behind == TokenKind::kLeftParen || behind == TokenKind::kAssign ||
                       behind == TokenKind::kArrow;
    if (part || other) continue;
    FreeName name;
    name.begin = tokens[i].begin;
    name.end = end_of(tokens[i]);
    if (behind == TokenKind::kDot && is_name(tokens[i + 2].kind)) {
      name.member_begin = tokens[i + 2].begin;
      name.member_end = end_of(tokens[i + 2]);
    }
    out.push_back(name);
  }
  return out;
}

bool is_expression_of_wires(const Element& element) {
  return element.kind == Kind::kSource && !element.inputs.empty();
}

std::vector<OperandPiece> operand_pieces(const Element& source) {
  const std::string_view text = source.operand.text;
  std::vector<OperandPiece> out;
  if (source.inputs.empty()) return {{text, nullptr}};
  std::unordered_map<std::string, const Input*> inputs;
  for (const Input& input : source.inputs) inputs.emplace(ir::fold_name(input.name), &input);
  size_t at = 0;
  for (const FreeName& name : free_names(text)) {
    const std::string whole(text.substr(name.begin, name.end - name.begin));
    const std::string member(text.substr(name.member_begin, name.member_end - name.member_begin));
    auto input = inputs.find(ir::fold_name(whole + '.' + member));
    const bool of_member = input != inputs.end();
    if (!of_member) input = inputs.find(ir::fold_name(whole));
    if (input == inputs.end()) continue;
    const size_t end = of_member ? name.member_end : name.end;
    if (name.begin > at) out.push_back({text.substr(at, name.begin - at), nullptr});
    out.push_back({text.substr(name.begin, end - name.begin), input->second});
    at = end;
  }
  if (at < text.size()) out.push_back({text.substr(at), nullptr});
  return out;
}

std::string operand_with(const Element& source,
                         const std::function<std::string(const Input&)>& name) {
  std::string out;
  for (const OperandPiece& piece : operand_pieces(source)) {
    out += piece.input == nullptr ? std::string(piece.text) : name(*piece.input);
  }
  return out;
}

Network with_expression_boxes(const Network& network) {
  Network out = network;
  for (Element& element : out.elements) {
    if (!is_expression_of_wires(element)) continue;
    element.kind = Kind::kBlock;
    element.type = std::move(element.operand);
    element.operand = {};
  }
  return out;
}

}  // namespace frontend::network
