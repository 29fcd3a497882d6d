// Loops with a counter, small enough that several of their turns are done at once (unroll.h).
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "vm/native/lir.h"

namespace vm::native {

struct Counted {
  uint32_t loop = kNone;
  std::vector<uint32_t> nodes;            // of one turn
  std::vector<Val> again;                 // what the next turn begins with
  std::vector<std::pair<Val, Val>> same;  // parameters inside of a turn, and what they are
  Val counter = kNone;
  int64_t step = 0;
  Cond stays = Cond::kLeS;
  Val limit = kNone;
  uint32_t turns = 0;  // at once
};

// A loop whose head only asks whether the counter is within a limit from before the loop, and of
// which every turn goes the same way.
std::optional<Counted> counted(const Function& function, uint32_t loop);

// From the limit to what the first of so many turns must be within, for the last to be within the
// limit.
int64_t limit_of_first(const Counted& counted, uint32_t turns);

// Is the value surely a number from 0 on that is far from the largest one?
bool is_far_from_the_ends(const Function& function, Val v);

}  // namespace vm::native
