// stc xref: what names mean, where they are declared and who uses them.
#include <charconv>
#include <cstdio>
#include <optional>

#include "frontend/questions/compilation.h"
#include "frontend/questions/questions.h"
#include "frontend/sema/names.h"
#include "ir/types/address_text.h"
#include "tools/common/json.h"
#include "tools/stc/commands.h"
#include "tools/stc/session.h"

namespace stc {
namespace {

using frontend::questions::Occurrence;
using frontend::questions::Questions;
using frontend::questions::Role;
using frontend::questions::Signature;
using frontend::questions::Symbol;

constexpr tools::OptionRow kXrefOptions[] = {
    TOOLS_COMPILE_OPTIONS,
    {"--at", "FILE:LINE:COLUMN", "what stands at that place"},
    {"--name", "NAME",
     "what has that name or address: Main.level, Colour#Red, %QX0.1 (default: all)"},
    tools::kFormatOption,
};
constexpr tools::Command kXrefCommand{
    "xref", "[PATHS...]", "Shows what names mean, where they are declared and used.", kXrefOptions};

struct Answer {
  std::vector<const Symbol*> symbols;
  std::optional<frontend::questions::TypedExpression> expression;  // with --at
};

base::Error wrong(const std::string& text) { return {base::Refusal::kUsage, "xref: " + text}; }

std::optional<uint32_t> number_of(std::string_view text) {
  uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// FILE:LINE:COLUMN
base::Result<base::SourcePos> place_of(const Questions& questions, const std::string& text) {
  const size_t last = text.rfind(':');
  const size_t first = last == std::string::npos || last == 0 ? last : text.rfind(':', last - 1);
  if (first == std::string::npos || first == last) {
    return wrong("`--at " + text + "` names no place; write FILE:LINE:COLUMN");
  }
  const auto line = number_of(std::string_view(text).substr(first + 1, last - first - 1));
  const auto column = number_of(std::string_view(text).substr(last + 1));
  if (!line || !column) return wrong("`--at " + text + "`: lines and columns are numbers from 1");
  const base::SourcePos pos = questions.place(text.substr(0, first), *line, *column);
  if (!pos.valid()) return wrong("no file of the project has the place `" + text + "`");
  return pos;
}

base::Result<Answer> answer_of(const tools::Options& options, Questions& questions) {
  Answer answer;
  if (options.has("--at")) {
    auto pos = place_of(questions, options.text("--at"));
    if (!pos.ok()) return pos.error();
    answer.expression = questions.type_at(*pos);
    if (const Symbol* symbol = questions.symbol_at(*pos)) answer.symbols.push_back(symbol);
    if (answer.symbols.empty() && !answer.expression) {
      return wrong("nothing with a name or a type stands at " + options.text("--at"));
    }
  } else if (options.has("--name")) {
    const std::string& name = options.text("--name");
    if (const auto address = ir::parse_address(name)) {
      answer.symbols = questions.symbols_at(*address);
      if (answer.symbols.empty()) return wrong("nothing stands at " + ir::address_text(*address));
      return answer;
    }
    if (const Symbol* symbol = questions.symbol_named(name)) answer.symbols.push_back(symbol);
    if (answer.symbols.empty()) {
      frontend::NearestName nearest(name);
      for (const Symbol& symbol : questions.index().symbols) nearest.offer(symbol.name);
      const std::string fix = nearest.fix();
      return wrong("nothing is named `" + name + "`" + (fix.empty() ? "" : "; " + fix));
    }
  } else {
    for (const Symbol& symbol : questions.index().symbols) answer.symbols.push_back(&symbol);
  }
  return answer;
}

const char* role_word(Role role) {
  switch (role) {
    case Role::kDeclared:
      return "declared";
    case Role::kRead:
      return "read";
    case Role::kWritten:
      return "written";
    case Role::kReadWritten:
      return "read-write";
  }
  return "";
}

std::string place_text(const base::SourceLocation& at) {
  return std::string(at.file) + ':' + std::to_string(at.line) + ':' + std::to_string(at.column);
}

std::string indented(const std::string& text) {
  std::string out = "  ";
  for (const char c : text) {
    out += c;
    if (c == '\n') out += "  ";
  }
  return out + '\n';
}

std::string text_form(Questions& questions, const Answer& answer) {
  std::string out;
  for (const Symbol* symbol : answer.symbols) {
    const Signature signature = questions.signature_of(*symbol);
    if (!out.empty()) out += '\n';
    out += signature.text + '\n';
    if (!signature.documentation.empty()) out += indented(signature.documentation);
    if (symbol->library) out += "  of the standard library\n";
    for (const Occurrence& use : questions.uses_of(*symbol)) {
      out += place_text(questions.locate(use.span.begin)) + ": " + role_word(use.role) + '\n';
    }
  }
  if (answer.expression) {
    out += place_text(questions.locate(answer.expression->span.begin)) + ": expression of type " +
           answer.expression->type + '\n';
  }
  return out;
}

void write_span(tools::JsonWriter& json, const Questions& questions, base::SourceSpan span) {
  const base::SourceLocation begin = questions.locate(span.begin);
  const base::SourceLocation end = questions.locate(span.end);
  json.field("file", begin.file).field("line", begin.line).field("column", begin.column);
  json.field("endLine", end.line).field("endColumn", end.column);
}

void write_symbol(tools::JsonWriter& json, Questions& questions, const Symbol& symbol) {
  const Signature signature = questions.signature_of(symbol);
  json.begin_object();
  json.field("name", symbol.name).field("kind", word_of(symbol.kind));
  json.field("signature", signature.text);
  if (!signature.documentation.empty()) json.field("documentation", signature.documentation);
  json.field("library", symbol.library || symbol.row != nullptr);
  json.key("parameters").begin_array();
  for (const frontend::questions::Parameter& parameter : signature.parameters) {
    json.begin_object().field("name", parameter.name).field("type", parameter.type);
    json.field("section", parameter.section).end_object();
  }
  json.end_array();
  json.key("uses").begin_array();
  for (const Occurrence& use : questions.uses_of(symbol)) {
    json.begin_object();
    write_span(json, questions, use.span);
    json.field("role", role_word(use.role)).end_object();
  }
  json.end_array().end_object();
}

std::string json_form(Questions& questions, const Answer& answer) {
  tools::JsonWriter json;
  json.begin_object().key("symbols").begin_array();
  for (const Symbol* symbol : answer.symbols) write_symbol(json, questions, *symbol);
  json.end_array();
  if (answer.expression) {
    json.key("expression").begin_object();
    write_span(json, questions, answer.expression->span);
    json.field("type", answer.expression->type).end_object();
  }
  return json.end_object().finish();
}

base::Result<std::string> xref(const tools::Options& options) {
  auto format = diagnostic_format(options);
  if (!format.ok()) return format.error();
  if (options.has("--at") && options.has("--name")) return wrong("give --at or --name, not both");
  base::Result<Project> project = open_project(options, options.arguments());
  if (!project.ok()) return project.error();
  frontend::questions::Compilation compilation(project->sources, project->compile);
  base::Diagnostics diagnostics = diagnostics_of(*project);
  for (const base::Diagnostic& message : compilation.diagnostics().all()) {
    if (message.severity == base::Severity::kError) diagnostics.add(message);
  }
  report(*project, diagnostics, base::DiagnosticFormat::kText);
  if (compilation.sema() == nullptr) {
    return base::Error{base::Refusal::kSourceErrors, "xref: the sources have errors"};
  }
  Questions questions(*compilation.sema());
  base::Result<Answer> answer = answer_of(options, questions);
  if (!answer.ok()) return answer.error();
  const bool as_json = *format == base::DiagnosticFormat::kJson;
  return as_json ? json_form(questions, *answer) : text_form(questions, *answer);
}

int run_xref(const tools::Options& options) {
  base::Result<std::string> text = xref(options);
  if (!text.ok()) return tools::refuse("stc", text.error());
  std::fputs(text->c_str(), stdout);
  return tools::kOk;
}

}  // namespace

const Entry kXref{&kXrefCommand, run_xref};

}  // namespace stc
