#include "tools/stvm/agent_command.h"

#include "tools/stvm/hand_over.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kAgentOptions[] = {
    STVM_DIR_OPTION,
    {"--broker", "FILE", "the broker: [broker] of this file (docs/FLEET.md)"},
    {"--trust", "KEYS", "carry out only what a key of this file has signed (docs/KEYS.md)"},
};

int hand_over_agent(const tools::Options& options) {
  return hand_over(kAgentCommand, kAgentProgram, "stvm-agent", options);
}

}  // namespace

const tools::Command kAgentCommand{
    "agent",
    "",
    "Connects a controller to a broker of MQTT, and does there what `stvm fleet` orders.",
    kAgentOptions,
    0,
    0};

const Entry kAgent{&kAgentCommand, hand_over_agent};

}  // namespace stvm
