// Bodies and conditions by language.
#include <algorithm>

#include "adapters/plcopen/drawing.h"
#include "adapters/plcopen/reader.h"
#include "base/name_case.h"
#include "frontend/lex/characters.h"

namespace plcopen {
namespace {

bool is_language(Node node) {
  for (const char* name : {"ST", "IL", "LD", "FBD", "SFC"}) {
    if (xml::is(node, name)) return true;
  }
  return false;
}

std::string failed(Node node, const std::string& text, Reporter& report,
                   const char* fix = "write it in ST, ladder or FBD where it was made") {
  report.add(Code::kXmlBody, node, text, fix);
  return error_text(text);
}

// CODESYS keeps bodies in CFC and others beside an empty <ST>.
Node body_in_data(Node add) {
  for (Node data : xml::children(add, "data")) {
    if (is_vendor(data, "cfc") || xml::child(data, "CFC")) return data;
  }
  return {};
}

// The first word of a pragma, in small letters.
std::string pragma_word(std::string_view pragma) {
  std::string word;
  for (char c : xml::trimmed(pragma)) {
    if (!frontend::is_name_part(c)) break;
    word += static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
  }
  return word;
}

// Beremiz and OpenPLC take a pragma that is no such word for C, and run it.
bool is_code(std::string_view pragma) {
  static constexpr std::string_view kWords[] = {
      "attribute", "if",   "elsif",  "else",    "end_if",      "define", "undefine", "region",
      "endregion", "info", "text",   "warning", "error",       "flow",   "analysis", "implicit",
      "library",   "nobp", "noflow", "bp",      "messageguid", "stop",   "ignore"};
  const bool statement = pragma.find(';') != std::string_view::npos;
  return statement && std::ranges::find(kWords, pragma_word(pragma)) == std::end(kWords);
}

void report_code(std::string_view text, Node node, Reporter& report) {
  for (size_t at = 0; at < text.size(); ++at) {
    const std::string_view rest = text.substr(at);
    const char first = text[at];
    const bool comment = rest.starts_with("(*");
    if (!comment && !rest.starts_with("//") && first != '\'' && first != '"' && first != '{') {
      continue;
    }
    const std::string_view close = comment ? "*)" : first == '/' ? "\n" : first == '{' ? "}" : "";
    const size_t end =
        text.find(close.empty() ? std::string_view(&first, 1) : close, at + (comment ? 2 : 1));
    if (end == std::string_view::npos) return;
    const std::string_view inside = text.substr(at + 1, end - at - 1);
    if (first == '{' && is_code(inside)) {
      report.add(Code::kXmlNotUnderstood, node,
                 "a pragma has code in another language, which does not run here: {" +
                     std::string(inside.substr(0, 40)) + (inside.size() > 40 ? "...}" : "}"));
    }
    at = end + close.size() - (close.empty() ? 0 : 1);
  }
}

}  // namespace

std::string error_text(const std::string& text) {
  std::string safe = text;
  for (char& c : safe) {
    if (c == '\'' || c == '"' || c == '{' || c == '}' || c == '$' || c == '\n') c = ' ';
  }
  return "{error '" + safe + "'}\n";
}

std::string language_text(Node body, Node owner, const std::string& name, Reporter& report) {
  std::string out;
  std::string_view language;
  for (Node node : xml::children(body)) {
    const std::string_view kind = xml::local_name(node);
    if (kind == "documentation") {
      out += xml::comment(xml::text_of(node), "");
    } else if (Node cfc = kind == "addData" ? body_in_data(node) : Node()) {
      out += failed(cfc, "the body of " + name + " is in CFC, which does not come in", report);
    } else if (kind == "addData") {
      for (Node data : xml::children(node, "data")) report_data(data, report);
    } else if (!is_language(node)) {
      out += failed(node,
                    "the body of " + name + " is in <" + std::string(kind) + ">, which is " +
                        "none of ST, IL, LD, FBD, SFC",
                    report);
    } else if (!language.empty() && language != kind) {
      out += failed(node, "the body of " + name + " is in two languages", report);
    } else {
      language = kind;
      if (kind == "ST" || kind == "IL") {
        std::string text = xml::text_of(node);
        if (xml::child(node, "xhtml")) report.out().kept.declares_xhtml = true;
        report_code(text, node, report);
        if (!text.empty()) out += text + "\n";
      } else if (kind == "SFC") {
        out += chart_text(node, owner, report);
      } else {
        out += diagram_text(node, name, report);
      }
    }
  }
  return out;
}

namespace {

// LADDER or FBD, where `text` is a drawing of its own.
std::string_view drawing_word(std::string_view text) {
  for (const std::string_view word : {"LADDER", "FBD"}) {
    const std::string end = "END_" + std::string(word) + "\n";
    if (text.starts_with(std::string(word) + "\n") && text.ends_with(end)) return word;
  }
  return {};
}

}  // namespace

// Several bodies are worksheets of one: their networks follow each other.
std::string body_text(Node owner, const std::string& name, Reporter& report) {
  std::string out;
  for (Node body : xml::children(owner, "body")) {
    std::string sheet = language_text(body, owner, name, report);
    const std::string_view before = drawing_word(out);
    const std::string_view word = drawing_word(sheet);
    if (before == word && !word.empty()) {
      out.resize(out.size() - word.size() - std::string_view("END_\n").size());
      sheet.erase(0, word.size() + 1);
    } else if ((!before.empty() || !word.empty()) && !out.empty() && !sheet.empty()) {
      sheet = failed(body, "the worksheets of " + name + " are in two languages", report);
    }
    out += sheet;
  }
  return out;
}

namespace {

// `name := a AND b;`, `:= a AND b`, `a AND b` -> a AND b. Empty: these are statements.
std::string expression_of(std::string_view text, const std::string& name) {
  text = xml::trimmed(text);
  if (!name.empty() && text.size() > name.size() &&
      base::same_name(text.substr(0, name.size()), name)) {
    std::string_view rest = xml::trimmed(text.substr(name.size()));
    if (rest.starts_with(":=")) text = rest;
  }
  if (text.starts_with(":=")) text = xml::trimmed(text.substr(2));
  while (text.ends_with(";")) text = xml::trimmed(text.substr(0, text.size() - 1));
  if (text.find(';') != std::string_view::npos || text.find(":=") != std::string_view::npos) {
    return {};
  }
  return std::string(text);
}

}  // namespace

std::string statements_of_condition(Node body, const std::string& name) {
  const Node st = xml::child(body, "ST");
  const std::string text = xml::text_of(st);
  if (!st || name.empty() || !expression_of(text, name).empty()) return {};
  const std::string folded = base::fold_name(text);
  const std::string wanted = base::fold_name(name);
  for (size_t at = folded.find(wanted); at != std::string::npos; at = folded.find(wanted, at + 1)) {
    const bool begins = at == 0 || !frontend::is_name_part(folded[at - 1]);
    const std::string_view rest = std::string_view(folded).substr(at + wanted.size());
    if (begins && xml::trimmed(rest).starts_with(":=")) return text + "\n";
  }
  return {};
}

std::string condition_text(Node body, const std::string& name, Reporter& report) {
  for (Node node : xml::children(body)) {
    if (xml::is(node, "IL")) return ":\n" + xml::indented(xml::text_of(node), kIndent);
    if (xml::is(node, "ST")) {
      std::string text = expression_of(xml::text_of(node), name);
      const bool open = text.find("//") != std::string::npos;  // a comment ends with its line
      if (!text.empty()) return " := " + text + (open ? "\n;\n" : ";\n");
      return failed(node, "the condition is no single expression", report);
    }
    if (xml::is(node, "LD") || xml::is(node, "FBD")) {
      std::string text = diagram_condition(node, name, report);
      return text.empty() ? error_text("the condition was not imported") : " := " + text + ";\n";
    }
    if (is_language(node)) return failed(node, "the condition is a chart", report);
  }
  return failed(body, "a transition has no condition", report);
}

}  // namespace plcopen
