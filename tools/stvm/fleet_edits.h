// Which edits on trial on a controller are those of a fleet file (E-32): what its journal says.
#pragma once

#include <string>
#include <vector>

#include "tools/stvm/controller_client.h"

namespace stvm {

struct FleetEdits {
  std::vector<TrialEdit> on_trial;  // all of them, newest first
  // The edits of the file, newest first, without those that were taken back alone since.
  std::vector<std::string> here;
  std::vector<std::string> names() const;  // of all on trial
};

// `edits`: oldest first, with those that were undone. A switch in the journal is known by its edit
// and both its versions: names begin anew when a controller does.
FleetEdits fleet_edits(std::vector<TrialEdit> edits,
                       const std::vector<online_change::JournalEntry>& journal,
                       const base::Digest& file);
// Asks for both.
base::Result<FleetEdits> fleet_edits_on(ControllerClient& client, const base::Digest& file);

}  // namespace stvm
