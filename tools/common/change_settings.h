// The table [change] of stc.toml (docs/PROJECT.md): how a project's controllers are changed.
// Options on the command line win.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "tools/common/toml.h"

namespace tools {

struct ChangeSettings {
  std::string strategy;     // "in-place", "standby", or "": not said
  bool restricted = false;  // no edits of interfaces (D7)
  std::string health;       // a BOOL that must stay TRUE on trial, or the controller undoes it
  std::string unless;       // a BOOL; while it is TRUE nothing is switched
  uint64_t data_limit = 0;  // bytes of all data areas of a change together; 0: no limit
};

inline constexpr std::string_view kChangeTable = "change.";

// Sets what `key` ("change.strategy") names. kBadProject for unknown keys and wrong values.
base::Status apply_change_key(const std::string& file, const std::string& key,
                              const TomlValue& value, ChangeSettings& settings);

// From stc.toml in those of the paths that are folders; the defaults without one.
base::Result<ChangeSettings> change_settings(const std::vector<std::string>& paths);

}  // namespace tools
