#include "frontend/network/comments.h"

#include <cstdint>

#include "frontend/lex/characters.h"

namespace frontend::network {

size_t comment_end(std::string_view text, size_t at) {
  std::string_view open = text.substr(at, 2);
  if (open == "//") {
    size_t end = text.find('\n', at);
    if (end == std::string_view::npos) end = text.size();
    return end > at && text[end - 1] == '\r' ? end - 1 : end;
  }
  if (open != "(*" && open != "/*") return at;
  std::string_view close = open == "(*" ? "*)" : "*/";
  uint32_t depth = 0;
  while (at < text.size()) {
    std::string_view mark = text.substr(at, 2);
    at += mark == open || mark == close ? 2 : 1;
    if (mark == open) ++depth;
    if (mark == close && --depth == 0) return at;
  }
  return text.size();
}

std::string comment_text(std::string_view comment) {
  std::string_view inside = comment.substr(comment.size() < 2 ? comment.size() : 2);
  bool closed = comment.size() >= 4 && (comment.ends_with("*)") || comment.ends_with("*/"));
  if (closed && !comment.starts_with("//")) inside.remove_suffix(2);
  std::string out;
  auto trim_end = [&] {
    while (!out.empty() && is_space(out.back()) && out.back() != '\n') out.pop_back();
  };
  bool fresh = true;
  for (char c : inside) {
    if (c == '\r' || (fresh && is_space(c) && c != '\n')) continue;
    fresh = c == '\n';
    if (fresh) trim_end();
    out += c == '\t' ? ' ' : c;
  }
  while (!out.empty() && is_space(out.back())) out.pop_back();
  size_t first = 0;
  while (first < out.size() && is_space(out[first])) ++first;
  return out.substr(first);
}

std::vector<Comment> comments_in(std::string_view text) {
  std::vector<Comment> out;
  for (size_t at = 0; at < text.size();) {
    char c = text[at];
    if (c == '\'' || c == '"') {
      ++at;
      while (at < text.size() && text[at] != c && text[at] != '\n') at += text[at] == '$' ? 2 : 1;
      ++at;
      continue;
    }
    size_t end = comment_end(text, at);
    if (end == at) {
      ++at;
      continue;
    }
    out.push_back({at, comment_text(text.substr(at, end - at))});
    at = end;
  }
  return out;
}

}  // namespace frontend::network
