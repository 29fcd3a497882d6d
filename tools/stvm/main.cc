// stvm: the controller's command line. Find the command, parse its options, run it.
#include <cstdio>
#include <cstring>

#include "tools/common/exit.h"
#include "tools/stvm/commands.h"

namespace {

const stvm::Entry* const kEntries[] = {
    &stvm::kRun,  &stvm::kBench,  &stvm::kServe,   &stvm::kStatus, &stvm::kGet,
    &stvm::kSet,  &stvm::kForce,  &stvm::kUnforce, &stvm::kWatch,  &stvm::kChange,
    &stvm::kUndo, &stvm::kAccept, &stvm::kStop};

std::string overview() {
  std::vector<const tools::Command*> commands;
  for (const stvm::Entry* entry : kEntries) commands.push_back(entry->command);
  return tools::overview("stvm", "Runs images of stc, and changes them while they run.", commands);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs(overview().c_str(), stderr);
    return tools::kUsage;
  }
  if (std::strcmp(argv[1], "--help") == 0 || std::strcmp(argv[1], "-h") == 0) {
    std::fputs(overview().c_str(), stdout);
    return tools::kOk;
  }
  std::span<char* const> args(argv + 2, argv + argc);
  for (const stvm::Entry* entry : kEntries) {
    if (std::strcmp(argv[1], entry->command->name) != 0) continue;
    if (tools::wants_help(args)) {
      std::fputs(tools::help_text("stvm", *entry->command).c_str(), stdout);
      return tools::kOk;
    }
    base::Result<tools::Options> options = tools::Options::parse(*entry->command, args);
    if (!options.ok()) return stvm::refuse(options.error());
    return entry->run(*options);
  }
  return stvm::refuse(
      {base::Refusal::kUsage, std::string("unknown command `") + argv[1] + "`; see stvm --help"});
}
