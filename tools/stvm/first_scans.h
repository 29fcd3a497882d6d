// What becomes of a version on trial in its first scans: most of what traps does so at once, and
// then the controller brings back what ran before (X7). Whoever made the change hears it as its
// answer, not as an alarm later.
#pragma once

#include "base/result.h"
#include "tools/stvm/controller_client.h"

namespace stvm {

// Waits until each task of at most 50 ms has run ten times since, and no longer than two seconds.
// kGivenBack, with the trap or the health condition, where the controller has undone it. One that
// cannot be asked says nothing.
base::Status first_scans(ControllerClient& client);

// Likewise behind an undo, which nothing takes back: kFault, with the trap, where one of cycle
// `from` or later stops a task or all of them.
base::Status first_scans_back(ControllerClient& client, uint64_t from);

}  // namespace stvm
