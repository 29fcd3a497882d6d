#include "ir/program/dominators.h"

namespace ir {

// By an explicit stack: blocks come from outside.
std::vector<uint32_t> reverse_post_order(const Pou& pou) {
  const size_t count = pou.blocks.size();
  std::vector<uint32_t> next_target(count);  // 0: not seen yet; else its number, plus 1
  std::vector<uint32_t> order(count);        // open blocks in front, finished ones from behind
  size_t open = 1;
  size_t finished = count;
  next_target[0] = 1;
  while (open > 0) {
    const uint32_t block = order[open - 1];
    const Targets& targets = pou.blocks[block].insts.back().targets;
    const uint32_t target = next_target[block] - 1;
    if (target == targets.size()) {
      --open;
      order[--finished] = block;
      continue;
    }
    ++next_target[block];
    const uint32_t next = targets[target].block.index;
    if (next_target[next] != 0) continue;
    next_target[next] = 1;
    order[open++] = next;
  }
  order.erase(order.begin(), order.begin() + static_cast<ptrdiff_t>(finished));
  return order;
}

Dominators::Dominators(const Pou& pou)
    : order_of_(pou.blocks.size(), kNone), order_(reverse_post_order(pou)) {
  for (uint32_t i = 0; i < order_.size(); ++i) order_of_[order_[i]] = i;
  find_dominators(pou);
  number_tree();
}

uint32_t Dominators::common(uint32_t a, uint32_t b) const {
  while (a != b) {
    if (a > b) {
      a = parent_[a];
    } else {
      b = parent_[b];
    }
  }
  return a;
}

void Dominators::find_dominators(const Pou& pou) {
  std::vector<std::vector<uint32_t>> sources(order_.size());
  for (uint32_t i = 0; i < order_.size(); ++i) {
    for (const Target& target : pou.blocks[order_[i]].insts.back().targets) {
      sources[order_of_[target.block.index]].push_back(i);
    }
  }
  parent_.assign(order_.size(), kNone);
  parent_[0] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (uint32_t i = 1; i < order_.size(); ++i) {
      changed |= update_parent(i, sources[i]);
    }
  }
}

bool Dominators::update_parent(uint32_t node, const std::vector<uint32_t>& sources) {
  uint32_t found = kNone;
  for (const uint32_t source : sources) {
    if (parent_[source] != kNone) {
      found = found == kNone ? source : common(found, source);
    }
  }
  const bool changed = parent_[node] != found;
  parent_[node] = found;
  return changed;
}

// first_ and last_ bound the numbers of a node's subtree.
void Dominators::number_tree() {
  const uint32_t count = static_cast<uint32_t>(order_.size());
  std::vector<uint32_t> size(count, 1);
  for (uint32_t i = count; i-- > 1;) {
    size[parent_[i]] += size[i];
  }
  first_.assign(count, 0);
  last_.assign(count, 0);
  std::vector<uint32_t> next(count, 1);  // the number of the next child
  for (uint32_t i = 0; i < count; ++i) {
    if (i != 0) {
      first_[i] = next[parent_[i]];
      next[parent_[i]] += size[i];
    }
    next[i] = first_[i] + 1;
    last_[i] = first_[i] + size[i] - 1;
  }
}

}  // namespace ir
