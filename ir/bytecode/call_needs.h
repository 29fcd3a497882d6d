// What calls need at most: linker and verifier measure the same way.
//
// A POU with a recursion depth n is active at most n times at once (the interpreter counts), so
// every circle of calls must lead through such a POU. In a group of POUs that call each other,
// at most K activations of declared POUs exist (the sum of their depths), and between two of them
// a chain of others in which none occurs twice.
#pragma once

#include <cstdint>
#include <vector>

namespace ir {

struct CallNode {
  std::vector<uint32_t> callees;
  uint64_t frame_bytes = 0;
  uint64_t native_bytes = 0;     // argument slots of native calls
  uint32_t recursion_depth = 0;  // at most kMaxCallDepth
};

struct CallNeeds {
  uint64_t bytes = 0;  // of frames, its own included
  uint64_t depth = 0;  // POUs in the longest chain, itself included
};

struct CallMeasure {
  std::vector<CallNeeds> of;     // by node
  std::vector<uint32_t> circle;  // not empty: a circle without a declared POU, `of` means nothing
};
CallMeasure measure_calls(const std::vector<CallNode>& nodes);

}  // namespace ir
