// stvm-fleet: what `stvm fleet` hands over to. Its command line is stvm's, and it calls itself so;
// `--version` is of this program.
#include "adapters/mqtt/of_build.h"
#include "tools/common/refusal_text.h"
#include "tools/stvm/fleet_command.h"

int main(int argc, char** argv) {
  const tools::Entry fleet{&stvm::kFleetCommand, [](const tools::Options& options) {
                             return stvm::run_fleet(options, mqtt::connect_in_this_build);
                           }};
  const tools::Entry* const entries[] = {&fleet};
  const tools::Tool tool{
      "stvm",      "Goes through a fleet of controllers, for `stvm fleet`.",
      entries,     {{"adapters", tools::VersionFact::kTexts, mqtt::adapters_of_this_build()}},
      {},          {{"json", tools::refusal_json}},
      "stvm-fleet"};
  return tools::dispatch(tool, argc, argv);
}
