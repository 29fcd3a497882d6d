#include "tests/golden/runner/compile.h"

#include <algorithm>

#include "frontend/compile.h"
#include "frontend/lex/lexer.h"
#include "frontend/parse/tree.h"
#include "frontend/warning_pragmas.h"
#include "ir/lower/lower.h"
#include "ir/opt/optimise.h"
#include "ir/program/verify.h"
#include "linker/link.h"

namespace golden {
namespace {

const char* severity_text(base::Severity severity) {
  switch (severity) {
    case base::Severity::kError:
      return "error";
    case base::Severity::kWarning:
      return "warning";
    case base::Severity::kNote:
      return "note";
  }
  return "?";
}

void collect(const base::SourceMap& sources, base::Diagnostics& diagnostics, Outcome& outcome,
             bool with_help = false) {
  outcome.errors = diagnostics.has_errors();
  outcome.messages = messages_of(sources, diagnostics, with_help);
}

frontend::CompileOptions options_of(const TestFile& test, size_t version) {
  frontend::CompileOptions options;
  options.name = "golden";
  options.strict_strings =
      std::find(test.options.begin(), test.options.end(), "--strict-strings") != test.options.end();
  std::string dialect = test.option_of(version, "--dialect", "codesys");
  if (dialect == "iec") options.dialect = frontend::Dialect::kIec;
  if (dialect == "twincat") options.dialect = frontend::Dialect::kTwincat;
  for (size_t i = 0; i + 1 < test.options.size(); ++i) {
    if (test.options[i] == "--resource") options.resource = test.options[i + 1];
    if (test.options[i] == "--define") options.defines.push_back(test.options[i + 1]);
  }
  return options;
}

// What runs is optimised; texts of a phase show what comes out of the phases before it.
base::Result<ir::PassSet> passes_of(const TestFile& test) {
  const bool text = test.mode == "ir" || test.mode == "bytecode" || test.mode == "link";
  return ir::PassSet::parse(test.option("--passes", text ? "none" : "all"));
}

}  // namespace

std::vector<std::string> messages_of(const base::SourceMap& sources, base::Diagnostics& diagnostics,
                                     bool with_help) {
  std::vector<std::string> out;
  diagnostics.sort();
  for (const base::Diagnostic& message : diagnostics.all()) {
    const base::DiagnosticRow& row = base::diagnostic_row(message.code);
    base::SourceLocation at = sources.locate(message.span.begin);
    out.push_back(std::to_string(at.line) + ":" + std::to_string(at.column) + ": " +
                  severity_text(message.severity) + "[" + std::string(row.code) +
                  "]: " + message.text);
    if (with_help && !message.fix.empty()) out.push_back("help: " + message.fix);
  }
  return out;
}

base::Result<Program> compile(const TestFile& test, size_t version, Outcome& outcome) {
  base::SourceMap sources;
  sources.add(test.name, test.versions[version]);
  for (const Source& used : test.used) sources.add(used.name, used.text);
  base::WarningPolicy warnings;
  const auto mistakes = frontend::silence_warnings(sources, options_of(test, version), warnings);
  base::Diagnostics diagnostics(warnings);
  for (const base::Diagnostic& mistake : mistakes) diagnostics.add(mistake);
  std::optional<ir::Program> program;
  if (test.has_option("--all-resources")) {
    auto all = frontend::compile_resources(sources, options_of(test, version), diagnostics);
    if (all) program = std::move(all->programs.front().program);
  } else {
    program = frontend::compile(sources, options_of(test, version), diagnostics);
  }
  collect(sources, diagnostics, outcome, test.has_option("--help"));
  if (!program) {
    std::string all;
    for (const std::string& message : outcome.messages) {
      if (message.find(": error[") != std::string::npos) all += message + "\n";
    }
    return base::Error{base::Refusal::kSourceErrors, all};
  }
  // The runner checks the IR of every golden file, whatever its mode.
  base::Status sound = ir::verify(*program);
  if (!sound.ok()) return sound.error();
  Program out{std::move(*program), {}, {}, {}, {}};
  base::Result<ir::PassSet> passes = passes_of(test);
  if (!passes.ok()) return passes.error();
  out.optimised = out.program;
  base::Status optimised = ir::optimise(out.optimised, *passes, true);
  if (!optimised.ok()) return optimised.error();
  for (uint32_t i = 0; i < out.program.pous.size(); ++i) {
    base::Result<ir::Object> object = ir::lower(out.optimised, ir::PouId(i));
    if (!object.ok()) return object.error();
    out.objects.push_back(std::move(*object));
  }
  return out;
}

base::Result<ir::VerifiedImage> link(const Program& program, const ir::Image* base_image,
                                     bool move_all) {
  const bool cold = base_image == nullptr && !move_all;
  if (cold && program.cold) return *program.cold;
  linker::Options options;
  options.base = base_image;
  options.move_all = move_all;
  base::Result<ir::Image> image = linker::link(program.program, program.objects, options);
  if (!image.ok()) return image.error();
  base::Result<ir::VerifiedImage> verified = ir::verify(ir::encode(*image));
  if (cold && verified.ok()) program.cold = *verified;
  return verified;
}

std::string tokens_of(const TestFile& test) {
  // Without the expectations, which would move the end of the file.
  std::string text = test.versions[0].substr(0, test.versions[0].find("// CHECK:"));
  base::SourceMap sources;
  sources.add(test.name, text);
  base::Diagnostics diagnostics;
  return frontend::print_tokens(frontend::lex(sources, 0, diagnostics), sources);
}

std::string tree_of(const TestFile& test, Outcome& outcome) {
  base::SourceMap sources;
  sources.add(test.name, test.versions[0]);
  base::Diagnostics diagnostics;
  frontend::Tree tree;
  frontend::parse_all(sources, options_of(test, 0), tree, diagnostics);
  collect(sources, diagnostics, outcome);
  return frontend::print(tree);
}

}  // namespace golden
