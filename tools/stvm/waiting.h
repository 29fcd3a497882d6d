// After the changes of others: `stvm change --wait`, and each controller of `stvm fleet change`.
#pragma once

#include "tools/stvm/controller_client.h"
#include "tools/stvm/switch_steps.h"

namespace stvm {

// Does the error say that others were faster, or are not done? Then the change has to be made anew
// from what runs.
bool others_change(const base::Error& error);
// Why it was not done; null: it was.
const base::Error* why_not(const base::Result<Outcome>& outcome);
// Until nothing is on trial. What is only staged is waited for no longer than a person would think
// about a report.
base::Status wait_for_others(ControllerClient& client);

}  // namespace stvm
