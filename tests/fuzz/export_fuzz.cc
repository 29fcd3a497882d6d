// The export of whatever sources the parser takes: a document in each form, well formed. What
// compiles also comes back: the import reads the document, with the sources in it and without, and
// makes sources of it that the parser takes.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "adapters/plcopen/export.h"
#include "adapters/plcopen/plcopen.h"
#include "base/check.h"
#include "frontend/compile.h"
#include "frontend/lex/literals.h"
#include "tests/fuzz/imported.h"

namespace {

using plcopen::Edition;

void show(const char* what, const std::string& text) {
  std::fprintf(stderr, "--- %s\n%s\n", what, text.c_str());
}

// Every source that was made of it, parsed.
void check_sources(const xml::Imported& out, const std::string& document) {
  base::SourceMap sources;
  for (const xml::MadeSource& made : out.sources) sources.add(made.name, made.text);
  base::Diagnostics diagnostics;
  frontend::Tree tree;
  frontend::parse_all(sources, {}, tree, diagnostics);
  if (!diagnostics.has_errors()) return;
  show("document", document);
  for (const xml::MadeSource& made : out.sources) show(made.name.c_str(), made.text);
  show("errors", base::render(diagnostics, sources, base::DiagnosticFormat::kText, false));
  base::check(false, "what was exported is a program when it comes back");
}

void check_document(const std::string& text, bool compiles) {
  base::SourceMap sources;
  xml::Imported out;
  const xml::Document document("fuzz.xml", text, sources, out);
  base::check(!document.root().empty(), "an export is well formed");
  plcopen::import(document, out);
  if (!compiles) return check_imported(document, out, sources);
  if (out.failed()) {
    show("document", text);
    for (const xml::Finding& finding : out.findings) show("finding", finding.text);
    base::check(false, "an export can be read");
  }
  check_imported(document, out, sources);
  check_sources(out, text);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (text.find('\0') != std::string::npos) return 0;  // no source text, which the tool says
  base::SourceMap sources;
  sources.add("fuzz.st", text);
  base::Diagnostics diagnostics;
  frontend::Tree tree;
  frontend::parse_all(sources, {}, tree, diagnostics);
  const bool nothing = tree.pous.empty() && tree.types.empty() && tree.globals.empty();
  if (diagnostics.has_errors() || nothing) return 0;
  // Names and texts in Latin-1 are others in UTF-8.
  const bool compiles = !frontend::is_latin1(text) &&
                        frontend::compile_resources(sources, {}, diagnostics).has_value();
  for (const Edition form : {Edition::kTc6v200, Edition::kTc6v201, Edition::kIec10}) {
    for (const bool with_sources : {true, false}) {
      base::Diagnostics found;
      const plcopen::ExportInput input{sources, tree, "fuzz", form, nullptr, with_sources};
      const std::optional<std::string> document = plcopen::export_document(input, found);
      base::check(document.has_value() != found.has_errors(), "a document, or an error");
      if (document) check_document(*document, compiles);
    }
  }
  return 0;
}
