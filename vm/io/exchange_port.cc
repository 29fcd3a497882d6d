#include "vm/io/exchange_port.h"

#include <algorithm>
#include <chrono>

#include "base/check.h"
#include "ir/types/time_units.h"
#include "vm/io/bit_copy.h"
#include "vm/runtime/thread_filter.h"

namespace vm {
namespace {

constexpr int64_t kNever = INT64_MIN;
constexpr int64_t kNsInMs = ir::kNsPerMillisecond;
constexpr int64_t kLongestRetryNs = 2000 * ir::kNsPerMillisecond;
constexpr int64_t kCloseSlackNs = 1000 * ir::kNsPerMillisecond;
constexpr size_t kMostWrites = 4096;  // from one boundary to the next

}  // namespace

ExchangeSet::ExchangeSet(DevicePoints what, LeftOutputs behind)
    : points(std::move(what)),
      left(std::move(behind)),
      inputs(points.input_bytes),
      outputs(points.output_bytes) {
  base::check(left.value.size() == points.output_bytes && left.held.size() == points.output_bytes,
              "values are left for other points");
  const auto writable = [](const PointRange& range) { return range.writable; };
  if (std::any_of(points.outputs.begin(), points.outputs.end(), writable)) {
    writes = std::make_unique<WriteQueue>(kMostWrites);
  }
}

// What port and thread share; the thread may outlive the port.
struct ExchangePort::Core final : OutsideEvents {
  Core(ir::Device d, std::unique_ptr<IoDriver> made, bool threaded, DeviceLog to)
      : device(std::move(d)),
        log(std::move(to)),
        own_thread(threaded),
        exclusive(ir::find_driver(device.driver)->exclusive),
        server(ir::find_driver(device.driver)->server),
        period_ns(ir::number_setting(device, "period_ms") * ir::kNsPerMillisecond),
        timeout_ns(ir::number_setting(device, "timeout_ms") * ir::kNsPerMillisecond),
        driver(std::move(made)) {}

  void run(bool confined);
  void round(int64_t now);
  base::Status leave_last(ExchangeSet* next, int64_t now);
  base::Status exchange(ExchangeSet& set, bool used, int64_t now);
  void note(const base::Status& status, int64_t now);
  void note_online(int64_t now);
  void note_error(const std::string& text);
  std::string with_age(const std::string& text) const;
  void written(const std::string& who, const std::string& what) override;
  void refused(const std::string& who, const std::string& what) override;
  void tell(DeviceEvent event, const std::string& text) const;
  int64_t pause_ns() const;

  const ir::Device device;
  const DeviceLog log;  // null: nobody wants to know
  const bool own_thread;
  const bool exclusive;
  const bool server;
  const int64_t period_ns;
  const int64_t timeout_ns;

  std::atomic<ExchangeSet*> used{nullptr};
  std::atomic<int64_t> received_ns{kNever};
  std::atomic<bool> failed{true};
  std::atomic<uint64_t> exchanges{0};
  std::atomic<uint64_t> errors{0};
  std::atomic<uint64_t> writes{0};

  // Never taken by the control thread.
  mutable std::mutex mutex;
  std::condition_variable wake;
  std::vector<std::shared_ptr<ExchangeSet>> sets;
  std::string error;
  int64_t error_ns = kNever;  // when it came
  std::string last_writer;
  bool stopping = false;
  bool ended = false;

  // The exchange's own.
  std::unique_ptr<IoDriver> driver;
  std::shared_ptr<ExchangeSet> last_used;
  uint32_t failures = 0;  // in turn
  std::string told;       // the error that was told last; "": it is online since
  int64_t told_ns = 0;    // since when it is lost
};

int64_t ExchangePort::now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

// What `points`, a part of the set's, become.
static base::Bytes values_left(ExchangeSet& set, const DevicePoints& points) {
  base::Bytes all(set.outputs.newest().begin(), set.outputs.newest().end());
  for (size_t i = 0; i < all.size(); ++i) {
    all[i] =
        static_cast<uint8_t>((all[i] & set.left.held[i]) | (set.left.value[i] & ~set.left.held[i]));
  }
  base::Bytes values(points.output_bytes);
  for (const PointRange& part : points.outputs) {
    for (const PointRange& range : set.points.outputs) {
      const bool inside = range.table == part.table && part.first >= range.first &&
                          part.first - range.first < range.count;
      if (!inside) continue;
      const uint32_t bit = (part.first - range.first) * (range.bits() / range.count);
      copy_bits(all, range.byte * 8 + bit, values, part.byte * 8, part.bits());
    }
  }
  return values;
}

// Where points are left for good. A server does not show them any more.
base::Status ExchangePort::Core::leave_last(ExchangeSet* next, int64_t now) {
  const DevicePoints points =
      outputs_without(last_used->points, next != nullptr ? &next->points : nullptr);
  if (!server && !points.outputs.empty() && last_used->has_outputs) {
    base::Status done =
        driver->exchange({points, values_left(*last_used, points), {}, now, nullptr, this});
    if (!done.ok()) return done;
  }
  last_used.reset();
  if (next == nullptr && exclusive) driver->disconnect();
  return base::Ok{};
}

base::Status ExchangePort::Core::exchange(ExchangeSet& set, bool is_used, int64_t now) {
  if (is_used && set.outputs.take()) set.has_outputs = true;
  const base::ByteSpan outputs =
      is_used && set.has_outputs ? base::ByteSpan(set.outputs.newest()) : base::ByteSpan();
  base::Status done =
      driver->exchange({set.points, outputs, set.inputs.work(), now, set.writes.get(), this});
  if (done.ok()) set.inputs.publish();
  return done;
}

void ExchangePort::Core::round(int64_t now) {
  std::vector<std::shared_ptr<ExchangeSet>> current;
  {
    std::lock_guard lock(mutex);
    current = sets;
  }
  ExchangeSet* const wanted = used.load(std::memory_order_acquire);
  const auto is_wanted = [&](const auto& set) { return set.get() == wanted; };
  const auto in_use = std::find_if(current.begin(), current.end(), is_wanted);
  if (wanted != nullptr && in_use == current.end()) return;  // added a moment ago: next time
  if (last_used && last_used.get() != wanted) {
    base::Status left = leave_last(wanted, now);
    if (!left.ok()) return note(left, now);
  }
  if (current.empty() || (wanted == nullptr && exclusive)) return;
  base::Status result = base::Ok{};
  for (const std::shared_ptr<ExchangeSet>& set : current) {
    const bool is_used = set.get() == wanted;
    if (!is_used && exclusive) continue;
    base::Status done = exchange(*set, is_used, now);
    if (is_used) last_used = set;
    // A version that does not run may ask for what the device does not have.
    if (is_used || wanted == nullptr) result = std::move(done);
    if (!result.ok()) break;
  }
  note(result, now);
}

void ExchangePort::Core::note(const base::Status& status, int64_t now) {
  if (status.ok()) {
    exchanges.fetch_add(1, std::memory_order_relaxed);
    received_ns.store(own_thread ? ExchangePort::now_ns() : now, std::memory_order_release);
    failed.store(false, std::memory_order_release);
    failures = 0;
    return note_online(ExchangePort::now_ns());
  }
  note_error(status.error().text);
}

void ExchangePort::Core::note_online(int64_t now) {
  if (told.empty()) return;
  told.clear();
  tell(DeviceEvent::kBack, "online after " + std::to_string((now - told_ns) / kNsInMs) + " ms");
}

// A server that nobody has asked yet is none that fails.
void ExchangePort::Core::note_error(const std::string& text) {
  const bool was_good = !failed.exchange(true, std::memory_order_acq_rel);
  const bool idle = driver->idle();
  if (!idle) {
    errors.fetch_add(1, std::memory_order_relaxed);
    failures = std::min<uint32_t>(failures + 1, 30);
  }
  const int64_t now = ExchangePort::now_ns();
  if ((was_good || !idle) && text != told) {
    if (told.empty()) told_ns = now;
    told = text;
    tell(DeviceEvent::kLost, with_age(text));
  }
  std::lock_guard lock(mutex);
  error = text;
  error_ns = now;
}

// What is used of it until it is back, or its policy for losses says something else.
std::string ExchangePort::Core::with_age(const std::string& text) const {
  const int64_t received = received_ns.load(std::memory_order_relaxed);
  if (received == kNever || !own_thread) return text;
  const int64_t age_ns = ExchangePort::now_ns() - received;
  return text + "; its newest inputs are " + std::to_string(age_ns / kNsInMs) + " ms old";
}

void ExchangePort::Core::written(const std::string& who, const std::string& what) {
  writes.fetch_add(1, std::memory_order_relaxed);
  tell(DeviceEvent::kWritten, who + " wrote " + what);
  std::lock_guard lock(mutex);
  last_writer = who;
}

void ExchangePort::Core::refused(const std::string& who, const std::string& what) {
  tell(DeviceEvent::kRefused, who + " was not permitted to write " + what);
}

// In virtual time the control thread exchanges, and has nothing to do with who listens.
void ExchangePort::Core::tell(DeviceEvent event, const std::string& text) const {
  if (log && own_thread) log(event, device.name, text);
}

// Longer and longer while nobody answers.
int64_t ExchangePort::Core::pause_ns() const {
  if (failures < 2 || server) return period_ns;  // a server waits for others
  const int64_t longest = std::max(period_ns, kLongestRetryNs);
  return std::min(period_ns << std::min<uint32_t>(failures - 1, 20), longest);
}

// Without the filter that it should have, nothing is exchanged.
void ExchangePort::Core::run(bool confined) {
  const int64_t begin = ExchangePort::now_ns();
  const base::Status fit =
      confined ? confine_thread(ThreadKind::kDevice) : base::Status(base::Ok{});
  if (!fit.ok()) note_error(fit.error().text);
  for (bool last = !fit.ok(); !last;) {
    {
      std::lock_guard lock(mutex);
      last = stopping;
    }
    const int64_t started = ExchangePort::now_ns();
    round(started - begin);
    if (last) break;
    const int64_t rest = started + pause_ns() - ExchangePort::now_ns();
    std::unique_lock lock(mutex);
    wake.wait_for(lock, std::chrono::nanoseconds(std::max<int64_t>(rest, 0)),
                  [this] { return stopping; });
  }
  driver.reset();
  std::lock_guard lock(mutex);
  ended = true;
  wake.notify_all();
}

ExchangePort::ExchangePort(ir::Device device, std::unique_ptr<IoDriver> driver, bool own_thread,
                           DeviceLog log, bool confined)
    : core_(std::make_shared<Core>(std::move(device), std::move(driver), own_thread,
                                   std::move(log))) {
  if (own_thread) {
    thread_ = std::thread([core = core_, confined] { core->run(confined); });
  }
}

ExchangePort::~ExchangePort() {
  if (!thread_.joinable()) return;
  std::unique_lock lock(core_->mutex);
  core_->stopping = true;
  core_->wake.notify_all();
  const bool ended =
      core_->wake.wait_for(lock, std::chrono::nanoseconds(core_->timeout_ns + kCloseSlackNs),
                           [this] { return core_->ended; });
  lock.unlock();
  if (ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

const ir::Device& ExchangePort::device() const { return core_->device; }

std::shared_ptr<ExchangeSet> ExchangePort::add(DevicePoints points, LeftOutputs left) {
  auto set = std::make_shared<ExchangeSet>(std::move(points), std::move(left));
  std::lock_guard lock(core_->mutex);
  core_->sets.push_back(set);
  return set;
}

void ExchangePort::drop(const std::shared_ptr<ExchangeSet>& set) {
  std::lock_guard lock(core_->mutex);
  std::erase(core_->sets, set);
}

DeviceStatus ExchangePort::status() const {
  DeviceStatus out;
  out.name = core_->device.name;
  out.driver = core_->device.driver;
  out.exchanges = core_->exchanges.load(std::memory_order_relaxed);
  out.errors = core_->errors.load(std::memory_order_relaxed);
  const int64_t received = received_ns();
  const bool threaded = thread_.joinable();
  if (received != kNever) out.age_ns = threaded ? now_ns() - received : 0;
  const bool good = threaded ? fresh(now_ns()) : !core_->failed.load(std::memory_order_acquire);
  out.state = good ? "online" : out.errors == 0 && received == kNever ? "waiting" : "lost";
  std::lock_guard lock(core_->mutex);
  out.error = core_->error;
  if (threaded && core_->error_ns != kNever) out.error_age_ns = now_ns() - core_->error_ns;
  out.writes = core_->writes.load(std::memory_order_relaxed);
  out.last_writer = core_->last_writer;
  return out;
}

void ExchangePort::use(ExchangeSet* set) { core_->used.store(set, std::memory_order_release); }

int64_t ExchangePort::received_ns() const {
  return core_->received_ns.load(std::memory_order_acquire);
}

bool ExchangePort::fresh(int64_t now) const {
  if (core_->failed.load(std::memory_order_acquire)) return false;
  const int64_t received = received_ns();
  return received != kNever && now - received <= core_->period_ns + core_->timeout_ns;
}

bool ExchangePort::failed() const { return core_->failed.load(std::memory_order_acquire); }

void ExchangePort::exchange_now(int64_t now) { core_->round(now); }

}  // namespace vm
