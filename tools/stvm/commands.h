// The commands of stvm, one file each. Each returns the exit code.
#pragma once

#include "tools/common/dispatch.h"
#include "tools/common/option_rows.h"

namespace stvm {

// What FB_Exit of all instances may take at the end of a run, or before a restart.
inline constexpr int64_t kExitLimitNs = 1'000'000'000;

using tools::Entry;

#define VERB(entry) extern const Entry entry;
#include "tools/stvm/verbs.def"
#undef VERB

#define STVM_DIR_OPTION tools::kDirOption
#define STVM_CONTROLLER_OPTIONS tools::kDirOption, tools::kHostOption
#define STVM_FORMAT_OPTION tools::kFormatOption

bool wants_json(const tools::Options& options);
std::string state_directory(const tools::Options& options);
// Prints the error as this tool does; the exit code.
int refuse(const base::Error& error);
int refuse_reported(const base::Error& error);  // where the report says so in its own form

}  // namespace stvm
