// The controller on virtual time as an Engine, in every hard mode.
#pragma once

#include "tests/golden/runner/engine.h"

namespace golden {

base::Result<std::unique_ptr<Engine>> make_machine_engine(Tier tier, const Program& program);

}  // namespace golden
