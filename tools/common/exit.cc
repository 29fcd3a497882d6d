#include "tools/common/exit.h"

#include <unistd.h>

#include <cstdio>

#include "tools/common/refusal_text.h"
#include "tools/common/terminal.h"

namespace tools {
namespace {

RefusalForm refusal_form = nullptr;

constexpr ExitRow kRows[] = {
    {kOk, "ok", "done, and nothing was found"},
    {kFindings, "findings",
     "the sources have errors, a test failed, a file would change, a trap stopped the run, the "
     "machine does not suit a controller"},
    {kUsage, "usage",
     "the command line was not understood (R0504), or a question could not be asked"},
    {kRefused, "refused",
     "refused for the reason that the code (R0101 ...) on standard error names"},
    {kInternal, "internal", "an error in the program itself (R0599)"},
    {kOutputLost, "output", "standard output could not be written; the work itself was done"},
};

}  // namespace

std::span<const ExitRow> exit_rows() { return kRows; }

int exit_code(const base::Error& error) {
  switch (error.refusal) {
    case base::Refusal::kUsage:
      return kUsage;
    case base::Refusal::kSourceErrors:
      return kFindings;
    case base::Refusal::kInternal:
      return kInternal;
    default:
      return kRefused;
  }
}

void set_refusal_form(RefusalForm form) { refusal_form = form; }
bool has_refusal_form() { return refusal_form != nullptr; }

int refuse_reported(const char* tool, const base::Error& error) {
  std::fputs(refusal_text(tool, error, has_colour(STDERR_FILENO)).c_str(), stderr);
  return exit_code(error);
}

int refuse(const char* tool, const base::Error& error) {
  // Errors of sources have been reported one by one.
  const bool wanted = refusal_form != nullptr && error.refusal != base::Refusal::kSourceErrors;
  if (wanted) std::fputs(refusal_form(error).c_str(), stdout);
  return refuse_reported(tool, error);
}

}  // namespace tools
