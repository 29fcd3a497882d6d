// By how much values of a counted loop are others in its next turn.
#pragma once

#include <vector>

#include "vm/native/counted.h"
#include "vm/native/number_table.h"

namespace vm::native {

inline constexpr int64_t kMostStep = int64_t{1} << 30;  // of all turns together

class TurnSteps {
 public:
  TurnSteps(const Function& function, const Counted& counted);
  // Of a value of 8 bytes; 0: it is the same, or nobody knows.
  int64_t of(Val v) const;
  // What a parameter of a block inside of the turn is.
  Val real(Val v) const;
  // Checks of the turns that hold in all of them when they hold in the first and in the last.
  const std::vector<uint32_t>& asked_once() const { return asked_; }

 private:
  void find(const Node& node);
  int64_t step(const Node& node) const;
  bool is_fixed(Val v) const;
  bool is_asked_once(const Node& node) const;

  const Function& f_;
  const Counted& c_;
  ByKey<int64_t> step_;  // by value that the loop makes
  ByKey<uint32_t> same_;
  std::vector<uint32_t> asked_;  // nodes
};

}  // namespace vm::native
