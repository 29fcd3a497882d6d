#include "tests/golden/runner/evaluator_engine.h"

#include <numeric>

#include "ir/program/evaluate.h"
#include "linker/type_numbers.h"

namespace golden {
namespace {

constexpr uint64_t kBudget = 20'000'000;

class EvaluatorEngine : public Engine {
 public:
  EvaluatorEngine(const ir::Program& program, ir::EvalMemory memory)
      : evaluator_(program, std::move(memory)), period_ns_(base_period_ns(program)) {}

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

  base::Status restart(Restart kind) override {
    if (kind != Restart::kHot) evaluator_.restart(kind == Restart::kWarm);
    return base::Ok{};
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
  constexpr int64_t kIdleNs = 10'000'000;  // as vm/runtime/task_tables.cc has it
  return period == 0 ? kIdleNs : period;
}

ir::EvalMemory memory_of(const ir::Image& image, const ir::TypeTable& types) {
  ir::EvalMemory memory;
  const linker::TypeNumbers numbers(types, &image);
  memory.layouts.of.resize(types.size());
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    const ir::TypeId id = numbers.of_base(ir::TypeId(i));
    if (id.valid()) memory.layouts.of[id.index] = image.layouts->of[i];
  }
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    if (!row.live) continue;
    memory.areas.push_back({image.instance_path(id), id, row.generation, row.data});
  }
  return memory;
}

base::Result<std::unique_ptr<Engine>> make_evaluator_engine(const Program& program) {
  base::Result<ir::VerifiedImage> image = link(program, nullptr, false);
  if (!image) return image.error();
  return std::unique_ptr<Engine>(std::make_unique<EvaluatorEngine>(
      program.program, memory_of(image->image(), program.program.types)));
}

}  // namespace golden
