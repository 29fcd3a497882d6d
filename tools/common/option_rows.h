// Options that several commands of either tool have, each declared once: it is spelt, explained and
// checked alike wherever it is taken. The lists below name what belongs together.
#pragma once

#include "tools/common/options.h"

namespace tools {

// What an image is compiled with. stvm hands these on to the stc beside it.
inline constexpr OptionRow kDialectOption{
    "--dialect",
    "NAME",
    "dialect of the sources: iec, codesys (default) or twincat",
#define DIALECT(id, name, what) name "|"
#include "frontend/dialects.def"
};
inline constexpr OptionRow kResourceOption{"--resource", "NAME",
                                           "the RESOURCE to compile, when there are several"};
inline constexpr OptionRow kDefineOption{
    "--define", "NAME", "for {IF defined(NAME)}; NAME=VALUE for hasvalue; repeatable",
    "",         "",     Times::kMany};
inline constexpr OptionRow kNameOption{"--name", "NAME",
                                       "name of the program, instead of the folder's or file's"};
inline constexpr OptionRow kJobsOption{
    "--jobs|-j", "N", "threads at most (default: one per core); the result is the same"};
inline constexpr OptionRow kWarnOption{"--warn|-W",
                                       "WHAT",
                                       "error: warnings are errors; CODE=LEVEL, such as W0003=off: "
                                       "error, warning, note or off; repeatable",
                                       "",
                                       "",
                                       Times::kMany};
#define TOOLS_COMPILE_OPTIONS                                                              \
  tools::kDialectOption, tools::kResourceOption, tools::kDefineOption, tools::kNameOption, \
      tools::kJobsOption, tools::kWarnOption
// The compile options that were given, as "--name=value".
std::vector<std::string> given_compile_options(const Options& options);

inline constexpr OptionRow kFormatOption{"--format", "FORM", "text (default) or json", "text|json"};
inline constexpr OptionRow kDiagnosticFormatOption{
    "--format", "FORM", "text (default), json, sarif or github", "text|json|sarif|github"};
inline constexpr OptionRow kYesOption{"--yes|-y", nullptr, "go on without asking"};
inline constexpr OptionRow kDryRunOption{
    "--dry-run", nullptr, "say what would happen, or why it would be refused; nothing is changed"};
inline constexpr OptionRow kRestrictedOption{
    "--restricted", nullptr, "refuse when the interface of a POU is edited", "", "--unrestricted"};
inline constexpr OptionRow kMatchingOption{
    "--matching", nullptr,
    "for a fleet file: take only the units that are there as before the edit"};
inline constexpr OptionRow kStrategyOption{
    "--strategy", "S",
    "in-place (default, or what the project says), or standby: a second data area, made in idle "
    "time",
    "in-place|standby"};

// What every command takes without a row of its own; dispatch() carries it out.
inline constexpr OptionRow kQuietOption{
    "--quiet|-q", nullptr, "print only what --format asks for; errors and the exit code stay"};
inline constexpr OptionRow kColorOption{
    "--color", "WHEN",
    "auto (default), always or never; $NO_COLOR and $CLICOLOR_FORCE say it for all commands",
    "auto|always|never"};
inline constexpr OptionRow kEveryCommand[] = {kQuietOption, kColorOption};

// Options of runs in this process: `stvm run`, `replay`, `serve`.
inline constexpr OptionRow kScansOption{"--scans", "N",
                                        "control cycles to run (default: all, or until stopped)"};
inline constexpr OptionRow kPrintOption{
    "--print", "NAMES", "print these variables at the end: A,B.c; patterns too; repeatable",
    "",        "",      Times::kMany};
inline constexpr OptionRow kPlotOption{"--plot", "FILE",
                                       "SVG picture of the variables of --print over the run"};
inline constexpr OptionRow kTraceOption{
    "--trace", "FILE", "CSV: values after every scan, of --print or of all variables"};
inline constexpr OptionRow kRecordOption{"--record", "FILE", "record the run, for `stvm replay`"};

// Options of everything that talks to a controller.
inline constexpr OptionRow kDirOption{
    "--dir", "STATE", "state directory of the controller (default: $STVM_DIR, else .stvm)"};
inline constexpr OptionRow kHostOption{"--host", "HOST",
                                       "the controller runs there; reached with ssh"};
inline constexpr OptionRow kIntervalOption{
    "--interval", "MS", "time between two samples, in milliseconds (default: 500; of `top` 1000)"};
inline constexpr OptionRow kCountOption{"--count", "N", "samples to take (default: until stopped)"};

}  // namespace tools
