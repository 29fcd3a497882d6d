// The command line of `stvm agent`. What it does is a program of its own beside stvm, stvm-agent.
#pragma once

#include "tools/stvm/commands.h"
#include "tools/stvm/fleet_broker.h"

namespace stvm {

inline constexpr const char* kAgentProgram = "stvm-agent";
extern const tools::Command kAgentCommand;
// What stvm-agent does, until a signal ends it.
int run_agent(const tools::Options& options, ConnectBroker connect);

}  // namespace stvm
