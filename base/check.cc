#include "base/check.h"

#include <cstdio>
#include <cstdlib>

namespace base {

void check_failed(const char* what, std::source_location where) {
  std::fprintf(stderr, "internal error: %s (%s:%u)\n", what, where.file_name(), where.line());
  std::abort();
}

}  // namespace base
