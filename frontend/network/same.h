// Do two bodies mean the same? What is written and read again must.
#pragma once

#include <string>

#include "frontend/network/network.h"

namespace frontend::network {

// A text that two bodies share when they do the same in the same order and have the same labels
// and comments, whatever the positions, the ids, the order of parallel contacts between two
// elements that write something, pins that nothing is connected to, and rails. Contacts without
// use are left out.
std::string canonical(const Body& body);

}  // namespace frontend::network
