#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ir/bytecode/symbols.h"
#include "tests/fuzz/answered.h"
#include "tests/fuzz/consumers.h"
#include "tools/stvm/condition_parse.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/fate_view.h"
#include "tools/stvm/player.h"
#include "tools/stvm/units.h"
#include "vm/io/device_io.h"
#include "vm/io/simulated_driver.h"

namespace fuzz {
namespace {

using namespace online_change;

constexpr int kScans = 4;
constexpr uint64_t kFuel = 2000;

// A file in memory; the recorder closes it.
struct Written {
  char* bytes = nullptr;
  size_t size = 0;
  std::FILE* file = ::open_memstream(&bytes, &size);
  ~Written() { std::free(bytes); }
};

// A controller as `stvm serve` makes it, on a storage in memory and with simulated devices.
class Site : public vm::Boundary {
 public:
  Site(stvm::MemoryStorage& storage, const std::optional<ir::VerifiedImage>& given)
      : store_(storage, {4096, 64, 64, 8}) {
    auto booted = boot(store_, given, "fuzz", 1);
    if (!answered(booted)) return;
    boot_ = std::move(*booted);
    vm::ControllerOptions options;
    options.fuel_budget = kFuel;
    options.tier.tier = vm::Tier::kInterpreter;
    record(options);
    recorder_->begin();
    auto started =
        vm::Controller::start(boot_->image, options, *recorder_, *recorder_, boot_->retained);
    if (!answered(started)) return;
    controller_ = *std::move(started);
    recorder_->end(*controller_);
    service_.emplace(*controller_, clock_, store_, *this,
                     stvm::StartReport{boot_->trial_lost, boot_->alarms, boot_->fault},
                     [] { return int64_t{2}; });
    service_->record(*recorder_);
    service_->asked_by("fuzz", 1);
    service_->resume(boot_->edits);
  }

  bool runs() const { return service_.has_value(); }
  vm::Controller& controller() { return *controller_; }
  stvm::ControllerService& service() { return *service_; }
  void run(int scans) {
    for (int i = 0; i < scans; ++i) pause(0);
    service_->keep_up();
  }
  // What is on trial boots at the next start.
  void stop() {
    Snapshot snapshot;
    service_->keeper().take(snapshot);
    answered(service_->keeper().save(snapshot));
    service_->keep_trial_over_stop();
  }
  vm::Recording recorded() {
    answered(recorder_->close());
    auto recording = vm::decode_recording(base::as_bytes({written_.bytes, written_.size}));
    base::check(recording.ok() && !recording->cut_off, "a recording can be read");
    return *std::move(recording);
  }

 private:
  void record(const vm::ControllerOptions& options) {
    vm::RecordedStart start;
    start.image = boot_->image.encoded();
    start.retained = boot_->retained;
    start.fuel_slice = options.fuel_slice;
    start.fuel_budget = options.fuel_budget;
    start.code_limit = options.code_limit;
    start.data_limit = options.data_limit;
    start.on_trap = options.on_trap;
    start.trial = encode_trial(boot_->edits);
    const base::Bytes bytes = vm::encode_record(start);
    std::fwrite(bytes.data(), 1, bytes.size(), written_.file);
    recorder_.emplace(written_.file, clock_, devices_);
  }

  // A boundary is an instant at which no scan is in between.
  Outcome run(const std::function<void()>& job, int64_t) override {
    for (int i = 0; i < 100 && !controller_->at_boundary(); ++i) pause(0);
    if (!controller_->at_boundary()) return Outcome::kTimeout;
    job();
    return Outcome::kDone;
  }
  void pause(int64_t) override {
    recorder_->begin();
    controller_->cycle();
    recorder_->end(*controller_);
  }

  Written written_;
  vm::VirtualClock clock_;
  vm::DeviceIo devices_{{vm::make_simulated_driver, {}, &clock_}};
  Store store_;
  std::optional<Boot> boot_;
  std::optional<vm::Recorder> recorder_;
  std::unique_ptr<vm::Controller> controller_;
  std::optional<stvm::ControllerService> service_;
};

class Asking : public vm::Transport {
 public:
  explicit Asking(stvm::ControllerService& service) : service_(service) {}
  base::Result<base::Bytes> exchange(base::ByteSpan request) override {
    bool keep_open = true;
    return service_.answer(request, keep_open);
  }

 private:
  stvm::ControllerService& service_;
};

stvm::ControllerClient client_of(Site& site) {
  return stvm::ControllerClient(std::make_unique<Asking>(site.service()));
}

std::vector<std::string> some_names(const ir::Image& image) {
  std::vector<std::string> names;
  uint32_t number = 0;
  ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol&) {
    if (number++ % 3 == 0 && names.size() < 12) names.push_back(path);
  });
  return names;
}

// All that tools show of a controller.
void ask_all(Site& site) {
  stvm::ControllerClient client = client_of(site);
  const ir::Image& image = site.controller().image();
  const auto status = client.status();
  const auto facts = client.facts();
  const auto units = client.units();
  base::check(answered(status) && answered(facts), "it says what it is");
  if (answered(units)) {
    const auto views = stvm::unit_views(*units, image, {}, {"*"});
    stvm::units_text(views);
    stvm::units_json(views, *facts, *status);
  }
  std::vector<std::string> names = some_names(image);
  for (int i = 0; i < 2; ++i) answered(client.get(names));  // looked up, and remembered
  const auto all = client.list("*");
  base::check(answered(all), "its variables");
  for (const auto& task : status->tasks) answered(client.task_times(task.name));
  answered(client.forces());
  answered(client.journal());
  answered(client.edits());
  answered(client.image());
}

void show_fates(stvm::ControllerClient& client) {
  if (const auto page = client.fates(); answered(page)) {
    base::check(!stvm::fates_text(*page).empty(), "a report");
    tools::JsonWriter json;
    json.begin_object();
    stvm::fates_json(*page, json);
    json.end_object();
  }
  if (const auto lines = client.every_fate(); answered(lines)) tools::every_fate_text(*lines);
}

// Conditions over variables of that version; not one of them stays TRUE with `fails`.
stvm::GuardOrder watch_over(const ir::Image& image, bool fails) {
  stvm::GuardOrder order;
  order.note = "plan of fuzz";
  order.deadline_ns = int64_t{3600} * 1'000'000'000;
  order.devices = order.alarms = true;
  order.window_ns = fails ? 1 : 0;
  for (const std::string& name : some_names(image)) {
    const auto variable = stvm::condition_variable(image, name);
    if (!answered(variable) || order.conditions.size() == stvm::kMostConditions) continue;
    const bool is_bool = stvm::condition_type(*variable) == stvm::ConditionType::kBool;
    const std::string same = name + " = baseline(" + name + ")";
    const std::string any = is_bool ? name + " OR NOT " + name : same + " OR " + name + " >= 0";
    size_t at = 0;
    answered(stvm::add_condition(fails ? "NOT (" + same + ")" : any, order, at));
  }
  return order;
}

constexpr uint32_t kSwitchAnyway = vm::kAllowLoss | vm::kAllowOverrun;

struct Change {
  base::Bytes there;
  base::Bytes back;
  uint32_t strategy = 0;  // flags of staging
};

enum class Conditions : uint8_t { kNone, kHold, kFail };

void watch(Site& site, stvm::ControllerClient& client, const Change& change,
           Conditions conditions) {
  const auto package = decode(change.there, site.controller().verified().encoded());
  const auto next = ir::verify(package->image);
  vm::Request guard{.command = vm::Command::kGuard};
  guard.data = encode(watch_over(next->image(), conditions == Conditions::kFail));
  answered(client.call(guard));
}

// A dry run, from a connection of its own, then the change itself. False: it is refused.
bool bring(Site& site, const Change& change, Conditions conditions, uint32_t flags) {
  stvm::ControllerClient client = client_of(site);
  answered(client.status());
  const uint32_t dry = change.strategy | vm::kRehearsal;
  answered(client.stage(change.there, dry | vm::kTableAdditions));
  if (answered(client.stage(change.there, dry))) show_fates(client);
  if (!answered(client.stage(change.there, change.strategy))) return false;
  show_fates(client);
  if (conditions != Conditions::kNone) watch(site, client, change, conditions);
  answered(client.call(vm::Request{.command = vm::Command::kRehearse, .flags = flags}));
  site.run(1);
  const auto made = client.make_switch(flags);
  site.run(kScans);
  return answered(made);
}

void undo_and_redo(Site& site) {
  stvm::ControllerClient client = client_of(site);
  answered(client.status());
  show_fates(client);  // of the way back
  if (!answered(client.undo())) return;
  site.run(kScans);
  answered(client.status());  // what runs now
  const auto edits = client.edits();
  if (!answered(edits) || edits->empty()) return;
  if (!answered(client.stage_again(edits->back().name))) return;
  if (!answered(client.make_switch(kSwitchAnyway))) return;
  site.run(kScans);
  answered(client.status());
  answered(client.call(vm::Request{.command = vm::Command::kAccept}));
  answered(client.image_before());
}

void take_out(Site& site, const Change& change) {
  stvm::ControllerClient client = client_of(site);
  answered(client.status());
  const auto edits = client.edits();
  if (!answered(edits) || edits->empty()) return;
  const std::string name = edits->back().name;
  answered(client.image_before(name));
  if (!answered(client.stage(change.back, change.strategy, {}, "taken out", name))) return;
  show_fates(client);
  if (!answered(client.make_switch(kSwitchAnyway))) return;
  site.run(kScans);
  answered(client.status());
  if (answered(client.undo())) answered(client.status());
  answered(client.call(vm::Request{.command = vm::Command::kAccept}));
}

void play(Site& site) {
  stvm::Player player(site.recorded());
  base::Status same = player.start();
  while (same.ok() && !player.at_end()) same = player.cycle();
  base::check(same.ok(), "a run is played again as it was");
}

}  // namespace

void serve_images(const ir::VerifiedImage& from, const ir::VerifiedImage& to, Strategy strategy,
                  uint8_t serving) {
  if (!can_run(from) || !can_run(to)) return;
  const auto there = make_package(from.encoded(), to.encoded());
  const auto back = make_package(to.encoded(), from.encoded());
  if (!answered(there) || !answered(back)) return;
  const Change change{encode(*there), encode(*back),
                      strategy == Strategy::kStandby ? uint32_t{vm::kByStandby} : 0};
  stvm::MemoryStorage storage;
  Site site(storage, from);
  if (!site.runs()) return;
  site.run(kScans);
  ask_all(site);
  const uint32_t flags = kSwitchAnyway | (serving == 2 ? uint32_t{vm::kLastEditBoots} : 0);
  constexpr Conditions kConditions[kServings] = {Conditions::kHold, Conditions::kNone,
                                                 Conditions::kNone, Conditions::kFail};
  const bool made = bring(site, change, kConditions[serving], flags);
  if (made && serving == 0) undo_and_redo(site);
  if (made && serving == 1) take_out(site, change);
  site.run(kScans);
  ask_all(site);
  if (serving == 2) site.stop();
  play(site);
  if (serving != 2) return;
  Site next(storage, std::nullopt);
  if (!next.runs()) return;
  next.run(kScans);
  ask_all(next);
  undo_and_redo(next);
  play(next);
}

}  // namespace fuzz
