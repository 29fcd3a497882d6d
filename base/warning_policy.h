// What becomes of warnings and notes: a level for each code, and stretches of the sources in
// which a code is silent. Errors stay errors.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"

namespace base {

enum class WarningLevel : uint8_t { kError, kWarning, kNote, kOff };
inline constexpr std::string_view kWarningLevels = "error|warning|note|off";
std::optional<WarningLevel> warning_level(std::string_view word);

// The code of "W0003"; nullopt where there is none.
std::optional<DiagnosticCode> diagnostic_code(std::string_view text);
// The code that was probably meant; "" when there is none. Only codes of warnings and notes.
std::string nearest_warning(std::string_view text);

class WarningPolicy {
 public:
  void set(DiagnosticCode code, WarningLevel level) { levels_[code] = level; }
  // Every warning without a level of its own is an error; notes stay notes.
  void set_warnings_are_errors() { warnings_are_errors_ = true; }

  // [begin, end) says nothing of `code`, or without one of any. Calls for one code come in the
  // order of the sources.
  void silence(std::optional<DiagnosticCode> code, SourceSpan span);
  void clear_silenced() { silenced_.clear(); }

  // How serious it is; nullopt: nothing is said.
  std::optional<Severity> grade(DiagnosticCode code, SourceSpan span) const;

 private:
  bool is_silent(std::optional<DiagnosticCode> code, SourcePos at) const;

  std::map<DiagnosticCode, WarningLevel> levels_;
  bool warnings_are_errors_ = false;
  std::map<std::optional<DiagnosticCode>, std::vector<SourceSpan>> silenced_;
};

}  // namespace base
