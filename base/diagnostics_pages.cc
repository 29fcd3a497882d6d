// The pages of the registry of messages. They are a unit of their own (scripts/batches.cmake): the
// texts of one unit are linked together, and a program that explains nothing needs none of these.
#include "base/check.h"
#include "base/diagnostics.h"

namespace base {

std::string_view diagnostic_page(DiagnosticCode code) {
  static constexpr std::string_view kPages[] = {
#define DIAGNOSTIC(id, code, severity, title, help) help,
#include "base/diagnostics.def"
#undef DIAGNOSTIC
  };
  const auto index = static_cast<uint32_t>(code);
  check(index < sizeof kPages / sizeof kPages[0], "diagnostic code within the registry");
  return kPages[index];
}

}  // namespace base
