// Which blocks lie on every way from the entry to a block, after Cooper, Harvey and Kennedy ("A
// Simple, Fast Dominance Algorithm"), numbered so that "a dominates b" is two comparisons. Holds
// its own tables: the POU may change afterwards, but then so may the answers.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/program/ir.h"

namespace ir {

// The reachable blocks in reverse post order, which begins with the entry.
std::vector<uint32_t> reverse_post_order(const Pou& pou);

class Dominators {
 public:
  explicit Dominators(const Pou& pou);

  bool reachable(uint32_t block) const { return order_of_[block] != kNone; }
  bool dominates(uint32_t a, uint32_t b) const {
    return reachable(a) && first_[order_of_[a]] <= first_[order_of_[b]] &&
           first_[order_of_[b]] <= last_[order_of_[a]];
  }
  // In reverse post order: those of order(), and where a reachable block is in it.
  const std::vector<uint32_t>& order() const { return order_; }
  uint32_t position(uint32_t block) const { return order_of_[block]; }

 private:
  static constexpr uint32_t kNone = 0xffffffffu;

  uint32_t common(uint32_t a, uint32_t b) const;
  void find_dominators(const Pou& pou);
  bool update_parent(uint32_t node, const std::vector<uint32_t>& sources);
  void number_tree();

  std::vector<uint32_t> order_of_;  // block -> position in reverse post order
  std::vector<uint32_t> order_;
  std::vector<uint32_t> parent_;  // by position
  std::vector<uint32_t> first_;   // of the numbers of a node's subtree
  std::vector<uint32_t> last_;
};

}  // namespace ir
