// What a controller says of a roll-out, by its journal and its edits on trial: was the edit of that
// plan brought, and what became of it? The tool asks by ssh or a folder, an agent beside its
// controller.
#pragma once

#include <string>

#include "tools/stvm/controller_client.h"

namespace stvm {

// The journal says so of a switch that takes back what was accepted.
inline constexpr const char* kBackNote = "back, ";

struct PlanTrace {
  bool answers = false;
  bool on_trial = false;
  bool switched = false;  // by this plan, at some time
  bool accepted = false;
  std::string edit;
  base::Digest from{};
  base::Digest to{};
  std::string text;   // of what became of it
  std::string alarm;  // it is sick, and could not take the edit back
};

// `known`: the edit that was seen on trial before; while it still is, the journal is not read.
PlanTrace find_plan(ControllerClient& client, const std::string& plan, const PlanTrace& known);

}  // namespace stvm
