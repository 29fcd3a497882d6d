// Forces on variables of one version of a program, and what takes them to another.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "ir/bytecode/symbols.h"
#include "vm/load/forced_code.h"
#include "vm/runtime/process_image.h"

namespace vm {

struct Force {
  std::string path;
  ir::Symbol symbol;
  base::Bytes value;
  // Why it holds at the boundaries of cycles only (ForcedCode); "": it holds everywhere.
  std::string reason = {};
};
std::string value_text(const ir::Image& image, const Force& force);
// Have they bytes in common, or bits of %I? Of members of a union and of inputs at overlapping
// addresses only one can be held.
bool overlap(const Force& a, const Force& b, const ProcessImage& process_image);
// "everywhere", or "at the boundaries of cycles: " and the reason.
std::string hold_text(const std::string& reason);
struct NamedValue {
  std::string path;
  std::string value;
};

// Shared, so that a boundary neither takes nor frees memory for it. Null: none.
using ForceList = std::shared_ptr<const std::vector<Force>>;

// What a switch to a version does to forces.
struct MovedForces {
  ForceList ended;  // those that were not adopted, on variables of the version before
  // On variables of this one: what the switch away from it has ended. Those whose place is free are
  // forced again.
  ForceList back;
};

// The forces on a generation's variables.
struct ForcedSet {
  std::vector<Force> forces;
  MovedForces moved;  // of a version that waits
  // What forced inputs are as %I, and which bits of %I these are: variables at overlapping
  // addresses see each other's forces. Empty: no input is forced.
  base::Bytes inputs;
  base::Bytes input_mask;
  std::shared_ptr<const ForcedCode> code;  // null: that of the generation
  uint64_t made_of = 0;                    // CodeTable::number of the generation's code
  // Finds out how `forces` hold on variables of the image, and makes the code.
  static ForcedSet make(const ir::VerifiedImage& image, const CodeTable& own,
                        std::vector<Force> forces, const TierOptions& tier);
  // Adopts forces of another image by path; what has no place of its kind here ends, and what had
  // ended when this version was left comes `back`.
  static ForcedSet adopt(const ir::VerifiedImage& image, const CodeTable& own,
                         const ir::Image& from, const std::vector<Force>& forces,
                         const TierOptions& tier, ForceList back);
};

// What prepare_force() made: for every version of the program that runs or can come to run.
struct ForceChange {
  struct Row {
    const Generation* generation = nullptr;
    ForcedSet set;
  };
  std::vector<Row> rows;
};

}  // namespace vm
