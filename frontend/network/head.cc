#include "frontend/network/head.h"

#include "frontend/lex/characters.h"
#include "frontend/lex/pragma.h"

namespace frontend::network {

std::optional<Head> read_head(std::string_view pragma) {
  PragmaReader reader(inside_pragma(pragma));
  if (!reader.accept_word("network")) return std::nullopt;
  Head out;
  if (reader.kind() == PragmaReader::Kind::kText) {
    const size_t quote = reader.piece().data() - pragma.data() - 1;
    const size_t end = quote + 1 + reader.piece().size();
    if (pragma[end] != pragma[quote]) return std::nullopt;  // not closed
    out.title = reader.piece();
    reader.next();
  }
  out.disabled = reader.accept_word("disabled");
  if (reader.kind() != PragmaReader::Kind::kEnd) return std::nullopt;
  return out;
}

std::string head_text(std::string_view title, bool disabled) {
  if (title.empty() && !disabled) return {};
  std::string out = "{network";
  if (!title.empty()) {
    const char quote = title.find('\'') == std::string_view::npos ? '\'' : '"';
    out += ' ' + (quote + std::string(title) + quote);
  }
  return out + (disabled ? " disabled}" : "}");
}

std::string title_of(std::string_view text) {
  std::string out;
  for (char c : text) {
    if (is_space(c) || static_cast<uint8_t>(c) < 0x20) {
      if (!out.empty() && out.back() != ' ') out += ' ';
    } else {
      out += c == '"' ? '\'' : c == '{' ? '(' : c == '}' ? ')' : c;
    }
  }
  while (out.ends_with(' ')) out.pop_back();
  return out;
}

}  // namespace frontend::network
