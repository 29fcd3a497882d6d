// The form for people:
//
//   pump.st:4:12: error[E1002]: `;` is missing after this statement
//      4 |   speed := 5
//        |             ^
//      help: write `;` here
#include <algorithm>

#include "base/diagnostics_render.h"

namespace base {

namespace {

constexpr uint32_t kWindow = 150;  // characters of a source line that are shown
constexpr std::string_view kBold = "\033[1m";
constexpr std::string_view kReset = "\033[0m";
constexpr std::string_view kGreen = "\033[32m";
constexpr std::string_view kBlue = "\033[34m";

class TextWriter {
 public:
  TextWriter(const SourceMap& sources, bool colour) : sources_(sources), colour_(colour) {}

  void write(const Diagnostic& diagnostic) {
    const DiagnosticRow& row = diagnostic_row(diagnostic.code);
    place(diagnostic.span);
    std::string label(severity_name(diagnostic.severity));
    paint(severity_colour(diagnostic.severity), label + '[' + std::string(row.code) + ']');
    out_ += ": ";
    paint(kBold, printable(diagnostic.text));
    out_ += '\n';
    snippet(diagnostic.span, severity_colour(diagnostic.severity));
    for (const DiagnosticNote& note : diagnostic.notes) {
      place(note.span);
      paint(kBlue, "note");
      out_ += ": " + printable(note.text) + '\n';
      snippet(note.span, kBlue);
    }
    if (diagnostic.fix.empty()) return;
    out_ += "   ";
    paint(kGreen, "help");
    out_ += ": " + printable(diagnostic.fix) + '\n';
  }

  void summary(uint32_t errors, uint32_t warnings, uint32_t notes, size_t shown) {
    if (errors + warnings + notes == 0) return;
    out_ += counted(errors, "error");
    if (warnings != 0) out_ += ", " + counted(warnings, "warning");
    if (notes != 0) out_ += ", " + counted(notes, "note");
    if (shown < static_cast<size_t>(errors) + warnings + notes) {
      out_ += " (" + std::to_string(shown) + " shown)";
    }
    out_ += '\n';
  }

  std::string take() { return std::move(out_); }

 private:
  static std::string_view severity_colour(Severity severity) {
    return severity == Severity::kError ? "\033[1;31m" : "\033[1;35m";
  }

  static std::string counted(uint32_t n, const char* what) {
    return std::to_string(n) + ' ' + what + (n == 1 ? "" : "s");
  }

  void paint(std::string_view colour, std::string_view text) {
    if (colour_) out_ += colour;
    out_ += text;
    if (colour_) out_ += kReset;
  }

  void place(SourceSpan span) {
    Region region = region_of(sources_, span);
    if (region.line == 0) return;
    paint(kBold, printable(region.file) + ':' + std::to_string(region.line) + ':' +
                     std::to_string(region.column) + ':');
    out_ += ' ';
  }

  // One source line, windowed around the caret so that no line floods a terminal.
  void snippet(SourceSpan span, std::string_view colour) {
    SourceLocation at = sources_.locate(span.begin);
    if (at.line == 0) return;
    size_t begin = std::min<size_t>(at.column - 1, at.line_text.size());
    size_t room = at.line_text.size() - begin;
    size_t length =
        span.end.valid() && span.end > span.begin ? span.end.offset - span.begin.offset : 1;
    length = std::max<size_t>(1, std::min({length, room, size_t{kWindow}}));
    size_t from = begin > kWindow * 2 / 3 ? begin - kWindow / 2 : 0;
    std::string_view shown = at.line_text.substr(from, kWindow + length);
    std::string number = std::to_string(at.line);
    number.insert(0, number.size() < 5 ? 5 - number.size() : 0, ' ');
    paint(kBlue, number + " |");
    out_ += ' ' + printable_line(shown) + '\n';
    paint(kBlue, std::string(number.size(), ' ') + " |");
    out_ += ' ' + indent(printable_line(at.line_text.substr(from, begin - from)));
    uint32_t carets = character_count(printable_line(at.line_text.substr(begin, length)));
    paint(colour, '^' + std::string(std::max(carets, 1u) - 1, '~'));
    out_ += '\n';
  }

  static std::string printable_line(std::string_view text) {
    std::string out;
    for (size_t at = 0; at <= text.size();) {  // tabs stay, so that carets line up
      size_t tab = std::min(text.find('\t', at), text.size());
      out += printable(text.substr(at, tab - at));
      if (tab < text.size()) out += '\t';
      at = tab + 1;
    }
    return out;
  }

  static std::string indent(std::string_view before) {
    std::string out;
    for (size_t at = 0; at < before.size(); at += character_bytes(before, at)) {
      out += before[at] == '\t' ? '\t' : ' ';
    }
    return out;
  }

  const SourceMap& sources_;
  bool colour_;
  std::string out_;
};

}  // namespace

std::string render_text(const Diagnostics& diagnostics, const SourceMap& sources, bool colour) {
  TextWriter writer(sources, colour);
  for (const Diagnostic& diagnostic : diagnostics.all()) writer.write(diagnostic);
  writer.summary(diagnostics.error_count(), diagnostics.warning_count(), diagnostics.note_count(),
                 diagnostics.all().size());
  return writer.take();
}

}  // namespace base
