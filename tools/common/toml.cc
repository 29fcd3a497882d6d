#include "tools/common/toml.h"

#include <charconv>

#include "base/joined.h"

namespace tools {
namespace {

// TOML has them in texts as escapes only.
bool is_control(char c) {
  return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == '\x7f';
}

bool is_key_char(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

class Parser {
 public:
  Parser(std::string_view file, std::string_view text) : file_(file), text_(text) {}

  base::Result<TomlTable> run() {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = line_start_ = 3;  // as editors of Windows begin
    while (at_ < text_.size() && !failed_) line();
    if (failed_) return error_;
    return std::move(table_);
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\n'; }
  uint32_t column() const { return static_cast<uint32_t>(at_ - line_start_) + 1; }
  void fail(std::string what) {
    if (!failed_) error_ = toml_error(file_, line_, column(), std::move(what));
    failed_ = true;
  }
  void blanks() {
    while (peek() == ' ' || peek() == '\t') ++at_;
  }
  // Blanks, comments and line ends, as allowed between the elements of an array.
  void white_space() {
    for (;;) {
      blanks();
      if (at_ >= text_.size()) return;
      if (peek() == '#') {
        while (peek() != '\n') ++at_;
      }
      if (peek() == '\r') ++at_;
      if (at_ >= text_.size() || peek() != '\n') return;
      next_line();
    }
  }
  void next_line() {
    ++at_;
    ++line_;
    line_start_ = at_;
  }
  void end_of_line() {
    blanks();
    if (peek() == '#') {
      while (peek() != '\n') ++at_;
    }
    if (peek() == '\r') ++at_;
    if (peek() != '\n') return fail("expected the end of the line");
    next_line();
  }

  void line() {
    blanks();
    if (peek() == '[') {
      ++at_;
      const bool one_of_many = peek() == '[';
      if (one_of_many) ++at_;
      const size_t begin = at_;
      prefix_ = key() + ".";
      while (!failed_ && peek() == '.') {
        ++at_;
        prefix_ += key() + ".";
      }
      if (!failed_ && peek() != ']') fail("expected `]` after the table's name");
      ++at_;
      if (one_of_many) {
        prefix_ += std::to_string(++of_many_[prefix_]) + ".";
        if (!failed_ && peek() != ']') fail("expected `]]` after the table's name");
        ++at_;
      } else if (!of_many_.emplace(prefix_, 0).second) {
        at_ = begin;
        fail("table `" + prefix_.substr(0, prefix_.size() - 1) + "` is given twice");
      }
    } else if (is_key_char(peek())) {
      entry();
    }
    if (!failed_) end_of_line();
  }

  std::string key() {
    size_t begin = at_;
    while (is_key_char(peek())) ++at_;
    if (at_ == begin) fail("expected a key");
    return std::string(text_.substr(begin, at_ - begin));
  }

  void entry() {
    TomlValue value;
    value.line = line_;
    value.column = column();
    const size_t begin = at_;
    const size_t line_start = line_start_;
    const std::string name = prefix_ + key();
    blanks();
    if (peek() != '=') return fail("expected `=` after `" + name + "`");
    ++at_;
    blanks();
    parse_value(value);
    const uint32_t line = value.line;
    if (failed_ || table_.emplace(name, std::move(value)).second) return;
    at_ = begin;
    line_start_ = line_start;
    line_ = line;
    fail("`" + name + "` is given twice");
  }

  void parse_value(TomlValue& value) {
    char c = peek();
    value.place = {line_, column()};
    if (c == '"') {
      value.data = string();
    } else if (c == '[') {
      value.data = array(value.places);
    } else if (text_.substr(at_, 4) == "true") {
      at_ += 4;
      value.data = true;
    } else if (text_.substr(at_, 5) == "false") {
      at_ += 5;
      value.data = false;
    } else if ((c >= '0' && c <= '9') || c == '-') {
      value.data = integer();
    } else {
      fail("expected a value: \"text\", a number, true, false or [\"a\", \"b\"]");
    }
  }

  std::string string() {
    std::string out;
    const size_t begin = at_;
    for (++at_; peek() != '"'; ++at_) {
      if (peek() == '\n') {
        at_ = begin;
        fail("text without closing quote");
        return out;
      }
      if (is_control(peek())) {
        fail("a text has no control characters but \\n and \\t, written so");
        return out;
      }
      if (peek() != '\\') {
        out += peek();
        continue;
      }
      ++at_;
      switch (peek()) {
        case '"':
          out += '"';
          break;
        case '\\':
          out += '\\';
          break;
        case 'n':
          out += '\n';
          break;
        case 't':
          out += '\t';
          break;
        default:
          fail("unknown escape; known are \\\" \\\\ \\n \\t");
          return out;
      }
    }
    ++at_;
    return out;
  }

  int64_t integer() {
    const size_t begin = at_;
    std::string digits;
    for (; is_key_char(peek()); ++at_) {
      if (peek() != '_') digits += peek();
    }
    int64_t value = 0;
    auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (code != std::errc() || end != digits.data() + digits.size()) {
      at_ = begin;
      fail("not a whole number in decimal digits");
    }
    return value;
  }

  std::vector<std::string> array(std::vector<TomlPlace>& places) {
    std::vector<std::string> out;
    ++at_;
    white_space();
    while (peek() != ']' && !failed_) {
      if (peek() != '"') {
        fail("expected \"text\" or `]`");
        return out;
      }
      places.push_back({line_, column()});
      out.push_back(string());
      white_space();
      if (peek() == ',') {
        ++at_;
        white_space();
      } else if (peek() != ']') {
        fail("expected `,` or `]`");
      }
    }
    ++at_;
    return out;
  }

  std::string_view file_;
  std::string_view text_;
  size_t at_ = 0;
  size_t line_start_ = 0;
  uint32_t line_ = 1;
  std::string prefix_;
  std::map<std::string, size_t> of_many_;  // tables that each [[name]] has had; 0: of [name]
  TomlTable table_;
  bool failed_ = false;
  base::Error error_{base::Refusal::kBadProject, {}};
};

}  // namespace

std::string toml_quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n' || c == '\t') {
      out += c == '\n' ? "\\n" : "\\t";
    } else {
      out += is_control(c) ? ' ' : c;
    }
  }
  return out + "\"";
}

base::Error toml_error(std::string_view file, uint32_t line, uint32_t column, std::string what) {
  return {base::Refusal::kBadProject,
          base::joined({file, ":", std::to_string(line), ":", std::to_string(column), ": ", what})};
}

base::Result<TomlTable> parse_toml(std::string_view file, std::string_view text) {
  return Parser(file, text).run();
}

}  // namespace tools
