// The forms for other programs: JSON, SARIF 2.1.0, GitHub workflow commands.
// Lines and columns are 1-based, columns count characters, ends are exclusive.
#include <algorithm>
#include <map>
#include <set>

#include "base/diagnostics_render.h"
#include "base/hash.h"
#include "base/sha256.h"

namespace base {

namespace {

std::string number_field(const char* name, uint32_t value) {
  return std::string(",\"") + name + "\":" + std::to_string(value);
}

std::string json_place(const Region& region) {
  return "\"file\":" + json_string(region.file) + number_field("line", region.line) +
         number_field("column", region.column) + number_field("endLine", region.end_line) +
         number_field("endColumn", region.end_column);
}

std::string json_entry(const Diagnostic& diagnostic, const SourceMap& sources) {
  const DiagnosticRow& row = diagnostic_row(diagnostic.code);
  std::string out = "{\"code\":" + json_string(row.code) +
                    ",\"severity\":" + json_string(severity_name(diagnostic.severity)) +
                    ",\"message\":" + json_string(diagnostic.text);
  if (!diagnostic.fix.empty()) out += ",\"fix\":" + json_string(diagnostic.fix);
  const Region region = region_of(sources, diagnostic.span);
  if (region.line != 0) out += ',' + json_place(region);
  out += ",\"notes\":[";
  for (size_t i = 0; i < diagnostic.notes.size(); ++i) {
    const DiagnosticNote& note = diagnostic.notes[i];
    out += (i == 0 ? "{" : ",{") + std::string("\"message\":") + json_string(note.text) + ',' +
           json_place(region_of(sources, note.span)) + '}';
  }
  return out + "]}";
}

std::string json_entry(const RefusedRun& refused) {
  std::string out = "{\"code\":" + json_string(refused.code) +
                    ",\"severity\":\"error\",\"message\":" + json_string(refused.text) +
                    ",\"fix\":" + json_string(refused.help);
  if (refused.region.line != 0) out += ',' + json_place(refused.region);
  return out + ",\"notes\":[]}";
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

// One log: its rules and results refer to each other.
class SarifWriter {
 public:
  SarifWriter(const SourceMap& sources, const RunFacts& run) : sources_(sources), run_(run) {}

  std::string log(const Diagnostics& diagnostics) {
    std::set<DiagnosticCode> used;
    for (const Diagnostic& diagnostic : diagnostics.all()) used.insert(diagnostic.code);
    codes_.assign(used.begin(), used.end());
    std::string out =
        "{\"$schema\":\"https://json.schemastore.org/sarif-2.1.0.json\",\"version\":\"2.1.0\","
        "\"runs\":[{\"tool\":{\"driver\":{\"name\":\"stc\",\"version\":" +
        json_string(run_.version) + ",\"rules\":[" + rules() + "]}},";
    if (!run_.root.empty()) {
      out += "\"originalUriBaseIds\":{\"SRCROOT\":{\"uri\":" +
             json_string(uri(std::string(run_.root) + "/")) + "}},";
    }
    if (const std::string rest = diagnostics.left_out(); !rest.empty()) {
      out +=
          "\"invocations\":[{\"executionSuccessful\":true,\"toolExecutionNotifications\":[{"
          "\"level\":\"warning\"," +
          sarif_message(rest) + "}]}],";
    }
    out += "\"columnKind\":\"unicodeCodePoints\",\"results\":[";
    const char* separator = "\n";
    for (const Diagnostic& diagnostic : diagnostics.all()) {
      out += separator + result(diagnostic);
      separator = ",\n";
    }
    if (run_.refused != nullptr) out += separator + result(*run_.refused);
    return out + "\n]}]}\n";
  }

 private:
  // Relative to the root where it lies below it: a log is read on other machines, too.
  std::string_view from_root(std::string_view file) const {
    const bool below = !run_.root.empty() && file.starts_with(run_.root) &&
                       file.substr(run_.root.size()).starts_with('/');
    return below ? file.substr(run_.root.size() + 1) : file;
  }

  std::string artifact(std::string_view file) const {
    file = from_root(file);
    std::string out = "\"artifactLocation\":{\"uri\":" + json_string(uri(file));
    const bool relative = !file.starts_with('/') && !run_.root.empty();
    return out + (relative ? ",\"uriBaseId\":\"SRCROOT\"}" : "}");
  }

  std::string location(const Region& region) const {
    return "\"physicalLocation\":{" + artifact(region.file) +
           ",\"region\":{\"startLine\":" + std::to_string(region.line) +
           number_field("startColumn", region.column) + number_field("endLine", region.end_line) +
           number_field("endColumn", region.end_column) + "}}";
  }

  std::string rule(std::string_view code, std::string_view title, std::string_view help) const {
    std::string out = "{\"id\":" + json_string(code) +
                      ",\"shortDescription\":{\"text\":" + json_string(title) + "},";
    if (!run_.documentation.empty()) {
      out +=
          "\"helpUri\":" + json_string(std::string(run_.documentation) + "/" + std::string(code)) +
          ",";
    }
    return out + "\"help\":{\"text\":" + json_string(help) + "}}";
  }

  // The codes that occur, in the registry's order; a refusal is the last.
  std::string rules() const {
    std::string out;
    for (DiagnosticCode code : codes_) {
      const DiagnosticRow& row = diagnostic_row(code);
      out += (out.empty() ? "" : ",") + rule(row.code, row.title, diagnostic_page(code));
    }
    if (run_.refused == nullptr) return out;
    return out + (out.empty() ? "" : ",") +
           rule(run_.refused->code, run_.refused->title, run_.refused->help);
  }

  size_t rule_index(DiagnosticCode code) const {
    return static_cast<size_t>(std::lower_bound(codes_.begin(), codes_.end(), code) -
                               codes_.begin());
  }

  // The same result has the same fingerprint when lines above it come and go: it is made of the
  // rule, the file, the line as it stands and, of equal ones, a number.
  std::string fingerprint(std::string_view code, const Region& region, std::string_view line) {
    const size_t first = std::min(line.find_first_not_of(" \t"), line.size());
    const std::string what = std::string(code) + '\n' + std::string(from_root(region.file)) + '\n' +
                             std::string(line.substr(first));
    const auto bytes = reinterpret_cast<const uint8_t*>(what.data());
    const std::string hash = to_hex(sha256({bytes, what.size()})).substr(0, 16);
    return ",\"partialFingerprints\":{\"lineOfCode/v1\":\"" + hash + ":" +
           std::to_string(++seen_[hash]) + "\"}";
  }

  std::string head(std::string_view code, size_t index, std::string_view level,
                   const std::string& text) const {
    return "{\"ruleId\":" + json_string(code) + ",\"ruleIndex\":" + std::to_string(index) +
           ",\"level\":" + json_string(level) + ',' + sarif_message(text);
  }

  std::string result(const Diagnostic& diagnostic) {
    const DiagnosticRow& row = diagnostic_row(diagnostic.code);
    std::string text = diagnostic.text;
    if (!diagnostic.fix.empty()) text += " (" + diagnostic.fix + ')';
    std::string out =
        head(row.code, rule_index(diagnostic.code), severity_name(diagnostic.severity), text);
    const Region region = region_of(sources_, diagnostic.span);
    if (region.line != 0) {
      out += ",\"locations\":[{" + location(region) + "}]";
      out += fingerprint(row.code, region, sources_.locate(diagnostic.span.begin).line_text);
    }
    std::string related;
    for (const DiagnosticNote& note : diagnostic.notes) {
      const Region place = region_of(sources_, note.span);
      if (place.line == 0) continue;
      related +=
          (related.empty() ? "{" : ",{") + location(place) + ',' + sarif_message(note.text) + '}';
    }
    if (!related.empty()) out += ",\"relatedLocations\":[" + related + ']';
    return out + '}';
  }

  std::string result(const RefusedRun& refused) {
    std::string out = head(refused.code, codes_.size(), "error",
                           std::string(refused.text) + " (" + std::string(refused.help) + ')');
    if (refused.region.line != 0) {
      out += ",\"locations\":[{" + location(refused.region) + "}]" +
             fingerprint(refused.code, refused.region, refused.text);
    }
    return out + '}';
  }

  const SourceMap& sources_;
  const RunFacts& run_;
  std::vector<DiagnosticCode> codes_;
  std::map<std::string, int> seen_;
};

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

std::string github_line(std::string_view code, std::string_view level, const Region& region,
                        const std::string& text) {
  std::string out = "::" + std::string(level == "note" ? "notice" : level) + ' ';
  if (region.line != 0) {
    out += "file=" + github_escape(region.file, true) + ",line=" + std::to_string(region.line) +
           ",endLine=" + std::to_string(region.end_line) + ",col=" + std::to_string(region.column) +
           ",endColumn=" + std::to_string(region.end_column) + ',';
  }
  return out + "title=" + std::string(code) + "::" + github_escape(text, false) + '\n';
}

std::string with_help(std::string_view text, std::string_view help) {
  return std::string(text) + (help.empty() ? "" : "\nhelp: " + std::string(help));
}

}  // namespace

std::string render_json(const Diagnostics& diagnostics, const SourceMap& sources,
                        const RunFacts& run) {
  std::string out = "{\"diagnostics\":[";
  const char* separator = "\n";
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    out += separator + json_entry(diagnostic, sources);
    separator = ",\n";
  }
  if (run.refused != nullptr) out += separator + json_entry(*run.refused);
  const uint32_t errors = diagnostics.error_count() + (run.refused != nullptr ? 1 : 0);
  return out + "\n],\"errors\":" + std::to_string(errors) +
         ",\"warnings\":" + std::to_string(diagnostics.warning_count()) +
         ",\"notes\":" + std::to_string(diagnostics.note_count()) + "}\n";
}

std::string render_sarif(const Diagnostics& diagnostics, const SourceMap& sources,
                         const RunFacts& run) {
  return SarifWriter(sources, run).log(diagnostics);
}

std::string render_github(const Diagnostics& diagnostics, const SourceMap& sources,
                          const RunFacts& run) {
  std::string out;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    const DiagnosticRow& row = diagnostic_row(diagnostic.code);
    out += github_line(row.code, severity_name(diagnostic.severity),
                       region_of(sources, diagnostic.span),
                       with_help(diagnostic.text, diagnostic.fix));
  }
  if (const std::string rest = diagnostics.left_out(); !rest.empty()) {
    out += github_line("stc", "warning", {}, rest);
  }
  if (run.refused == nullptr) return out;
  return out + github_line(run.refused->code, "error", run.refused->region,
                           with_help(run.refused->text, run.refused->help));
}

}  // namespace base
