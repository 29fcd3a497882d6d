// A strict JSON reader for tests of what the tools print: RFC 8259, no more.
#pragma once

#include <cctype>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace base {

struct JsonValue {
  enum class Kind { kNull, kBool, kNumber, kString, kArray, kObject };
  Kind kind = Kind::kNull;
  bool boolean = false;
  double number = 0;
  std::string text;
  std::vector<JsonValue> items;
  std::map<std::string, JsonValue> members;

  bool has(const std::string& key) const { return members.count(key) != 0; }
  const JsonValue& operator[](const std::string& key) const {
    static const JsonValue kNone;
    auto found = members.find(key);
    return found == members.end() ? kNone : found->second;
  }
};

class JsonReader {
 public:
  explicit JsonReader(std::string_view text) : text_(text) {}

  std::optional<JsonValue> read() {
    JsonValue out;
    if (!value(out)) return std::nullopt;
    space();
    return at_ == text_.size() ? std::optional(out) : std::nullopt;
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  void space() {
    while (peek() == ' ' || peek() == '\n' || peek() == '\t' || peek() == '\r') ++at_;
  }
  bool word(std::string_view expected) {
    if (text_.substr(at_, expected.size()) != expected) return false;
    at_ += expected.size();
    return true;
  }

  bool value(JsonValue& out) {
    space();
    switch (peek()) {
      case '{':
        return object(out);
      case '[':
        return array(out);
      case '"':
        out.kind = JsonValue::Kind::kString;
        return string(out.text);
      case 't':
        out.kind = JsonValue::Kind::kBool;
        return out.boolean = word("true");
      case 'f':
        out.kind = JsonValue::Kind::kBool;
        return word("false");
      case 'n':
        return word("null");
      default:
        return number(out);
    }
  }

  bool number(JsonValue& out) {
    size_t begin = at_;
    take('-');
    while (std::isdigit(static_cast<unsigned char>(peek())) != 0 || peek() == '.') ++at_;
    if (at_ == begin) return false;
    out.kind = JsonValue::Kind::kNumber;
    out.number = std::stod(std::string(text_.substr(begin, at_ - begin)));
    return true;
  }

  bool string(std::string& out) {
    if (!take('"')) return false;
    while (!take('"')) {
      char c = peek();
      if (static_cast<unsigned char>(c) < 0x20) return false;  // also the end of the text
      ++at_;
      if (c != '\\') {
        out += c;
      } else if (!escape(out)) {
        return false;
      }
    }
    return true;
  }

  bool escape(std::string& out) {
    char c = peek();
    ++at_;
    if (c == 'u') {
      for (int i = 0; i < 4; ++i, ++at_) {
        if (std::isxdigit(static_cast<unsigned char>(peek())) == 0) return false;
      }
      out += '?';
      return true;
    }
    static constexpr std::string_view kKnown = "\"\\/bfnrt";
    out += c == 'n' ? '\n' : c;
    return kKnown.find(c) != std::string_view::npos;
  }

  bool array(JsonValue& out) {
    out.kind = JsonValue::Kind::kArray;
    take('[');
    space();
    if (take(']')) return true;
    do {
      out.items.emplace_back();
      if (!value(out.items.back())) return false;
      space();
    } while (take(','));
    return take(']');
  }

  bool object(JsonValue& out) {
    out.kind = JsonValue::Kind::kObject;
    take('{');
    space();
    if (take('}')) return true;
    do {
      space();
      std::string key;
      if (!string(key) || out.has(key)) return false;
      space();
      if (!take(':') || !value(out.members[key])) return false;
      space();
    } while (take(','));
    return take('}');
  }

  std::string_view text_;
  size_t at_ = 0;
};

}  // namespace base
