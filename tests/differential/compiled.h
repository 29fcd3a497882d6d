// A random program, compiled.
#pragma once

#include <string>

#include "base/result.h"
#include "tests/golden/runner/compile.h"

namespace differential {

base::Result<golden::Program> compiled(const std::string& source, const std::string& passes);

}  // namespace differential
