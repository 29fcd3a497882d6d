// The controllers of a fleet: those that a command line names, and those of a file (E-27).
//
//   [controllers.line2]
//   host = "plc@line2"      # or dir = "/var/lib/stvm", or agent = "line2" (fleet_broker.h)
//   name = "Line 2"         # as results call it; else what stands after `controllers.`
//   allow_loss = true       # for this one only
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "tools/common/options.h"

namespace stvm {

// What the words say that name a place. kEither, of a command line without them: a folder where
// there is one, else a host.
enum class PlaceKind : uint8_t { kEither, kFolder, kHost, kAtAgent };

struct FleetMember {
  std::string name;   // as results call it
  std::string place;  // a state directory, a host, or what its agent is called at the broker
  bool allow_loss = false;
  PlaceKind kind = PlaceKind::kEither;
};

bool is_at_folder(const FleetMember& member);
bool is_at_agent(const FleetMember& member);

// Reads the list of a file. Mistakes with line and column (kBadProject).
base::Result<std::vector<FleetMember>> read_fleet_list(const std::string& file);
// The same of its text.
base::Result<std::vector<FleetMember>> parse_fleet_list(const std::string& file,
                                                        const std::string& text);
// --dir, --host, and --fleet FILE in the order of the file. kUsage: there is none, or two have one
// name.
base::Result<std::vector<FleetMember>> fleet_members(const tools::Options& options);

}  // namespace stvm
