// Runs TEST blocks: each on a cold machine of its own and on virtual time, so no test can see
// another one, and a run gives the same result every time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "frontend/compile.h"
#include "ir/bytecode/verify.h"

namespace stc {

enum class Verdict : uint8_t {
  kPassed,
  kFailed,  // an assertion
  kError,   // any other trap
};

struct TestResult {
  frontend::TestCase test;
  Verdict verdict = Verdict::kPassed;
  std::string file;  // where it ended, when it did not pass
  uint32_t line = 0;
  std::string text;    // "expected 10, got 7"
  std::string trap;    // "assert", "division-by-zero"
  double seconds = 0;  // of the real clock
};

// Calls and rounds of loops of one test; one that takes more hangs, most likely.
inline constexpr uint64_t kTestFuel = 100'000'000;

// `image` holds the test's program instance. What code has counted for coverage is added to `hits`;
// null: nothing is counted. Errors: no memory.
base::Result<TestResult> run_test(const ir::VerifiedImage& image, const frontend::TestCase& test,
                                  uint64_t fuel, std::vector<uint64_t>* hits);

}  // namespace stc
