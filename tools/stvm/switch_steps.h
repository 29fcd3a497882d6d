// From a change package to its switch: stage it, show every variable's fate, ask, switch.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/common/options.h"
#include "tools/stvm/controller_client.h"

namespace stvm {

// What the command line and stc.toml say of it.
struct SwitchOptions {
  uint32_t stage_flags = 0;   // vm::StageFlags
  uint32_t switch_flags = 0;  // vm::SwitchFlags
  bool restricted = false;    // for who makes the package
  std::string health;         // a BOOL that must stay TRUE, or the controller undoes the change
  std::string unless;         // a BOOL; while it is TRUE nothing is switched
  std::string note;           // what the journal says of it (E-33)
  base::Bytes guard = {};     // conditions of its trial, as vm::Command::kGuard has them; none
  int64_t window_ms = 0;      // so long the controller looks at values before the switch
  uint32_t wave = 1;          // of a roll-out
  std::string taken_out;      // the edit whose work it takes back
  std::string sign = {};      // file of the key to sign it with; "": nobody signs it
  bool dry_run = false;
  bool all = false;  // a line for each variable
  bool wait = false;  // for the changes of others
  bool ask = true;
  bool json = false;
  // Asked instead of the question, where somebody asks in another way.
  std::function<base::Status()> confirm = {};
};
// Reads the options of `stvm change`.
base::Result<SwitchOptions> switch_options(const tools::Options& options);
// Where the project of other paths says what the command line does not.
base::Result<SwitchOptions> switch_options(const tools::Options& options,
                                           const std::vector<std::string>& paths);

struct Outcome {
  using Time = std::chrono::steady_clock::time_point;
  FatePage page;
  std::vector<FateLine> every;  // by --all
  std::vector<std::string> exchange;
  std::optional<online_change::SwitchReport> report;
  std::optional<base::Error> refused;  // after the report was made
  Time staged;                         // the controller has checked and prepared it
  Time shown;                          // its fates
  bool permanent = false;              // accepted at once, as it was asked for or is the first one
};

// kChangePending while a change is on trial.
base::Status check_no_trial(const vm::StatusReport& status);
// Prints the fates on the way, unless that is JSON's. What is not switched is cancelled.
base::Result<Outcome> bring(const SwitchOptions& options, ControllerClient& client,
                            base::ByteSpan package);
// Switches to what is staged already.
base::Result<Outcome> bring_staged(const SwitchOptions& options, ControllerClient& client);
void print(const SwitchOptions& options, const Outcome& outcome);

}  // namespace stvm
