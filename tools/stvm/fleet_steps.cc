// An edit whose units start one after the other, each at a boundary of its own (E-25, E-26).
#include "tools/stvm/fleet_steps.h"

namespace stvm {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool is_to_come(const std::vector<ir::PartEdit>& parts) {
  for (const ir::PartEdit& part : parts) {
    if (part.state == ir::PartState::kOk) return true;
  }
  return false;
}

}  // namespace

std::vector<size_t> steps_to_come(const std::vector<std::string>& steps,
                                  const std::vector<ir::PartEdit>& parts,
                                  const ir::UnitMembers& members) {
  std::vector<size_t> left;
  for (size_t i = 0; i < steps.size(); ++i) {
    if (is_to_come(ir::of_step(parts, steps[i], members))) left.push_back(i);
  }
  return left;
}

bool lacks_room(const base::Error& why) {
  return why.refusal == base::Refusal::kOutOfMemory || why.refusal == base::Refusal::kTooLarge ||
         why.refusal == base::Refusal::kNoMemory;
}

Mixture mixture_of(const std::vector<std::string>& steps, const std::vector<size_t>& to_come,
                   size_t arrived, uint64_t cycle) {
  Mixture mixture;
  mixture.cycle = cycle;
  for (size_t i = 0; i < to_come.size(); ++i) {
    auto& names = i < arrived ? mixture.new_ones : mixture.old_ones;
    names.push_back(ir::step_text(steps[to_come[i]]));
  }
  return mixture;
}

std::string mixture_text(const Mixture& mixture) {
  return "from cycle " + std::to_string(mixture.cycle) + ": " + listed(mixture.new_ones) +
         " new, " + listed(mixture.old_ones) + " as before";
}

}  // namespace stvm
