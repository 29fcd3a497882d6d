// Outputs that code of one version writes and no code of another one does, though it has them still
// (X1, change case 67): they stay as they are for ever. Borrows nothing.
#pragma once

#include <string>
#include <vector>

#include "ir/bytecode/image.h"
#include "ir/bytecode/symbols.h"

namespace vm {

struct LeftOutput {
  ir::DirectAddress address;
  std::string path;   // in the old version
  ir::Symbol symbol;  // likewise
};

struct RunningCode {
  const ir::Image& image;
  const std::vector<bool>& pous;  // ir::CallFacts::running
};

// The old image has the names of the new one. What no task runs writes nothing. What a reference or
// a VAR_IN_OUT of the new version may lead to counts as written. Cost: one pass over the code of
// each version that has outputs; where the POUs that are others do what they did, and more, over
// the code of these alone.
std::vector<LeftOutput> left_outputs(const RunningCode& before, const RunningCode& after);

}  // namespace vm
