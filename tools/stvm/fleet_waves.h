// How an edit is rolled out (X6-01): what fleet.toml says of waves and of the trial on each
// controller.
//
//   [roll]
//   health = ["Line.Errors <= baseline(Line.Errors) + 2"]    # docs/FLEET.md has all keys
//   soak = "30min"
//
//   [[wave]]
//   controllers = ["line1"]          # the canary
//   [[wave]]
//   percent = 100
#pragma once

#include <string>
#include <vector>

#include "tools/common/toml.h"
#include "tools/stvm/fleet_list.h"
#include "tools/stvm/trial_guard_order.h"

namespace stvm {

struct Wave {
  std::vector<size_t> members;  // numbers in the list of controllers
  int64_t soak_ms = 600'000;
  int64_t deadline_ms = 0;  // of the trial on each controller
  uint32_t max_failed = 0;
  uint32_t parallel = 1;
  bool accept_at_end = false;  // or after its soak
};

struct RollSettings {
  std::vector<Wave> waves;
  // Without note and deadline, which belong to a wave.
  GuardOrder guard;
  int64_t lost_after_ms = 60'000;  // who is silent for so long counts as failed (X6-08)
  bool undo_all = false;           // where a wave fails: those before it, too (X6-07)
};

// Of the tables [roll] and [[wave]]; mistakes with line and column (kBadProject). `members`: those
// of the same file, which waves name.
base::Result<RollSettings> roll_settings(const std::string& file, const tools::TomlTable& table,
                                         const std::vector<FleetMember>& members);
// Is a key one of these tables?
bool is_roll_key(const std::string& key);
// "30min", "1h", "5s", "200ms", "0s"; -1: it is no such time.
int64_t roll_time_ms(const std::string& text);
std::string roll_time_text(int64_t ms);

}  // namespace stvm
