// Inside of the diagnostic renderings: each format is one function that appends
// the output for a whole run. Sources may hold any bytes, so everything that
// comes from them passes printable() (terminals) or json_string() (tools) first.
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostics.h"

namespace base {

// First and last place of a span, columns in characters, end exclusive. Line 0: no place.
struct Region {
  std::string_view file;
  uint32_t line = 0;
  uint32_t column = 0;
  uint32_t end_line = 0;
  uint32_t end_column = 0;
};
Region region_of(const SourceMap& sources, SourceSpan span);

// What refused the whole run (refusals.def): among the diagnostics it is one more error.
struct RefusedRun {
  std::string_view code;
  std::string_view title;
  std::string_view text;
  std::string_view help;
  Region region;
};

// What the forms for programs say beside.
struct RunFacts {
  std::string_view version = "0";       // of the compiler
  std::string_view root = {};           // SARIF: paths below this folder are relative to it
  std::string_view documentation = {};  // SARIF: where pages of codes are, "/E3001" after it
  const RefusedRun* refused = nullptr;
};

std::string render_text(const Diagnostics& diagnostics, const SourceMap& sources, bool colour);
std::string render_json(const Diagnostics& diagnostics, const SourceMap& sources,
                        const RunFacts& run = {});
std::string render_sarif(const Diagnostics& diagnostics, const SourceMap& sources,
                         const RunFacts& run = {});
std::string render_github(const Diagnostics& diagnostics, const SourceMap& sources,
                          const RunFacts& run = {});

std::string_view severity_name(Severity severity);  // "error", "warning", "note"

// UTF-8 in any case: bytes that are not UTF-8 are read as Latin-1, control
// characters other than newline become `?`, so no source can steer a terminal, and those that turn
// the direction of what follows become \u202e, so none can show other code than it has.
std::string printable(std::string_view bytes);
// Quoted and escaped for JSON; the same reading of bytes.
std::string json_string(std::string_view bytes);
// Length in bytes of the UTF-8 character at `at`; 1 when it is not valid UTF-8.
uint32_t character_bytes(std::string_view bytes, size_t at);
// Characters in `bytes`, by the same reading.
uint32_t character_count(std::string_view bytes);

}  // namespace base
