#include "tools/stvm/served_resource.h"

#include <algorithm>
#include <filesystem>

#include "base/sha256.h"
#include "tools/common/files.h"
#include "tools/common/version.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/event_text.h"
#include "tools/stvm/key_trust.h"
#include "tools/stvm/record.h"

namespace stvm {
namespace {

using online_change::Event;

// So long before a cycle nothing else is begun: a command that comes then is answered after it.
constexpr int64_t kQuietNs = 2'000'000;
// Commands are answered between cycles too, at once. What the keeper wants and signals are looked
// for in each cycle, and when so much time has gone.
constexpr int64_t kLookNs = 100'000'000;
constexpr int64_t kFaultLookNs = 10'000'000;
constexpr const char* kWho = "serve";  // starts it, for the journal and the table of units

constexpr const char* kWayOut =
    "; name an image or sources for it, or --create: its first program then comes by `stvm change`";

base::Error empty(const std::string& directory) {
  return {base::Refusal::kFileNotFound, directory + " holds no program yet" + kWayOut};
}

}  // namespace

ServedResource::ServedResource(const std::string& directory, const std::string& name,
                               StateFolder folder, const std::shared_ptr<LogOutput>& output)
    : directory_(directory),
      name_(name),
      folder_(std::move(folder)),
      storage_(folder_.path(), folder_.descriptor()),
      store_(storage_),
      events_(std::make_shared<EventLog>(store_, name, output)) {}

ServedResource::~ServedResource() {
  events_->close();
  if (begun_ || !folder_.is_new()) return;
  server_.reset();  // its socket lies there
  std::error_code stays;
  std::filesystem::remove_all(folder_.path(), stays);
}

void ServedResource::note(online_change::Event event, std::string text) {
  online_change::JournalEntry entry;
  entry.time_ns = wall_time_ns();
  entry.event = event;
  entry.who = kWho;
  entry.text = std::move(text);
  store_.note(std::move(entry));
}

// What boots is not asked about: it is in the state folder, which is trusted, and so the same
// command line starts the controller again, whatever has expired.
base::Result<std::string> ServedResource::admit(const std::optional<ir::VerifiedImage>& given,
                                                const StartTrust& trust) {
  if (trust.path.empty()) return std::string();
  auto made = make_trust(trust.path, store_);
  if (!made.ok()) return made.error();
  trust_ = std::move(*made);
  if (!given || store_.boots() == given->digest()) return std::string();
  const auto found = trust.images.find(base::sha256(given->encoded()));
  if (found == trust.images.end()) {
    const base::Error unsigned_image{base::Refusal::kUnsigned,
                                     "nobody has signed the image that it is to start with"};
    note(Event::kRefused, base::to_string(unsigned_image));
    return unsigned_image;
  }
  const int64_t now_s = wall_time_ns() / 1'000'000'000;
  base::Result<Signed> signer =
      trust_->check(found->second, online_change::SignedKind::kImage, now_s);
  base::Status taken = signer.ok() ? trust_->take(*signer, now_s) : base::Status(signer.error());
  if (taken.ok()) return signer_text(*signer);
  note(Event::kRefused, base::to_string(taken.error()));
  return taken.error();
}

base::Result<std::unique_ptr<ServedResource>> ServedResource::open(
    const std::string& directory, const std::string& name,
    const std::optional<ir::VerifiedImage>& given, bool create,
    const std::shared_ptr<LogOutput>& output, const StartTrust& trust) {
  const bool may_make = given || create;
  const bool unused = tools::is_folder(directory) && !holds_program(directory);
  if (unused && !may_make) return empty(directory);
  base::Result<StateFolder> folder = StateFolder::open(directory, may_make);
  if (!folder.ok() && folder.error().refusal == base::Refusal::kFileNotFound) {
    return base::Error{base::Refusal::kFileNotFound, folder.error().text + kWayOut};
  }
  if (!folder.ok()) return folder.error();
  const bool is_new = folder->is_new();
  auto out = std::make_unique<ServedResource>(directory, name, std::move(*folder), output);
  if (is_new) out->note(Event::kNewFolder, "new state folder: " + out->folder_.path());
  const base::Result<std::string> signer = out->admit(given, trust);
  if (!signer.ok()) return signer.error();
  auto boot = online_change::choose_boot(out->store_, given, kWho, wall_time_ns(), create);
  // Behind the choice: a folder whose journal has a row is not new.
  if (!signer->empty()) out->note(Event::kStaged, *signer);
  if (!boot.ok() && boot.error().refusal == base::Refusal::kFileNotFound) return empty(directory);
  if (!boot.ok()) {
    return base::Error{boot.error().refusal, directory + ": " + boot.error().text};
  }
  out->boot_ = std::move(*boot);
  return out;
}

base::Status ServedResource::start(const ResourceController::Settings& settings, vm::Clock& clock,
                                   const vm::RealClock* real_clock) {
  clock_ = &clock;
  real_clock_ = real_clock;
  ResourceController::Settings own = settings;
  own.limits.halted = !boot_->fault.empty();
  own.limits.events = &events_->ring();
  own.trial = online_change::encode_trial(boot_->edits);
  own.log = [weak = std::weak_ptr<EventLog>(events_)](
                vm::DeviceEvent event, const std::string& device, const std::string& text) {
    if (const auto log = weak.lock()) log->take_device(event, device, text);
  };
  if (!own.limits.halted) keep_last_recording(own.options, name_);
  auto running = ResourceController::start(own, clock, boot_->retained);
  if (!running.ok()) return running.error();
  running_ = std::move(*running);
  service_ = std::make_unique<ControllerService>(
      controller(), clock, store_, mailbox_,
      StartReport{boot_->trial_lost, {}, boot_->fault, kWho, trust_.get()});
  service_->is_version(tools::kVersion);
  service_->store_beside();
  service_->show_events(*events_);
  events_->watch(running_->recorder());
  if (running_->recorder() != nullptr) service_->record(*running_->recorder());
  auto server = vm::SocketServer::open(folder_.path(), *service_);
  if (!server.ok()) return server.error();
  server_ = std::move(*server);
  service_->keeper().start();
  events_->start();
  return base::Ok{};
}

base::Status ServedResource::begin() {
  begun_ = true;
  base::Status stored = online_change::carry_out(store_, *boot_);
  if (!stored.ok()) {
    return base::Error{stored.error().refusal, directory_ + ": " + stored.error().text};
  }
  service_->resume(boot_->edits, boot_->alarms);
  return base::Ok{};
}

base::Status ServedResource::make_real_time(const vm::RealTimeOptions& options) {
  base::Status fit = vm::make_real_time(options);
  if (fit.ok() && options.lock_memory) vm::prefault(controller());
  return fit;
}

// Until the next cycle begins, or shortly before: the rest is the clock's wait. One sleep for a
// cycle, when nothing comes.
void ServedResource::idle(const std::function<bool()>& stop, const std::function<void()>& alive) {
  while (!stop() && !service_->stop_wanted()) {
    alive();
    const int64_t now = clock_->now_ns();
    const int64_t next = controller().next_cycle_ns();
    if (next - now <= kQuietNs) return;
    mailbox_.wait_until(*real_clock_, std::min(now + kLookNs, next));
    if (next - clock_->now_ns() <= kQuietNs) return;
    mailbox_.serve();
    service_->keeper().serve(controller().next_cycle_ns() - clock_->now_ns());
  }
}

void ServedResource::run(const std::function<bool()>& stop, const std::function<void()>& alive) {
  while (!stop() && !service_->stop_wanted()) {
    running_->cycle();
    alive();
    if (!controller().at_boundary()) continue;
    mailbox_.serve();
    service_->keeper().serve(controller().next_cycle_ns() - clock_->now_ns());
    if (controller().faulted()) {
      mailbox_.wait(kFaultLookNs);
    } else if (real_clock_ != nullptr) {  // virtual time only goes on when cycles do
      idle(stop, alive);
    }
  }
  base::Status left = base::Ok{};
  if (controller().at_boundary()) left = controller().leave_all(kExitLimitNs);
  controller().make_outputs_safe();
  mailbox_.close();
  if (!left.ok()) note(Event::kAlarm, base::to_string(left.error()));
}

// A clean end costs nothing of the retained values. In the middle of a scan there is no boundary:
// then the last one's are stored.
base::Status ServedResource::end() {
  if (controller().at_boundary() && store_.names(controller().verified().digest())) {
    online_change::Snapshot last;
    service_->keeper().take(last);
    base::Status saved = service_->keeper().save(last);
    if (!saved.ok()) note(Event::kAlarm, "not saved at the end: " + base::to_string(saved.error()));
  }
  service_->keep_trial_over_stop();
  if (!controller().forces().empty()) {
    note(Event::kUnforced, "with the end of the controller: " + list_text(controller().forces()));
  }
  online_change::JournalEntry entry;
  entry.time_ns = wall_time_ns();
  entry.event = Event::kStopped;
  entry.who = service_->stop_wanted() ? service_->stopped_by() : kWho;
  entry.from = controller().verified().digest();
  events_->look();
  store_.note(std::move(entry));
  events_->close();
  return running_->close();
}

void ServedResource::give_up() { mailbox_.close(); }

}  // namespace stvm
