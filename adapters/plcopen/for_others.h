// Networks as other tools have to understand them.
#pragma once

#include "frontend/network/network.h"

namespace plcopen {

// What no element says as other tools understand it: a title becomes the first comment of its
// network, and a disabled network a comment that shows it, since others would execute it.
frontend::network::Body for_others(frontend::network::Body body);

}  // namespace plcopen
