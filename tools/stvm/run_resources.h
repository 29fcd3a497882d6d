// `stvm run` of several resources: all in this process, with their globals exchanged.
#pragma once

#include <optional>
#include <vector>

#include "tools/common/json.h"
#include "tools/stvm/resource_controller.h"

namespace stvm {

struct RunSettings {
  bool json = false;
  std::optional<uint64_t> scans;
  std::vector<std::string> print;
};

// In virtual time the resources take turns in one thread: the one whose control cycle begins first
// is next, of equals the one that stands first in `resources`. Otherwise each has a thread. `scans`
// counts cycles of the first. Names begin with the resource's. The exit code.
base::Result<int> run_resources(const std::vector<vm::GlobalExchange::Resource>& resources,
                                RunSettings settings, const tools::Options& options);

// --set and --force, in this order; those of `resource` (all, when it is ""), without its name.
// What is done is noted in the recording.
base::Status apply_assignments(const tools::Options& options, const std::string& resource,
                               vm::Controller& controller, vm::Recorder* recorder);
// A task that is still inside its scan would show half of its results.
void finish_scan(ResourceController& resource);
std::string value_of(const vm::Controller& controller, const std::string& name);
// As `stvm get --format json` has it (json_value.h).
void typed_value_of(tools::JsonWriter& json, const vm::Controller& controller,
                    const std::string& name);
// Instances leave, outputs become safe, traps are printed. Was everything as it should be?
bool end_run(ResourceController& resource);

}  // namespace stvm
