#include "tools/stvm/tier.h"

#include "vm/native/program.h"

namespace stvm {

base::Result<vm::Tier> tier_of(const tools::Options& options) {
  const std::string name = options.text("--tier");
  if (name.empty() || name == "auto") return vm::Tier::kAuto;
  if (name == "interp") return vm::Tier::kInterpreter;
  if (name == "native" && vm::native::is_available()) return vm::Tier::kNative;
  return base::Error{base::Refusal::kUsage,
                     "there is no native tier for this machine; use --tier auto or interp"};
}

vm::TierOptions tier_options(vm::Tier tier, bool virtual_time) {
  vm::TierOptions out;
  out.tier = tier;
  if (tier == vm::Tier::kAuto && !virtual_time) out.making = vm::Making::kBeside;
  return out;
}

}  // namespace stvm
