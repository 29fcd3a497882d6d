// What is to be told of what happens in the plant, and a device that is lost.
#include <condition_variable>
#include <mutex>

#include "tests/sim/world.h"
#include "vm/io/exchange_port.h"

namespace sim {
namespace {

// A device that does what it is told, exchange by exchange, and then answers.
class ScriptedDriver : public vm::IoDriver {
 public:
  explicit ScriptedDriver(std::vector<std::string> errors) : errors_(std::move(errors)) {}

  base::Status exchange(const vm::Exchange&) override {
    const std::lock_guard lock(mutex_);
    if (next_ == errors_.size()) {
      answered_ = true;  // behind the last one, so that has been told
      done_.notify_all();
      return base::Ok{};
    }
    const std::string& error = errors_[next_++];
    if (error.empty()) return base::Ok{};
    return vm::exchange_failed(error);
  }
  void wait_for_end() {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return answered_; });
  }

 private:
  const std::vector<std::string> errors_;
  std::mutex mutex_;
  std::condition_variable done_;
  size_t next_ = 0;
  bool answered_ = false;
};

}  // namespace

// By the thread that a device has; what it does is the same every time, whenever it does it.
void World::device_fault() {
  ir::Device device;
  device.name = "press" + std::to_string(random_.below(3));
  device.driver = ir::driver_rows().front().name;
  device.settings = {{"period_ms", "1"}};
  say("a device is lost: " + device.name);
  const std::string source = "device " + device.name;
  std::vector<std::string> errors{""};
  const uint32_t losses = 1 + random_.below(8);
  for (uint32_t loss = 0; loss < losses; ++loss) {
    for (const char* why : {"no answer", "connection refused"}) {
      errors.insert(errors.end(), 1 + random_.below(2), why);
      events_->happened(Event::kDeviceLost, source);
      if (random_.one_in(2)) break;
    }
    errors.push_back("");
    events_->happened(Event::kDeviceBack, source);
  }
  auto made = std::make_unique<ScriptedDriver>(std::move(errors));
  ScriptedDriver& driver = *made;
  vm::ExchangePort port(device, std::move(made), true, events_->device_log());
  const auto set = port.add({}, {});
  port.use(set.get());
  driver.wait_for_end();
  ++tally_.faults;
}

// A trap in its first cycles, and the controller has undone it by itself (X7).
bool World::given_back() {
  const auto journal = connect().client->journal();
  if (!journal.ok()) return false;
  for (auto entry = journal->rbegin(); entry != journal->rend(); ++entry) {
    if (entry->event == online_change::Event::kSwitched) return false;
    if (entry->event == online_change::Event::kUndone) return entry->who == "controller";
  }
  return false;
}

void World::check_events() {
  events_->check(*controller_, service_->keeper().unsaved().has_value());
}

void World::told_refused(const Hand& hand, const base::Status& done) {
  if (done.ok()) return;
  const base::Error& error = done.error();
  // A request that names another version than the one that runs is no change.
  const bool is_none = error.text.rfind("the request is for version", 0) == 0;
  if (hand.way->lost() || hand.way->armed() || is_none) return;
  events_->happened(Event::kRefused, {}, base::to_string(error));
}

// Once each: that it runs, or that the trial goes on, and what has become of a trial.
void World::expect_start(const online_change::Boot& boot) {
  events_->happened(Event::kStarted);
  if (!boot.edits.empty()) events_->happened(Event::kResumed);
  if (boot.trial_lost) events_->happened(Event::kTrialLost);
  for (const std::string& alarm : boot.alarms) events_->happened(Event::kAlarm, {}, alarm);
}

}  // namespace sim
