// The verbs of a roll-out by waves: `stvm fleet roll|resume|abort|watch` (docs/FLEET.md).
#pragma once

#include "tools/common/options.h"
#include "tools/stvm/fleet_broker.h"
#include "tools/stvm/fleet_visit.h"
#include "tools/stvm/package_making.h"

namespace stvm {

bool is_roll_verb(const std::string& verb);
int run_roll(const tools::Options& options, ConnectBroker connect);
std::string new_plan_id();
// Over sockets and ssh, with packages of that fleet file.
FleetAccess fleet_access(uint32_t patience_s, const std::string& file, const PackageOptions& made);

}  // namespace stvm
