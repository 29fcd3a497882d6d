// stvm bench: nanoseconds of each scan of one program, without tasks, I/O and waiting.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/compiler.h"
#include "tools/stvm/tier.h"
#include "tools/stvm/trap_text.h"
#include "vm/native/program.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/io.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kBenchOptions[] = {
    {"--program", "P", "program instance (default: the first)"},
    {"--scans", "N", "scans that are measured (default 10000); a tenth more run before"},
    {"--batch", "N",
     "scans between two readings of the clock (default 1); their time is divided by N"},
    {"--period", "NS", "virtual time between two scans (default 10000000)"},
    STVM_TIER_OPTION,
    TOOLS_COMPILE_OPTIONS,
    STVM_FORMAT_OPTION,
};
constexpr tools::Command kBenchCommand{"bench", "IMAGE|SOURCES...",
                                       "Measures the scan time of one program.", kBenchOptions, 1};

using SteadyClock = std::chrono::steady_clock;

int64_t since(SteadyClock::time_point begin) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(SteadyClock::now() - begin).count();
}

// What two looks at the clock cost, to be taken off.
int64_t clock_cost() {
  std::vector<int64_t> costs(1001);
  for (int64_t& cost : costs) cost = since(SteadyClock::now());
  std::nth_element(costs.begin(), costs.begin() + 500, costs.end());
  return costs[500];
}

base::Result<uint32_t> find_program(const ir::Image& image, const std::string& name) {
  std::string names;
  for (uint32_t id : image.program_ids()) {
    if (name.empty() || ir::same_name(name, image.instances[id].name)) return id;
    names += (names.empty() ? "" : ", ") + image.instances[id].name;
  }
  return base::Error{base::Refusal::kNoSuchVariable,
                     "no program instance `" + name + "`; there are: " + names};
}

struct Timing {
  double min = 0;
  double median = 0;
  double p99 = 0;
};

Timing summarise(std::vector<double>& times) {
  std::sort(times.begin(), times.end());
  return {times.front(), times[times.size() / 2], times[times.size() * 99 / 100]};
}

constexpr uint64_t kFuel = 1'000'000'000;

// The error of a scan that did not end as it should.
base::Error failure(const vm::Controller& controller, const vm::Execution& execution,
                    vm::Exit exit) {
  if (exit == vm::Exit::kSuspended) {
    return base::Error{base::Refusal::kFault, "the scan does not end: endless loop?"};
  }
  vm::TrapRecord record{0, "bench", execution.trap(),
                        vm::describe(controller.image(), execution.trap())};
  return base::Error{base::Refusal::kFault, trap_text(record)};
}

struct BenchSettings {
  bool json = false;
  uint64_t scans = 0;
  uint64_t batch = 1;
  int64_t period_ns = 0;
  vm::Tier tier = vm::Tier::kAuto;
};

base::Result<BenchSettings> read_bench_settings(const tools::Options& options) {
  const bool json = wants_json(options);
  base::Result<uint64_t> scans = options.number("--scans", 10'000);
  if (!scans.ok()) return scans.error();
  base::Result<uint64_t> batch = options.number("--batch", 1);
  if (!batch.ok()) return batch.error();
  base::Result<uint64_t> period = options.number("--period", 10'000'000);
  if (!period.ok()) return period.error();
  constexpr uint64_t kMost = 100'000'000;
  if (*scans == 0 || *scans > kMost) {
    return base::Error{base::Refusal::kUsage, "--scans is 1 to 100000000"};
  }
  if (*batch == 0 || *batch > *scans) {
    return base::Error{base::Refusal::kUsage, "--batch is 1 to the number of scans"};
  }
  base::Result<vm::Tier> tier = tier_of(options);
  if (!tier.ok()) return tier.error();
  return BenchSettings{json, *scans, *batch, static_cast<int64_t>(*period), *tier};
}

base::Result<Timing> measure(const BenchSettings& settings, vm::Controller& controller,
                             uint32_t program) {
  vm::Execution execution(controller.image().call_depth);
  const uint64_t warm_up = (settings.scans / 10 / settings.batch + 1) * settings.batch;
  const uint64_t all = warm_up + settings.scans;
  std::vector<double> times;
  times.reserve(settings.scans / settings.batch);
  const int64_t cost = clock_cost();
  const vm::Generation& generation = controller.generation();
  uint8_t* const memory = controller.memory().data();
  for (uint64_t scan = 0; scan + settings.batch <= all;) {
    const bool counts = scan >= warm_up;
    const auto begin = SteadyClock::now();
    for (uint64_t end = scan + settings.batch; scan < end; ++scan) {
      execution.start(generation, memory, program, ir::kStackBegin,
                      static_cast<int64_t>(scan) * settings.period_ns);
      const vm::Exit exit = execution.run(kFuel);
      if (exit != vm::Exit::kDone) return failure(controller, execution, exit);
    }
    const auto ns = static_cast<double>(std::max<int64_t>(since(begin) - cost, 0));
    if (counts) times.push_back(ns / static_cast<double>(settings.batch));
  }
  return summarise(times);
}

void print(const BenchSettings& settings, const std::string& program, const char* tier,
           const Timing& timing) {
  if (!settings.json) {
    std::printf("%s: %.0f ns min, %.0f ns median, %.0f ns p99 of %llu scans (%s)\n",
                program.c_str(), timing.min, timing.median, timing.p99,
                static_cast<unsigned long long>(settings.scans), tier);
    return;
  }
  tools::JsonWriter json;
  json.begin_object().field("program", program).field("scans", settings.scans);
  json.field("min_ns", timing.min).field("median_ns", timing.median).field("p99_ns", timing.p99);
  json.field("tier", tier).end_object();
  std::fputs(json.finish().c_str(), stdout);
}

// Which POUs have no machine code, and why.
void print_interpreted(const ir::Image& image, const vm::native::Program& native) {
  for (uint32_t number = 0; number < image.pous.size(); ++number) {
    const std::string& reason = native.reason(number);
    if (reason.empty()) continue;
    std::printf("%s is interpreted: %s\n", image.pous[number].name.c_str(), reason.c_str());
  }
}

base::Status bench(const tools::Options& options) {
  base::Result<BenchSettings> settings = read_bench_settings(options);
  if (!settings.ok()) return settings.error();
  base::Result<ir::VerifiedImage> image = load_program(sources_of(options));
  if (!image.ok()) return image.error();
  base::Result<uint32_t> program = find_program(image->image(), options.text("--program"));
  if (!program.ok()) return program.error();
  vm::VirtualClock clock;
  vm::NullIo io;
  vm::ControllerOptions limits;
  limits.tier.tier = settings->tier;
  auto controller = vm::Controller::start(*image, limits, clock, io);
  if (!controller.ok()) return controller.error();
  base::Result<Timing> timing = measure(*settings, **controller, *program);
  if (!timing.ok()) return timing.error();
  const vm::native::Program* const native = (*controller)->generation().native();
  if (native != nullptr && !settings->json) print_interpreted(image->image(), *native);
  print(*settings, image->image().instances[*program].name, native != nullptr ? "native" : "interp",
        *timing);
  return base::Ok{};
}

int run_bench(const tools::Options& options) {
  base::Status done = bench(options);
  return done.ok() ? tools::kOk : refuse(done.error());
}

}  // namespace

const Entry kBench{&kBenchCommand, run_bench};

}  // namespace stvm
