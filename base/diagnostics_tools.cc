// The forms for other programs: JSON, SARIF 2.1.0, GitHub workflow commands.
// Lines and columns are 1-based, columns count characters, ends are exclusive.
#include <algorithm>
#include <set>

#include "base/diagnostics_render.h"

namespace base {

namespace {

std::string number_field(const char* name, uint32_t value) {
  return std::string(",\"") + name + "\":" + std::to_string(value);
}

std::string json_place(const SourceMap& sources, SourceSpan span) {
  Region region = region_of(sources, span);
  return "\"file\":" + json_string(region.file) + number_field("line", region.line) +
         number_field("column", region.column) + number_field("endLine", region.end_line) +
         number_field("endColumn", region.end_column);
}

std::string json_entry(const Diagnostic& diagnostic, const SourceMap& sources) {
  const DiagnosticRow& row = diagnostic_row(diagnostic.code);
  std::string out = "{\"code\":" + json_string(row.code) +
                    ",\"severity\":" + json_string(severity_name(row.severity)) +
                    ",\"message\":" + json_string(diagnostic.text);
  if (!diagnostic.fix.empty()) out += ",\"fix\":" + json_string(diagnostic.fix);
  out += ',' + json_place(sources, diagnostic.span) + ",\"notes\":[";
  for (size_t i = 0; i < diagnostic.notes.size(); ++i) {
    const DiagnosticNote& note = diagnostic.notes[i];
    out += (i == 0 ? "{" : ",{") + std::string("\"message\":") + json_string(note.text) + ',' +
           json_place(sources, note.span) + '}';
  }
  return out + "]}";
}

std::string sarif_message(std::string_view text) {
  return "\"message\":{\"text\":" + json_string(text) + '}';
}

// A URI reference: everything but unreserved characters and `/` is percent-encoded, so that no
// colon of a relative path looks like a scheme. An absolute path becomes a file URI.
std::string uri(std::string_view path) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  static constexpr std::string_view kPlain = "-._~/";
  std::string out = path.starts_with('/') ? "file://" : "";
  for (char c : path) {
    auto byte = static_cast<uint8_t>(c);
    bool letter = (byte | 0x20) >= 'a' && (byte | 0x20) <= 'z';
    if (letter || (byte >= '0' && byte <= '9') || kPlain.find(c) != std::string_view::npos) {
      out += c;
    } else {
      out += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return out;
}

std::string sarif_location(const SourceMap& sources, SourceSpan span) {
  Region region = region_of(sources, span);
  return "\"physicalLocation\":{\"artifactLocation\":{\"uri\":" + json_string(uri(region.file)) +
         "},\"region\":{\"startLine\":" + std::to_string(region.line) +
         number_field("startColumn", region.column) + number_field("endLine", region.end_line) +
         number_field("endColumn", region.end_column) + "}}";
}

// The rules that occur, in the registry's order.
using Rules = std::vector<DiagnosticCode>;

Rules rules_of(const Diagnostics& diagnostics) {
  std::set<DiagnosticCode> used;
  for (const Diagnostic& diagnostic : diagnostics.all()) used.insert(diagnostic.code);
  return {used.begin(), used.end()};
}

size_t rule_index(const Rules& rules, DiagnosticCode code) {
  return static_cast<size_t>(std::lower_bound(rules.begin(), rules.end(), code) - rules.begin());
}

std::string sarif_result(const Diagnostic& diagnostic, const SourceMap& sources,
                         const Rules& rules) {
  const DiagnosticRow& row = diagnostic_row(diagnostic.code);
  std::string text = diagnostic.text;
  if (!diagnostic.fix.empty()) text += " (" + diagnostic.fix + ')';
  std::string out = "{\"ruleId\":" + json_string(row.code) +
                    ",\"ruleIndex\":" + std::to_string(rule_index(rules, diagnostic.code)) +
                    ",\"level\":" + json_string(severity_name(row.severity)) + ',' +
                    sarif_message(text);
  if (region_of(sources, diagnostic.span).line != 0) {
    out += ",\"locations\":[{" + sarif_location(sources, diagnostic.span) + "}]";
  }
  std::string related;
  for (const DiagnosticNote& note : diagnostic.notes) {
    if (region_of(sources, note.span).line == 0) continue;
    related += (related.empty() ? "{" : ",{") + sarif_location(sources, note.span) + ',' +
               sarif_message(note.text) + '}';
  }
  if (!related.empty()) out += ",\"relatedLocations\":[" + related + ']';
  return out + '}';
}

std::string sarif_rules(const Rules& rules) {
  std::string out;
  for (DiagnosticCode code : rules) {
    const DiagnosticRow& row = diagnostic_row(code);
    out += (out.empty() ? "{" : ",{") + std::string("\"id\":") + json_string(row.code) +
           ",\"shortDescription\":{\"text\":" + json_string(row.title) +
           "},\"help\":{\"text\":" + json_string(row.help) + "}}";
  }
  return out;
}

std::string github_escape(std::string_view text, bool property) {
  std::string out;
  for (char c : printable(text)) {
    if (c == '%' || c == '\n' || (property && (c == ':' || c == ','))) {
      out += c == '%' ? "%25" : c == '\n' ? "%0A" : c == ':' ? "%3A" : "%2C";
    } else {
      out += c;
    }
  }
  return out;
}

std::string github_line(const Diagnostic& diagnostic, const SourceMap& sources) {
  const DiagnosticRow& row = diagnostic_row(diagnostic.code);
  Region region = region_of(sources, diagnostic.span);
  std::string out = "::" + std::string(severity_name(row.severity)) + ' ';
  if (region.line != 0) {
    out += "file=" + github_escape(region.file, true) + ",line=" + std::to_string(region.line) +
           ",endLine=" + std::to_string(region.end_line) + ",col=" + std::to_string(region.column) +
           ",endColumn=" + std::to_string(region.end_column) + ',';
  }
  std::string text = diagnostic.text;
  if (!diagnostic.fix.empty()) text += "\nhelp: " + diagnostic.fix;
  return out + "title=" + std::string(row.code) + "::" + github_escape(text, false) + '\n';
}

}  // namespace

std::string render_json(const Diagnostics& diagnostics, const SourceMap& sources) {
  std::string out = "{\"diagnostics\":[";
  const char* separator = "\n";
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    out += separator + json_entry(diagnostic, sources);
    separator = ",\n";
  }
  return out + "\n],\"errors\":" + std::to_string(diagnostics.error_count()) +
         ",\"warnings\":" + std::to_string(diagnostics.warning_count()) + "}\n";
}

std::string render_sarif(const Diagnostics& diagnostics, const SourceMap& sources) {
  Rules rules = rules_of(diagnostics);
  std::string out =
      "{\"$schema\":\"https://json.schemastore.org/sarif-2.1.0.json\",\"version\":\"2.1.0\","
      "\"runs\":[{\"tool\":{\"driver\":{\"name\":\"stc\",\"rules\":[" +
      sarif_rules(rules) + "]}},\"columnKind\":\"unicodeCodePoints\",\"results\":[";
  const char* separator = "\n";
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    out += separator + sarif_result(diagnostic, sources, rules);
    separator = ",\n";
  }
  return out + "\n]}]}\n";
}

std::string render_github(const Diagnostics& diagnostics, const SourceMap& sources) {
  std::string out;
  for (const Diagnostic& diagnostic : diagnostics.all()) out += github_line(diagnostic, sources);
  return out;
}

}  // namespace base
