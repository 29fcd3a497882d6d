// The sources that a golden file names with `// USE:` lines: one file, or `folder/*.st` (in the
// order of their names). Paths count from the nearest folder above the test that has the first
// part of the path, which is the root of the repository.
#pragma once

#include "base/result.h"
#include "tests/golden/runner/test_file.h"

namespace golden {

// Fills test.used from test.lines. Errors: what reading gives; kBadProject when a line names
// nothing.
base::Status read_used_sources(TestFile& test);

}  // namespace golden
