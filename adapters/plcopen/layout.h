// Where the elements of a network that was written as text are in a drawing.
#pragma once

#include <cstdint>
#include <vector>

#include "frontend/network/network.h"

namespace plcopen {

struct Place {
  int32_t x = 0;
  int32_t y = 0;
};

struct Layout {
  std::vector<Place> at;  // of each element
  int32_t bottom = 0;     // where the network ends
};

// From `top` on. `by_order`: so that the order of places is that of execution as far as possible.
Layout lay_out(const frontend::network::Network& network, int32_t top, bool by_order);

// Is the order of places that of execution? Contacts read when a coil needs them, unless they
// count.
bool in_order(const frontend::network::Network& network, const std::vector<Place>& at,
              bool with_contacts);

bool acts(frontend::network::Kind kind);  // does it write something, or go elsewhere?

}  // namespace plcopen
