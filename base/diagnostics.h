// What the compiler says to people: one registry (diagnostics.def), one sink,
// four renderings. A message describes the situation with its values ("`speed`
// is REAL, this place needs INT"); `fix` says the way out.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/source.h"

namespace base {

enum class Severity : uint8_t { kError, kWarning, kNote };

// Codes: E0xxx lexical, E1xxx syntax, E2xxx names and declarations, E3xxx types,
// E4xxx statements, E5xxx configuration, E6xxx limits, W0xxx warnings.
enum class DiagnosticCode : uint16_t {
#define DIAGNOSTIC(id, code, severity, title, help) id,
#include "base/diagnostics.def"
#undef DIAGNOSTIC
};

struct DiagnosticRow {
  std::string_view code;  // "E3001"
  Severity severity;
  std::string_view title;  // what kind of mistake, without values
  std::string_view help;   // the page that `stc explain CODE` shows
};
const DiagnosticRow& diagnostic_row(DiagnosticCode code);
// Number of rows, to walk the registry.
uint32_t diagnostic_count();

struct DiagnosticNote {
  SourceSpan span;
  std::string text;
};

struct Diagnostic {
  DiagnosticCode code;
  SourceSpan span;
  std::string text;
  std::string fix;  // may be empty
  std::vector<DiagnosticNote> notes;
};

// Collects the messages of one compilation. Past `limit` errors further ones are
// counted but not kept, so hostile input cannot exhaust memory.
class Diagnostics {
 public:
  explicit Diagnostics(uint32_t limit = 200) : limit_(limit) {}
  void add(Diagnostic diagnostic);
  void add(DiagnosticCode code, SourceSpan span, std::string text, std::string fix = {});
  bool has_errors() const { return error_count_ != 0; }
  uint32_t error_count() const { return error_count_; }
  uint32_t warning_count() const { return warning_count_; }
  const std::vector<Diagnostic>& all() const { return all_; }
  // By file and position, each (code, position) once. Call before rendering.
  void sort();

 private:
  std::vector<Diagnostic> all_;
  uint32_t limit_;
  uint32_t error_count_ = 0;
  uint32_t warning_count_ = 0;
};

enum class DiagnosticFormat : uint8_t { kText, kJson, kSarif, kGithub };
// The whole output for one run, newline-terminated. `colour` applies to kText.
std::string render(const Diagnostics& diagnostics, const SourceMap& sources,
                   DiagnosticFormat format, bool colour);

}  // namespace base
