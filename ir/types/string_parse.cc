// String literals to code units: parse_string and parse_wstring of value_text.h.
// Escapes are those of IEC 61131-3 tables 6 and 7.
#include <optional>

#include "ir/types/utf.h"
#include "ir/types/value_text.h"

namespace ir {
namespace {

std::optional<std::string_view> between_quotes(std::string_view text, std::string_view prefix,
                                               char quote) {
  if (text.size() > prefix.size() && same_name(text.substr(0, prefix.size()), prefix)) {
    text.remove_prefix(prefix.size());
  }
  if (text.size() < 2 || text.front() != quote || text.back() != quote) {
    return std::nullopt;
  }
  return text.substr(1, text.size() - 2);
}

std::optional<uint32_t> hex_code(std::string_view text) {
  uint32_t code = 0;
  for (const char c : text) {
    const size_t digit = std::string_view("0123456789ABCDEFabcdef").find(c);
    if (digit == std::string_view::npos) {
      return std::nullopt;
    }
    code = code << 4 | static_cast<uint32_t>(digit < 16 ? digit : digit - 6);
  }
  return code;
}

struct Escape {
  uint32_t code = 0;
  uint32_t length = 0;  // characters after `$`; 0: no escape
};

// `text` is what follows `$`.
Escape read_escape(std::string_view text, char quote, uint32_t hex_digits) {
  if (text.empty()) {
    return {};
  }
  switch (text[0]) {
    case '$':
      return {'$', 1};
    case 'L':
    case 'l':
    case 'N':
    case 'n':
      return {'\n', 1};
    case 'P':
    case 'p':
      return {'\f', 1};
    case 'R':
    case 'r':
      return {'\r', 1};
    case 'T':
    case 't':
      return {'\t', 1};
    default:
      break;
  }
  if (text[0] == quote) {
    return {static_cast<uint32_t>(quote), 1};
  }
  if (text.size() < hex_digits) {
    return {};
  }
  const std::optional<uint32_t> code = hex_code(text.substr(0, hex_digits));
  return code ? Escape{*code, hex_digits} : Escape{};
}

base::Error not_a_string(std::string_view text, std::string_view form) {
  return {base::Refusal::kBadValue,
          "`" + std::string(text) + "` is no string; write it as " + std::string(form)};
}

}  // namespace

base::Result<std::string> parse_string(std::string_view text) {
  const auto body = between_quotes(text, "STRING#", '\'');
  if (!body) {
    return not_a_string(text, "'text'");
  }
  std::string bytes;
  for (size_t at = 0; at < body->size(); ++at) {
    const char c = (*body)[at];
    if (c == '$') {
      const Escape escape = read_escape(body->substr(at + 1), '\'', 2);
      if (escape.length == 0) {
        return not_a_string(text, "'text'; after $ one of $ ' L N P R T or two hex digits");
      }
      bytes += static_cast<char>(escape.code);
      at += escape.length;
    } else if (c == '\'') {
      return not_a_string(text, "'text' with $' for a quote");
    } else {
      bytes += c;
    }
  }
  return bytes;
}

base::Result<std::string> parse_wstring(std::string_view text) {
  const auto body = between_quotes(text, "WSTRING#", '"');
  if (!body) {
    return not_a_string(text, "\"text\"");
  }
  std::string units;
  for (size_t at = 0; at < body->size();) {
    if ((*body)[at] == '$') {
      const Escape escape = read_escape(body->substr(at + 1), '"', 4);
      if (escape.length == 0) {
        return not_a_string(text, "\"text\"; after $ one of $ \" L N P R T or four hex digits");
      }
      units += utf16le(escape.code);
      at += escape.length + 1;
      continue;
    }
    const Utf8Character character = read_utf8(body->substr(at));
    if (character.bytes == 0 || character.code == '"') {
      return not_a_string(text, "\"text\" in UTF-8 with $\" for a quote");
    }
    units += utf16le(character.code);
    at += character.bytes;
  }
  return units;
}

}  // namespace ir
