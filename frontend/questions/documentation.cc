#include "frontend/questions/documentation.h"

#include <algorithm>

namespace frontend::questions {
namespace {

std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
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

// Strings and attributes have no comments in them.
Documentation::Documentation(std::string_view text) : text_(text) {
  for (size_t at = 0; at < text_.size();) {
    const std::string_view rest = text_.substr(at);
    size_t end = std::string_view::npos;
    if (rest.starts_with("//")) {
      end = text_.find('\n', at);
      comments_.push_back({at, end == std::string_view::npos ? text_.size() : end});
    } else if (rest.starts_with("(*") || rest.starts_with("/*")) {
      const char close = rest[0] == '(' ? ')' : '/';
      size_t depth = 1;
      end = at + 2;
      for (; end + 1 < text_.size() && depth > 0; ++end) {
        if (text_[end] == rest[0] && text_[end + 1] == '*')
          ++depth, ++end;
        else if (text_[end] == '*' && text_[end + 1] == close)
          --depth, ++end;
      }
      comments_.push_back({at, end});
    } else if (rest[0] == '\'' || rest[0] == '"') {
      end = at + 1;
      while (end < text_.size() && text_[end] != rest[0] && text_[end] != '\n') {
        end += text_[end] == '$' ? 2 : 1;
      }
      ++end;
    } else if (rest[0] == '{') {
      end = text_.find('}', at);
    } else {
      ++at;
      continue;
    }
    if (end >= text_.size()) break;
    at = end;
  }
}

std::string Documentation::above(size_t name) const {
  std::string out;
  size_t begin = begin_of(text_, name);
  auto comment = std::partition_point(comments_.begin(), comments_.end(),
                                      [&](const Comment& one) { return one.begin < begin; });
  while (comment != comments_.begin()) {
    --comment;
    const size_t line = text_.rfind('\n', comment->begin);
    const size_t first = line == std::string_view::npos ? 0 : line + 1;
    const bool alone = trimmed(text_.substr(first, comment->begin - first)).empty();
    if (!alone || !is_gap(text_.substr(comment->end, begin - comment->end), 1)) break;
    const std::string one = text_of(text_.substr(comment->begin, comment->end - comment->begin));
    out = out.empty() ? one : one + '\n' + out;
    begin = comment->begin;
  }
  return out;
}

std::string Documentation::at(size_t name, bool below) const {
  std::string over = above(name);
  if (!over.empty()) return over;
  const auto comment = std::partition_point(comments_.begin(), comments_.end(),
                                            [&](const Comment& one) { return one.begin < name; });
  if (comment == comments_.end()) return {};
  const size_t end = std::min(text_.find('\n', name), text_.size());
  const bool in_line = comment->begin < end;
  const bool next =
      below && comment->begin >= end && is_gap(text_.substr(end, comment->begin - end), 1);
  if (!in_line && !next) return {};
  return text_of(text_.substr(comment->begin, comment->end - comment->begin));
}

}  // namespace frontend::questions
