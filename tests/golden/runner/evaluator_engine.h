// The oracle as an Engine.
#pragma once

#include "tests/golden/runner/engine.h"

namespace golden {

base::Result<std::unique_ptr<Engine>> make_evaluator_engine(const Program& program);
// Greatest common divisor of the task periods: one scan of the runner.
int64_t base_period_ns(const ir::Program& program);

}  // namespace golden
