// stvm run: a program in this process, without state directory and control channel.
#include <algorithm>
#include <cstdio>
#include <optional>

#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/compiler.h"
#include "tools/stvm/device_drivers.h"
#include "tools/stvm/hard_mode.h"
#include "tools/stvm/json_value.h"
#include "tools/stvm/names.h"
#include "tools/stvm/plot.h"
#include "tools/stvm/run_resources.h"
#include "tools/stvm/run_timing.h"
#include "tools/stvm/stop_signal.h"
#include "tools/stvm/tier.h"
#include "tools/stvm/trace.h"
#include "tools/stvm/trap_text.h"
#include "vm/runtime/clocks.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kRunOptions[] = {
    tools::kScansOption,
    {"--virtual-time", nullptr, "run as fast as possible, the same every time"},
    {"--set", "NAME=VALUE", "write a variable before the first scan; repeatable", "", "",
     tools::Times::kMany},
    {"--force", "NAME=VALUE", "impose a value in every scan; repeatable", "", "",
     tools::Times::kMany},
    tools::kPrintOption,
    tools::kPlotOption,
    tools::kTraceOption,
    tools::kRecordOption,
    {"--state", nullptr, "print every variable at the end"},
    {"--hash", nullptr, "print the hash of the state at the end"},
    {"--hard-mode", "MODE", "fuel1, identity or move: nothing may come out differently",
     "fuel1|identity|move"},
    {"--every", "K", "identity, move: change after every K-th scan (default 1)"},
    STVM_TIMING_OPTIONS,
    STVM_TIER_OPTION,
    STVM_DEVICE_OPTION,
    TOOLS_COMPILE_OPTIONS,
    STVM_FORMAT_OPTION,
};
constexpr tools::Command kRunCommand{"run", "IMAGES|SOURCES...", "Runs a program scan by scan.",
                                     kRunOptions, 1};

struct Settings {
  bool json = false;
  HardMode hard_mode = HardMode::kNone;
  std::optional<uint64_t> scans;
  vm::Tier tier = vm::Tier::kAuto;
  uint64_t every = 1;
  std::vector<std::string> print;
  RunTiming timing;
};

base::Result<Settings> read_settings(const tools::Options& options) {
  Settings out;
  const bool json = wants_json(options);
  base::Result<HardMode> hard_mode = parse_hard_mode(options.text("--hard-mode"));
  if (!hard_mode.ok()) return hard_mode.error();
  base::Result<uint64_t> scans = options.number("--scans", 0);
  if (!scans.ok()) return scans.error();
  base::Result<uint64_t> every = options.number("--every", 1);
  if (!every.ok()) return every.error();
  base::Result<vm::Tier> tier = tier_of(options);
  if (!tier.ok()) return tier.error();
  base::Result<RunTiming> timing = RunTiming::read(options);
  if (!timing.ok()) return timing.error();
  out.timing = std::move(*timing);
  out.tier = *tier;
  out.json = json;
  out.hard_mode = *hard_mode;
  if (options.has("--scans")) out.scans = *scans;
  out.every = std::max<uint64_t>(*every, 1);
  out.print = split_names(options.all("--print"));
  return out;
}

base::Status run_scans(const Settings& settings, const tools::Options& options,
                       ResourceController& running, vm::VirtualClock& clock, TimingChart* chart) {
  vm::Controller& controller = running.controller();
  std::optional<Trace> trace;
  if (options.has("--trace")) {
    base::Result<Trace> opened =
        Trace::open(options.text("--trace"), controller.image(), settings.print);
    if (!opened.ok()) return opened.error();
    trace.emplace(std::move(*opened));
  }
  std::optional<Plot> plot;
  if (options.has("--plot")) {
    base::Result<Plot> begun = Plot::of(controller, settings.print);
    if (!begun.ok()) return begun.error();
    plot.emplace(std::move(*begun));
  }
  std::optional<RunChange> change;
  if (settings.timing.change) change.emplace(*settings.timing.change, controller, clock);
  while (!controller.faulted() && !StopSignal::received()) {
    if (settings.scans && controller.cycles() >= *settings.scans) break;
    running.cycle();
    if (!controller.at_boundary()) continue;
    if (plot) plot->sample(controller);
    if (trace) {
      base::Status written = trace->write(controller);
      if (!written.ok()) return written;
    }
    if (controller.faulted()) continue;
    if (change) {
      base::Status stepped = change->step(chart);
      if (!stepped.ok()) return stepped;
    }
    if (controller.cycles() % settings.every != 0) continue;
    base::Status changed = apply_hard_mode(settings.hard_mode, sources_of(options), controller);
    if (!changed.ok()) return changed;
  }
  if (change && !change->end().ok()) return change->end();
  if (plot) {
    const std::string picture = plot->svg(controller.image().name);
    base::Status drawn = tools::write_file(options.text("--plot"), base::as_bytes(picture));
    if (!drawn.ok()) return drawn;
  }
  return trace ? trace->close() : base::Status(base::Ok{});
}

void print_text(const Settings& settings, const tools::Options& options,
                vm::Controller& controller) {
  for (const std::string& name : settings.print) {
    std::printf("%s=%s\n", name.c_str(), value_of(controller, name).c_str());
  }
  auto memory = controller.memory().view();
  if (options.has("--state")) {
    std::fputs(ir::state_text(controller.image(), memory).c_str(), stdout);
  }
  if (options.has("--hash")) {
    std::printf("%s\n", base::to_hex(ir::state_hash(controller.image(), memory)).c_str());
  }
}

// To its file, or to standard output where that has no JSON.
base::Status show_chart(const Settings& settings, const TimingChart& chart,
                        const std::string& title) {
  const std::string& path = settings.timing.chart;
  if (path != "-") return tools::write_file(path, base::as_bytes(chart.svg(title)));
  if (!settings.json) std::fputs(chart.text().c_str(), stdout);
  return base::Ok{};
}

void print_json(const Settings& settings, const tools::Options& options, vm::Controller& controller,
                const TimingChart* chart) {
  tools::JsonWriter json;
  json.begin_object().field("scans", controller.cycles()).field("faulted", controller.faulted());
  json.key("values").begin_object();
  for (const std::string& name : settings.print) {
    json.key(name);
    typed_value_of(json, controller, name);
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
  json.end_array();
  if (chart != nullptr) chart->json(json);
  json.end_object();
  std::fputs(json.finish().c_str(), stdout);
}

base::Result<int> run_alone(Settings settings,
                            const std::vector<vm::GlobalExchange::Resource>& program,
                            const tools::Options& options) {
  const RunTiming& timing = settings.timing;
  const ir::Image& image = program.front().image.image();
  if (base::Status known = timing.check_tasks(image); !known.ok()) return known.error();
  vm::VirtualClock virtual_clock(timing.safe_point_ns);
  for (const auto& [task, ns] : timing.durations) virtual_clock.let_scans_last(task, ns);
  std::optional<TimingChart> chart;
  if (!timing.chart.empty()) chart.emplace(image);
  vm::RealClock real_clock;
  const bool virtual_time = options.has("--virtual-time");
  vm::Clock& clock = virtual_time ? static_cast<vm::Clock&>(virtual_clock) : real_clock;
  ResourceController::Settings start{options, {}, virtual_time, nullptr, program, 0};
  start.limits.tier = tier_options(settings.tier, virtual_time);
  start.limits.fuel_slice = timing.fuel_slice(start.limits.fuel_slice);
  if (settings.hard_mode == HardMode::kFuel1) start.limits.fuel_slice = 1;
  if (chart) start.limits.timeline = &*chart;
  auto running = ResourceController::start(start, clock, {});
  if (!running.ok()) return running.error();
  vm::Controller& controller = (*running)->controller();
  base::Status assigned = apply_assignments(options, "", controller, (*running)->recorder());
  if (!assigned.ok()) return assigned.error();
  // A name that is not there shall be said before the first scan, not after the last.
  base::Result<Names> names = matching(controller.image(), settings.print);
  if (!names.ok()) return names.error();
  settings.print = std::move(*names);
  StopSignal::install_for_outputs();
  TimingChart* const seen = chart ? &*chart : nullptr;
  base::Status done = run_scans(settings, options, **running, virtual_clock, seen);
  if (!done.ok()) return done.error();
  if (chart) {
    const int64_t now_ns = clock.now_ns();
    const bool virtual_end = virtual_time && !controller.faulted();
    chart->end(virtual_end ? std::max(now_ns, controller.next_cycle_ns()) : now_ns);
    base::Status drawn = show_chart(settings, *chart, image.name);
    if (!drawn.ok()) return drawn.error();
  }
  finish_scan(**running);
  if (base::Status recorded = (*running)->close(); !recorded.ok()) return recorded.error();
  if (settings.json) {
    print_json(settings, options, controller, seen);
  } else {
    print_text(settings, options, controller);
  }
  return end_run(**running) ? tools::kOk : tools::kFindings;
}

base::Result<int> run_one(const tools::Options& options) {
  base::Result<Settings> settings = read_settings(options);
  if (!settings.ok()) return settings.error();
  if (options.has("--record") && settings->hard_mode != HardMode::kNone) {
    return base::Error{base::Refusal::kUsage, "--record cannot be combined with --hard-mode"};
  }
  base::Status fit = options.has("--change") ? base::Status(base::Ok{})
                                             : check_compile_options(sources_of(options));
  if (!fit.ok()) return fit.error();
  base::Status possible = check_hard_mode(settings->hard_mode, sources_of(options));
  if (!possible.ok()) return possible.error();
  expect_programs(sources_of(options));
  auto images = load_programs(sources_of(options));
  if (!images.ok()) return images.error();
  // The images end with the process: taking their tables apart would cost a part of a short run.
  [[gnu::used]] static const auto* const kept = new std::vector<ir::VerifiedImage>(*images);
  auto resources = name_resources(std::move(*images));
  if (!resources.ok()) return resources.error();
  if (resources->size() > 1) {
    if (settings->timing.any() || !settings->timing.chart.empty()) {
      return base::Error{base::Refusal::kUsage,
                         "--duration, --safe-point, --change and --chart are for one resource"};
    }
    return run_resources(*resources, {settings->json, settings->scans, settings->print}, options);
  }
  return run_alone(*settings, *resources, options);
}

int run_command(const tools::Options& options) {
  base::Result<int> code = run_one(options);
  return code.ok() ? *code : refuse(code.error());
}

}  // namespace

const Entry kRun{&kRunCommand, run_command};

}  // namespace stvm
