#include "adapters/xml/imported.h"

#include <algorithm>

#include "base/diagnostics_render.h"
#include "base/name_case.h"

namespace xml {

std::string Names::take(std::string_view name) {
  uint32_t& next = taken_[base::fold_name(name)];
  std::string out(name);
  if (next == 0) {
    next = 2;
    return out;
  }
  do {
    out = std::string(name) + "_" + std::to_string(next++);
  } while (!taken_.emplace(base::fold_name(out), 2).second);
  return out;
}

bool Names::has(std::string_view name) const { return taken_.count(base::fold_name(name)) != 0; }

std::string Imported::add_source(std::string_view name, std::string text) {
  std::string own = names.take(name);
  sources.push_back({own + ".st", std::move(text)});
  return own;
}

void Imported::add_finding(Finding finding) {
  constexpr size_t kMaxFindings = 10000;
  finding.text = base::printable(finding.text);
  if (findings.size() == kMaxFindings) {
    finding.text =
        "there are more findings than " + std::to_string(kMaxFindings) + "; these are left out";
    finding.fix.clear();
  } else if (findings.size() > kMaxFindings) {
    const bool error = base::diagnostic_row(finding.code).severity == base::Severity::kError;
    if (!error || findings.size() > 2 * kMaxFindings) return;
  }
  findings.push_back(std::move(finding));
}

bool Imported::failed() const {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return base::diagnostic_row(finding.code).severity == base::Severity::kError;
  });
}

}  // namespace xml
