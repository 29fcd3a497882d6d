#include "base/warning_policy.h"

#include <algorithm>

#include "base/nearest_name.h"

namespace base {

std::optional<WarningLevel> warning_level(std::string_view word) {
  if (word == "error") return WarningLevel::kError;
  if (word == "warning") return WarningLevel::kWarning;
  if (word == "note") return WarningLevel::kNote;
  if (word == "off") return WarningLevel::kOff;
  return std::nullopt;
}

std::optional<DiagnosticCode> diagnostic_code(std::string_view text) {
  for (uint32_t i = 0; i < diagnostic_count(); ++i) {
    const auto code = static_cast<DiagnosticCode>(i);
    if (diagnostic_row(code).code == text) return code;
  }
  return std::nullopt;
}

std::string nearest_warning(std::string_view text) {
  NearestName nearest(text);
  for (uint32_t i = 0; i < diagnostic_count(); ++i) {
    const DiagnosticRow& row = diagnostic_row(static_cast<DiagnosticCode>(i));
    if (row.severity != Severity::kError) nearest.offer(row.code);
  }
  return nearest.best();
}

void WarningPolicy::silence(std::optional<DiagnosticCode> code, SourceSpan span) {
  silenced_[code].push_back(span);
}

bool WarningPolicy::is_silent(std::optional<DiagnosticCode> code, SourcePos at) const {
  const auto found = silenced_.find(code);
  if (found == silenced_.end()) return false;
  const std::vector<SourceSpan>& spans = found->second;
  const auto after =
      std::upper_bound(spans.begin(), spans.end(), at,
                       [](SourcePos pos, const SourceSpan& span) { return pos < span.begin; });
  return after != spans.begin() && at < std::prev(after)->end;
}

std::optional<Severity> WarningPolicy::grade(DiagnosticCode code, SourceSpan span) const {
  const Severity listed = diagnostic_row(code).severity;
  if (listed == Severity::kError) return listed;
  if (is_silent(code, span.begin) || is_silent(std::nullopt, span.begin)) return std::nullopt;
  if (const auto found = levels_.find(code); found != levels_.end()) {
    if (found->second == WarningLevel::kOff) return std::nullopt;
    return static_cast<Severity>(found->second);
  }
  return warnings_are_errors_ && listed == Severity::kWarning ? Severity::kError : listed;
}

}  // namespace base
