#include "tools/stvm/run_resources.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <thread>

#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/json_value.h"
#include "tools/stvm/names.h"
#include "tools/stvm/stop_signal.h"
#include "tools/stvm/tier.h"
#include "tools/stvm/trace.h"
#include "tools/stvm/trap_text.h"
#include "vm/runtime/clocks.h"

namespace stvm {
namespace {

using Resource = vm::GlobalExchange::Resource;
using Running = std::vector<std::unique_ptr<ResourceController>>;

// What stands after "Line."; nullopt: it is of another resource.
std::optional<std::string> name_in(const std::string& resource, const std::string& name) {
  if (resource.empty()) return name;
  const size_t dot = name.find('.');
  if (dot == std::string::npos || !ir::same_name(name.substr(0, dot), resource)) {
    return std::nullopt;
  }
  return name.substr(dot + 1);
}

// As `stvm set` and `stvm force` would ask for it.
void note_assignment(vm::Recorder& recorder, const vm::Controller& controller, bool set,
                     const Assignment& row) {
  vm::Request request;
  request.command = set ? vm::Command::kSet : vm::Command::kForce;
  request.expected = controller.verified().digest();
  request.names = {row.name};
  request.values = {row.value};
  recorder.begin_job(controller);
  recorder.end_job(controller);
  recorder.note(vm::encode(request));
}

struct Name {
  ResourceController* resource = nullptr;
  std::string path;
};
base::Result<Name> find_name(const Running& running, const std::string& name) {
  std::string known;
  for (const auto& resource : running) {
    if (const auto path = name_in(resource->name(), name)) return Name{resource.get(), *path};
    known += (known.empty() ? "" : ", ") + resource->name();
  }
  return base::Error{base::Refusal::kNoSuchVariable,
                     "`" + name + "`: with several resources, names begin with one: " + known};
}

// The names of --print, as paths after the name of their resource.
base::Result<Names> names_to_print(const Running& running, const Names& names) {
  Names out;
  for (const std::string& name : names) {
    base::Result<Name> found = find_name(running, name);
    if (!found.ok()) return found.error();
    base::Result<Names> paths = matching(found->resource->controller().image(), {found->path});
    if (!paths.ok()) return paths;
    const bool path_itself = paths->size() == 1 && paths->front() == found->path;
    if (path_itself) {
      out.push_back(name);
      continue;
    }
    for (const std::string& path : *paths) out.push_back(found->resource->name() + "." + path);
  }
  return out;
}

base::Status check_assignments(const Running& running, const tools::Options& options) {
  for (const char* option : {"--set", "--force"}) {
    base::Result<std::vector<Assignment>> rows = parse_assignments(options.all(option));
    if (!rows.ok()) return rows.error();
    for (const Assignment& row : *rows) {
      if (base::Result<Name> found = find_name(running, row.name); !found.ok()) {
        return found.error();
      }
    }
  }
  return base::Ok{};
}

bool enough(const Running& running, const RunSettings& settings) {
  return settings.scans && running.front()->controller().cycles() >= *settings.scans;
}

// Ends when the first has had its cycles, and the others theirs up to the same instant.
void take_turns(const Running& running, const RunSettings& settings) {
  int64_t last_ns = settings.scans == uint64_t{0} ? -1 : INT64_MAX;
  while (!StopSignal::received()) {
    const vm::Controller& first = running.front()->controller();
    const bool counted = enough(running, settings);
    ResourceController* next = nullptr;
    for (const auto& resource : running) {
      const vm::Controller& controller = resource->controller();
      if (controller.faulted() || (counted && &controller == &first)) continue;
      if (next == nullptr || controller.next_cycle_ns() < next->controller().next_cycle_ns()) {
        next = resource.get();
      }
    }
    // Who counts the cycles counts no more when it has stopped.
    if (next == nullptr || (settings.scans && first.faulted())) return;
    const int64_t begin_ns = next->controller().next_cycle_ns();
    if (counted && begin_ns > last_ns) return;
    if (&next->controller() == &first) last_ns = begin_ns;
    next->cycle();
  }
}

void run_in_threads(const Running& running, const RunSettings& settings) {
  std::atomic<bool> done{false};
  std::vector<std::thread> threads;
  for (const auto& resource : running) {
    threads.emplace_back([&, first = resource == running.front()] {
      const vm::Controller& controller = resource->controller();
      while (!done && !StopSignal::received() && !controller.faulted()) {
        if (first && enough(running, settings)) break;
        resource->cycle();
      }
      if (first && settings.scans) done = true;
    });
  }
  for (std::thread& thread : threads) thread.join();
}

void print_resources_text(const Running& running, const RunSettings& settings,
                          const tools::Options& options) {
  for (const std::string& name : settings.print) {
    base::Result<Name> found = find_name(running, name);
    std::printf("%s=%s\n", name.c_str(),
                value_of(found->resource->controller(), found->path).c_str());
  }
  for (const auto& resource : running) {
    vm::Controller& controller = resource->controller();
    const std::string state = ir::state_text(controller.image(), controller.memory().view());
    for (size_t at = 0; options.has("--state") && at < state.size();) {
      const size_t end = std::min(state.find('\n', at), state.size());
      std::printf("%s.%s\n", resource->name().c_str(), state.substr(at, end - at).c_str());
      at = end + 1;
    }
    if (!options.has("--hash")) continue;
    const auto hash = ir::state_hash(controller.image(), controller.memory().view());
    std::printf("%s %s\n", resource->name().c_str(), base::to_hex(hash).c_str());
  }
}

void print_resource(tools::JsonWriter& json, ResourceController& resource,
                    const RunSettings& settings, const tools::Options& options) {
  vm::Controller& controller = resource.controller();
  json.begin_object().field("name", resource.name()).field("scans", controller.cycles());
  json.field("faulted", controller.faulted()).key("values").begin_object();
  for (const std::string& name : settings.print) {
    const auto path = name_in(resource.name(), name);
    if (!path) continue;
    json.key(*path);
    typed_value_of(json, controller, *path);
  }
  auto memory = controller.memory().view();
  if (options.has("--state")) {
    ir::for_each_leaf(controller.image(), [&](const std::string& path, const ir::Symbol& symbol) {
      json.key(path);
      typed_value(json, ir::type_text(controller.image(), symbol),
                  ir::format_value(controller.image(), symbol, memory));
    });
  }
  json.end_object();
  if (options.has("--hash")) {
    json.field("hash", base::to_hex(ir::state_hash(controller.image(), memory)));
  }
  json.key("traps").begin_array();
  for (const auto& trap : controller.traps()) json.value(trap_text(*trap));
  json.end_array().end_object();
}

void print_resources_json(const Running& running, const RunSettings& settings,
                          const tools::Options& options) {
  tools::JsonWriter json;
  json.begin_object().key("resources").begin_array();
  for (const auto& resource : running) print_resource(json, *resource, settings, options);
  json.end_array().end_object();
  std::fputs(json.finish().c_str(), stdout);
}

// What a force cannot do.
void note_hold(const vm::Force& force) {
  if (force.reason.empty()) return;
  std::fprintf(stderr, "%s is forced %s\n", force.path.c_str(),
               vm::hold_text(force.reason).c_str());
}

}  // namespace

base::Status apply_assignments(const tools::Options& options, const std::string& resource,
                               vm::Controller& controller, vm::Recorder* recorder) {
  for (const char* option : {"--set", "--force"}) {
    base::Result<std::vector<Assignment>> rows = parse_assignments(options.all(option));
    if (!rows.ok()) return rows.error();
    std::vector<Assignment> own;
    for (const Assignment& row : *rows) {
      const auto path = name_in(resource, row.name);
      if (path) own.push_back({*path, row.value});
    }
    rows = matching(controller.image(), own);
    if (!rows.ok()) return rows.error();
    for (const Assignment& row : *rows) {
      const bool set = std::string_view(option) == "--set";
      base::Status status =
          set ? controller.set(row.name, row.value) : controller.force(row.name, row.value);
      if (!status.ok()) return status;
      if (!set) note_hold(controller.forces().back());
      if (recorder != nullptr) note_assignment(*recorder, controller, set, row);
    }
  }
  return base::Ok{};
}

void finish_scan(ResourceController& resource) {
  while (!resource.controller().at_boundary()) resource.cycle();
}

std::string value_of(const vm::Controller& controller, const std::string& name) {
  base::Result<std::string> value = controller.get(name);
  return value.ok() ? *value : "?";
}

void typed_value_of(tools::JsonWriter& json, const vm::Controller& controller,
                    const std::string& name) {
  const base::Result<ir::Symbol> symbol = ir::find_symbol(controller.image(), name);
  typed_value(json, symbol.ok() ? ir::type_text(controller.image(), *symbol) : std::string(),
              value_of(controller, name));
}

bool end_run(ResourceController& resource) {
  vm::Controller& controller = resource.controller();
  base::Status left = controller.leave_all(kExitLimitNs);  // its trap is one of these
  controller.make_outputs_safe();
  const std::string where = resource.name().empty() ? "" : resource.name() + ": ";
  for (const auto& trap : controller.traps()) {
    std::fprintf(stderr, "stvm: trap: %s%s\n", where.c_str(), trap_text(*trap).c_str());
  }
  return left.ok() && controller.traps().empty();
}

base::Result<int> run_resources(const std::vector<Resource>& resources, RunSettings settings,
                                const tools::Options& options) {
  for (const char* option : {"--trace", "--plot", "--hard-mode"}) {
    if (!options.has(option)) continue;
    return base::Error{base::Refusal::kUsage,
                       std::string(option) + " is for one resource; name one image"};
  }
  base::Result<vm::Tier> tier = tier_of(options);
  if (!tier.ok()) return tier.error();
  vm::ControllerOptions limits;
  auto exchange = make_exchange(resources);
  if (!exchange.ok()) return exchange.error();
  const bool virtual_time = options.has("--virtual-time");
  limits.tier = tier_options(*tier, virtual_time);
  vm::RealClock real_clock;
  std::vector<vm::VirtualClock> virtual_clocks(resources.size());
  Running running;
  for (size_t i = 0; i < resources.size(); ++i) {
    const ResourceController::Settings of_one{options,         limits,    virtual_time,
                                              exchange->get(), resources, i};
    vm::Clock& clock = virtual_time ? static_cast<vm::Clock&>(virtual_clocks[i]) : real_clock;
    auto started = ResourceController::start(of_one, clock, {});
    if (!started.ok()) return started.error();
    running.push_back(std::move(*started));
  }
  base::Result<Names> names = names_to_print(running, settings.print);
  if (!names.ok()) return names.error();
  settings.print = std::move(*names);
  base::Status known = check_assignments(running, options);
  if (!known.ok()) return known.error();
  for (const auto& resource : running) {
    base::Status assigned =
        apply_assignments(options, resource->name(), resource->controller(), resource->recorder());
    if (!assigned.ok()) return assigned.error();
  }
  StopSignal::install_for_outputs();
  virtual_time ? take_turns(running, settings) : run_in_threads(running, settings);
  for (const auto& resource : running) {
    finish_scan(*resource);
    if (base::Status recorded = resource->close(); !recorded.ok()) return recorded.error();
  }
  (settings.json ? print_resources_json : print_resources_text)(running, settings, options);
  bool good = true;
  for (const auto& resource : running) good = end_run(*resource) && good;
  return good ? tools::kOk : tools::kFindings;
}

}  // namespace stvm
