// What the compiler says to people: one registry (diagnostics.def), one sink,
// four renderings. A message describes the situation with its values ("`speed`
// is REAL, this place needs INT"); `fix` says the way out.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/source.h"
#include "base/tool_limits.h"

namespace base {

enum class Severity : uint8_t { kError, kWarning, kNote };

// Codes: E0xxx lexical, E1xxx syntax, E2xxx names and declarations, E3xxx types,
// E4xxx statements, E5xxx configuration, E6xxx limits, W0xxx warnings.
enum class DiagnosticCode : uint16_t {
#define NAME(id) id,
#include "base/diagnostics.def.names"
#undef NAME
};

struct DiagnosticRow {
  std::string_view code;  // "E3001"
  Severity severity;
  std::string_view title;  // what kind of mistake, without values
};
const DiagnosticRow& diagnostic_row(DiagnosticCode code);
// What `stc explain CODE` shows. Apart from the rows: a program that explains nothing has no pages.
std::string_view diagnostic_page(DiagnosticCode code);
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
  Severity severity = Severity::kError;  // add() says what it is
};

class WarningPolicy;

// Collects the messages of one compilation. Past `limit` errors (warnings, notes) further ones are
// counted but not kept, so hostile input cannot exhaust memory.
class Diagnostics {
 public:
  explicit Diagnostics(uint32_t limit = kMostListedMessages) : limit_(limit) {}
  // Warnings are what the policy makes of them; it must outlive the messages' collection.
  explicit Diagnostics(const WarningPolicy& policy) : policy_(&policy) {}
  void add(Diagnostic diagnostic);
  void add(DiagnosticCode code, SourceSpan span, std::string text, std::string fix = {});
  bool has_errors() const { return error_count() != 0; }
  // Errors by nature, not by a policy for warnings: the program has no meaning.
  bool has_hard_errors() const { return hard_errors_ != 0; }
  uint32_t error_count() const { return counts_[0]; }
  uint32_t warning_count() const { return counts_[1]; }
  uint32_t note_count() const { return counts_[2]; }
  const std::vector<Diagnostic>& all() const { return all_; }
  // "of 300 warnings 200 are listed"; "": everything was kept.
  std::string left_out() const;
  // By file and position, each (code, position) once. Call before rendering.
  void sort();

 private:
  std::vector<Diagnostic> all_;
  uint32_t limit_ = kMostListedMessages;
  const WarningPolicy* policy_ = nullptr;
  uint32_t hard_errors_ = 0;
  uint32_t counts_[3] = {};  // by Severity
};

enum class DiagnosticFormat : uint8_t { kText, kJson, kSarif, kGithub };
// The whole output for one run, newline-terminated. `colour` applies to kText.
std::string render(const Diagnostics& diagnostics, const SourceMap& sources,
                   DiagnosticFormat format, bool colour);

}  // namespace base
