#include "base/diagnostics_render.h"

#include "base/visible_text.h"

namespace base {

namespace {

bool continues(std::string_view bytes, size_t at) {
  return at < bytes.size() && (static_cast<uint8_t>(bytes[at]) & 0xC0) == 0x80;
}

void append_latin1(std::string& out, uint8_t byte) {
  out += static_cast<char>(0xC0 | (byte >> 6));
  out += static_cast<char>(0x80 | (byte & 0x3F));
}

// Overlong forms, surrogates and code points above U+10FFFF are not UTF-8.
bool second_byte_fits(uint8_t lead, uint8_t second) {
  if (lead == 0xE0) return second >= 0xA0;
  if (lead == 0xED) return second < 0xA0;
  if (lead == 0xF0) return second >= 0x90;
  if (lead == 0xF4) return second < 0x90;
  return true;
}

uint32_t column_of(const SourceLocation& at) {
  return character_count(at.line_text.substr(0, at.column - 1)) + 1;
}

}  // namespace

std::string render(const Diagnostics& diagnostics, const SourceMap& sources,
                   DiagnosticFormat format, bool colour) {
  switch (format) {
    case DiagnosticFormat::kText:
      return render_text(diagnostics, sources, colour);
    case DiagnosticFormat::kJson:
      return render_json(diagnostics, sources);
    case DiagnosticFormat::kSarif:
      return render_sarif(diagnostics, sources);
    case DiagnosticFormat::kGithub:
      return render_github(diagnostics, sources);
  }
  return {};
}

std::string_view severity_name(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    case Severity::kNote:
      return "note";
  }
  return "error";
}

uint32_t character_bytes(std::string_view bytes, size_t at) {
  auto lead = static_cast<uint8_t>(bytes[at]);
  uint32_t length = lead < 0xC2 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF5 ? 4 : 1;
  for (uint32_t i = 1; i < length; ++i) {
    if (!continues(bytes, at + i)) return 1;
  }
  if (length > 1 && !second_byte_fits(lead, static_cast<uint8_t>(bytes[at + 1]))) return 1;
  return length;
}

uint32_t character_count(std::string_view bytes) {
  uint32_t count = 0;
  for (size_t at = 0; at < bytes.size(); at += character_bytes(bytes, at)) ++count;
  return count;
}

std::string printable(std::string_view bytes) {
  std::string out;
  out.reserve(bytes.size());
  for (size_t at = 0; at < bytes.size();) {
    uint32_t length = character_bytes(bytes, at);
    auto byte = static_cast<uint8_t>(bytes[at]);
    bool control = byte < 0x20 || byte == 0x7F;
    // C1 controls, in either encoding, steer terminals too.
    bool c1 = (length == 1 && byte >= 0x80 && byte < 0xA0) ||
              (length == 2 && byte == 0xC2 && static_cast<uint8_t>(bytes[at + 1]) < 0xA0);
    if ((control && byte != '\n') || c1) {
      out += '?';
    } else if (length == 1 && byte >= 0x80) {
      append_latin1(out, byte);
    } else if (const uint32_t turns = length > 1 ? direction_control(bytes.substr(at)) : 0) {
      out += code_point_text(turns);
    } else {
      out += bytes.substr(at, length);
    }
    at += length;
  }
  return out;
}

std::string json_string(std::string_view bytes) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  for (size_t at = 0; at < bytes.size();) {
    uint32_t length = character_bytes(bytes, at);
    auto byte = static_cast<uint8_t>(bytes[at]);
    if (byte == '"' || byte == '\\') {
      out += '\\';
      out += static_cast<char>(byte);
    } else if (byte == '\n') {
      out += "\\n";
    } else if (byte < 0x20 || byte == 0x7F) {
      out += "\\u00";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    } else if (length == 1 && byte >= 0x80) {
      append_latin1(out, byte);
    } else {
      out += bytes.substr(at, length);
    }
    at += length;
  }
  return out + '"';
}

Region region_of(const SourceMap& sources, SourceSpan span) {
  SourceLocation begin = sources.locate(span.begin);
  if (begin.line == 0) return {};
  Region region{begin.file, begin.line, column_of(begin), begin.line, column_of(begin) + 1};
  if (!span.end.valid() || span.end <= span.begin) return region;
  SourceLocation end = sources.locate(span.end);
  if (end.line == 0 || end.file != begin.file) return region;
  region.end_line = end.line;
  region.end_column = column_of(end);
  return region;
}

}  // namespace base
