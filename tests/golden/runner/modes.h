// What a mode produces for a golden file.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "tests/golden/runner/test_file.h"

namespace golden {

struct Actual {
  std::vector<std::vector<std::string>> outputs;  // parallel to TestFile::steps
  std::vector<std::string> scans;                 // parallel to TestFile::scans
  std::vector<std::string> failures;              // beyond wrong output: tiers that disagree
};

// A failure of the product (does not compile, does not link) is part of `failures`.
Actual produce(const TestFile& test);

}  // namespace golden
