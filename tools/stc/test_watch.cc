#include "tools/stc/test_watch.h"

#include <unistd.h>

#include <cstdio>

#include "tools/common/terminal.h"
#include "tools/stc/test_order.h"
#include "tools/stc/test_report.h"

namespace stc {

base::Result<WatchTarget::Next> WatchedTests::take(const ir::Image& image, const Project& project,
                                                   const Built& built) {
  base::Result<TestOrder> order = order_tests(*built.tests, options_, failed_);
  if (!order.ok()) return order.error();
  base::Result<ir::VerifiedImage> verified = ir::verify(ir::encode(image));
  if (!verified.ok()) return verified.error();
  if (!options_.has("--quiet")) built.print();
  const bool colour = tools::has_colour(STDOUT_FILENO);
  failed_.clear();
  std::vector<TestResult> results;
  for (const frontend::TestCase& test : order->cases) {
    base::Result<TestResult> result = run_test(*verified, test, fuel_, nullptr);
    if (!result.ok()) return result.error();
    if (result->verdict != Verdict::kPassed) failed_.insert(key_of(test));
    std::fputs(test_text(*result, project.sources, colour).c_str(), stdout);
    results.push_back(std::move(*result));
  }
  std::fputs((summary_text(results, colour) + "\n").c_str(), stdout);
  std::fflush(stdout);
  return Next::kWait;
}

base::Result<WatchTarget::Next> WatchedTests::take(std::vector<ResourceVersion>&, const Project&,
                                                   const Built&) {
  return Next::kWait;  // tests are one program, whatever the RESOURCEs are
}

}  // namespace stc
