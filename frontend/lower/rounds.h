// Whether the rounds of a loop can differ.
#pragma once

#include <span>

#include "ir/program/ir.h"

namespace frontend {

// True: what `condition` computes is the same in each round, since nothing in `loop`, which holds
// it, stores what it reads. False where that is not certain: calls, references, overlapping places.
bool is_same_each_round(const ir::Pou& pou, std::span<const ir::BlockId> condition,
                        std::span<const ir::BlockId> loop);

}  // namespace frontend
