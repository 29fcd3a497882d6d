#include "tools/stvm/json_value.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "base/limits.h"
#include "ir/types/types.h"

namespace stvm {
namespace {

constexpr int64_t kExact = int64_t{1} << 53;

bool has_64_bits(std::string_view type) {
  for (std::string_view name : {"LINT", "ULINT", "LWORD"}) {
    if (ir::same_name(type, name)) return true;
  }
  return false;
}

// "INT" of "ARRAY[0..3] OF INT".
std::string_view element_of(std::string_view type) {
  const size_t of = type.starts_with("ARRAY") ? type.find(" OF ") : std::string_view::npos;
  return of == std::string_view::npos ? std::string_view() : type.substr(of + 4);
}

std::optional<int64_t> whole_number(std::string_view text) {
  int base = 10;
  if (text.starts_with("16#")) {
    text.remove_prefix(3);
    base = 16;
  }
  int64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (text.empty() || code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> real_number(std::string_view text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = code == std::errc() && end == text.data() + text.size();
  const bool digits = !text.empty() && text.find_first_not_of("0123456789.eE+-") == text.npos;
  return whole && digits && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

void append_utf8(std::string& out, uint32_t unit) {
  if (unit < 0x80) {
    out += static_cast<char>(unit);
  } else if (unit < 0x800) {
    out += static_cast<char>(0xC0 | (unit >> 6));
    out += static_cast<char>(0x80 | (unit & 0x3F));
  } else {
    out += static_cast<char>(0xE0 | (unit >> 12));
    out += static_cast<char>(0x80 | ((unit >> 6) & 0x3F));
    out += static_cast<char>(0x80 | (unit & 0x3F));
  }
}

class Reader {
 public:
  Reader(std::string_view text, tools::JsonWriter& json) : text_(text), json_(json) {}

  // The text is somebody's who may be hostile: every step goes on, and none goes too deep.
  void value(std::string_view type) {
    const char first = peek();
    const bool deep = depth_ == base::kMaxNesting;
    if (first == '(' && !deep) return members();
    if (first == '[' && !deep) return elements(element_of(type));
    if (first == '\'' || first == '"') {
      json_.value(quoted(first));
      return;
    }
    const size_t begin = std::min(at_ + 1, text_.size());
    const size_t end = std::min(text_.find_first_of(",)]", begin), text_.size());
    scalar(type, text_.substr(at_, end - at_));
    at_ = end;
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void step() { at_ = std::min(at_ + 1, text_.size()); }
  void skip(std::string_view wanted) {
    if (text_.substr(at_).starts_with(wanted)) at_ += wanted.size();
  }

  // "(a := 1, b := 2)"
  void members() {
    json_.begin_object();
    ++depth_;
    for (step(); at_ < text_.size() && peek() != ')'; skip(", ")) {
      const size_t end = std::min(text_.find(" := ", at_), text_.size());
      json_.key(text_.substr(at_, end - at_));
      at_ = end;
      skip(" := ");
      value({});
    }
    step();
    --depth_;
    json_.end_object();
  }

  void elements(std::string_view type) {
    json_.begin_array();
    ++depth_;
    for (step(); at_ < text_.size() && peek() != ']'; skip(", ")) value(type);
    step();
    --depth_;
    json_.end_array();
  }

  std::string quoted(char quote) {
    std::string out;
    const size_t digits = quote == '"' ? 4 : 2;
    for (step(); at_ < text_.size() && peek() != quote; step()) {
      if (peek() != '$') {
        out += peek();
        continue;
      }
      step();
      escaped(out, digits);
    }
    step();
    return out;
  }

  void escaped(std::string& out, size_t digits) {
    constexpr std::string_view kLetters = "LNPRT";
    constexpr std::string_view kMeaning = "\n\n\f\r\t";
    const size_t letter = kLetters.find(peek());
    uint32_t unit = 0;
    const char* const begin = text_.data() + at_;
    const char* const end = text_.data() + std::min(at_ + digits, text_.size());
    const auto read = std::from_chars(begin, end, unit, 16);
    if (letter != std::string_view::npos) {
      out += kMeaning[letter];
    } else if (read.ec == std::errc() && read.ptr == begin + digits) {
      append_utf8(out, unit);
      at_ += digits - 1;  // none is behind the end: `read` has seen them
    } else {
      out += peek();
    }
  }

  void scalar(std::string_view type, std::string_view text) {
    if (text == "TRUE" || text == "FALSE") {
      json_.value(text == "TRUE");
    } else if (text == "NULL") {
      json_.null();
    } else if (const auto number = whole_number(text)) {
      const bool exact = *number <= kExact && *number >= -kExact;
      has_64_bits(type) || !exact ? json_.value(text) : json_.value(*number);
    } else if (const auto real = real_number(text); real && text.find('.') != text.npos) {
      json_.value(*real);
    } else {
      json_.value(text);
    }
  }

  std::string_view text_;
  tools::JsonWriter& json_;
  size_t at_ = 0;
  uint32_t depth_ = 0;
};

}  // namespace

void typed_value(tools::JsonWriter& json, std::string_view type, std::string_view literal) {
  json.begin_object();
  typed_fields(json, type, literal);
  json.end_object();
}

void typed_fields(tools::JsonWriter& json, std::string_view type, std::string_view literal) {
  json.field("type", type).key("value");
  Reader(literal, json).value(type);
}

}  // namespace stvm
