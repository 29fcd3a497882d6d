// Dominators after Cooper, Harvey and Kennedy ("A Simple, Fast Dominance
// Algorithm"), numbered so that "a dominates b" is two comparisons.
#include <string>

#include "ir/program/verify_parts.h"

namespace ir {
namespace {

constexpr uint32_t kNone = 0xffffffffu;

class Dominators {
 public:
  explicit Dominators(const Pou& pou) : pou_(pou), order_of_(pou.blocks.size(), kNone) {
    number_blocks();
    find_dominators();
    number_tree();
  }

  bool reachable(uint32_t block) const { return order_of_[block] != kNone; }
  bool dominates(uint32_t a, uint32_t b) const {
    return reachable(a) && first_[order_of_[a]] <= first_[order_of_[b]] &&
           first_[order_of_[b]] <= last_[order_of_[a]];
  }

 private:
  const std::vector<Target>& targets(uint32_t block) const {
    return pou_.blocks[block].insts.back().targets;
  }

  // Reverse postorder by an explicit stack: blocks come from outside.
  void number_blocks() {
    struct Visit {
      uint32_t block;
      size_t next_target;
    };
    std::vector<uint32_t> postorder;
    std::vector<bool> seen(pou_.blocks.size());
    std::vector<Visit> open = {{0, 0}};
    seen[0] = true;
    while (!open.empty()) {
      Visit& visit = open.back();
      if (visit.next_target == targets(visit.block).size()) {
        postorder.push_back(visit.block);
        open.pop_back();
        continue;
      }
      const uint32_t next = targets(visit.block)[visit.next_target++].block.index;
      if (!seen[next]) {
        seen[next] = true;
        open.push_back({next, 0});
      }
    }
    order_.assign(postorder.rbegin(), postorder.rend());
    for (uint32_t i = 0; i < order_.size(); ++i) {
      order_of_[order_[i]] = i;
    }
  }

  uint32_t common(uint32_t a, uint32_t b) const {
    while (a != b) {
      if (a > b) {
        a = parent_[a];
      } else {
        b = parent_[b];
      }
    }
    return a;
  }

  void find_dominators() {
    std::vector<std::vector<uint32_t>> sources(order_.size());
    for (uint32_t i = 0; i < order_.size(); ++i) {
      for (const Target& target : targets(order_[i])) {
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

  bool update_parent(uint32_t node, const std::vector<uint32_t>& sources) {
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
  void number_tree() {
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

  const Pou& pou_;
  std::vector<uint32_t> order_of_;  // block -> position in reverse postorder
  std::vector<uint32_t> order_;
  std::vector<uint32_t> parent_;  // by position
  std::vector<uint32_t> first_;
  std::vector<uint32_t> last_;
};

struct Definition {
  uint32_t block = kNone;
  uint32_t position = 0;  // 0 for parameters, instruction number + 1 otherwise
};

std::vector<Definition> find_definitions(const Pou& pou) {
  std::vector<Definition> definitions(pou.values.size());
  for (uint32_t b = 0; b < pou.blocks.size(); ++b) {
    for (const ValueId param : pou.blocks[b].params) {
      definitions[param.index] = {b, 0};
    }
    for (uint32_t i = 0; i < pou.blocks[b].insts.size(); ++i) {
      if (const ValueId result = pou.blocks[b].insts[i].result; result.valid()) {
        definitions[result.index] = {b, i + 1};
      }
    }
  }
  return definitions;
}

void add_place_values(const Pou& pou, PlaceId id, std::vector<ValueId>& values) {
  if (!id.valid()) {
    return;
  }
  const Place& place = pou.places[id.index];
  if (place.base == PlaceBase::kPointee || place.base == PlaceBase::kTarget) {
    values.push_back(place.value);
  }
  for (const Step& step : place.steps) {
    if (step.value.valid()) {
      values.push_back(step.value);
    }
  }
}

}  // namespace

std::vector<ValueId> used_values(const Pou& pou, const Inst& inst) {
  std::vector<ValueId> values = inst.operands;
  add_place_values(pou, inst.place, values);
  add_place_values(pou, inst.place2, values);
  for (const Target& target : inst.targets) {
    values.insert(values.end(), target.args.begin(), target.args.end());
  }
  return values;
}

base::Status verify_dominance(const Pou& pou) {
  const Dominators dominators(pou);
  const std::vector<Definition> definitions = find_definitions(pou);
  for (uint32_t b = 0; b < pou.blocks.size(); ++b) {
    for (uint32_t i = 0; i < pou.blocks[b].insts.size() && dominators.reachable(b); ++i) {
      for (const ValueId value : used_values(pou, pou.blocks[b].insts[i])) {
        const Definition& definition = definitions[value.index];
        const bool before = definition.block == b ? definition.position <= i
                                                  : definition.block != kNone &&
                                                        dominators.dominates(definition.block, b);
        if (!before) {
          return not_verified(inst_place(pou, b, i) + "v" + std::to_string(value.index) +
                              " is used where it may not be defined");
        }
      }
    }
  }
  return base::Ok{};
}

}  // namespace ir
