#include "tests/differential/compiled.h"

namespace differential {

base::Result<golden::Program> compiled(const std::string& source, const Build& build) {
  golden::TestFile test;
  test.name = "random.st";
  test.versions.push_back(source);
  test.options = {"--passes", build.passes, "--dialect", build.dialect};
  golden::Outcome outcome;
  return golden::compile(test, 0, outcome);
}

}  // namespace differential
