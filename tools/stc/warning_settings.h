// What the project and the command line make of warnings. Of two settings for a code the
// command line's counts; a code that has its own setting is not under "warnings are errors".
#pragma once

#include "base/warning_policy.h"
#include "tools/common/options.h"
#include "tools/common/project_file.h"

namespace stc {

// The table [warnings] of a checked file.
void apply_warning_table(const tools::ProjectFile& file, base::WarningPolicy& policy);
// kUsage for what is neither `error` nor CODE=LEVEL, for an unknown code and for a second level.
base::Status apply_warning_options(const tools::Options& options, base::WarningPolicy& policy);

}  // namespace stc
