#include "tools/stc/test_order.h"

#include <algorithm>
#include <random>

#include "tools/common/pattern.h"

namespace stc {
namespace {

bool is_wanted(const tools::Options& options, const std::string& name) {
  if (!options.has("--filter")) return true;
  const std::string pattern = options.text("--filter");
  const bool wild = pattern.find_first_of("*?") != std::string::npos;
  return tools::matches(wild ? pattern : "*" + pattern + "*", name);
}

// The order is the same on every machine: no distribution of the library decides.
void shuffle(std::vector<frontend::TestCase>& cases, uint64_t seed) {
  std::mt19937_64 numbers(seed);
  for (size_t left = cases.size(); left > 1; --left) {
    std::swap(cases[left - 1], cases[numbers() % left]);
  }
}

}  // namespace

std::string key_of(const frontend::TestCase& test) { return test.file + "/" + test.name; }

base::Result<TestOrder> order_tests(const std::vector<frontend::TestCase>& cases,
                                    const tools::Options& options,
                                    const std::set<std::string>& first) {
  TestOrder order;
  for (const frontend::TestCase& test : cases) {
    if (is_wanted(options, test.name)) order.cases.push_back(test);
  }
  if (options.has("--seed")) {
    base::Result<uint64_t> seed = options.number("--seed", 0);
    if (!seed.ok()) return seed.error();
    order.seed = *seed;
  } else if (options.has("--shuffle")) {
    order.seed = std::random_device()();
  }
  if (order.seed) shuffle(order.cases, *order.seed);
  std::stable_partition(
      order.cases.begin(), order.cases.end(),
      [&](const frontend::TestCase& test) { return first.contains(key_of(test)); });
  return order;
}

}  // namespace stc
