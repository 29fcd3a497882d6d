#include <cstring>

#include "base/windows_1252.h"
#include "frontend/lex/characters.h"
#include "frontend/lex/literals.h"
#include "ir/types/utf.h"

namespace frontend {

using base::DiagnosticCode;

namespace {

// Without the quotes; an unterminated string (already reported) has only one.
std::string_view content(std::string_view text) {
  std::string_view inside = text.substr(1);
  if (!inside.empty() && inside.back() == text[0]) inside.remove_suffix(1);
  return inside;
}

// IEC table 7: the character after `$`; 0 when it is not one of them.
char simple_escape(char c) {
  switch (to_upper(c)) {
    case '$':
      return '$';
    case '\'':
      return '\'';
    case '"':
      return '"';
    case 'L':
      return '\n';
    case 'N':
      return '\n';
    case 'P':
      return '\f';
    case 'R':
      return '\r';
    case 'T':
      return '\t';
    default:
      return 0;
  }
}

struct Escape {
  uint32_t code = 0;
  size_t length = 0;  // with the `$`; 0: not an escape
};

Escape read_escape(std::string_view inside, size_t at, size_t hex_digits) {
  if (at + 1 >= inside.size()) return {};
  if (char c = simple_escape(inside[at + 1])) return {static_cast<uint8_t>(c), 2};
  if (inside.size() - at - 1 < hex_digits) return {};
  uint32_t code = 0;
  for (size_t i = 1; i <= hex_digits; ++i) {
    uint32_t digit = digit_value(inside[at + i]);
    if (digit > 15) return {};
    code = code * 16 + digit;
  }
  return {code, 1 + hex_digits};
}

LiteralProblem bad_escape(size_t at, size_t hex_digits) {
  std::string digits = hex_digits == 2 ? "two" : "four";
  return {DiagnosticCode::kBadEscape, static_cast<uint32_t>(at + 1), 2,
          "`$` begins an escape, and this is none",
          "write `$$` for a dollar sign, or " + digits + " hexadecimal digits after `$`"};
}

LiteralProblem wide_character(size_t at, std::string_view character) {
  return {DiagnosticCode::kCharacterTooWide, static_cast<uint32_t>(at),
          static_cast<uint32_t>(character.size()),
          "`" + std::string(character) + "` does not fit into one byte of a STRING",
          "use WSTRING and \"...\", or USTRING#'...' for the bytes of UTF-8"};
}

void append_unit(std::string& out, uint32_t unit) {
  out += static_cast<char>(unit & 0xFF);
  out += static_cast<char>(unit >> 8);
}

// Code and length of the source character at `at`.
Escape read_character(std::string_view inside, size_t at, bool latin1) {
  if (latin1) return {base::of_windows_1252(static_cast<uint8_t>(inside[at])), 1};
  ir::Utf8Character character = ir::read_utf8(inside.substr(at));
  if (character.bytes == 0) return {static_cast<uint8_t>(inside[at]), 1};
  return {character.code, character.bytes};
}

// Bytes without escapes, from a source of that charset; `at` is their place in the literal.
void append_plain(DecodedString& out, std::string_view plain, size_t at, StringCharset charset) {
  bool utf8 = charset == StringCharset::kUtf8Source;
  if (!utf8 && charset != StringCharset::kLatin1ToUtf8) {
    out.bytes += plain;
    return;
  }
  for (size_t i = 0; i < plain.size();) {
    Escape character = read_character(plain, i, !utf8);
    if (!utf8) {
      out.bytes += ir::utf8(character.code);
    } else if (character.code <= 0xFF) {
      out.bytes += static_cast<char>(character.code);
    } else if (const uint8_t byte = base::windows_1252_byte(character.code); byte != 0) {
      out.bytes += static_cast<char>(byte);
    } else {
      if (!out.problem) out.problem = wide_character(at + i, plain.substr(i, character.length));
      out.bytes += '?';
    }
    i += character.length;
  }
}

}  // namespace

DecodedString decode_string(std::string_view text, StringCharset charset) {
  DecodedString out;
  std::string_view inside = content(text);
  for (size_t at = 0; at < inside.size();) {
    size_t plain = std::min(inside.find('$', at), inside.size());
    append_plain(out, inside.substr(at, plain - at), at + 1, charset);
    at = plain;
    if (at == inside.size()) break;
    Escape escape = read_escape(inside, at, 2);
    if (escape.length == 0) {
      if (!out.problem) out.problem = bad_escape(at, 2);
      escape = {'$', 1};
    }
    out.bytes += static_cast<char>(escape.code);
    at += escape.length;
  }
  return out;
}

DecodedString decode_wide_string(std::string_view text, bool latin1) {
  DecodedString out;
  std::string_view inside = content(text);
  for (size_t at = 0; at < inside.size();) {
    if (inside[at] != '$') {
      Escape character = read_character(inside, at, latin1);
      out.bytes += ir::utf16le(character.code);
      at += character.length;
      continue;
    }
    Escape escape = read_escape(inside, at, 4);
    if (escape.length == 0) {
      if (!out.problem) out.problem = bad_escape(at, 4);
      escape = {'$', 1};
    }
    append_unit(out.bytes, escape.code);
    at += escape.length;
  }
  return out;
}

bool is_latin1(std::string_view source) {
  for (size_t at = 0; at < source.size();) {
    uint64_t eight = 0;
    if (source.size() - at >= sizeof eight) std::memcpy(&eight, source.data() + at, sizeof eight);
    bool ascii = source.size() - at >= sizeof eight && (eight & 0x8080'8080'8080'8080u) == 0;
    if (ascii || static_cast<uint8_t>(source[at]) < 0x80) {
      at += ascii ? sizeof eight : 1;
      continue;
    }
    uint32_t length = ir::read_utf8(source.substr(at)).bytes;
    if (length == 0) return true;
    at += length;
  }
  return false;
}

}  // namespace frontend
