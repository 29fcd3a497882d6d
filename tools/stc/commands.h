// The commands of stc, one file each. Each returns the exit code.
#pragma once

#include <span>

#include "tools/common/options.h"

namespace stc {

struct Entry {
  const tools::Command* command;
  int (*run)(const tools::Options& options);
};

extern const Entry kCheck;
extern const Entry kBuild;
extern const Entry kPackage;
extern const Entry kDiff;
extern const Entry kDump;
extern const Entry kExplain;

}  // namespace stc
