#include "tools/common/dispatch.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "base/joined.h"
#include "base/nearest_name.h"
#include "tools/common/exit.h"
#include "tools/common/help.h"
#include "tools/common/option_rows.h"
#include "tools/common/outputs.h"
#include "tools/common/terminal.h"

namespace tools {
namespace {

constexpr OptionRow kFormatOptions[] = {kFormatOption};
constexpr Command kHelp{"help",         "[COMMAND]", "Lists the commands, or the options of one.",
                        kFormatOptions, 0,           1};
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
  return {base::Refusal::kUsage, base::joined({"unknown command `", given, "`; see ", tool.name,
                                               " --help", nearest.question()})};
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
  const char* const name = tool.program == nullptr ? tool.name : tool.program;
  return say(options.text("--format") == "json" ? version_json(name, tool.facts)
                                                : version_text(name, tool.facts));
}

// What --format says, also on a command line with mistakes, which are said in that form.
std::string_view wanted_format(std::span<char* const> args) {
  constexpr std::string_view kFormat = "--format";
  for (size_t i = 0; i < args.size(); ++i) {
    const std::string_view arg = args[i];
    if (arg == "--") break;
    if (arg == kFormat && i + 1 < args.size()) return args[i + 1];
    if (arg.starts_with(kFormat) && arg.substr(kFormat.size(), 1) == "=") {
      return arg.substr(kFormat.size() + 1);
    }
  }
  return {};
}

RefusalForm form_of(const Tool& tool, std::string_view format) {
  for (const NamedForm& row : tool.forms) {
    if (format == row.name) return row.form;
  }
  return nullptr;
}

// A file that is opened would take the number of a standard stream that is closed, and get what is
// printed. What is printed to the stand-in fails, and that is said at the end.
void stand_in_for_closed_streams() {
  for (int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    (void)::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

// The exit code, when all that was printed has arrived.
int check_output(const Tool& tool, int code) {
  const bool before = std::ferror(stdout) != 0;
  if (std::fflush(stdout) == 0 && !before) return code;
  std::fprintf(
      stderr,
      "%s: standard output could not be written%s%s\n"
      "  help: the command has done its work, but its output is not complete; free space, or "
      "write to another place\n",
      tool.name, before ? "" : ": ", before ? "" : std::strerror(errno));
  return code == kOk || code == kFindings ? kOutputLost : code;
}

// From here on what is printed goes nowhere. The descriptor stays as it is: `-o /dev/stdout` is a
// file like any other.
void be_quiet() {
  std::FILE* const nowhere = std::fopen("/dev/null", "w");
  if (nowhere != nullptr) stdout = nowhere;
}

// Parses what stands after the command, and runs it.
template <class Run>
int with_options(const Tool& tool, const Command& command, std::span<char* const> args, Run run) {
  if (wants_help(args)) return say(help_text(tool.name, command));
  set_refusal_form(form_of(tool, wanted_format(args)));
  base::Result<Options> options = Options::parse(command, args);
  if (!options.ok()) return refuse(tool.name, options.error());
  choose_colour(options->text("--color"));
  if (options->has("--quiet") && options->text("--format", "text") == "text") be_quiet();
  return run(*options);
}

}  // namespace

static int run_tool(const Tool& tool, int argc, char** argv) {
  if (argc < 2) {
    std::fputs(overview_of(tool).c_str(), stderr);
    return kUsage;
  }
  const std::string_view verb = argv[1];
  const std::span<char* const> args(argv + 2, argv + argc);
  if (verb == kHelp.name || verb == "--help" || verb == "-h") {
    return with_options(tool, kHelp, args,
                        [&](const Options& given) { return run_help(tool, given); });
  }
  if (verb == kVersionCommand.name || verb == "--version" || verb == "-V") {
    return with_options(tool, kVersionCommand, args,
                        [&](const Options& given) { return run_version(tool, given); });
  }
  for (const Entry* entry : tool.entries) {
    if (verb != entry->command->name) continue;
    return with_options(tool, *entry->command, args, [&](const Options& given) {
      // What is signed may be signed in place.
      base::Status free = check_outputs(given, verb == "key");
      return free.ok() ? entry->run(given) : refuse(tool.name, free.error());
    });
  }
  return refuse(tool.name, unknown_command(tool, verb));
}

int dispatch(const Tool& tool, int argc, char** argv) {
  stand_in_for_closed_streams();
  // A file that may not grow any further is an error of the write, not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  return check_output(tool, run_tool(tool, argc, argv));
}

}  // namespace tools
