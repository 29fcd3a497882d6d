#include "base/diagnostics.h"

#include <algorithm>
#include <tuple>

#include "base/check.h"
#include "base/warning_policy.h"

namespace base {

namespace {

constexpr Severity kError = Severity::kError;
constexpr Severity kWarning = Severity::kWarning;
constexpr Severity kNote = Severity::kNote;

constexpr DiagnosticRow kRows[] = {
#define DIAGNOSTIC(id, code, severity, title, help) {code, severity, title},
#include "base/diagnostics.def"
#undef DIAGNOSTIC
};
constexpr uint32_t kRowCount = sizeof kRows / sizeof kRows[0];

// The enumeration is made of the table by another way (scripts/enumerations.cmake).
constexpr DiagnosticCode kDiagnosticsInOrder[] = {
#define DIAGNOSTIC(id, code, severity, title, help) DiagnosticCode::id,
#include "base/diagnostics.def"
#undef DIAGNOSTIC
};
static_assert([] {
  for (uint32_t i = 0; i < kRowCount; ++i) {
    if (static_cast<uint32_t>(kDiagnosticsInOrder[i]) != i) return false;
  }
  return true;
}());

auto sort_key(const Diagnostic& d) {
  return std::make_tuple(d.span.begin.offset, static_cast<uint16_t>(d.code), d.span.end.offset);
}

bool same_message(const Diagnostic& a, const Diagnostic& b) {
  return a.code == b.code && a.span.begin == b.span.begin;
}

}  // namespace

const DiagnosticRow& diagnostic_row(DiagnosticCode code) {
  auto index = static_cast<uint32_t>(code);
  check(index < kRowCount, "diagnostic code within the registry");
  return kRows[index];
}

uint32_t diagnostic_count() { return kRowCount; }

void Diagnostics::add(Diagnostic diagnostic) {
  diagnostic.severity = diagnostic_row(diagnostic.code).severity;
  if (diagnostic.severity == Severity::kError) ++hard_errors_;
  if (policy_ != nullptr) {
    const std::optional<Severity> graded = policy_->grade(diagnostic.code, diagnostic.span);
    if (!graded) return;
    diagnostic.severity = *graded;
  }
  uint32_t& count = counts_[static_cast<uint8_t>(diagnostic.severity)];
  ++count;
  if (count <= limit_) all_.push_back(std::move(diagnostic));
}

void Diagnostics::add(DiagnosticCode code, SourceSpan span, std::string text, std::string fix) {
  add(Diagnostic{code, span, std::move(text), std::move(fix), {}});
}

std::string Diagnostics::left_out() const {
  std::string out;
  const char* const names[] = {"errors", "warnings", "notes"};
  for (size_t i = 0; i < 3; ++i) {
    if (counts_[i] <= limit_) continue;
    out += (out.empty() ? "of " : ", of ") + std::to_string(counts_[i]) + ' ' + names[i] + ' ' +
           std::to_string(limit_) + " are listed";
  }
  return out;
}

void Diagnostics::sort() {
  std::stable_sort(all_.begin(), all_.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return sort_key(a) < sort_key(b);
  });
  all_.erase(std::unique(all_.begin(), all_.end(), same_message), all_.end());
}

}  // namespace base
