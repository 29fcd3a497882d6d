// stvm serve: a controller with state directory and control channel.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "tools/common/change_settings.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/signed_content.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/device_drivers.h"
#include "tools/stvm/log_output.h"
#include "tools/stvm/served_resource.h"
#include "tools/stvm/service_notify.h"
#include "tools/stvm/state_folder.h"
#include "tools/stvm/stop_signal.h"
#include "tools/stvm/tier.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/thread_filter.h"

namespace stvm {
namespace {

constexpr std::chrono::milliseconds kAliveLook{20};

constexpr tools::OptionRow kServeOptions[] = {
    STVM_DIR_OPTION,
    {"--first", "IMAGE", "the program of a state folder that holds none yet; else it is not read"},
    {"--create", nullptr,
     "without IMAGE: make the state folder, and wait for the first program (`stvm change`)"},
    {"--data-limit", "BYTES",
     "bytes of all data areas of a change together (default: no limit, or what the project says)"},
    STVM_TIER_OPTION,
    {"--code-limit", "BYTES", "bytes of all code, two slots for each POU (default: 2 GiB)"},
    {"--code-slack", "PERCENT",
     "room in each code slot for longer code (default: 25, or what the project says)"},
    {"--fifo", "PRIORITY", "SCHED_FIFO for the control thread, 1 to 99"},
    {"--cpu", "N", "keep the control thread on this processor"},
    {"--lock-memory", nullptr, "keep all memory in RAM, and touch it before the first scan"},
    {"--seccomp", nullptr, "threads may only make the system calls that docs/RUNNING.md names"},
    {"--trust", "KEYS", "take only what a key of this file has signed (docs/KEYS.md)"},
    tools::kRecordOption,
    {"--virtual-time", nullptr, "cycles as fast as they can run, instead of real time"},
    STVM_DEVICE_OPTION,
    TOOLS_COMPILE_OPTIONS,
};
constexpr tools::Command kServeCommand{
    "serve", "[IMAGES|SOURCES...]",
    "Runs a controller that can be watched and changed. Without IMAGE: the one stored last.\n"
    "Of several RESOURCEs each has a control thread, and its state in STATE/NAME.",
    kServeOptions};

using Served = std::vector<std::unique_ptr<ServedResource>>;
// What all resources get: where their events go, and the keys.
struct Shared {
  std::shared_ptr<LogOutput> log;
  StartTrust trust;
};
using Resource = vm::GlobalExchange::Resource;

base::Status open_one(const std::string& directory, const std::string& name,
                      const std::optional<ir::VerifiedImage>& given, bool create, Served& served,
                      const Shared& shared) {
  const std::string folder = name.empty() ? directory : directory + "/" + name;
  auto opened = ServedResource::open(folder, name, given, create, shared.log, shared.trust);
  if (!opened.ok()) return opened.error();
  served.push_back(std::move(*opened));
  return base::Ok{};
}

// What is stored there must not come back beside what is given, when nothing is named.
base::Status check_stored(const std::string& directory, const std::vector<Resource>& given) {
  if (given.size() > 1 && holds_program(directory)) {
    return base::Error{
        base::Refusal::kUsage,
        directory + " holds the program of a single resource; use another directory"};
  }
  for (const std::string& stored : stored_resources(directory)) {
    const bool known = std::any_of(given.begin(), given.end(), [&](const Resource& resource) {
      return resource.name == stored;
    });
    if (known) continue;
    return base::Error{
        base::Refusal::kUsage,
        directory + " holds RESOURCE " + stored +
            ", which is not among these; remove its folder, or use another directory"};
  }
  return base::Ok{};
}

base::Status open_given(const std::string& directory, const std::vector<Resource>& given,
                        Served& served, const Shared& shared) {
  base::Status opened = check_stored(directory, given);
  for (size_t i = 0; i < given.size() && opened.ok(); ++i) {
    opened = open_one(directory, given[i].name, given[i].image, true, served, shared);
  }
  return opened;
}

base::Result<Served> open_programs(const tools::Options& options, std::vector<std::string> programs,
                                   const std::string& directory, const Shared& shared) {
  Sources sources = sources_of(options);
  sources.paths = std::move(programs);
  auto images = load_programs(sources);
  if (!images.ok()) return images.error();
  auto given = name_resources(std::move(*images));
  if (!given.ok()) return given.error();
  Served served;
  base::Status opened = open_given(directory, *given, served, shared);
  if (!opened.ok()) return opened.error();
  return served;
}

// By a single resource, or by several.
base::Result<Served> open_stored(const std::string& directory, bool create, const Shared& shared) {
  Served served;
  const std::vector<std::string> stored = stored_resources(directory);
  base::Status opened = base::Ok{};
  if (stored.empty()) opened = open_one(directory, "", std::nullopt, create, served, shared);
  for (size_t i = 0; i < stored.size() && opened.ok(); ++i) {
    opened = open_one(directory, stored[i], std::nullopt, create, served, shared);
  }
  if (!opened.ok()) return opened.error();
  return served;
}

// What is given, or what is stored, or where nothing ever was, the first program.
base::Result<Served> open_all(const tools::Options& options, const Shared& shared) {
  const std::string directory = state_directory(options);
  if (!options.has("--first")) {
    if (options.arguments().empty()) {
      return open_stored(directory, options.has("--create"), shared);
    }
    return open_programs(options, options.arguments(), directory, shared);
  }
  if (!options.arguments().empty()) {
    return base::Error{base::Refusal::kUsage,
                       "--first is for a start without other programs; leave one of them out"};
  }
  base::Result<Served> stored = open_stored(directory, false, shared);
  if (stored.ok() || stored.error().refusal != base::Refusal::kFileNotFound) return stored;
  return open_programs(options, {options.text("--first")}, directory, shared);
}

// Of the images among these.
base::Result<StartTrust> trust_of(const tools::Options& options) {
  StartTrust out{options.text("--trust")};
  std::vector<std::string> paths = options.arguments();
  if (options.has("--first")) paths.push_back(options.text("--first"));
  for (const std::string& path : paths) {
    if (out.path.empty() || !tools::is_signed_as(path, online_change::SignedKind::kImage)) continue;
    base::Result<base::Bytes> bytes = tools::read_bytes(path);
    if (!bytes.ok()) return bytes.error();
    base::Result<online_change::SignedFile> file = online_change::open_signed(*bytes);
    if (!file.ok()) return base::Error{file.error().refusal, path + ": " + file.error().text};
    out.images.emplace(file->statement.content, std::move(*file));
  }
  return out;
}

base::Result<vm::ControllerOptions> limits_of(const tools::Options& options) {
  vm::ControllerOptions limits;
  base::Result<tools::ChangeSettings> settings = tools::change_settings(options.arguments());
  if (!settings.ok()) return settings.error();
  base::Result<uint64_t> data_limit = options.number("--data-limit", settings->data_limit);
  if (!data_limit.ok()) return data_limit.error();
  limits.data_limit = *data_limit;
  base::Result<uint64_t> code_limit = options.number("--code-limit", limits.code_limit);
  if (!code_limit.ok()) return code_limit.error();
  limits.code_limit = *code_limit;
  base::Result<uint64_t> slack = options.number("--code-slack", settings->code_slack_percent);
  if (!slack.ok()) return slack.error();
  if (*slack > vm::CodeSlots::kMostSlackPercent) {
    return base::Error{base::Refusal::kUsage, "--code-slack is at most " +
                                                  std::to_string(vm::CodeSlots::kMostSlackPercent)};
  }
  limits.code_slack_percent = *slack;
  base::Result<vm::Tier> tier = tier_of(options);
  if (!tier.ok()) return tier.error();
  limits.tier = tier_options(*tier, options.has("--virtual-time"));
  return limits;
}

base::Result<vm::RealTimeOptions> real_time_options(const tools::Options& options) {
  vm::RealTimeOptions out;
  base::Result<uint64_t> fifo = options.number("--fifo", 0);
  if (!fifo.ok()) return fifo.error();
  base::Result<uint64_t> cpu = options.number("--cpu", 0);
  if (!cpu.ok()) return cpu.error();
  if (*fifo > 99 || *cpu > 4096 || (options.has("--fifo") && *fifo == 0)) {
    return base::Error{base::Refusal::kUsage, "--fifo is 1 to 99, --cpu the number of a processor"};
  }
  out.fifo_priority = static_cast<uint32_t>(*fifo);
  if (options.has("--cpu")) out.cpu = static_cast<uint32_t>(*cpu);
  out.lock_memory = options.has("--lock-memory");
  out.confined = options.has("--seccomp");
  return out;
}

bool is_journal() { return LogOutput::is_journal(STDERR_FILENO, std::getenv("JOURNAL_STREAM")); }

void print_ready(ServedResource& resource) {
  const vm::Controller& controller = resource.controller();
  std::printf("ready: %s %s in %s\n", controller.image().name.c_str(),
              base::short_hex(controller.verified().digest()).c_str(),
              resource.directory().c_str());
  std::fflush(stdout);
}

// Runs on the control thread, which is the calling one.
base::Status run_one(ServedResource& resource, const vm::RealTimeOptions& real_time,
                     ServiceNotify& notify) {
  // After all other threads, which stay as they are.
  base::Status fit = resource.make_real_time(real_time);
  if (fit.ok()) fit = resource.begin();
  if (!fit.ok()) {
    resource.give_up();
    return fit;
  }
  print_ready(resource);
  notify.ready(base::short_hex(resource.controller().verified().digest()));
  resource.run(StopSignal::received, [&] { notify.alive(); });
  notify.stopping();
  return resource.end();
}

// A control thread each; this one tells the service manager that all of them live. When one ends,
// all end.
base::Status run_several(Served& served, const vm::RealTimeOptions& real_time,
                         ServiceNotify& notify) {
  std::atomic<bool> stop{false};
  std::atomic<size_t> ready{0};
  std::atomic<size_t> ended{0};
  std::vector<std::atomic<bool>> alive(served.size());
  std::vector<base::Status> results(served.size(), base::Ok{});
  std::vector<std::thread> threads;
  for (size_t i = 0; i < served.size(); ++i) {
    threads.emplace_back([&, i] {
      vm::RealTimeOptions own = real_time;
      if (own.cpu) *own.cpu += static_cast<uint32_t>(i);
      results[i] = served[i]->make_real_time(own);
      if (results[i].ok()) results[i] = served[i]->begin();
      if (results[i].ok()) {
        print_ready(*served[i]);
        ++ready;
        served[i]->run([&] { return stop || StopSignal::received(); }, [&] { alive[i] = true; });
      } else {
        served[i]->give_up();
      }
      stop = true;
      ++ended;
    });
  }
  bool told = false;
  while (ended < served.size()) {
    std::this_thread::sleep_for(kAliveLook);
    if (!told && ready == served.size()) {
      notify.ready(std::to_string(served.size()) + " resources");
      told = true;
    }
    if (!std::all_of(alive.begin(), alive.end(), [](const auto& one) { return one.load(); })) {
      continue;
    }
    notify.alive();
    for (std::atomic<bool>& one : alive) one = false;
  }
  notify.stopping();
  base::Status out = base::Ok{};
  for (size_t i = 0; i < served.size(); ++i) {
    threads[i].join();
    const bool ran = results[i].ok();
    base::Status ending = ran ? served[i]->end() : results[i];
    if (out.ok()) out = ending;
  }
  return out;
}

base::Status serve(const tools::Options& options) {
  base::Result<vm::ControllerOptions> limits = limits_of(options);
  if (!limits.ok()) return limits.error();
  base::Status fit = check_compile_options(sources_of(options));
  if (!fit.ok()) return fit;
  base::Result<vm::RealTimeOptions> real_time = real_time_options(options);
  if (!real_time.ok()) return real_time.error();
  StopSignal::install_service();
  // What the resources use outlives them.
  vm::RealClock real_clock;
  vm::VirtualClock virtual_clock;
  std::unique_ptr<vm::GlobalExchange> exchange;
  const auto output = std::make_shared<LogOutput>(STDERR_FILENO, is_journal());
  base::Result<StartTrust> trust = trust_of(options);
  if (!trust.ok()) return trust.error();
  base::Result<Served> served = open_all(options, {output, std::move(*trust)});
  if (!served.ok()) return served.error();
  // After the compiler, which is a program of its own, and before all threads.
  if (real_time->confined) {
    base::Status confined = vm::confine_thread(vm::ThreadKind::kAny);
    if (!confined.ok()) return confined;
  }
  output->start();
  const bool virtual_time = options.has("--virtual-time");
  if (virtual_time && served->size() > 1) {
    return base::Error{base::Refusal::kUsage,
                       "--virtual-time serves one resource; `stvm run` takes turns"};
  }
  std::vector<Resource> resources;
  for (const auto& one : *served) resources.push_back({one->name(), one->program()});
  auto made = make_exchange(resources);
  if (!made.ok()) return made.error();
  exchange = std::move(*made);
  vm::Clock& clock = virtual_time ? static_cast<vm::Clock&>(virtual_clock) : real_clock;
  for (size_t i = 0; i < served->size(); ++i) {
    base::Status started =
        (*served)[i]->start({options, *limits, virtual_time, exchange.get(), resources, i}, clock,
                            virtual_time ? nullptr : &real_clock);
    if (!started.ok()) {
      for (size_t k = 0; k < i; ++k) (*served)[k]->give_up();
      return started;
    }
  }
  ServiceNotify notify;
  return served->size() == 1 ? run_one(*served->front(), *real_time, notify)
                             : run_several(*served, *real_time, notify);
}

int run_serve(const tools::Options& options) {
  base::Status served = serve(options);
  std::clearerr(stdout);  // whoever read what it says may have gone long ago
  if (served.ok()) return tools::kOk;
  if (is_journal()) std::fputs("<3>", stderr);  // the level, as that of events
  return refuse(served.error());
}

}  // namespace

const Entry kServe{&kServeCommand, run_serve};

}  // namespace stvm
