// The oracle as an Engine.
#pragma once

#include "ir/program/evaluate.h"
#include "tests/golden/runner/engine.h"

namespace golden {

base::Result<std::unique_ptr<Engine>> make_evaluator_engine(const Program& program);
// Greatest common divisor of the task periods: one scan of the runner.
int64_t base_period_ns(const ir::Program& program);

// Where variables are in an image, for what is looked at as bytes. `types`: the program's, which
// have other numbers there.
ir::EvalMemory memory_of(const ir::Image& image, const ir::TypeTable& types);

}  // namespace golden
