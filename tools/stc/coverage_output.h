// What people ask of coverage on the command line, and where it goes.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "tools/common/options.h"
#include "tools/stc/coverage_report.h"

namespace stc {

struct CoverageWishes {
  std::string folder;           // "": none
  std::string format;           // "": all
  std::optional<double> least;  // percent

  bool counts() const { return !folder.empty() || least; }
};

// What the options of `stc test` ask for. Errors: kUsage.
base::Result<CoverageWishes> coverage_wishes(const tools::Options& options);

// Writes the files, and with `text` the table for people. False: less was reached than wanted, and
// that was said. Errors: kFileUnwritable.
base::Result<bool> put_out(const CoverageReport& report, const CoverageWishes& wishes,
                           const std::string& project, bool text);

}  // namespace stc
