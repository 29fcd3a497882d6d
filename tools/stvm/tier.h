// --tier of run, bench, serve and replay.
#pragma once

#include "tools/common/options.h"
#include "vm/exec/tier.h"

namespace stvm {

#define STVM_TIER_OPTION                                                              \
  {                                                                                   \
    "--tier", "T", "auto (default), native or interp: the same results, other times", \
        "auto|native|interp"                                                          \
  }

// kUsage for other names.
base::Result<vm::Tier> tier_of(const tools::Options& options);
// In real time with --tier auto the first scan does not wait for machine code; in virtual time, and
// with --tier native, it is there before.
vm::TierOptions tier_options(vm::Tier tier, bool virtual_time);

}  // namespace stvm
