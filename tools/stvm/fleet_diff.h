// What differs between two programs of a fleet (E-32): by unit and other parts, each with both
// identities, and by variable.
#pragma once

#include <string>
#include <vector>

#include "ir/bytecode/identities.h"
#include "tools/common/json.h"

namespace stvm {

struct PartDifference {
  ir::PartKind kind = ir::PartKind::kUnit;
  std::string name;
  base::Digest one{};  // zeros: it has none
  base::Digest other{};
};

// A global, or a variable that every instance of a block has.
struct VariableDifference {
  std::string name;  // "level", "Pump.speed"
  std::string one;   // "INT RETAIN"; "": it has none
  std::string other;
  bool value = false;  // only the initial value
};

struct FleetDifference {
  std::string one;  // as people name it
  std::string other;
  std::vector<PartDifference> parts;
  std::vector<VariableDifference> variables;
};

// Sorted by kind and name; by name.
FleetDifference fleet_difference(const ir::Image& one, const ir::Image& other);
std::string difference_text(const FleetDifference& difference);
void difference_json(const FleetDifference& difference, tools::JsonWriter& json);

}  // namespace stvm
