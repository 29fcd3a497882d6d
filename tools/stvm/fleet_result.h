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
#include "tools/common/json.h"

namespace stvm {

enum class FleetOutcome : uint8_t {
  kDone,
  kPossible,  // by --dry-run: it would be done
  kHadIt,
  kRefused,
  kUnreachable,
  kCancelled,  // somebody said no
  kNotAsked,   // somebody ended the run before its turn
  kReached,    // it was looked at
  kUndone,
  kAccepted,
  kHadItNot,  // the edit is not on trial there
  kTakenBack,  // it failed in the middle of several steps, and went again
};
std::string_view outcome_name(FleetOutcome outcome);
// Nothing is left to do there.
bool is_good(FleetOutcome outcome);

// What ran while parts of an edit had come and others not.
struct Mixture {
  uint64_t cycle = 0;  // the first one
  std::vector<std::string> new_ones;
  std::vector<std::string> old_ones;
};

struct FleetRow {
  std::string place;    // as the command line names it
  std::string program;  // that ran
  FleetOutcome outcome = FleetOutcome::kNotAsked;
  std::optional<base::Error> why;                    // of those that are not done
  std::vector<ir::PartEdit> parts;                   // what the edit changes, and what was there
  std::vector<online_change::TableEdit> table = {};  // of its own, where that is another (E-16)
  std::vector<ir::Part> has;  // all that was there, where somebody looks
  std::string edits;          // "E2, E1": what was taken back or accepted
  std::vector<Mixture> mixtures = {};  // E-25
  base::Digest from{};        // image that ran
  std::optional<online_change::SwitchReport> report;
};

std::string fleet_text(const std::vector<FleetRow>& rows);
// A line for each that was not done, whole: a table cuts what it has no room for.
std::string reasons_text(const std::vector<FleetRow>& rows);
std::string fleet_json(const base::Digest& file, const std::vector<FleetRow>& rows);
// The array of the rows alone.
void fleet_rows_json(const std::vector<FleetRow>& rows, tools::JsonWriter& json);
// 0: all are done or had it; 1: some are not; 7: none is.
int fleet_exit_code(const std::vector<FleetRow>& rows);

}  // namespace stvm
