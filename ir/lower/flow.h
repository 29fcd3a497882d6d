// Order of emission: the reachable blocks in reverse post order, so that only back
// edges jump backwards, with blocks of their own for edges that need code.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/program/ir.h"

namespace ir::codegen {

inline constexpr uint32_t kNoHandler = 0xffffffffu;

struct FlowBlock {
  BlockId source;                              // invalid: a split edge
  uint32_t handler = kNoHandler;               // position of the handler of its try
  const Target* edge = nullptr;                // of a split edge: where it goes
  base::InlineVector<uint32_t, 2> successors;  // positions, parallel to the terminator's targets
};

struct Flow {
  std::vector<FlowBlock> blocks;  // in order of emission
};

// Splits edges of branches and switches that pass arguments, the second of two backward ones of a
// branch, backward ones of a table, and the way to a handler that lies before its try.
Flow order_blocks(const Pou& pou);

}  // namespace ir::codegen
