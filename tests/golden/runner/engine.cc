#include "tests/golden/runner/engine.h"

namespace golden {

base::Error unsupported(const char* what) {
  return {base::Refusal::kUsage, std::string(what) + " is not for this tier"};
}

const char* tier_name(Tier tier) {
  switch (tier) {
    case Tier::kEvaluator:
      return "evaluator";
    case Tier::kInterpreter:
      return "interpreter";
    case Tier::kUnfused:
      return "interpreter, one instruction at a time";
    case Tier::kFuelOne:
      return "fuel 1";
    case Tier::kIdentity:
      return "identity change at every scan";
    case Tier::kMoveAll:
      return "every instance moved at every scan";
    case Tier::kStandby:
      return "changes by the standby strategy";
    case Tier::kNative:
      return "native";
    case Tier::kNativeFuelOne:
      return "native, fuel 1";
    case Tier::kFewRegisters:
      return "native, few registers";
    case Tier::kSpills:
      return "native, random registers and tiers";
    case Tier::kAlternating:
      return "another tier after every scan";
    case Tier::kBeside:
      return "machine code that comes later, fuel 1";
  }
  return "?";
}

base::Status Engine::force(const std::string&, const std::string&) { return unsupported("force"); }
base::Status Engine::unforce(const std::string&) { return unsupported("unforce"); }
base::Result<std::vector<std::string>> Engine::change(const Program&, bool) {
  return unsupported("change");
}
base::Result<std::vector<std::string>> Engine::undo(bool) { return unsupported("undo"); }
base::Status Engine::accept() { return unsupported("accept"); }

}  // namespace golden
