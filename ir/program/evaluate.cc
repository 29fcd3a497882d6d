// Tasks, paths and the state text of the evaluator.
#include "ir/program/evaluate.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <numeric>

#include "ir/program/eval_machine.h"
#include "ir/types/value_text.h"

namespace ir {
namespace {

base::Error no_such_variable(std::string_view path) {
  return {base::Refusal::kNoSuchVariable, "there is no variable `" + std::string(path) + "`"};
}

// "1,-2" as the element number of an array; nullopt when out of bounds.
std::optional<uint64_t> flat_index(const Type& array, std::string_view text) {
  uint64_t flat = 0;
  for (size_t i = 0; i < array.dims.size(); ++i) {
    const size_t comma = std::min(text.find(','), text.size());
    int64_t index = 0;
    const auto read = std::from_chars(text.data(), text.data() + comma, index);
    const Dimension& dim = array.dims[i];
    const bool last = i + 1 == array.dims.size();
    if (read.ec != std::errc() || read.ptr != text.data() + comma || index < dim.low ||
        index > dim.high || last != (comma == text.size())) {
      return std::nullopt;
    }
    flat = flat * dim.count() + (static_cast<uint64_t>(index) - static_cast<uint64_t>(dim.low));
    text.remove_prefix(last ? comma : comma + 1);
  }
  return flat;
}

// The inverse of flat_index, for paths.
std::string index_text(const Type& array, uint64_t flat) {
  std::string text;
  for (size_t i = array.dims.size(); i-- > 0;) {
    const uint64_t count = array.dims[i].count();
    const int64_t index =
        static_cast<int64_t>(static_cast<uint64_t>(array.dims[i].low) + flat % count);
    text = std::to_string(index) + (text.empty() ? "" : ",") + text;
    flat /= count;
  }
  return "[" + text + "]";
}

}  // namespace

struct Evaluator::Impl {
  const Program& program;
  Variable globals;
  std::vector<Variable> instances;  // parallel to Program::instances
  EvalMachine machine;

  explicit Impl(const Program& p)
      : program(p), globals(Variables(p).make(p.globals)), machine(p, globals) {
    for (const ProgramInstance& instance : program.instances) {
      instances.push_back(Variables(program).make(instance.type, instance.init));
    }
  }

  // Numbers of the tasks due at `now_ns`: by priority, then declaration.
  std::vector<uint32_t> due_tasks(int64_t now_ns) const {
    std::vector<uint32_t> due;
    for (uint32_t i = 0; i < program.tasks.size(); ++i) {
      if (now_ns % program.tasks[i].period_ns == 0) {
        due.push_back(i);
      }
    }
    std::stable_sort(due.begin(), due.end(), [this](uint32_t a, uint32_t b) {
      return program.tasks[a].priority < program.tasks[b].priority;
    });
    return due;
  }

  std::optional<EvalTrap> run_task(uint32_t task, int64_t now_ns, uint64_t budget) {
    for (size_t i = 0; i < instances.size(); ++i) {
      if (program.instances[i].task != task) {
        continue;
      }
      if (auto trap = machine.run(instances[i], now_ns, budget)) {
        return trap;
      }
    }
    return std::nullopt;
  }

  Variable* find_first(std::string_view name) {
    for (size_t i = 0; i < instances.size(); ++i) {
      if (same_name(program.instances[i].name, name)) {
        return &instances[i];
      }
    }
    return find_member(globals, name);
  }

  Variable* find_member(Variable& variable, std::string_view name) {
    const int32_t member = program.types.find_member(variable.type, name);
    if (member < 0 || variable.slot || variable.parts.empty()) {
      return nullptr;
    }
    return &variable.parts[static_cast<size_t>(member)];
  }

  Variable* find_element(Variable& variable, std::string_view& rest) {
    const size_t close = rest.find(']');
    const Type& type = program.types[variable.type];
    if (close == std::string_view::npos || type.kind != Kind::kArray || variable.slot) {
      return nullptr;
    }
    const std::optional<uint64_t> flat = flat_index(type, rest.substr(1, close - 1));
    rest.remove_prefix(close + 1);
    return flat ? &variable.parts[*flat] : nullptr;
  }

  // Path grammar of ir/bytecode/symbols.h.
  Variable* find(std::string_view path) {
    size_t end = std::min(path.find_first_of(".["), path.size());
    Variable* variable = find_first(path.substr(0, end));
    std::string_view rest = path.substr(end);
    while (variable != nullptr && !rest.empty()) {
      if (rest[0] == '[') {
        variable = find_element(*variable, rest);
      } else if (rest[0] == '.') {
        end = std::min(rest.find_first_of(".[", 1), rest.size());
        variable = find_member(*variable, rest.substr(1, end - 1));
        rest.remove_prefix(end);
      } else {
        return nullptr;
      }
    }
    return variable;
  }

  base::Result<Variable*> find_scalar(std::string_view path) {
    Variable* variable = find(path);
    if (variable == nullptr) {
      return no_such_variable(path);
    }
    if (variable->slot || !program.types.is_scalar(variable->type)) {
      return base::Error{base::Refusal::kBadValue, "`" + std::string(path) + "` is " +
                                                       program.types.text(variable->type) +
                                                       ", which is no scalar"};
    }
    return variable;
  }

  std::string leaf_text(const Variable& variable) const {
    switch (program.types[variable.type].kind) {
      case Kind::kString:
        return string_text(variable.text);
      case Kind::kWstring:
        return wstring_text(variable.text);
      default:
        return scalar_text(program.types, variable.type, variable.bits);
    }
  }

  void append_state(const std::string& path, const Variable& variable, std::string& out) const {
    const Type& type = program.types[variable.type];
    if (variable.slot) {
      return;
    }
    if (type.kind == Kind::kArray) {
      for (size_t i = 0; i < variable.parts.size(); ++i) {
        append_state(path + index_text(type, i), variable.parts[i], out);
      }
    } else if (program.types.has_members(variable.type)) {
      append_members(path.empty() ? path : path + ".", variable, out);
    } else {
      out += path + "=" + leaf_text(variable) + "\n";
    }
  }

  void append_members(const std::string& prefix, const Variable& variable, std::string& out) const {
    const std::vector<Member>& members = program.types[variable.type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      append_state(prefix + members[i].name, variable.parts[i], out);
    }
  }
};

Evaluator::Evaluator(const Program& program) : impl_(std::make_unique<Impl>(program)) {}
Evaluator::~Evaluator() = default;

std::vector<EvalTrap> Evaluator::scan(int64_t now_ns, uint64_t budget) {
  std::vector<EvalTrap> traps;
  for (const uint32_t task : impl_->due_tasks(now_ns)) {
    if (auto trap = impl_->run_task(task, now_ns, budget)) {
      traps.push_back(*std::move(trap));
    }
  }
  return traps;
}

base::Result<uint64_t> Evaluator::bits(std::string_view path) const {
  const base::Result<Variable*> variable = impl_->find_scalar(path);
  if (!variable.ok()) {
    return variable.error();
  }
  return (*variable)->bits;
}

base::Result<std::string> Evaluator::string(std::string_view path) const {
  const Variable* variable = impl_->find(path);
  if (variable == nullptr) {
    return no_such_variable(path);
  }
  const Kind kind = impl_->program.types[variable->type].kind;
  if (variable->slot || (kind != Kind::kString && kind != Kind::kWstring)) {
    return base::Error{base::Refusal::kBadValue, "`" + std::string(path) + "` is no string"};
  }
  return variable->text;
}

base::Status Evaluator::set_bits(std::string_view path, uint64_t bits) {
  const base::Result<Variable*> variable = impl_->find_scalar(path);
  if (!variable.ok()) {
    return variable.error();
  }
  (*variable)->bits = canonical(impl_->program.types.scalar((*variable)->type), bits);
  return base::Ok{};
}

std::string Evaluator::state() const {
  std::string text;
  impl_->append_state("", impl_->globals, text);
  for (size_t i = 0; i < impl_->instances.size(); ++i) {
    impl_->append_state(impl_->program.instances[i].name, impl_->instances[i], text);
  }
  return text;
}

}  // namespace ir
