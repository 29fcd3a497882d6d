// stvm-agent: what `stvm agent` hands over to. Its command line is stvm's, and it calls itself so;
// `--version` is of this program.
#include "adapters/mqtt/of_build.h"
#include "tools/common/refusal_text.h"
#include "tools/stvm/agent_command.h"

int main(int argc, char** argv) {
  const tools::Entry agent{&stvm::kAgentCommand, [](const tools::Options& options) {
                             return stvm::run_agent(options, mqtt::connect_in_this_build);
                           }};
  const tools::Entry* const entries[] = {&agent};
  const tools::Tool tool{
      "stvm",      "Connects a controller to a broker, for `stvm agent`.",
      entries,     {{"adapters", tools::VersionFact::kTexts, mqtt::adapters_of_this_build()}},
      {},          {{"json", tools::refusal_json}},
      "stvm-agent"};
  return tools::dispatch(tool, argc, argv);
}
