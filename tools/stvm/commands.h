// The commands of stvm, one file each. Each returns the exit code.
#pragma once

#include "tools/common/dispatch.h"
#include "tools/common/option_rows.h"

namespace stvm {

// What FB_Exit of all instances may take at the end of a run, or before a restart.
inline constexpr int64_t kExitLimitNs = 1'000'000'000;

using tools::Entry;

extern const Entry kRun;
extern const Entry kBench;
extern const Entry kServe;
extern const Entry kStatus;
extern const Entry kGet;
extern const Entry kSet;
extern const Entry kForce;
extern const Entry kUnforce;
extern const Entry kWatch;
extern const Entry kChange;
extern const Entry kEdits;
extern const Entry kUndo;
extern const Entry kRedo;
extern const Entry kRevert;
extern const Entry kFleet;
extern const Entry kAccept;
extern const Entry kAbort;
extern const Entry kStop;
extern const Entry kRestart;
extern const Entry kJournal;
extern const Entry kEvents;
extern const Entry kImage;
extern const Entry kSource;
extern const Entry kBridge;
extern const Entry kReplay;
extern const Entry kTop;
extern const Entry kDoctor;

#define STVM_DIR_OPTION tools::kDirOption
#define STVM_CONTROLLER_OPTIONS tools::kDirOption, tools::kHostOption
#define STVM_FORMAT_OPTION tools::kFormatOption

bool wants_json(const tools::Options& options);
std::string state_directory(const tools::Options& options);
// Prints the error as this tool does; the exit code.
int refuse(const base::Error& error);
int refuse_reported(const base::Error& error);  // where the report says so in its own form

}  // namespace stvm
