#include "tools/stvm/fleet_command.h"

#include "tools/stvm/hand_over.h"
#include "tools/stvm/switch_option_rows.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kFleetOptions[] = {
    {"--dir", "DIR", "state directory of a controller; repeatable", "", "", tools::Times::kMany},
    {"--host", "HOST", "[user@]host of a controller, by ssh; repeatable", "", "",
     tools::Times::kMany},
    {"--fleet", "FILE", "the controllers of this file (docs/FLEET.md)"},
    {"--jobs|-j", "N", "how many controllers at once (default 1)"},
    {"--timeout", "SECONDS", "give up a controller that does not answer for so long (default 60)"},
    {"--one-by-one", nullptr, "wait until a controller answers, do it, and wait for the next one"},
    STVM_SWITCH_OPTIONS,
    {"--trust", "KEYS", "take only a fleet file that a key of this file has signed"},
    tools::kMatchingOption,
    {"--confirm-each-wave", nullptr,
     "ask before each wave of a roll-out, not only before the first"},
    STVM_FORMAT_OPTION,
};

int hand_over_fleet(const tools::Options& options) {
  return hand_over(kFleetCommand, kFleetProgram, "stc", options);
}

}  // namespace

const tools::Command kFleetCommand{
    "fleet",
    "VERB [FILE|PLAN|A B]",
    "Makes the edit of a fleet file (stc fleet) on many controllers (VERB: change), takes it\n"
    "back (undo) or accepts it (accept), goes on with those left (continue), or says who has\n"
    "what of it (status) and what differs between them (diff). Brings it by waves (roll), goes\n"
    "on with that (resume), takes it back (abort), or shows it (watch).",
    kFleetOptions,
    1,
    3};

const Entry kFleet{&kFleetCommand, hand_over_fleet};

}  // namespace stvm
