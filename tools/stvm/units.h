// The table of units of a running controller as people and scripts read it (E-06, D8): what each
// says, in which slot its code runs, and what was edited since the program was accepted.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "ir/bytecode/identities.h"
#include "tools/stvm/unit_message.h"
#include "vm/runtime/protocol.h"

namespace stvm {

// A POU as the controller tells of it, and as its own image does.
struct UnitView {
  UnitRow row;
  std::string kind;        // "function block", "method"
  std::string unit;        // that it belongs to: its own name, or that of its block
  base::Digest content{};  // identity of that unit (ir::parts_of); zeros: it has none
  bool edited = false;     // the unit is another one than in the program that was accepted last
  std::string edit;        // the newest one on trial that has edited it, by whom and when
  std::string edited_by;
  int64_t edited_ns = 0;
};

// An edit on trial, with the parts of the version that it was made on.
struct EditStep {
  TrialEdit edit;
  std::vector<ir::Part> before;
};

// `running`: the image that the rows are of. `edits`: those on trial, oldest first. Rows whose name
// matches none of the patterns are left out; without patterns none are.
std::vector<UnitView> unit_views(const std::vector<UnitRow>& rows, const ir::Image& running,
                                 const std::vector<EditStep>& edits,
                                 const std::vector<std::string>& patterns);

// What the controller is and can do, by name: ControllerClient::facts().
using ControllerFacts = std::map<std::string, std::string>;

std::string units_text(const std::vector<UnitView>& units);
std::string facts_text(const ControllerFacts& facts, const vm::StatusReport& status);
std::string units_json(const std::vector<UnitView>& units, const ControllerFacts& facts,
                       const vm::StatusReport& status);

}  // namespace stvm
