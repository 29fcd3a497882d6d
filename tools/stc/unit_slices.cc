#include "tools/stc/unit_slices.h"

#include <algorithm>
#include <iterator>

#include "frontend/lex/characters.h"
#include "frontend/lex/lexer.h"
#include "frontend/network/comments.h"
#include "frontend/parse/section_word.h"
#include "ir/types/types.h"

namespace stc {
namespace {

// Where a string that begins at `at` ends, after its quote; `at` when none begins there.
size_t string_end(std::string_view text, size_t at) {
  const char quote = text[at];
  if (quote != '\'' && quote != '"') return at;
  for (size_t i = at + 1; i < text.size(); ++i) {
    if (text[i] == '$') {
      ++i;
    } else if (text[i] == quote || text[i] == '\n') {
      return i + 1;
    }
  }
  return text.size();
}

// After the comment, string or byte at `at`.
size_t behind_piece(std::string_view text, size_t at) {
  const size_t comment = frontend::network::comment_end(text, at);
  const size_t string = string_end(text, at);
  return comment == at && string == at ? at + 1 : std::max(comment, string);
}

}  // namespace

std::string_view Slices::of(base::SourceSpan span) const {
  const uint32_t file = sources_.file_of(span.begin);
  if (file == sources_.file_count() || span.end < span.begin) return {};
  const uint32_t begin = span.begin.offset - sources_.begin(file).offset;
  const std::string_view text = sources_.text(file);
  if (begin > text.size()) return {};
  return text.substr(begin, span.end.offset - span.begin.offset);
}

std::string_view Slices::trimmed(std::string_view text) {
  while (!text.empty() && frontend::is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && frontend::is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string Slices::plain_text(std::string_view text) {
  std::string out;
  bool blank = false;
  const auto add = [&](std::string_view piece) {
    if (blank && !out.empty()) out += ' ';
    blank = false;
    out += piece;
  };
  for (size_t at = 0; at < text.size();) {
    const size_t comment = frontend::network::comment_end(text, at);
    const size_t string = string_end(text, at);
    if (comment != at || frontend::is_space(text[at])) {
      blank = true;
      at = comment != at ? comment : at + 1;
    } else {
      const size_t end = string != at ? string : at + 1;
      add(text.substr(at, end - at));
      at = end;
    }
  }
  return out;
}

std::string_view Slices::from(base::SourcePos begin) const {
  const uint32_t file = sources_.file_of(begin);
  if (file == sources_.file_count()) return {};
  return sources_.text(file).substr(begin.offset - sources_.begin(file).offset);
}

std::string Slices::to_semicolon(base::SourcePos begin) const {
  const std::string_view text = from(begin);
  size_t at = 0;
  while (at < text.size() && text[at] != ';') at = behind_piece(text, at);
  return plain_text(text.substr(0, at));
}

base::SourceSpan Slices::whole(const frontend::VarBlock& block) const {
  constexpr std::string_view kEnd = "END_VAR";
  base::SourceSpan out = block.span;
  if (block.vars.size() != 0) {
    out.end = std::max(out.end, block.vars[block.vars.size() - 1].span.end);
  }
  const std::string_view text = from(out.end);
  for (size_t at = 0; at < text.size(); at = behind_piece(text, at)) {
    if (!ir::same_name(text.substr(at, kEnd.size()), kEnd)) continue;
    out.end.offset += static_cast<uint32_t>(at + kEnd.size());
    break;
  }
  return out;
}

std::vector<BodyLine> Slices::lines(base::SourceSpan span) const {
  std::vector<BodyLine> out;
  std::string_view text = of(span);
  uint32_t number = line(span.begin);
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view one = text.substr(0, end);
    while (!one.empty() && frontend::is_space(one.back())) one.remove_suffix(1);
    out.push_back({std::string(one), number++});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string squeezed(std::string_view line) {
  std::string out;
  for (char c : line) {
    if (!frontend::is_space(c)) {
      out += c;
    } else if (!out.empty() && out.back() != ' ') {
      out += ' ';
    }
  }
  if (out.ends_with(' ')) out.pop_back();
  return out;
}

std::string tokens_of(std::string_view text) {
  base::Diagnostics ignored;
  const frontend::TokenList list = frontend::lex(text, base::SourcePos{0}, ignored);
  std::string out;
  for (const frontend::Token& token : list.tokens) {
    if (token.begin + token.length > text.size()) continue;
    const std::string_view word = text.substr(token.begin, token.length);
    const bool folded = frontend::is_keyword(token.kind) || frontend::is_name(token.kind);
    out += folded ? ir::fold_name(word) : std::string(word);
    out += '\n';
  }
  for (const base::SourceSpan& pragma : list.pragmas) {
    const uint32_t begin = pragma.begin.offset;
    out += Slices::plain_text(text.substr(begin, pragma.end.offset - begin)) + '\n';
  }
  return out;
}

std::string comments_of(std::string_view text) {
  std::string out;
  for (const frontend::network::Comment& comment : frontend::network::comments_in(text)) {
    out += comment.text + '\n';
  }
  return out;
}

std::string section_text(const frontend::VarBlock& block) {
  static constexpr const char* kAccess[] = {"", " PUBLIC", " PRIVATE", " PROTECTED", " INTERNAL"};
  std::string out = frontend::section_word(block.section);
  out += kAccess[static_cast<size_t>(block.access)];
  if (block.constant) out += " CONSTANT";
  if (block.retain) out += " RETAIN";
  if (block.non_retain) out += " NON_RETAIN";
  return out;
}

}  // namespace stc
