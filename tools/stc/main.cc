// stc: the compiler's command line. Find the command, parse its options, run it.
#include <cstdio>
#include <cstring>

#include "tools/common/exit.h"
#include "tools/stc/commands.h"

namespace {

const stc::Entry* const kEntries[] = {&stc::kCheck,   &stc::kBuild, &stc::kDiff,
                                      &stc::kPackage, &stc::kDump,  &stc::kExplain};

std::string overview() {
  std::vector<const tools::Command*> commands;
  for (const stc::Entry* entry : kEntries) commands.push_back(entry->command);
  return tools::overview("stc", "Compiles IEC 61131-3 programs to images for stvm.", commands);
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
  for (const stc::Entry* entry : kEntries) {
    if (std::strcmp(argv[1], entry->command->name) != 0) continue;
    if (tools::wants_help(args)) {
      std::fputs(tools::help_text("stc", *entry->command).c_str(), stdout);
      return tools::kOk;
    }
    base::Result<tools::Options> options = tools::Options::parse(*entry->command, args);
    if (!options.ok()) return tools::refuse("stc", options.error());
    return entry->run(*options);
  }
  return tools::refuse("stc", {base::Refusal::kUsage,
                               std::string("unknown command `") + argv[1] + "`; see stc --help"});
}
