// What calls need at most: linker and verifier measure the same way.
//
// A POU with a recursion depth n is active at most n times at once (the interpreter counts), so
// every circle of calls must lead through such a POU. In a group of POUs that call each other,
// at most K activations of declared POUs exist (the sum of their depths), and between two of them
// a chain of others in which none occurs twice.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/bytecode/image.h"

namespace ir {

struct CallNode {
  std::vector<uint32_t> callees;
  uint64_t frame_bytes = 0;
  uint64_t native_bytes = 0;     // argument slots of native calls
  uint32_t recursion_depth = 0;  // at most kMaxCallDepth
  bool is_pou = true;            // false: a choice between its callees, see DynamicCalls
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

// Calls whose callee is known at run time only are edges to a node of their own, after those of
// the POUs, which leads to everything that may run.
class DynamicCalls {
 public:
  explicit DynamicCalls(const Image& image)
      : pous_(static_cast<uint32_t>(image.pous.size())), types_(image.types.size()) {}

  // CALL_REF: the body of the type or of one that extends it.
  uint32_t any_body(TypeId type) const { return pous_ + type.index; }
  // CALL_VIRTUAL: what stands for the prototype in some type.
  uint32_t any_target(uint32_t prototype) const { return pous_ + types_ + prototype; }
  // After `nodes`, one for each POU of the image; `pou_of_type`: bodies, by type number.
  void add_nodes(const Image& image, const std::vector<uint32_t>& pou_of_type,
                 std::vector<CallNode>& nodes) const;

 private:
  uint32_t pous_;
  uint32_t types_;
};

}  // namespace ir
