// What a plan promises to whoever carries it out, whoever made it. Planner asks it of what it has
// made, Transfer of what it is given (base/check.h). For plans of others, package/plan_check.h.
#pragma once

#include "base/check.h"
#include "online_change/plan/plan.h"

namespace online_change {

// The first promise that the plan breaks; null: none. `from` and `to`: the versions whose memories
// it reads and writes. Linear in the steps.
const char* broken_promise(const Plan& plan, const ir::Image& from, const ir::Image& to);
inline void expect_promises(const Plan& plan, const ir::Image& from, const ir::Image& to) {
  if constexpr (!base::kHardChecks) return;
  if (const char* const broken = broken_promise(plan, from, to)) base::dcheck(false, broken);
}

}  // namespace online_change
