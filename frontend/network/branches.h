// Network -> nested series and parallel branches; the inside of layout.h.
#pragma once

#include <optional>
#include <vector>

#include "frontend/network/network.h"

namespace frontend::network {

struct Item;
using Series = std::vector<Item>;

// An element, or branches side by side. Branches that `end` go on to the right rail, each for
// itself, and nothing follows them; others meet behind. A branch without items is a wire.
struct Item {
  uint32_t element = 0;
  std::vector<Series> branches;  // empty: this is an element
  bool end = false;
  uint32_t first = 0;          // smallest element in it
  uint32_t does = 0xffffffff;  // the smallest that is no contact: branches are in this order
};

struct PowerPins {  // of an element that is placed
  uint32_t input = 0;
  uint32_t output = 0xffffffffu;
};

struct Branches {
  Series rung;
  std::vector<PowerPins> pins;  // by element
};

inline constexpr uint32_t kMaxBranchNesting = 64;

// nullopt as place().
std::optional<Branches> find_branches(const Network& network);

}  // namespace frontend::network
