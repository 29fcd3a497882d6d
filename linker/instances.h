// The instance tree: every program and function block instance, in the order in
// which IDs are given (A10): programs in declaration order, then depth first the
// instances in each program, then those among the globals.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/program/ir.h"
#include "linker/initial.h"

namespace linker {

inline constexpr uint32_t kGlobalsNode = 0;

struct InstanceNode {
  ir::TypeId type;
  uint32_t parent = kGlobalsNode;  // node; programs: kGlobalsNode too
  uint32_t slot_offset = 0;        // of its ID slot in the parent's area; not for programs
  bool program = false;
  bool retained = false;  // the whole instance is RETAIN
  ir::ConstId init;       // what its declaration says, or invalid
  std::string name;       // path from the parent: "inst2", "arr[3]", "s.fb"
  uint32_t id = 0;        // row of the instance table
};

// Node 0 stands for the globals, and counts among the `most`.
base::Result<std::vector<InstanceNode>> walk_instances(const ir::Program& program,
                                                       const ir::Layouts& layouts, uint32_t most);

// Gives every node an ID and returns the table's rows without data and code. With
// a base, an instance with the same path and types keeps its ID; new ones take
// free IDs, lowest first, but none that only this change frees, so that undo finds
// those as they were.
base::Result<std::vector<ir::Instance>> number_instances(const ir::Program& program,
                                                         std::vector<InstanceNode>& nodes,
                                                         const ir::Image* base, uint32_t most);

}  // namespace linker
