#include "vm/native/jump_tables.h"

#include <algorithm>

namespace vm::native {
namespace {

constexpr size_t kMostPerWay = 8;  // entries
constexpr uint32_t kMostDepth = 32;

}  // namespace

// Nothing but the same question, with other limits.
bool JumpTables::asks(Block block, Block root) const {
  const End& e = f_.blocks[block].end;
  const End& first = f_.blocks[root].end;
  return e.kind == EndKind::kBranch && e.compare == Op::kCompare && e.cond == Cond::kLtU &&
         e.in[0] == first.in[0] && e.width == first.width && f_.values[e.in[1]].constant &&
         places_.blocks[block].in[0] == places_.blocks[root].in[0] &&
         (block == root || places_.blocks[block].steps.empty());
}

void JumpTables::fork(Block block, Block root, uint64_t first, uint64_t last, uint32_t depth) {
  const uint64_t edge = f_.values[f_.blocks[block].end.in[1]].bits;
  if (edge > first) way({block, 0}, root, first, std::min(edge - 1, last), depth);
  if (edge <= last) way({block, 1}, root, std::max(edge, first), last, depth);
}

void JumpTables::way(JumpTable::Way way, Block root, uint64_t first, uint64_t last,
                     uint32_t depth) {
  const Block to = f_.blocks[way.block].end.target[way.target];
  const bool moves = !places_.blocks[way.block].edges[way.target].empty();
  if (!moves && depth < kMostDepth && f_.blocks[to].params.empty() && asks(to, root)) {
    inside_[to] = true;
    return fork(to, root, first, last, depth + 1);
  }
  leaves_.push_back({last, way});
}

std::optional<JumpTable> JumpTables::at(Block block) {
  if (inside_[block] || !asks(block, block)) return std::nullopt;
  if (places_.blocks[block].in[0].kind != Place::kRegister) return std::nullopt;
  leaves_.clear();
  const uint8_t width = f_.blocks[block].end.width;
  fork(block, block, 0, ~uint64_t{0} >> (64 - 8 * width), 0);
  if (leaves_.size() < std::max<size_t>(least_ways_, 2)) return std::nullopt;
  const uint64_t most = leaves_[leaves_.size() - 2].last;
  if (most >= kMostPerWay * leaves_.size()) return std::nullopt;
  JumpTable table;
  for (size_t i = 0; i + 1 < leaves_.size(); ++i) {
    table.ways.resize(static_cast<size_t>(leaves_[i].last) + 1, leaves_[i].way);
  }
  table.otherwise = leaves_.back().way;
  return table;
}

}  // namespace vm::native
