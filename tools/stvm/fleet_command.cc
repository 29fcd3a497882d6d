#include "tools/stvm/fleet_command.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "tools/common/files.h"
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

// The options that were given, as on the command line.
std::vector<std::string> command_line(const tools::Command& command,
                                      const tools::Options& options) {
  std::vector<std::string> words = {command.name};
  const auto add = [&](const tools::OptionRow& row) {
    const std::string name(tools::long_name(row));
    if (row.value == nullptr && options.has(name)) words.push_back(name);
    if (row.value == nullptr) return;
    for (const std::string& value : options.all(name)) words.push_back(name + "=" + value);
  };
  for (const tools::OptionRow& row : command.options) add(row);
  for (const tools::OptionRow& row : tools::kEveryCommand) add(row);
  words.emplace_back("--");
  words.insert(words.end(), options.arguments().begin(), options.arguments().end());
  return words;
}

int hand_over(const tools::Options& options) {
  const std::string program = tools::own_folder() + "/" + kFleetProgram;
  std::vector<std::string> words = command_line(kFleetCommand, options);
  words.insert(words.begin(), program);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  ::execv(program.c_str(), argv.data());
  return refuse({base::Refusal::kFileNotFound,
                 program + ": " + std::strerror(errno) + "; it comes with stc"});
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

const Entry kFleet{&kFleetCommand, hand_over};

}  // namespace stvm
