// Runs a check in a process of its own, so that a crash or an endless loop is a finding like
// any other.
#pragma once

#include <functional>

#include "tests/differential/tiers.h"

namespace differential {

// `seconds` of processor time at most; a check that waits for ever is ended much later.
Finding isolated(const std::function<Finding()>& check, unsigned seconds);

}  // namespace differential
