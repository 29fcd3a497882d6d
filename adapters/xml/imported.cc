#include "adapters/xml/imported.h"

#include <algorithm>

#include "base/name_case.h"

namespace xml {

std::string Imported::add_source(std::string_view name, std::string text) {
  std::string free(name);
  for (uint32_t n = 2; !names.insert(base::fold_name(free)).second; ++n) {
    free = std::string(name) + "_" + std::to_string(n);
  }
  sources.push_back({free + ".st", std::move(text)});
  return free;
}

bool Imported::failed() const {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return base::diagnostic_row(finding.code).severity == base::Severity::kError;
  });
}

}  // namespace xml
