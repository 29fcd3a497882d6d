// Bytes of an XML document -> UTF-8.
#include <algorithm>
#include <cctype>

#include "adapters/xml/document.h"
#include "base/diagnostics_render.h"
#include "base/windows_1252.h"

namespace xml {
namespace {

void append(std::string& out, uint32_t code) {
  auto byte = [&out](uint32_t value) { out += static_cast<char>(value); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xC0 | code >> 6);
  } else {
    if (code < 0x10000) {
      byte(0xE0 | code >> 12);
    } else {
      byte(0xF0 | code >> 18);
      byte(0x80 | (code >> 12 & 0x3F));
    }
    byte(0x80 | (code >> 6 & 0x3F));
  }
  byte(0x80 | (code & 0x3F));
}

Decoded from_latin(std::string_view bytes, bool windows) {
  Decoded out;
  out.text.reserve(bytes.size());
  for (char c : bytes) {
    const auto byte = static_cast<uint8_t>(c);
    append(out.text, windows ? base::of_windows_1252(byte) : byte);
  }
  return out;
}

Decoded from_utf16(std::string_view bytes, bool big) {
  Decoded out;
  out.text.reserve(bytes.size());
  auto unit = [&](size_t at) {
    uint32_t first = static_cast<uint8_t>(bytes[at]);
    uint32_t second = static_cast<uint8_t>(bytes[at + 1]);
    return big ? first << 8 | second : second << 8 | first;
  };
  for (size_t at = 0; at < bytes.size(); at += 2) {
    const bool whole = at + 1 < bytes.size();
    uint32_t code = whole ? unit(at) : 0xD800;
    if (code >= 0xD800 && code < 0xDC00 && at + 3 < bytes.size()) {
      uint32_t low = unit(at + 2);
      if (low >= 0xDC00 && low < 0xE000) {
        code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
        at += 2;
      }
    }
    if (code >= 0xD800 && code < 0xE000) {
      out.error = "byte " + std::to_string(at) + " is no UTF-16";
      return out;
    }
    append(out.text, code);
  }
  return out;
}

Decoded from_utf8(std::string_view bytes) {
  Decoded out;
  for (size_t at = 0; at < bytes.size();) {
    const uint32_t length = base::character_bytes(bytes, at);
    if (length == 1 && static_cast<uint8_t>(bytes[at]) >= 0x80) {
      out.error = "byte " + std::to_string(at) + " is no UTF-8";
      return out;
    }
    at += length;
  }
  out.text = bytes;
  return out;
}

// What the declaration says, in lower case.
std::string declared_encoding(std::string_view bytes) {
  if (!bytes.starts_with("<?xml")) return {};
  std::string_view head = bytes.substr(0, std::min<size_t>(bytes.find("?>"), 512));
  size_t at = head.find("encoding");
  if (at == std::string_view::npos) return {};
  at = head.find_first_of("'\"", at);
  if (at == std::string_view::npos) return {};
  size_t end = head.find(head[at], at + 1);
  if (end == std::string_view::npos) return {};
  std::string out(head.substr(at + 1, end - at - 1));
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

Decoded decode(std::string_view bytes) {
  auto begins = [bytes](const char* with, size_t count) {
    return bytes.starts_with(std::string_view(with, count));
  };
  if (begins("\xFF\xFE\0\0", 4) || begins("\0\0\xFE\xFF", 4)) {
    return {{}, "UTF-32 is not read; save it as UTF-8"};
  }
  if (begins("\xEF\xBB\xBF", 3)) return from_utf8(bytes.substr(3));
  if (begins("\xFF\xFE", 2)) return from_utf16(bytes.substr(2), false);
  if (begins("\xFE\xFF", 2)) return from_utf16(bytes.substr(2), true);
  if (begins("<\0", 2)) return from_utf16(bytes, false);
  if (begins("\0<", 2)) return from_utf16(bytes, true);
  const std::string encoding = declared_encoding(bytes);
  if (encoding == "iso-8859-1" || encoding == "latin1" || encoding == "latin-1") {
    return from_latin(bytes, false);
  }
  if (encoding == "windows-1252" || encoding == "cp1252") return from_latin(bytes, true);
  const bool known = encoding.empty() || encoding == "utf-8" || encoding == "utf8" ||
                     encoding == "us-ascii" || encoding == "ascii" || encoding == "utf-16";
  if (known) return from_utf8(bytes);
  return {{}, "the encoding `" + base::printable(encoding) + "` is not read; save it as UTF-8"};
}

}  // namespace

std::string as_utf8(std::string_view bytes) {
  std::string out;
  for (size_t at = 0; at < bytes.size();) {
    const uint32_t length = base::character_bytes(bytes, at);
    if (length == 1) {
      append(out, base::of_windows_1252(static_cast<uint8_t>(bytes[at])));
    } else {
      out += bytes.substr(at, length);
    }
    at += length;
  }
  return out;
}

std::string text_as_utf8(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  Decoded out = from_utf8(bytes);
  if (!out.error.empty()) out = from_latin(bytes, true);
  std::replace(out.text.begin(), out.text.end(), '\0', ' ');
  return std::move(out.text);
}

Decoded to_utf8(std::string_view bytes) {
  Decoded out = decode(bytes);
  if (!out.error.empty()) return out;
  const size_t zero = out.text.find('\0');
  if (zero != std::string::npos) {
    out.error = "character " + std::to_string(zero) + " is NUL, which no XML holds";
  }
  return out;
}

}  // namespace xml
