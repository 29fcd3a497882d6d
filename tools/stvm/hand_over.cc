#include "tools/stvm/hand_over.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "tools/common/files.h"
#include "tools/stvm/commands.h"

namespace stvm {
namespace {

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

}  // namespace

int hand_over(const tools::Command& command, const char* name, const char* package,
              const tools::Options& options) {
  const std::string program = tools::own_folder() + "/" + name;
  std::vector<std::string> words = command_line(command, options);
  words.insert(words.begin(), program);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  ::execv(program.c_str(), argv.data());
  return refuse({base::Refusal::kFileNotFound,
                 program + ": " + std::strerror(errno) + "; it comes with the package " + package});
}

}  // namespace stvm
