// stc test --watch: runs the tests again whenever a source is saved, on the compiler that stays.
#pragma once

#include <set>
#include <string>

#include "tools/common/options.h"
#include "tools/stc/watch.h"

namespace stc {

class WatchedTests : public WatchTarget {
 public:
  // `options` outlive it.
  WatchedTests(const tools::Options& options, uint64_t fuel) : options_(options), fuel_(fuel) {}

  bool is_for_tests() const override { return true; }
  std::shared_ptr<const ir::Image> base() const override { return nullptr; }
  base::Result<Next> take(const ir::Image& image, const Project& project,
                          const Built& built) override;
  base::Result<Next> take(std::vector<ResourceVersion>& versions, const Project& project,
                          const Built& built) override;

 private:
  const tools::Options& options_;
  uint64_t fuel_;
  std::set<std::string> failed_;  // in the last run: they are the first of the next one
};

}  // namespace stc
