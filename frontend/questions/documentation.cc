#include "frontend/questions/documentation.h"

#include <vector>

namespace frontend::questions {
namespace {

std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

struct Comment {
  size_t begin;
  size_t end;
};

// All comments of the text, in order. Strings and attributes have none in them.
std::vector<Comment> comments_of(std::string_view text) {
  std::vector<Comment> found;
  for (size_t at = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    size_t end = std::string_view::npos;
    if (rest.starts_with("//")) {
      end = text.find('\n', at);
      found.push_back({at, end == std::string_view::npos ? text.size() : end});
    } else if (rest.starts_with("(*") || rest.starts_with("/*")) {
      const char close = rest[0] == '(' ? ')' : '/';
      size_t depth = 1;
      end = at + 2;
      for (; end + 1 < text.size() && depth > 0; ++end) {
        if (text[end] == rest[0] && text[end + 1] == '*')
          ++depth, ++end;
        else if (text[end] == '*' && text[end + 1] == close)
          --depth, ++end;
      }
      found.push_back({at, end});
    } else if (rest[0] == '\'' || rest[0] == '"') {
      end = at + 1;
      while (end < text.size() && text[end] != rest[0] && text[end] != '\n') {
        end += text[end] == '$' ? 2 : 1;
      }
      ++end;
    } else if (rest[0] == '{') {
      end = text.find('}', at);
    } else {
      ++at;
      continue;
    }
    if (end >= text.size()) break;
    at = end;
  }
  return found;
}

// Without the marks of the comment, and without a border of stars.
std::string text_of(std::string_view comment) {
  const bool block = !comment.starts_with("//");
  comment.remove_prefix(2);
  if (block && comment.size() >= 2) comment.remove_suffix(2);
  std::string out;
  while (!comment.empty()) {
    const size_t newline = comment.find('\n');
    std::string_view line = trimmed(comment.substr(0, newline));
    while (line.starts_with('*') || line.starts_with('/')) line.remove_prefix(1);
    while (line.ends_with('*')) line.remove_suffix(1);
    line = trimmed(line);
    if (!line.empty()) out += (out.empty() ? "" : "\n") + std::string(line);
    comment.remove_prefix(newline == std::string_view::npos ? comment.size() : newline + 1);
  }
  return out;
}

// Nothing but spaces, with at most `lines` ends of lines?
bool is_gap(std::string_view between, size_t lines) {
  size_t ends = 0;
  for (const char c : between) {
    if (c == '\n') ++ends;
    if (c != ' ' && c != '\t' && c != '\r' && c != '\n') return false;
  }
  return ends <= lines;
}

// Where the declaration begins: its line, and lines above that are attributes.
size_t begin_of(std::string_view text, size_t name) {
  size_t begin = text.rfind('\n', name == 0 ? 0 : name - 1);
  begin = begin == std::string_view::npos || name == 0 ? 0 : begin + 1;
  for (;;) {
    const size_t last = text.find_last_not_of(" \t\r\n", begin == 0 ? 0 : begin - 1);
    if (begin == 0 || last == std::string_view::npos || text[last] != '}') return begin;
    const size_t open = text.rfind('{', last);
    if (open == std::string_view::npos) return begin;
    const size_t line = text.rfind('\n', open);
    begin = line == std::string_view::npos ? 0 : line + 1;
  }
}

}  // namespace

std::string documentation(std::string_view text, size_t name, bool below) {
  const std::vector<Comment> comments = comments_of(text);
  std::string above;
  size_t begin = begin_of(text, name);
  for (auto comment = comments.rbegin(); comment != comments.rend(); ++comment) {
    if (comment->begin >= begin) continue;
    const size_t line = text.rfind('\n', comment->begin);
    const size_t first = line == std::string_view::npos ? 0 : line + 1;
    const bool alone = trimmed(text.substr(first, comment->begin - first)).empty();
    if (!alone || !is_gap(text.substr(comment->end, begin - comment->end), 1)) break;
    const std::string one = text_of(text.substr(comment->begin, comment->end - comment->begin));
    above = above.empty() ? one : one + '\n' + above;
    begin = comment->begin;
  }
  if (!above.empty()) return above;
  const size_t newline = text.find('\n', name);
  const size_t end = newline == std::string_view::npos ? text.size() : newline;
  size_t after = below ? end : name;
  for (const Comment& comment : comments) {
    if (comment.begin < name) continue;
    const bool in_line = comment.begin < end;
    const bool next = below && is_gap(text.substr(after, comment.begin - after), 1);
    if (!in_line && !next) break;
    return text_of(text.substr(comment.begin, comment.end - comment.begin));
  }
  return {};
}

}  // namespace frontend::questions
