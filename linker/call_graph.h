// Who calls whom: recursion is refused, and the deepest chain says how much stack
// a program needs (V11).
#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/call_needs.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"

namespace linker {

struct StackNeeds {
  uint32_t bytes = 0;  // over all priorities
  uint32_t depth = 0;  // frames of the deepest chain
};

// Do both call the same, with the same room for arguments of natives? Then a graph with one is that
// with the other, if their frames are as large.
bool same_calls(const ir::Object& a, const ir::Object& b);

// By POU number, and after them what calls that are decided at run time lead to
// (ir::DynamicCalls). `objects` by POU number, null for unused numbers.
std::vector<ir::CallNode> call_nodes(const ir::Image& image,
                                     const std::vector<const ir::Object*>& objects);

// `objects` by POU number, null for unused numbers; image.pous have their frame sizes.
base::Result<StackNeeds> stack_needs(const ir::Image& image,
                                     const std::vector<const ir::Object*>& objects);

}  // namespace linker
