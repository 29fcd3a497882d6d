#include "adapters/text_export/pins.h"

#include "base/diagnostics.h"
#include "base/name_case.h"
#include "frontend/lex/lexer.h"
#include "stdlib/sources.h"

namespace text_export {
namespace {

using frontend::Token;
using frontend::TokenKind;

// One function block after FUNCTION_BLOCK.
class Declaration {
 public:
  Declaration(std::string_view text, const std::vector<Token>& tokens, size_t at)
      : text_(text), tokens_(tokens), at_(at) {}

  Pins run() {
    std::vector<std::string> in_outs;
    bool inputs_follow = false;
    for (; !ends(); ++at_) {
      const TokenKind section = kind();
      if (section == TokenKind::kExtends) pins_.unclear = "it extends another block";
      if (section == TokenKind::kVarInput) {
        inputs_follow = inputs_follow || !in_outs.empty();
        names(pins_.left);
      } else if (section == TokenKind::kVarInOut) {
        names(in_outs);
      } else if (section == TokenKind::kVarOutput) {
        names(pins_.right);
      }
    }
    if (inputs_follow) pins_.unclear = "it declares VAR_IN_OUT in front of VAR_INPUT";
    pins_.left.insert(pins_.left.end(), in_outs.begin(), in_outs.end());
    return std::move(pins_);
  }

 private:
  // Behind the end, too: a section may reach up to there.
  TokenKind kind() const { return at_ < tokens_.size() ? tokens_[at_].kind : TokenKind::kEnd; }

  // Members have parameters of their own.
  bool ends() const {
    return kind() == TokenKind::kEnd || kind() == TokenKind::kEndFunctionBlock ||
           kind() == TokenKind::kMethod || kind() == TokenKind::kProperty ||
           kind() == TokenKind::kAction;
  }

  // Up to END_VAR: `a, b : INT := c;`, `a AT %IW0 : INT;`
  void names(std::vector<std::string>& out) {
    bool declares = true;
    for (++at_; kind() != TokenKind::kEnd && kind() != TokenKind::kEndVar; ++at_) {
      if (kind() == TokenKind::kColon) declares = false;
      if (kind() == TokenKind::kSemicolon) declares = true;
      const TokenKind next = tokens_[at_ + 1].kind;
      const bool named =
          next == TokenKind::kComma || next == TokenKind::kColon || next == TokenKind::kAt;
      if (!declares || !named || !frontend::is_name(kind())) continue;
      out.emplace_back(text_.substr(tokens_[at_].begin, tokens_[at_].length));
    }
  }

  std::string_view text_;
  const std::vector<Token>& tokens_;
  size_t at_;
  Pins pins_;
};

}  // namespace

void PinNames::add(std::string_view source, std::map<std::string, Pins>& to) const {
  base::Diagnostics ignored;
  const std::vector<Token> tokens = frontend::lex(source, {0}, ignored).tokens;
  uint32_t namespaces = 0;
  for (size_t i = 0; i + 1 < tokens.size(); ++i) {
    const bool begins = i == 0 || tokens[i - 1].kind != TokenKind::kUsing;
    namespaces += tokens[i].kind == TokenKind::kNamespace && begins ? 1 : 0;
    namespaces -= tokens[i].kind == TokenKind::kEndNamespace && namespaces > 0 ? 1 : 0;
    if (tokens[i].kind != TokenKind::kFunctionBlock || namespaces != 0) continue;
    const Token& name = tokens[i + 1];
    const std::string folded = base::fold_name(source.substr(name.begin, name.length));
    Pins pins = Declaration(source, tokens, i + 2 < tokens.size() ? i + 2 : i + 1).run();
    const auto [known, is_new] = to.try_emplace(folded, pins);
    if (is_new) continue;
    if (known->second.left != pins.left || known->second.right != pins.right) {
      known->second.unclear = "it is declared twice, with other pins";
    }
  }
}

void PinNames::add(std::string_view source) { add(source, types_); }

void PinNames::add_library() {
  std::map<std::string, Pins> library;
  for (const stdlib::LibrarySource& source : stdlib::library_sources()) {
    if (stdlib::is_of_dialect(source, false)) add(source.text, library);
  }
  types_.merge(library);
}

const Pins* PinNames::find(std::string_view type) const {
  const auto found = types_.find(base::fold_name(type));
  return found == types_.end() ? nullptr : &found->second;
}

}  // namespace text_export
