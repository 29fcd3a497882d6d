// The table [change] of stc.toml (docs/PROJECT.md): how a project's controllers are changed.
// Options on the command line win.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "tools/common/project_file.h"

namespace tools {

struct ChangeSettings {
  std::string strategy;          // "in-place", "standby", or "": not said
  bool restricted = false;       // no edits of interfaces (D7)
  std::string health;            // a BOOL that must stay TRUE on trial, or the controller undoes it
  std::string unless;            // a BOOL; while it is TRUE nothing is switched
  bool last_edit = false;        // what is on trial boots after a power loss (D4)
  uint64_t data_limit = 0;       // bytes of all data areas of a change together; 0: no limit
  uint64_t code_slack_percent = 25;  // [slack] of code slots, which the controller makes
  bool table_additions = false;  // of a fleet file whose table is restricted (E-16)
};

// What the file says, over what is in `settings`.
void take_change_settings(const ProjectFile& file, ChangeSettings& settings);
// From the stc.toml that is nearest to each path but images; the defaults without one. Whether they
// are right is said by stc, which compiles what the paths name.
base::Result<ChangeSettings> change_settings(const std::vector<std::string>& paths);

}  // namespace tools
