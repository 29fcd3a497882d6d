// The durable events of a controller, out of its state folder; it need not run.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "online_change/store/journal.h"

namespace stvm {

// Oldest first; kFileNotFound.
base::Result<std::vector<online_change::JournalEntry>> stored_events(const std::string& directory);

}  // namespace stvm
