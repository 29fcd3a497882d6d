// The command line of `stvm fleet`. stvm runs on controllers and has no more of it than that: what
// goes through a fleet is a program of its own beside it, stvm-fleet.
#pragma once

#include "tools/stvm/commands.h"
#include "tools/stvm/fleet_broker.h"

namespace stvm {

// The program beside stvm.
inline constexpr const char* kFleetProgram = "stvm-fleet";
extern const tools::Command kFleetCommand;
// What stvm-fleet does.
int run_fleet(const tools::Options& options, ConnectBroker connect);

}  // namespace stvm
