// A path may have two rows of a report: what goes, and what takes its name. Each has a value of its
// own.
#pragma once

#include <string>

#include "online_change/diff/fates.h"

namespace tools {

// The key of a row in LiveValues (fate_report.h).
inline std::string live_key(const online_change::FateRow& row) {
  return row.old_type.empty() ? row.path + " new" : row.path;
}

}  // namespace tools
