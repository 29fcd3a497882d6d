#include "tools/common/dispatch.h"

#include <cstdio>
#include <cstring>

#include "tools/common/exit.h"

namespace tools {
namespace {

int run_command(const char* tool, const Entry& entry, std::span<char* const> args) {
  if (wants_help(args)) {
    std::fputs(help_text(tool, *entry.command).c_str(), stdout);
    return kOk;
  }
  base::Result<Options> options = Options::parse(*entry.command, args);
  return options.ok() ? entry.run(*options) : refuse(tool, options.error());
}

}  // namespace

int dispatch(const char* tool, const char* purpose, std::span<const Entry* const> entries, int argc,
             char** argv, const std::string& notes) {
  std::vector<const Command*> commands;
  for (const Entry* entry : entries) commands.push_back(entry->command);
  if (argc < 2) {
    std::fputs((overview(tool, purpose, commands) + notes).c_str(), stderr);
    return kUsage;
  }
  if (std::strcmp(argv[1], "--help") == 0 || std::strcmp(argv[1], "-h") == 0) {
    std::fputs((overview(tool, purpose, commands) + notes).c_str(), stdout);
    return kOk;
  }
  for (const Entry* entry : entries) {
    if (std::strcmp(argv[1], entry->command->name) == 0) {
      return run_command(tool, *entry, {argv + 2, argv + argc});
    }
  }
  return refuse(tool, {base::Refusal::kUsage,
                       std::string("unknown command `") + argv[1] + "`; see " + tool + " --help"});
}

}  // namespace tools
