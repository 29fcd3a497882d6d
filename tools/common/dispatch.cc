#include "tools/common/dispatch.h"

#include <cstdio>
#include <string_view>

#include "base/nearest_name.h"
#include "tools/common/exit.h"
#include "tools/common/help.h"

namespace tools {
namespace {

constexpr OptionRow kFormatOptions[] = {
    {"--format", "FORM", "text (default) or json", "text|json"}};
constexpr Command kHelp{"help", "[COMMAND]", "Lists the commands, or the options of one.",
                        kFormatOptions, 0, 1};
constexpr Command kVersionCommand{
    "version", "", "Says version and commit, and what was built in.", kFormatOptions, 0, 0};

std::vector<const Command*> commands_of(const Tool& tool) {
  std::vector<const Command*> commands;
  for (const Entry* entry : tool.entries) commands.push_back(entry->command);
  commands.push_back(&kHelp);
  commands.push_back(&kVersionCommand);
  return commands;
}

std::string overview_of(const Tool& tool) {
  return overview(tool.name, tool.purpose, commands_of(tool)) + tool.notes;
}

base::Error unknown_command(const Tool& tool, std::string_view given) {
  base::NearestName nearest(given);
  for (const Command* command : commands_of(tool)) nearest.offer(command->name);
  return {base::Refusal::kUsage, "unknown command `" + std::string(given) + "`; see " + tool.name +
                                     " --help" + nearest.question()};
}

int say(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  return kOk;
}

int run_help(const Tool& tool, const Options& options) {
  const std::vector<const Command*> commands = commands_of(tool);
  const bool json = options.text("--format") == "json";
  if (options.arguments().empty()) {
    return say(json ? help_json(tool.name, tool.purpose, commands) : overview_of(tool));
  }
  const std::string& wanted = options.arguments()[0];
  for (const Command* command : commands) {
    if (wanted != command->name) continue;
    const Command* const one[] = {command};
    return say(json ? help_json(tool.name, tool.purpose, one) : help_text(tool.name, *command));
  }
  return refuse(tool.name, unknown_command(tool, wanted));
}

int run_version(const Tool& tool, const Options& options) {
  return say(options.text("--format") == "json" ? version_json(tool.name, tool.facts)
                                                : version_text(tool.name, tool.facts));
}

// Parses what stands behind the command, and runs it.
template <class Run>
int with_options(const Tool& tool, const Command& command, std::span<char* const> args, Run run) {
  if (wants_help(args)) return say(help_text(tool.name, command));
  base::Result<Options> options = Options::parse(command, args);
  return options.ok() ? run(*options) : refuse(tool.name, options.error());
}

}  // namespace

int dispatch(const Tool& tool, int argc, char** argv) {
  if (argc < 2) {
    std::fputs(overview_of(tool).c_str(), stderr);
    return kUsage;
  }
  const std::string_view verb = argv[1];
  const std::span<char* const> args(argv + 2, argv + argc);
  if (verb == kHelp.name || verb == "--help" || verb == "-h") {
    return with_options(tool, kHelp, args, [&](const Options& given) {
      return run_help(tool, given);
    });
  }
  if (verb == kVersionCommand.name || verb == "--version" || verb == "-V") {
    return with_options(tool, kVersionCommand, args, [&](const Options& given) {
      return run_version(tool, given);
    });
  }
  for (const Entry* entry : tool.entries) {
    if (verb == entry->command->name) return with_options(tool, *entry->command, args, entry->run);
  }
  return refuse(tool.name, unknown_command(tool, verb));
}

}  // namespace tools
