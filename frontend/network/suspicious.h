// What a diagram may say, but hardly means: a second coil of a variable (W0035), a timer,
// counter or edge box whose input gets no power (W0036).
#pragma once

#include "base/diagnostics.h"
#include "frontend/network/network.h"

namespace frontend::network {

void report_suspicious(const Body& body, base::Diagnostics& diagnostics);

}  // namespace frontend::network
