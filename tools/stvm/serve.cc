// stvm serve: a controller with state directory and control channel.
#include <algorithm>
#include <cstdio>

#include "tools/common/exit.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/compiler.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/state_folder.h"
#include "tools/stvm/stop_signal.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/file_storage.h"
#include "vm/runtime/io.h"
#include "vm/runtime/mailbox.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kOptions[] = {
    STVM_DIR_OPTION,
    {"--data-limit", "BYTES", "of all data areas of a change together (default: no limit)"},
    {"--virtual-time", nullptr, "cycles as fast as they can run, instead of real time"},
    STVM_DIALECT_OPTION,
};
constexpr tools::Command kCommand{
    "serve", "[IMAGE|SOURCES...]",
    "Runs a controller that can be watched and changed. Without IMAGE: the one stored last.",
    kOptions};

// Commands are answered between cycles too, so a long period does not make them slow.
constexpr int64_t kLookNs = 2'000'000;
constexpr int64_t kFaultLookNs = 10'000'000;

base::Result<ir::VerifiedImage> verify_stored(base::ByteSpan bytes, const tools::Options& options) {
  base::Result<ir::VerifiedImage> image = ir::verify(bytes);
  if (image.ok()) return image;
  return base::Error{image.error().refusal, "the program stored in " + state_directory(options) +
                                                " cannot be used: " + image.error().text};
}

base::Result<ir::VerifiedImage> boot_image(const tools::Options& options, vm::Storage& storage) {
  if (options.arguments().empty()) {
    base::Result<base::Bytes> stored = storage.read(kBootRecord);
    if (stored.ok()) return verify_stored(*stored, options);
    if (stored.error().refusal != base::Refusal::kFileNotFound) return stored.error();
    return base::Error{
        base::Refusal::kFileNotFound,
        state_directory(options) + " holds no program yet; name an image or sources"};
  }
  base::Result<ir::VerifiedImage> image = load_program(sources_of(options));
  if (!image.ok()) return image;
  base::Status stored = storage.write(kBootRecord, image->encoded());
  if (!stored.ok()) return stored.error();
  return image;
}

// Until the next cycle begins; what remains at the end is left to the clock's exact wait.
void idle(vm::Controller& controller, vm::Clock& clock, vm::Mailbox& mailbox) {
  while (!StopSignal::received()) {
    int64_t now = clock.now_ns();
    if (controller.next_cycle_ns() - now <= kLookNs) return;
    clock.wait_until(std::min(now + kLookNs, controller.next_cycle_ns() - kLookNs));
    mailbox.serve();
  }
}

void control_loop(vm::Controller& controller, vm::Clock& clock, vm::Mailbox& mailbox,
                  const ControllerService& service) {
  while (!StopSignal::received() && !service.stop_wanted()) {
    controller.cycle();
    if (!controller.at_boundary()) continue;
    mailbox.serve();
    if (controller.faulted()) {
      clock.wait_until(clock.now_ns() + kFaultLookNs);
    } else {
      idle(controller, clock, mailbox);
    }
  }
  if (!controller.at_boundary()) return;
  base::Status left = controller.leave_all(kExitLimitNs);
  if (!left.ok()) refuse(left.error());
}

void print_ready(const vm::Controller& controller, const std::string& directory) {
  std::printf("ready: %s %s in %s\n", controller.image().name.c_str(),
              base::short_hex(controller.verified().digest()).c_str(), directory.c_str());
  std::fflush(stdout);
}

base::Status serve(const tools::Options& options) {
  std::string directory = state_directory(options);
  StopSignal::install();
  base::Result<StateFolder> folder = StateFolder::open(directory);
  if (!folder.ok()) return folder.error();
  vm::FileStorage storage(directory);
  base::Result<ir::VerifiedImage> image = boot_image(options, storage);
  if (!image.ok()) return image.error();
  vm::RealClock real_clock;
  vm::VirtualClock virtual_clock;
  vm::Clock* clock = &real_clock;
  if (options.has("--virtual-time")) clock = &virtual_clock;
  vm::NullIo io;
  vm::ControllerOptions limits;
  base::Result<uint64_t> data_limit = options.number("--data-limit", 0);
  if (!data_limit.ok()) return data_limit.error();
  limits.data_limit = *data_limit;
  auto controller = vm::Controller::start(*image, limits, *clock, io);
  if (!controller.ok()) return controller.error();
  vm::Mailbox mailbox;
  ControllerService service(**controller, *clock, storage, mailbox);
  auto server = vm::SocketServer::open(directory, service);
  if (!server.ok()) return server.error();
  print_ready(**controller, directory);
  control_loop(**controller, *clock, mailbox, service);
  mailbox.close();
  return base::Ok{};
}

int run(const tools::Options& options) {
  base::Status served = serve(options);
  return served.ok() ? tools::kOk : refuse(served.error());
}

}  // namespace

const Entry kServe{&kCommand, run};

}  // namespace stvm
