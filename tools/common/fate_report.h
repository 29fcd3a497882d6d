// The fate report (X1) as people and scripts read it; the same for `stc diff` and `stvm change`.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "online_change/plan/every_fate.h"
#include "online_change/plan/plan.h"
#include "online_change/plan/pou_edits.h"
#include "online_change/plan/system_edits.h"
#include "tools/common/json.h"

namespace tools {

// What a controller adds: the live value of a variable, and what becomes of it.
struct LiveValue {
  std::string now;
  std::string after;
  std::string loss;  // "saturates"; empty when nothing is lost
};
using LiveValues = std::map<std::string, LiveValue>;  // by path

// A fate with what a controller knows of it.
struct FateLine {
  online_change::FateRow row;
  LiveValue live;  // empty: no single value stands for the row
  // In data memory, of a line for one variable; 0: that version has no such variable.
  uint32_t old_address = 0;
  uint32_t new_address = 0;
};

using PouEdits = std::vector<online_change::PouEdit>;
using SystemEdits = std::vector<online_change::SystemEdit>;

// Counts, then one row for each group of variables that is not kept, for each POU with other code,
// and for whatever else changes (system_edits.h).
std::string fate_report(const online_change::Plan& plan, const LiveValues& live,
                        const PouEdits& edits, const SystemEdits& system);
// "fates", "code", "system", "counts", "predicted_pause_ns" into an open object.
void fate_report(const online_change::Plan& plan, const LiveValues& live, const PouEdits& edits,
                 const SystemEdits& system, JsonWriter& json);

// One line for each variable: `--all`. JSON: "variables" into an open object.
std::string every_fate_text(std::span<const FateLine> lines);
void every_fate(std::span<const FateLine> lines, JsonWriter& json);
// Without a controller.
std::vector<FateLine> every_line(const online_change::Plan& plan, const ir::Image& old_image,
                                 const ir::Image& new_image);

FateLine every_line(const online_change::VariableFate& variable, const ir::Image& old_image,
                    const ir::Image& new_image);

// "12.5 us", "3 ms": three digits at most.
std::string duration(int64_t ns);

}  // namespace tools
