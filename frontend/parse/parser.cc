#include "frontend/parse/parser.h"

#include <algorithm>

#include "base/diagnostics_render.h"
#include "base/limits.h"
#include "frontend/parse/foreign_words.h"
#include "frontend/parse/parse.h"
#include "ir/types/types.h"

namespace frontend {

namespace {

// Room for the nodes of one more file, without losing geometric growth.
template <class T>
void make_room(std::vector<T>& store, size_t more) {
  size_t needed = store.size() + more;
  if (needed > store.capacity()) store.reserve(std::max(needed, store.capacity() * 2));
}

}  // namespace

bool has_open_comment(const base::Diagnostics& diagnostics, size_t first) {
  const auto& all = diagnostics.all();
  return std::any_of(all.begin() + static_cast<ptrdiff_t>(first), all.end(), [](const auto& one) {
    return one.code == base::DiagnosticCode::kUnterminatedComment;
  });
}

void parse(const base::SourceMap& sources, uint32_t file, Tree& tree,
           base::Diagnostics& diagnostics, const LexOptions& options) {
  const size_t before = diagnostics.all().size();
  TokenList tokens = lex(sources, file, diagnostics, options);
  // What an open comment has swallowed is missing everywhere: one message says it.
  base::Diagnostics unheard;
  base::Diagnostics& heard = has_open_comment(diagnostics, before) ? unheard : diagnostics;
  constexpr size_t kMost = 1 << 20;  // a long file may have declarations only
  make_room(tree.stmts, std::min(tokens.tokens.size() / 10, kMost));
  Parser(sources, file, tokens, tree, heard, options.declarations).parse_file();
}

Parser::Parser(const base::SourceMap& sources, uint32_t file, const TokenList& tokens, Tree& tree,
               base::Diagnostics& diagnostics, const DeclarationIndex* declarations)
    : text_(sources.text(file)),
      base_(sources.begin(file).offset),
      list_(tokens),
      declarations_(declarations),
      first_(tokens.tokens.data()),
      current_(first_),
      last_(first_ + tokens.tokens.size() - 1),
      var_scan_end_(first_),
      test_end_(first_),
      tree_(tree),
      diagnostics_(diagnostics) {}

bool Parser::expect(TokenKind wanted, const char* where) {
  if (accept(wanted)) return true;
  std::string what(token_text(wanted));
  // What is missing at a line's end is missed there, not somewhere below.
  base::SourceSpan span = current_->span();
  if (on_new_line()) span = {last_end(), {last_end().offset + 1}};
  report(Code::kExpected, span,
         "expected `" + what + "` " + where + ", found " + describe(*current_),
         is_name(kind()) ? instead_of(text(*current_)) : "");
  return false;
}

bool Parser::is_word(const Token& token, std::string_view word) const {
  return is_name(token.kind) && ir::same_name(text(token), word);
}

Name Parser::parse_name(const char* what) {
  if (is_name(kind())) return name_of(take());
  if (is_keyword(kind())) {
    report_here(Code::kReservedWord,
                describe(*current_) + " is a reserved word and cannot name " + with_article(what),
                "choose another name");
  } else {
    report_here(Code::kExpectedName,
                "expected the name of " + with_article(what) + ", found " + describe(*current_));
  }
  return {};
}

bool Parser::on_new_line() const {
  if (current_ == first_) return true;
  uint32_t from = last_end().offset - base_;
  return text_.substr(from, current_->begin - base_ - from).find('\n') != std::string_view::npos;
}

std::string Parser::describe(const Token& token) const {
  static constexpr size_t kShown = 40;
  if (token.kind == TokenKind::kEnd) return "the end of the file";
  std::string_view shown = text(token);
  if (shown.size() > kShown) return '`' + base::printable(shown.substr(0, kShown)) + "...`";
  return '`' + base::printable(shown) + '`';
}

std::string Parser::with_article(const char* noun) {
  bool vowel = std::string_view("aeiou").find(noun[0]) != std::string_view::npos;
  return (vowel ? "an " : "a ") + std::string(noun);
}

bool Parser::report_too_deep() {
  report_here(Code::kTooDeep,
              "this is nested more than " + std::to_string(base::kMaxNesting) + " levels deep",
              "move a part into a function or a variable of its own");
  return false;
}

}  // namespace frontend
