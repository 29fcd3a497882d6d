// The net of a chart, as far as a change asks: which steps can be active together (change cases 38
// and 73). Every transition takes a token from each of its `from` and puts one on each of its `to`,
// so what active steps add up to, in a space where each transition adds nothing, never changes. In
// that space steps before and after a transition are one vector; where branches run at once, their
// vectors add up to that of the step before. A run of the chart leads to some set of active steps
// only if they add up to what the initial steps do. That is necessary, and for nets whose
// branches end where they began together it is enough.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

class ChartNet {
 public:
  // Nothing is known of it.
  ChartNet() = default;
  // The chart of instances of `type`, with those of the types that it extends. `ir::Image::charts`
  // says nothing of the charts of older compilers. A net of absurd size (more than a million steps
  // of work) is not known either.
  ChartNet(const ir::Image& image, ir::TypeId type);

  bool known() const { return !sums_.empty(); }
  // Can these steps, by their member numbers, be active together and no other? Networks without
  // any active step have not begun, and are not asked.
  bool reaches(const std::vector<uint32_t>& active) const;

 private:
  using Sum = std::map<uint32_t, uint64_t>;  // coordinates that are not zero, modulo a prime

  void join_networks(const std::vector<ir::ChartMove>& moves);
  bool solve(const std::vector<ir::ChartMove>& moves);
  // In coordinates of their own only: those of steps that have no sum yet.
  Sum reduced(Sum sum);

  std::map<uint32_t, Sum> sums_;          // of each step
  std::map<uint32_t, uint32_t> network_;  // of each step: the first step of its network
  std::vector<uint32_t> initial_;
  uint64_t work_ = 0;
};

}  // namespace online_change
