// What came of an edit on each controller of a fleet (E-31): a table, JSON and the exit code.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/result.h"
#include "ir/bytecode/part_edits.h"
#include "online_change/apply/change.h"
#include "online_change/plan/table_edits.h"

namespace stvm {

enum class FleetOutcome : uint8_t {
  kDone,
  kPossible,  // by --dry-run: it would be done
  kHadIt,
  kRefused,
  kUnreachable,
  kCancelled,  // somebody said no
  kNotAsked,   // somebody ended the run before its turn
};
std::string_view outcome_name(FleetOutcome outcome);

struct FleetRow {
  std::string place;    // as the command line names it
  std::string program;  // that ran
  FleetOutcome outcome = FleetOutcome::kNotAsked;
  std::optional<base::Error> why;                    // of those that are not done
  std::vector<ir::PartEdit> parts;                   // what the edit changes, and what was there
  std::vector<online_change::TableEdit> table = {};  // of its own, where that is another (E-16)
  base::Digest from{};                               // image that ran
  std::optional<online_change::SwitchReport> report;
};

std::string fleet_text(const std::vector<FleetRow>& rows);
std::string fleet_json(const base::Digest& file, const std::vector<FleetRow>& rows);
// 0: all are done or had it; 1: some are not; 7: none is.
int fleet_exit_code(const std::vector<FleetRow>& rows);

}  // namespace stvm
