// Which tests run, and in which order: --filter, --shuffle, --seed.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/result.h"
#include "frontend/compile.h"
#include "tools/common/options.h"

namespace stc {

struct TestOrder {
  std::vector<frontend::TestCase> cases;
  std::optional<uint64_t> seed;  // that gives this order again; none: that of the sources
};

// Orders the tests. Those of `first`, by file and name ("a_test.st/starts"), come before all
// others. Errors: kUsage.
base::Result<TestOrder> order_tests(const std::vector<frontend::TestCase>& cases,
                                    const tools::Options& options,
                                    const std::set<std::string>& first = {});
std::string key_of(const frontend::TestCase& test);

}  // namespace stc
