// The page of `stvm top`: what runs, its tasks, devices, changes and alarms, on a terminal of any
// size from 80 x 24 up. A function of two reports, so that it can be tested as text.
#pragma once

#include <string>

#include "vm/runtime/protocol.h"

namespace stvm {

struct TopView {
  size_t width = 80;
  size_t height = 24;
  bool color = false;
};

// Lines of at most `width` columns, each ended, at most `height`. Rates are those between `before`
// and `now`; with the same report twice there are none.
std::string top_page(const vm::StatusReport& before, const vm::StatusReport& now,
                     const TopView& view);

}  // namespace stvm
