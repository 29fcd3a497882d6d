#include "tools/common/refusal_text.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/joined.h"
#include "base/visible_text.h"
#include "tools/common/files.h"
#include "tools/common/json.h"

namespace tools {
namespace {

constexpr size_t kLongestLine = 150;

// The number that `text` has at `at`, which goes after it and the `:` there.
std::optional<uint32_t> number_and_colon(std::string_view text, size_t& at) {
  uint32_t value = 0;
  const size_t begin = at;
  while (at < text.size() && text[at] >= '0' && text[at] <= '9' && at - begin < 9) {
    value = value * 10 + static_cast<uint32_t>(text[at++] - '0');
  }
  if (at == begin || at == text.size() || text[at] != ':') return std::nullopt;
  ++at;
  return value;
}

// "FILE:LINE:COLUMN: TEXT", as toml_error() writes it.
bool take_place(std::string_view text, Refused& out) {
  for (size_t colon = text.find(':'); colon != std::string_view::npos;
       colon = text.find(':', colon + 1)) {
    size_t at = colon + 1;
    const auto line = number_and_colon(text, at);
    const auto column = line ? number_and_colon(text, at) : std::nullopt;
    if (!column || at >= text.size() || text[at] != ' ') continue;
    out.file = text.substr(0, colon);
    out.line = *line;
    out.column = *column;
    out.text = text.substr(at + 1);
    return true;
  }
  return false;
}

// How long the key or the value at `begin` is.
size_t length_of(std::string_view line, size_t begin) {
  if (begin >= line.size()) return 1;
  size_t end = begin + 1;
  if (line[begin] == '"') {
    while (end < line.size() && line[end] != '"') end += line[end] == '\\' ? 2 : 1;
    ++end;
  } else {
    end = std::min(line.find_first_of(" \t=,#[]\"\r", begin), line.size());
  }
  return std::max<size_t>(std::min(end, line.size()) - begin, 1);
}

void take_line(Refused& out) {
  base::Result<std::string> text = read_text(out.file, 1 << 20);
  if (!text.ok()) return;
  size_t begin = 0;
  for (uint32_t line = 1; line < out.line; ++line) {
    const size_t end = text->find('\n', begin);
    if (end == std::string::npos) return;
    begin = end + 1;
  }
  out.line_text = text->substr(begin, text->find('\n', begin) - begin);
  if (out.line_text.ends_with('\r')) out.line_text.pop_back();
  const size_t length = length_of(out.line_text, out.column - 1);
  out.end_column = out.column + static_cast<uint32_t>(length);
}

class Writer {
 public:
  explicit Writer(bool colour) : colour_(colour) {}
  void say(std::initializer_list<std::string_view> parts) { out_ += base::joined(parts); }
  void paint(const char* colour, std::string_view text) {
    if (colour_) say({"\033[", colour, "m"});
    out_ += text;
    if (colour_) say({"\033[0m"});
  }
  std::string take() { return std::move(out_); }

 private:
  bool colour_;
  std::string out_;
};

// The line and a caret below its place, when the line is no longer than a terminal is wide. Tabs
// stay, so that the caret stands where it should.
void snippet(const Refused& what, Writer& out) {
  if (what.end_column == 0 || what.line_text.size() > kLongestLine) return;
  std::string number = std::to_string(what.line);
  number.insert(0, number.size() < 5 ? 5 - number.size() : 0, ' ');
  std::string shown = what.line_text;
  std::string indent;
  for (size_t i = 0; i < shown.size(); ++i) {
    const auto byte = static_cast<uint8_t>(shown[i]);
    if (i + 1 < what.column && (byte & 0xC0) != 0x80) indent += byte == '\t' ? '\t' : ' ';
    if ((byte < 0x20 && byte != '\t') || byte == 0x7F) shown[i] = '?';
  }
  out.paint("34", number + " |");
  out.say({" ", shown, "\n"});
  out.paint("34", std::string(number.size(), ' ') + " |");
  out.say({" ", indent});
  out.paint("1;31", '^' + std::string(what.end_column - what.column - 1, '~'));
  out.say({"\n"});
}

}  // namespace

Refused refused(const base::Error& error) {
  Refused out{base::refusal_code(error.refusal),
              error.text,
              base::refusal_help(error.refusal),
              {},
              0,
              0,
              0,
              {}};
  const bool of_settings =
      error.refusal == base::Refusal::kBadProject || error.refusal == base::Refusal::kBadMapping;
  if (of_settings && take_place(error.text, out)) take_line(out);
  return out;
}

std::string refusal_text(std::string_view tool, const base::Error& error, bool colour) {
  const Refused what = refused(error);
  const std::string text = base::visible_lines(what.text);
  Writer out(colour);
  if (what.file.empty()) {
    out.say({tool, ": ", what.code, ": ", text, "\n"});
    if (error.refusal != base::Refusal::kSourceErrors) out.say({"  help: ", what.help, "\n"});
    return out.take();
  }
  out.paint("1", base::joined({base::visible(what.file), ":", std::to_string(what.line), ":",
                               std::to_string(what.column), ":"}));
  out.say({" "});
  out.paint("1;31", base::joined({"error[", what.code, "]"}));
  out.say({": "});
  out.paint("1", text);
  out.say({"\n"});
  snippet(what, out);
  out.say({"   help: ", what.help, "\n"});
  return out.take();
}

std::string refusal_json(const base::Error& error) {
  const Refused what = refused(error);
  JsonWriter json;
  json.begin_object().key("diagnostics").begin_array().begin_object();
  json.field("code", what.code).field("severity", "error").field("message", what.text);
  json.field("fix", what.help);
  if (!what.file.empty()) {
    json.field("file", what.file).field("line", what.line).field("column", what.column);
    json.field("endLine", what.line);
    json.field("endColumn", std::max(what.end_column, what.column + 1));
  }
  json.key("notes").begin_array().end_array().end_object().end_array();
  json.field("errors", 1).field("warnings", 0).field("notes", 0).end_object();
  return json.finish();
}

}  // namespace tools
