// In which order the parts of an edit arrive where its units start one after the other (E-23 to
// E-25). A step is the table, which is all that is no unit, or one unit with its variables
// (ir::of_step).
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/part_edits.h"

namespace linker {

enum class StepOrder : uint8_t {
  kTableFirst,    // the table, then the units as they stand in the sources
  kTableLast,     //
  kCalleesFirst,  // the table, then each unit after those that it calls
  kCallersFirst,  //
};

struct EditImages {
  const ir::Image& original;  // both are verified
  const ir::Image& edited;
};

// Names of the steps. Units that the edit removes come last: others call them until then.
base::Result<std::vector<std::string>> edit_steps(const EditImages& edit, StepOrder order);
// The steps in the order of `names`, where the table comes first unless they have ir::kTableName.
// kUsage: a name is no step of the edit, or stands there twice, or one is missing.
base::Result<std::vector<std::string>> listed_steps(const EditImages& edit,
                                                    const std::vector<std::string>& names);

// A unit that would run with an old version of one that it calls, until that arrives.
struct RunsBefore {
  std::string unit;
  std::string needs;
};
base::Result<std::vector<RunsBefore>> runs_before(const EditImages& edit,
                                                  const std::vector<std::string>& steps);

}  // namespace linker
