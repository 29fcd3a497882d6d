// stvm-agent: what `stvm agent` hands over to. Its command line is stvm's, and it calls itself so.
#include "adapters/mqtt/of_build.h"
#include "tools/common/refusal_text.h"
#include "tools/stvm/agent_command.h"

int main(int argc, char** argv) {
  const tools::Entry agent{&stvm::kAgentCommand, [](const tools::Options& options) {
                             return stvm::run_agent(options, mqtt::connect_in_this_build);
                           }};
  const tools::Entry* const entries[] = {&agent};
  const tools::Tool tool{"stvm",  "Connects a controller to a broker, for `stvm agent`.",
                         entries, {},
                         {},      {{"json", tools::refusal_json}}};
  return tools::dispatch(tool, argc, argv);
}
