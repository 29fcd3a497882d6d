// Trees of comparisons of one value (facts.h, Fork) that a jump through a table replaces. That is
// one jump which the machine guesses badly unless the value seldom changes, so a small tree stays.
#pragma once

#include <optional>
#include <vector>

#include "vm/native/allocate.h"

namespace vm::native {

struct JumpTable {
  // Way number `target` of a fork, after whose moves it goes on.
  struct Way {
    Block block = 0;
    uint32_t target = 0;
    friend bool operator==(const Way&, const Way&) = default;
  };
  std::vector<Way> ways;  // of 0, 1, 2 and so on
  Way otherwise;
};

class JumpTables {
 public:
  // `least_ways` 0: where it pays.
  JumpTables(const Function& function, const Allocated& places, uint32_t least_ways)
      : f_(function),
        places_(places),
        least_ways_(least_ways != 0 ? least_ways : kLeastWays),
        inside_(function.blocks.size(), false) {}
  // In the place of the branch at the end of the block, which holds the value in a register.
  std::optional<JumpTable> at(Block block);

 private:
  static constexpr uint32_t kLeastWays = 96;  // measured: docs/adr/0027-case-tables.md
  struct Leaf {
    uint64_t last = 0;
    JumpTable::Way way;
  };
  bool asks(Block block, Block root) const;
  void fork(Block block, Block root, uint64_t first, uint64_t last, uint32_t depth);
  void way(JumpTable::Way way, Block root, uint64_t first, uint64_t last, uint32_t depth);

  const Function& f_;
  const Allocated& places_;
  size_t least_ways_;
  std::vector<bool> inside_;  // of a tree that has been looked at
  std::vector<Leaf> leaves_;
};

}  // namespace vm::native
