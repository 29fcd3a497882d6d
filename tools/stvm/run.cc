// stvm run: a program in this process, without state directory and control channel.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <optional>

#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/compiler.h"
#include "tools/stvm/device_drivers.h"
#include "tools/stvm/hard_mode.h"
#include "tools/stvm/plot.h"
#include "tools/stvm/record.h"
#include "tools/stvm/stop_signal.h"
#include "tools/stvm/trace.h"
#include "tools/stvm/trap_text.h"
#include "vm/runtime/clocks.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kOptions[] = {
    {"--scans", "N", "control cycles to run (default: until interrupted)"},
    {"--virtual-time", nullptr, "as fast as it can, the same every time"},
    {"--set", "NAME=VALUE", "write a variable before the first scan; repeatable"},
    {"--force", "NAME=VALUE", "impose a value in every scan; repeatable"},
    {"--print", "NAMES", "print these variables at the end: A,B.c"},
    {"--plot", "FILE", "SVG picture of the variables of --print over the run"},
    {"--trace", "FILE", "CSV: values after every scan, of --print or of all variables"},
    {"--record", "FILE", "record the run, for `stvm replay`"},
    {"--state", nullptr, "print every variable at the end"},
    {"--hash", nullptr, "print the hash of the state at the end"},
    {"--hard-mode", "MODE", "fuel1, identity or move: nothing may come out differently"},
    {"--every", "K", "identity, move: change after every K-th scan (default 1)"},
    STVM_DEVICE_OPTION,
    STVM_DIALECT_OPTION,
    STVM_FORMAT_OPTION,
};
constexpr tools::Command kCommand{"run", "IMAGE|SOURCES...", "Runs a program scan by scan.",
                                  kOptions, 1};

struct Settings {
  bool json = false;
  HardMode hard_mode = HardMode::kNone;
  std::optional<uint64_t> scans;
  uint64_t every = 1;
  std::vector<std::string> print;
};

base::Result<Settings> read_settings(const tools::Options& options) {
  Settings out;
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return json.error();
  base::Result<HardMode> hard_mode = parse_hard_mode(options.text("--hard-mode"));
  if (!hard_mode.ok()) return hard_mode.error();
  base::Result<uint64_t> scans = options.number("--scans", 0);
  if (!scans.ok()) return scans.error();
  base::Result<uint64_t> every = options.number("--every", 1);
  if (!every.ok()) return every.error();
  out.json = *json;
  out.hard_mode = *hard_mode;
  if (options.has("--scans")) out.scans = *scans;
  out.every = std::max<uint64_t>(*every, 1);
  out.print = split_names(options.all("--print"));
  return out;
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

base::Status apply_assignments(const tools::Options& options, vm::Controller& controller,
                               vm::Recorder* recorder) {
  for (const char* option : {"--set", "--force"}) {
    base::Result<std::vector<Assignment>> rows = parse_assignments(options.all(option));
    if (!rows.ok()) return rows.error();
    for (const Assignment& row : *rows) {
      bool set = std::string_view(option) == "--set";
      base::Status status =
          set ? controller.set(row.name, row.value) : controller.force(row.name, row.value);
      if (!status.ok()) return status;
      if (recorder != nullptr) note_assignment(*recorder, controller, set, row);
    }
  }
  return base::Ok{};
}

void run_cycle(vm::Controller& controller, vm::Recorder* recorder) {
  if (recorder != nullptr) recorder->begin();
  controller.cycle();
  if (recorder != nullptr) recorder->end(controller);
}

// A name that is not there shall be said before the first scan, not after the last.
base::Status check_names(const std::vector<std::string>& names, const vm::Controller& controller) {
  for (const std::string& name : names) {
    base::Result<ir::Symbol> symbol = ir::find_symbol(controller.image(), name);
    if (!symbol.ok()) return symbol.error();
  }
  return base::Ok{};
}

base::Status run_scans(const Settings& settings, const tools::Options& options,
                       vm::Controller& controller, vm::Recorder* recorder) {
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
  while (!controller.faulted() && !StopSignal::received()) {
    if (settings.scans && controller.cycles() >= *settings.scans) break;
    run_cycle(controller, recorder);
    if (!controller.at_boundary()) continue;
    if (plot) plot->sample(controller);
    if (trace) {
      base::Status written = trace->write(controller);
      if (!written.ok()) return written;
    }
    if (controller.faulted() || controller.cycles() % settings.every != 0) continue;
    base::Status changed = apply_hard_mode(settings.hard_mode, sources_of(options), controller);
    if (!changed.ok()) return changed;
  }
  if (plot) {
    const std::string picture = plot->svg(controller.image().name);
    base::Status drawn = tools::write_file(options.text("--plot"), base::as_bytes(picture));
    if (!drawn.ok()) return drawn;
  }
  return trace ? trace->close() : base::Status(base::Ok{});
}

// A task that is still inside its scan would show half of its results.
void finish_scan(vm::Controller& controller, vm::Recorder* recorder) {
  while (!controller.at_boundary()) run_cycle(controller, recorder);
}

std::string value_of(const vm::Controller& controller, const std::string& name) {
  base::Result<std::string> value = controller.get(name);
  return value.ok() ? *value : "?";
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

void print_json(const Settings& settings, const tools::Options& options,
                vm::Controller& controller) {
  tools::JsonWriter json;
  json.begin_object().field("scans", controller.cycles()).field("faulted", controller.faulted());
  json.key("values").begin_object();
  for (const std::string& name : settings.print) json.field(name, value_of(controller, name));
  auto memory = controller.memory().view();
  if (options.has("--state")) {
    ir::for_each_leaf(controller.image(), [&](const std::string& path, const ir::Symbol& symbol) {
      json.field(path, ir::format_value(controller.image(), symbol, memory));
    });
  }
  json.end_object();
  if (options.has("--hash")) {
    json.field("hash", base::to_hex(ir::state_hash(controller.image(), memory)));
  }
  json.key("traps").begin_array();
  for (const vm::TrapRecord& trap : controller.traps()) json.value(trap_text(trap));
  json.end_array().end_object();
  std::fputs(json.finish().c_str(), stdout);
}

base::Result<int> run_program(const tools::Options& options) {
  base::Result<Settings> settings = read_settings(options);
  if (!settings.ok()) return settings.error();
  if (options.has("--record") && settings->hard_mode != HardMode::kNone) {
    return base::Error{base::Refusal::kUsage, "--record cannot be combined with --hard-mode"};
  }
  base::Status possible = check_hard_mode(settings->hard_mode, sources_of(options));
  if (!possible.ok()) return possible.error();
  base::Result<ir::VerifiedImage> image = load_program(sources_of(options));
  if (!image.ok()) return image.error();
  vm::ControllerOptions controller_options;
  if (settings->hard_mode == HardMode::kFuel1) controller_options.fuel_slice = 1;
  vm::VirtualClock virtual_clock;
  vm::RealClock real_clock;
  vm::Clock* clock = &real_clock;
  if (options.has("--virtual-time")) clock = &virtual_clock;
  auto devices = device_options(options, clock == &virtual_clock ? clock : nullptr);
  if (!devices.ok()) return devices.error();
  vm::DeviceIo io(std::move(*devices));
  base::Result<std::unique_ptr<vm::Recorder>> recorder =
      open_recorder(options, *image, {}, controller_options, *clock, io);
  if (!recorder.ok()) return recorder.error();
  auto controller = start_recorded(*image, controller_options, *clock, io, {}, recorder->get());
  if (!controller.ok()) return controller.error();
  base::Status assigned = apply_assignments(options, **controller, recorder->get());
  if (!assigned.ok()) return assigned.error();
  base::Status known = check_names(settings->print, **controller);
  if (!known.ok()) return known.error();
  StopSignal::install();
  base::Status done = run_scans(*settings, options, **controller, recorder->get());
  if (!done.ok()) return done.error();
  finish_scan(**controller, recorder->get());
  if (*recorder) {
    base::Status recorded = (*recorder)->close();
    if (!recorded.ok()) return recorded.error();
  }
  (settings->json ? print_json : print_text)(*settings, options, **controller);
  base::Status left = (*controller)->leave_all(kExitLimitNs);  // its trap is one of these
  (*controller)->make_outputs_safe();
  for (const vm::TrapRecord& trap : (*controller)->traps()) {
    std::fprintf(stderr, "stvm: trap: %s\n", trap_text(trap).c_str());
  }
  return left.ok() && (*controller)->traps().empty() ? tools::kOk : tools::kFindings;
}

int run(const tools::Options& options) {
  base::Result<int> code = run_program(options);
  return code.ok() ? *code : refuse(code.error());
}

}  // namespace

const Entry kRun{&kCommand, run};

}  // namespace stvm
