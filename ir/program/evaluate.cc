// Tasks, paths and the state text of the evaluator.
#include "ir/program/evaluate.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "ir/program/eval_inspect.h"
#include "ir/program/eval_machine.h"
#include "ir/program/eval_restart.h"
#include "ir/types/inside.h"
#include "ir/types/natural_layout.h"

namespace ir {
namespace {

constexpr uint64_t kStartBudget = 100'000'000;  // instructions of a task that runs once

}  // namespace

struct Evaluator::Impl {
  const Program& program;
  EvalMemory memory;
  Variable globals;
  std::vector<Variable> instances;  // parallel to Program::instances; never moved
  struct Output {
    Variable* variable;  // a scalar, or what overlaps
    uint64_t bits = 0;   // as when the scan began
    std::string bytes = {};
  };
  std::vector<Output> outputs;  // at %Q
  struct Held {
    std::string path;
    Address at;
    std::vector<uint8_t> bytes;
  };
  std::vector<Held> held;
  References references;
  EvalMachine machine;
  EvalInspector inspector;
  std::vector<EvalTrap> start_traps;  // of what ran before the first scan
  bool start_pending = false;         // after a restart
  std::vector<bool> released;         // by task
  std::vector<bool> level;            // of its event, when it was looked at last

  Impl(const Program& p, EvalMemory m)
      : program(p),
        memory(std::move(m)),
        globals(Variables(p, &memory.layouts).make(p.globals)),
        instances(make_instances(p, memory.layouts)),
        references(p, memory.layouts),
        machine(p, globals, &memory.layouts, &references),
        inspector(p, memory.layouts, references, globals, instances) {
    link_programs();
    place_areas();
    collect_outputs(globals);
    for (Variable& instance : instances) collect_outputs(instance);
    for (Output& output : outputs) output.bytes.resize(output.variable->bytes.size());
    released.resize(program.tasks.size());
    level.resize(program.tasks.size());
    run_start_code(start_traps, 0);
  }

  // `located`: all of it is at %Q.
  void collect_outputs(Variable& owner, bool located = false) {
    if (owner.slot) return;
    const Type& type = program.types[owner.type];
    const bool members = program.types.has_members(owner.type);
    for (size_t i = 0; i < owner.parts.size(); ++i) {
      const bool at = members && type.members[i].address.area == DirectArea::kOutput;
      collect_outputs(owner.parts[i], located || at);
    }
    if (located && owner.parts.empty()) outputs.push_back({&owner});
  }

  static std::vector<Variable> make_instances(const Program& program, const Layouts& layouts) {
    std::vector<Variable> made;
    for (const ProgramInstance& instance : program.instances) {
      made.push_back(Variables(program, &layouts).make(instance.type, instance.init));
    }
    return made;
  }

  // A global of program type is another way to the program instance of that name.
  void link_programs() {
    const std::vector<Member>& members = program.types[program.globals].members;
    for (size_t i = 0; i < globals.parts.size(); ++i) {
      for (size_t p = 0; p < instances.size() && globals.parts[i].slot; ++p) {
        if (same_name(program.instances[p].name, members[i].name)) {
          globals.parts[i].target = {&instances[p],     0, &instances[p], 0,
                                     instances[p].type, 0, false};
        }
      }
    }
  }

  // Every instance gets the ID and place that `memory` says; otherwise IDs are those that the
  // linker gives a first version: programs, the instances in each, those among the globals.
  void place_areas() {
    std::unordered_map<std::string, const EvalArea*> known;
    uint32_t next_id = 0;
    uint32_t next_data = 64;
    for (const EvalArea& area : memory.areas) {
      known.emplace(fold_name(area.path), &area);
      next_id = std::max(next_id, area.id + 1);
    }
    for_each_area([&](Variable& root, const std::string& path) {
      EvalArea area{path, next_id, 0, next_data};
      if (const auto found = known.find(fold_name(path)); found != known.end()) {
        area = *found->second;
      } else {
        ++next_id;
      }
      next_data += (memory.layouts[root.type].used + 15) / 8 * 8;
      references.add_area(root, area.id, area.generation, area.data);
      references.name_area(root, path);
    });
  }

  using VisitArea = std::function<void(Variable&, const std::string&)>;

  void for_each_area(const VisitArea& visit) {
    visit(globals, "");
    for (size_t i = 0; i < instances.size(); ++i) {
      visit(instances[i], program.instances[i].name);
    }
    for (size_t i = 0; i < instances.size(); ++i) {
      inner_areas(instances[i], program.instances[i].name, visit);
    }
    inner_areas(globals, "", visit);
  }

  void inner_areas(Variable& variable, const std::string& path, const VisitArea& visit) {
    const Type& type = program.types[variable.type];
    for (size_t i = 0; i < variable.parts.size(); ++i) {
      Variable& part = variable.parts[i];
      if (part.slot || (part.parts.empty() && !program.types.is_instance(part.type))) {
        continue;
      }
      const std::string name = type.kind == Kind::kArray
                                   ? path + index_text(type, i)
                                   : path + (path.empty() ? "" : ".") + type.members[i].name;
      if (program.types.is_instance(part.type)) {
        visit(part, name);
      }
      inner_areas(part, name, visit);
    }
  }

  static void add_trap(std::vector<EvalTrap>& traps, std::optional<EvalTrap> trap) {
    if (trap) {
      traps.push_back(*std::move(trap));
    }
  }

  // Numbers of the wanted tasks: by priority, then declaration.
  template <class Wanted>
  std::vector<uint32_t> by_priority(Wanted wanted) const {
    std::vector<uint32_t> due;
    for (uint32_t i = 0; i < program.tasks.size(); ++i) {
      if (wanted(program.tasks[i])) {
        due.push_back(i);
      }
    }
    std::stable_sort(due.begin(), due.end(), [this](uint32_t a, uint32_t b) {
      return program.tasks[a].priority < program.tasks[b].priority;
    });
    return due;
  }

  // What a task that traps has written to outputs goes back to what it was when the scan began
  // (vm/runtime/scheduler_scan.cc).
  std::optional<EvalTrap> run_task(uint32_t task, int64_t now_ns, uint64_t budget) {
    impose();
    for (Output& output : outputs) {
      output.bits = output.variable->bits;
      output.bytes = output.variable->bytes;
    }
    std::optional<EvalTrap> trap = run_programs(task, now_ns, budget);
    for (const Output& output : outputs) {
      if (!trap) break;
      output.variable->bits = output.bits;
      output.variable->bytes = output.bytes;
    }
    return trap;
  }

  void impose() {
    for (const Held& one : held) references.bytes().write(*one.at.root, one.at.offset, one.bytes);
  }

  // What leaves traps in nobody's scan.
  void restart(bool warm) {
    EvalRestart data(program, memory.layouts, globals, instances);
    if (data.mark_leaving()) {
      std::vector<EvalTrap> unreported;
      run_start_code(unreported, 0);
    }
    data.reset(warm);
    released.assign(released.size(), false);
    level.assign(level.size(), false);
    start_pending = true;
  }

  void run_start_code(std::vector<EvalTrap>& traps, int64_t now_ns) {
    for (const uint32_t task : by_priority([](const Task& each) { return each.once; })) {
      add_trap(traps, run_task(task, now_ns, kStartBudget));
    }
  }

  // Edges of events release tasks.
  void look_at_events() {
    for (uint32_t i = 0; i < program.tasks.size(); ++i) {
      const uint32_t event = program.tasks[i].event;
      if (event == kNoEvent) continue;
      const bool now = globals.parts[event].bits != 0;
      if (now && !level[i]) released[i] = true;
      level[i] = now;
    }
  }

  void release_due(int64_t now_ns) {
    for (uint32_t i = 0; i < program.tasks.size(); ++i) {
      const Task& task = program.tasks[i];
      const bool due =
          task.policy.freewheeling || (task.period_ns > 0 && now_ns % task.period_ns == 0);
      if (due && !(task.event != kNoEvent && level[i])) released[i] = true;
    }
  }

  // The most urgent task that is released and has not begun in this cycle.
  std::optional<uint32_t> next_task(const std::vector<bool>& begun) const {
    for (const uint32_t task : by_priority([](const Task& each) { return !each.once; })) {
      if (released[task] && !begun[task]) return task;
    }
    return std::nullopt;
  }

  std::optional<EvalTrap> run_programs(uint32_t task, int64_t now_ns, uint64_t budget) {
    for (size_t i = 0; i < instances.size(); ++i) {
      if (program.instances[i].task != task) {
        continue;
      }
      if (auto trap = machine.run(instances[i], task, now_ns, budget)) {
        return trap;
      }
    }
    for (const BlockTask& block : program.block_tasks) {
      if (block.task != task) continue;
      if (auto trap =
              machine.run(instances[block.program].parts[block.member], task, now_ns, budget)) {
        return trap;
      }
    }
    return std::nullopt;
  }
};

EvalResult evaluate_alone(const Program& program, const Pou& pou, uint32_t local, uint64_t budget) {
  Variable no_globals;
  return EvalMachine(program, no_globals).run_alone(pou, local, budget);
}

Evaluator::Evaluator(const Program& program)
    : Evaluator(program, {natural_layouts(program.types), {}}) {}
Evaluator::Evaluator(const Program& program, EvalMemory memory)
    : impl_(std::make_unique<Impl>(program, std::move(memory))) {}
Evaluator::~Evaluator() = default;

void Evaluator::run_start() { impl_->run_start_code(impl_->start_traps, 0); }

std::vector<EvalTrap> Evaluator::scan(int64_t now_ns, uint64_t budget) {
  std::vector<EvalTrap> traps = std::exchange(impl_->start_traps, {});
  impl_->look_at_events();
  impl_->release_due(now_ns);
  if (std::exchange(impl_->start_pending, false)) impl_->run_start_code(traps, now_ns);
  std::vector<bool> begun(impl_->program.tasks.size());
  while (const std::optional<uint32_t> task = impl_->next_task(begun)) {
    begun[*task] = true;
    impl_->released[*task] = false;
    Impl::add_trap(traps, impl_->run_task(*task, now_ns, budget));
    impl_->look_at_events();
  }
  return traps;
}

void Evaluator::restart(bool warm) { impl_->restart(warm); }

base::Result<uint64_t> Evaluator::bits(std::string_view path) const {
  const base::Result<Address> at = impl_->inspector.find_scalar(path);
  if (!at.ok()) {
    return at.error();
  }
  return impl_->inspector.bits_of(*at);
}

base::Result<std::string> Evaluator::string(std::string_view path) const {
  const base::Result<Address> at = impl_->inspector.find_string(path);
  if (!at.ok()) {
    return at.error();
  }
  return impl_->inspector.text_of(*at);
}

base::Status Evaluator::set_string(std::string_view path, std::string_view text) {
  const base::Result<Address> at = impl_->inspector.find_string(path);
  if (!at.ok()) {
    return at.error();
  }
  Variable value = Variables(impl_->program).make(at->type);
  Variables(impl_->program).set_text(value, text);
  const auto* units = reinterpret_cast<const uint8_t*>(value.bytes.data());
  impl_->references.bytes().write(*at->root, at->offset, {units, value.bytes.size()});
  return base::Ok{};
}

base::Status Evaluator::set_bits(std::string_view path, uint64_t bits) {
  const base::Result<Address> at = impl_->inspector.find_scalar(path);
  if (!at.ok()) {
    return at.error();
  }
  std::vector<uint8_t> raw(scalar_size(impl_->program.types.scalar(at->type)));
  for (size_t i = 0; i < raw.size(); ++i) {
    raw[i] = static_cast<uint8_t>(bits >> (8 * i));
  }
  impl_->references.bytes().write(*at->root, at->offset, raw);
  return base::Ok{};
}

base::Status Evaluator::hold(std::string_view path, std::span<const uint8_t> bytes) {
  const base::Result<Address> at = impl_->inspector.find_value(path);
  if (!at.ok()) {
    return at.error();
  }
  impl_->held.push_back({std::string(path), *at, {bytes.begin(), bytes.end()}});
  impl_->machine.written = [impl = impl_.get()] { impl->impose(); };
  return base::Ok{};
}

void Evaluator::release(std::string_view path) {
  std::erase_if(impl_->held, [&](const Impl::Held& one) { return one.path == path; });
}

base::Status Evaluator::set_bytes(std::string_view path, std::span<const uint8_t> bytes) {
  const base::Result<Address> at = impl_->inspector.find_value(path);
  if (!at.ok()) {
    return at.error();
  }
  impl_->references.bytes().write(*at->root, at->offset, bytes);
  for (Impl::Output& output : impl_->outputs) {
    output.bits = output.variable->bits;
    output.bytes = output.variable->bytes;
  }
  return base::Ok{};
}

std::string Evaluator::state() const { return impl_->inspector.state(); }

}  // namespace ir
