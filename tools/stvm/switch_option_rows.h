// Options of the commands that switch to another version: `change`, `revert`, `fleet change`.
#pragma once

#include "tools/common/option_rows.h"

#define STVM_SWITCH_OPTIONS                                                                      \
  tools::kYesOption, tools::kDryRunOption,                                                       \
      {"--all", nullptr, "show the fate of each variable too, with addresses and values"},       \
      {"--allow-loss", nullptr, "switch even if live values are lost, as the report says"},      \
      tools::kStrategyOption,                                                                    \
      {"--allow-overrun", nullptr, "switch even if a task may be delayed"},                      \
      tools::kRestrictedOption,                                                                  \
      {"--unrestricted", nullptr, "do not refuse that, whatever the project says"},              \
      {"--health", "NAME",                                                                       \
       "a BOOL that stays TRUE while all is well: FALSE in the first 1000 cycles undoes the "    \
       "change"},                                                                                \
      {"--unless", "NAME",                                                                       \
       "a BOOL of the running program: while it is TRUE nothing is switched, and a change that " \
       "is being prepared is aborted"},                                                          \
      {"--wait", nullptr, "wait while others change the controller, or have a change on trial"}, \
      {"--sign", "KEY", "sign it for a controller with keys; a private key of `stc key new`"},   \
      {"--no-auto-undo", nullptr,                                                                \
       "do not undo it when a trap stops a task in these cycles either"},                        \
  {                                                                                              \
    "--permanent", nullptr, "accept at once: no undo, the new program boots next"                \
  }
