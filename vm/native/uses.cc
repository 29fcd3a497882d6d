#include "vm/native/uses.h"

#include <algorithm>

namespace vm::native {

// In the order of their positions.
std::vector<Uses::Use> Uses::all_uses(const Target& target) const {
  const Function& f = function_;
  std::vector<Use> all;
  all.reserve(2 * f.nodes.size());
  for (Block b = 0; b < f.blocks.size(); ++b) {
    const BasicBlock& block = f.blocks[b];
    uint32_t position = begins_[b];
    const auto exit_uses = [&](uint32_t exit) {
      if (exit == kNone) return;
      for (const SlotValue& slot : f.exits[exit].slots) {
        if (!f.values[slot.value].constant) all.push_back({slot.value, position, b});
      }
    };
    for (const uint32_t n : block.nodes) {
      ++position;
      const Node& node = f.nodes[n];
      for (uint32_t i = 0; i < 4; ++i) {
        if (node.in[i] == kNone) continue;
        if (f.values[node.in[i]].constant && target.takes_constant(f, node, i)) continue;
        all.push_back({node.in[i], position, b});
      }
      if (node.mem.index != kNone) all.push_back({node.mem.index, position, b});
      if (node.mem.pointer != kNone) all.push_back({node.mem.pointer, position, b});
      exit_uses(node.exit);
    }
    ++position;
    for (uint32_t i = 0; i < 2; ++i) {
      const Val v = block.end.in[i];
      if (v == kNone) continue;
      if (f.values[v].constant && target.end_takes_constant(f, block.end, i)) continue;
      all.push_back({v, position, b});
    }
    for (const std::vector<Val>& args : block.end.args) {
      for (const Val v : args) {
        if (!f.values[v].constant) all.push_back({v, position, b});
      }
    }
    exit_uses(block.end.exit);
  }
  return all;
}

Uses::Uses(const Function& function, const Target& target) : function_(function) {
  const Function& f = function;
  uint32_t position = 0;
  std::vector<uint32_t> defined(f.values.size(), 0);
  begins_.reserve(f.blocks.size());
  ends_.reserve(f.blocks.size());
  for (Block b = 0; b < f.blocks.size(); ++b) {
    begins_.push_back(position);
    for (const Val param : f.blocks[b].params) defined[param] = position;
    for (const uint32_t n : f.blocks[b].nodes) {
      ++position;
      if (f.nodes[n].result != kNone) defined[f.nodes[n].result] = position;
    }
    ends_.push_back(++position);
    ++position;
  }
  const std::vector<Use> all = all_uses(target);
  // A value from before a loop that the loop uses lives until the loop ends.
  const auto each = [&](auto visit) {
    for (const auto& [v, at, b] : all) {
      visit(v, at);
      for (uint32_t l = f.blocks[b].loop; l != kNone; l = f.loops[l].parent) {
        const bool before = f.values[v].constant || defined[v] < begins_[f.loops[l].head];
        if (!before) break;
        visit(v, ends_[f.loops[l].last]);
      }
    }
  };
  first_.assign(f.values.size() + 1, 0);
  each([&](Val v, uint32_t) { ++first_[v + 1]; });
  for (size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  uses_.resize(first_.back());
  cursor_.assign(first_.begin(), first_.end() - 1);
  each([&](Val v, uint32_t at) { uses_[cursor_[v]++] = at; });
  cursor_.assign(first_.begin(), first_.end() - 1);
  for (Val v = 0; v < f.values.size(); ++v) {
    // Only the ends of loops are out of order.
    if (!f.loops.empty()) std::sort(uses_.begin() + first_[v], uses_.begin() + first_[v + 1]);
    if (f.values[v].constant && first_[v] != first_[v + 1]) constants_.push_back(v);
  }
  find_live(all, defined);
}

// From each use back to the definition.
void Uses::find_live(const std::vector<Use>& uses, const std::vector<uint32_t>& defined) {
  const Function& f = function_;
  const size_t blocks = f.blocks.size();
  std::vector<uint32_t> first_pred(blocks + 1, 0);
  const auto each_way = [&](auto visit) {
    for (Block b = 0; b < blocks; ++b) {
      for (const Block to : f.blocks[b].end.target) {
        if (to != kNone) visit(b, to);
      }
    }
  };
  each_way([&](Block, Block to) { ++first_pred[to + 1]; });
  for (size_t b = 0; b < blocks; ++b) first_pred[b + 1] += first_pred[b];
  std::vector<Block> preds(first_pred.back());
  std::vector<uint32_t> fill(first_pred.begin(), first_pred.end() - 1);
  each_way([&](Block b, Block to) { preds[fill[to]++] = b; });

  std::vector<std::pair<Val, Block>> all;
  for (const auto& [v, at, b] : uses) {
    const std::pair use(v, b);
    if (f.values[v].constant || defined[v] >= begins_[b]) continue;
    if (all.empty() || all.back() != use) all.push_back(use);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<Val> seen(blocks, kNone);
  std::vector<Block> work;
  std::vector<std::pair<Block, Val>> found;  // sorted by value
  first_live_.assign(blocks + 1, 0);
  for (const auto& [v, used_in] : all) {
    work.push_back(used_in);
    while (!work.empty()) {
      const Block b = work.back();
      work.pop_back();
      if (seen[b] == v) continue;
      seen[b] = v;
      found.push_back({b, v});
      ++first_live_[b + 1];
      for (uint32_t at = first_pred[b]; at < first_pred[b + 1]; ++at) {
        // The value's own block defines it, as a parameter or after its beginning.
        if (f.values[v].block != preds[at]) work.push_back(preds[at]);
      }
    }
  }
  for (size_t b = 0; b < blocks; ++b) first_live_[b + 1] += first_live_[b];
  live_.resize(found.size());
  fill.assign(first_live_.begin(), first_live_.end() - 1);
  for (const auto& [b, v] : found) live_[fill[b]++] = v;
}

}  // namespace vm::native
