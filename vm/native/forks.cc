// The tree of comparisons that a SWITCH is. It has no more forks than the table has JMPs, each of
// which is a block of its own; so the forks stand in their places.
#include "vm/native/facts.h"

namespace vm::native {
namespace {

// Numbers from `begin` on, up to the next run's: where they go on.
struct Run {
  uint64_t begin = 0;
  Block to = kNone;
};

}  // namespace

void Facts::find_forks(Block block) {
  const uint32_t at = blocks_[block].last;
  const uint32_t entries = extension(at).y();
  const Block behind = block + 1 + entries;
  std::vector<Run> runs;
  for (uint32_t i = 0; i < entries; ++i) {
    const Block to = block_at_[jump_target(next(at) + i)];
    if (runs.empty() || runs.back().to != to) runs.push_back({i, to});
  }
  const uint32_t bits = 8 * ir::class_size(ir::opcode_row(code_[at].opcode()).b.cls);
  const bool all = bits < 32 && entries >> bits != 0;  // every value has an entry
  if (!all && runs.back().to != behind) runs.push_back({entries, behind});
  Block free = block;
  const auto grow = [&](const auto& self, size_t first, size_t end) -> Block {
    if (end - first == 1) return runs[first].to;
    const Block fork = free++;
    const size_t middle = first + (end - first) / 2;
    const Block below = self(self, first, middle);
    forks_[fork] = {runs[middle].begin, below, self(self, middle, end)};
    return fork;
  };
  if (runs.size() == 1) {
    forks_[free++] = {0, runs[0].to, runs[0].to};
  } else {
    grow(grow, 0, runs.size());
  }
  while (free < behind) forks_[free++] = Fork();
}

}  // namespace vm::native
