// Where the values of a plan's steps lie, found by their place. Memory follows the number of steps
// and not that of values: an array of a million elements is one step.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "online_change/plan/plan.h"

namespace online_change {

struct StepValue {
  uint32_t to = 0;
  uint32_t size = 0;
  uint32_t step = 0;
  uint32_t index = 0;  // of the value in its step
  uint64_t end() const { return uint64_t{to} + size; }
};

class StepValues {
 public:
  // In each step count and size are not 0, its values do not overlap each other, and end below
  // 2^32.
  explicit StepValues(const std::vector<UpdateStep>& steps);

  // The lowest one that ends after `place`; where values overlap, one of them.
  std::optional<StepValue> first_behind(uint32_t place) const;
  // The place of a value that begins inside of another one. Time follows the number of values only
  // where steps alternate without a common period.
  std::optional<uint32_t> overlap() const;

 private:
  // Steps that take turns in one period, as members of an array's structures do.
  struct Comb {
    uint32_t begin = 0;
    uint32_t stride = 0;
    uint32_t count = 1;
    uint32_t first = 0;  // of teeth_
    uint32_t teeth = 0;
    uint64_t end = 0;
  };
  struct Tooth {
    uint32_t phase = 0;  // after the beginning of the comb
    uint32_t size = 0;
    uint32_t step = 0;
  };
  struct Place {
    uint32_t comb = 0;
    uint32_t tooth = 0;
    uint32_t turn = 0;
  };

  void make_combs(const std::vector<UpdateStep>& steps);
  void make_ends();
  StepValue value(const Place& place) const;
  bool next(Place& place) const;
  StepValue first_in(uint32_t comb, uint32_t place) const;
  bool overlaps_inside(size_t first, size_t end, uint32_t& at) const;

  std::vector<Comb> combs_;  // by beginning
  std::vector<Tooth> teeth_;
  // A tree over the combs: the farthest end below each node; the leaves begin at leaves_.
  std::vector<uint64_t> ends_;
  size_t leaves_ = 1;
};

}  // namespace online_change
