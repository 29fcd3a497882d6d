// Who has what (E-32): a row for each part, a column for each controller, and what is odd there.
#pragma once

#include <string>
#include <vector>

#include "tools/common/json.h"
#include "tools/stvm/fleet_result.h"

namespace stvm {

// What is known of one part on one controller that was reached.
struct FleetCell {
  base::Digest here{};  // zeros: it has none
  std::string text;     // the state, or the first digits of the identity
  bool odd = false;
};

struct FleetLine {
  ir::PartKind kind = ir::PartKind::kUnit;
  std::string name;
  base::Digest original{};  // of an edit; zeros: it adds it, or there is no edit
  base::Digest edited{};
  base::Digest most{};  // what most of them have; of two that are as frequent, the smaller one
  std::vector<FleetCell> cells;  // by controller
};

struct FleetMatrix {
  std::vector<std::string> controllers;  // those that were reached
  std::vector<FleetLine> lines;
  bool differs = false;  // something is odd
};

// With an edit: the parts that it changes; odd is what is missing or different. Without one: all
// parts; odd is what most do not have.
FleetMatrix fleet_matrix(const std::vector<FleetRow>& rows, bool of_edit);

// Controllers that are alike in all that is shown are one column, under the name of the first one
// and "+N"; below stands who they are. 80 columns wide; what does not fit stands below. Of parts
// that are the same everywhere a line says how many there are, unless `all` are wanted.
std::string matrix_text(const FleetMatrix& matrix, bool of_edit, bool all);
// An array of the lines.
void matrix_json(const FleetMatrix& matrix, tools::JsonWriter& json);

}  // namespace stvm
