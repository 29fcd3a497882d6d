#include "tools/common/exit.h"

#include <cstdio>

#include "base/visible_text.h"

namespace tools {

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

int refuse(const char* tool, const base::Error& error) {
  std::fprintf(stderr, "%s: %s\n", tool, base::visible_lines(base::to_string(error)).c_str());
  if (error.refusal != base::Refusal::kSourceErrors) {
    std::fprintf(stderr, "  help: %s\n", base::refusal_help(error.refusal));
  }
  return exit_code(error);
}

}  // namespace tools
