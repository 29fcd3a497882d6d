#include "tests/golden/runner/evaluator_engine.h"

#include <numeric>

#include "ir/program/evaluate.h"

namespace golden {
namespace {

constexpr uint64_t kBudget = 20'000'000;

class EvaluatorEngine : public Engine {
 public:
  explicit EvaluatorEngine(const ir::Program& program)
      : evaluator_(program), period_ns_(base_period_ns(program)) {}

  base::Result<std::string> scan() override {
    std::vector<ir::EvalTrap> traps = evaluator_.scan(now_ns_, kBudget);
    now_ns_ += period_ns_;
    if (traps.empty()) return std::string();
    return std::string(ir::trap_name(traps[0].kind)) + " " + traps[0].pou + ":" +
           std::to_string(traps[0].line);
  }
  std::string state() const override { return evaluator_.state(); }
  base::Status set(const std::string&, const std::string&) override {
    return base::Error{base::Refusal::kUsage, "a script with `set` needs mode change"};
  }

 private:
  ir::Evaluator evaluator_;
  int64_t period_ns_;
  int64_t now_ns_ = 0;
};

}  // namespace

int64_t base_period_ns(const ir::Program& program) {
  int64_t period = 0;
  for (const ir::Task& task : program.tasks) period = std::gcd(period, task.period_ns);
  return period;
}

std::unique_ptr<Engine> make_evaluator_engine(const Program& program) {
  return std::make_unique<EvaluatorEngine>(program.program);
}

}  // namespace golden
