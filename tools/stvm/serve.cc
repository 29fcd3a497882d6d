// stvm serve: a controller with state directory and control channel.
#include <algorithm>
#include <cstdio>

#include "tools/common/change_settings.h"
#include "tools/common/exit.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/compiler.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/device_drivers.h"
#include "tools/stvm/record.h"
#include "tools/stvm/service_notify.h"
#include "tools/stvm/state_folder.h"
#include "tools/stvm/stop_signal.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/file_storage.h"
#include "vm/runtime/mailbox.h"
#include "vm/runtime/realtime.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kOptions[] = {
    STVM_DIR_OPTION,
    {"--data-limit", "BYTES",
     "of all data areas of a change together (default: no limit, or what the project says)"},
    {"--code-limit", "BYTES", "of all code, two slots for each POU (default: 2 GiB)"},
    {"--fifo", "PRIORITY", "SCHED_FIFO for the control thread, 1 to 99"},
    {"--cpu", "N", "keep the control thread on this processor"},
    {"--lock-memory", nullptr, "keep all memory in RAM, and touch it before the first scan"},
    {"--record", "FILE", "record the run, for `stvm replay`"},
    {"--virtual-time", nullptr, "cycles as fast as they can run, instead of real time"},
    STVM_DEVICE_OPTION,
    STVM_DIALECT_OPTION,
};
constexpr tools::Command kCommand{
    "serve", "[IMAGE|SOURCES...]",
    "Runs a controller that can be watched and changed. Without IMAGE: the one stored last.",
    kOptions};

// Commands are answered between cycles too, so a long period does not make them slow.
constexpr int64_t kLookNs = 2'000'000;
constexpr int64_t kFaultLookNs = 10'000'000;

// What runs, and the reason when it is not what was asked for.
base::Result<online_change::Boot> boot_program(const tools::Options& options,
                                               online_change::Store& store) {
  std::optional<ir::VerifiedImage> given;
  if (!options.arguments().empty()) {
    base::Result<ir::VerifiedImage> image = load_program(sources_of(options));
    if (!image.ok()) return image.error();
    given = *image;
  }
  auto boot = online_change::boot(store, given, "serve", wall_time_ns());
  if (boot.ok()) return boot;
  const std::string directory = state_directory(options);
  if (boot.error().refusal == base::Refusal::kFileNotFound) {
    return base::Error{base::Refusal::kFileNotFound,
                       directory + " holds no program yet; name an image or sources"};
  }
  return base::Error{boot.error().refusal, directory + ": " + boot.error().text};
}

// Until the next cycle begins; what remains at the end is left to the clock's exact wait.
void idle(vm::Controller& controller, vm::Clock& clock, vm::Mailbox& mailbox,
          online_change::RetainKeeper& keeper, ServiceNotify& notify) {
  while (!StopSignal::received()) {
    notify.alive();
    int64_t now = clock.now_ns();
    if (controller.next_cycle_ns() - now <= kLookNs) return;
    clock.wait_until(std::min(now + kLookNs, controller.next_cycle_ns() - kLookNs));
    mailbox.serve();
    keeper.serve(controller.next_cycle_ns() - clock.now_ns());
  }
}

void control_loop(vm::Controller& controller, vm::Clock& clock, vm::Mailbox& mailbox,
                  ControllerService& service, vm::Recorder* recorder, ServiceNotify& notify) {
  online_change::RetainKeeper& keeper = service.keeper();
  while (!StopSignal::received() && !service.stop_wanted()) {
    if (recorder != nullptr) recorder->begin();
    controller.cycle();
    if (recorder != nullptr) recorder->end(controller);
    notify.alive();
    if (!controller.at_boundary()) continue;
    mailbox.serve();
    keeper.serve(controller.next_cycle_ns() - clock.now_ns());
    if (controller.faulted()) {
      clock.wait_until(clock.now_ns() + kFaultLookNs);
    } else {
      idle(controller, clock, mailbox, keeper, notify);
    }
  }
  if (!controller.at_boundary()) return;
  base::Status left = controller.leave_all(kExitLimitNs);
  if (!left.ok()) refuse(left.error());
}

// A clean end costs nothing of the retained values. In the middle of a scan there is no boundary:
// then the last one's are stored.
void end(vm::Controller& controller, online_change::Store& store, ControllerService& service) {
  if (controller.at_boundary()) {
    online_change::Snapshot last;
    service.keeper().take(last);
    base::Status saved = service.keeper().save(last);
    if (!saved.ok()) refuse(saved.error());
  }
  online_change::JournalEntry entry;
  entry.time_ns = wall_time_ns();
  entry.event = online_change::Event::kStopped;
  entry.who = "serve";
  entry.from = controller.verified().digest();
  store.note(std::move(entry));
}

void print_boot(const online_change::Boot& boot) {
  for (const std::string& alarm : boot.alarms) std::fprintf(stderr, "alarm: %s\n", alarm.c_str());
  if (!boot.trial_lost) return;
  std::fprintf(stderr, "the trial of %s was lost; %s runs\n",
               base::short_hex(*boot.trial_lost).c_str(),
               base::short_hex(boot.image.digest()).c_str());
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
  return out;
}

void print_ready(const vm::Controller& controller, const std::string& directory) {
  std::printf("ready: %s %s in %s\n", controller.image().name.c_str(),
              base::short_hex(controller.verified().digest()).c_str(), directory.c_str());
  std::fflush(stdout);
}

base::Status serve(const tools::Options& options) {
  std::string directory = state_directory(options);
  base::Result<vm::ControllerOptions> limits = limits_of(options);
  if (!limits.ok()) return limits.error();
  base::Result<vm::RealTimeOptions> real_time = real_time_options(options);
  if (!real_time.ok()) return real_time.error();
  StopSignal::install();
  base::Result<StateFolder> folder = StateFolder::open(directory);
  if (!folder.ok()) return folder.error();
  vm::FileStorage storage(directory);
  online_change::Store store(storage);
  base::Result<online_change::Boot> boot = boot_program(options, store);
  if (!boot.ok()) return boot.error();
  print_boot(*boot);
  vm::RealClock real_clock;
  vm::VirtualClock virtual_clock;
  vm::Clock* clock = &real_clock;
  if (options.has("--virtual-time")) clock = &virtual_clock;
  auto devices = device_options(options, clock == &virtual_clock ? clock : nullptr);
  if (!devices.ok()) return devices.error();
  vm::DeviceIo io(std::move(*devices));
  auto recorder = open_recorder(options, boot->image, boot->retained, *limits, *clock, io);
  if (!recorder.ok()) return recorder.error();
  auto controller =
      start_recorded(boot->image, *limits, *clock, io, boot->retained, recorder->get());
  if (!controller.ok()) return controller.error();
  vm::Mailbox mailbox;
  ControllerService service(**controller, *clock, store, mailbox, {boot->trial_lost, boot->alarms});
  if (*recorder) service.record(**recorder);
  auto server = vm::SocketServer::open(directory, service);
  if (!server.ok()) return server.error();
  service.keeper().start();
  // Behind all other threads, which stay as they are.
  base::Status fit = vm::make_real_time(*real_time);
  if (!fit.ok()) {
    mailbox.close();
    return fit;
  }
  if (real_time->lock_memory) vm::prefault(**controller);
  ServiceNotify notify;
  print_ready(**controller, directory);
  notify.ready(base::short_hex((*controller)->verified().digest()));
  control_loop(**controller, *clock, mailbox, service, recorder->get(), notify);
  notify.stopping();
  (*controller)->make_outputs_safe();
  mailbox.close();
  end(**controller, store, service);
  return *recorder ? (*recorder)->close() : base::Status(base::Ok{});
}

int run(const tools::Options& options) {
  base::Status served = serve(options);
  return served.ok() ? tools::kOk : refuse(served.error());
}

}  // namespace

const Entry kServe{&kCommand, run};

}  // namespace stvm
