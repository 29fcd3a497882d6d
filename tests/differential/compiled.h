// A random program, compiled.
#pragma once

#include <string>

#include "base/result.h"
#include "tests/golden/runner/compile.h"

namespace differential {

// How it is compiled. The generator knows the dialect: programs for `iec` convert what the others
// convert by themselves, and have none of their extensions.
struct Build {
  std::string passes;  // ir::PassSet::parse()
  std::string dialect = "codesys";
  bool is_iec() const { return dialect == "iec"; }
};

base::Result<golden::Program> compiled(const std::string& source, const Build& build);

}  // namespace differential
