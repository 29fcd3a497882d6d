// The fate report (X1) as people and scripts read it; the same for `stc diff` and `stvm change`.
#pragma once

#include <map>
#include <string>

#include "online_change/plan/system_edits.h"
#include "online_change/plan/plan.h"
#include "online_change/plan/pou_edits.h"
#include "tools/common/json.h"

namespace tools {

// What a controller adds: the live value of a variable, and what becomes of it.
struct LiveValue {
  std::string now;
  std::string after;
  std::string loss;  // "saturates"; empty when nothing is lost
};
using LiveValues = std::map<std::string, LiveValue>;  // by path

using PouEdits = std::vector<online_change::PouEdit>;
using SystemEdits = std::vector<online_change::SystemEdit>;

// Counts, then one row for each group of variables that is not kept, for each POU with other code,
// and for whatever else changes (system_edits.h).
std::string fate_report(const online_change::Plan& plan, const LiveValues& live,
                        const PouEdits& edits, const SystemEdits& system);
// "fates", "code", "system", "counts", "predicted_pause_ns" into an open object.
void fate_report(const online_change::Plan& plan, const LiveValues& live, const PouEdits& edits,
                 const SystemEdits& system, JsonWriter& json);

// "12.5 us", "3 ms": three digits at most.
std::string duration(int64_t ns);

}  // namespace tools
