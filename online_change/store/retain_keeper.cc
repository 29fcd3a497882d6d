#include "online_change/store/retain_keeper.h"

#include <algorithm>
#include <chrono>

#include "online_change/store/retained_values.h"

namespace online_change {
namespace {

// Together well below the second that a power cut may cost, the disk's time included.
constexpr int64_t kPeriodNs = 400'000'000;
constexpr int64_t kPatienceNs = 200'000'000;  // then any boundary will do
constexpr int64_t kPollNs = 1'000'000;
// What fails is tried again after the first of these, and then less and less often.
constexpr int64_t kAgainNs = kPeriodNs;
constexpr int64_t kLongestNs = 8 * kPeriodNs;
constexpr int64_t kCopyNs = 1'000;  // and one for every kCopyBytesPerNs bytes
constexpr int64_t kCopyBytesPerNs = 2;

}  // namespace

RetainKeeper::RetainKeeper(vm::Controller& controller, Store& store, WallTime wall_time)
    : controller_(controller),
      store_(store),
      wall_time_(std::move(wall_time)),
      save_again_(kAgainNs, kLongestNs),
      renew_again_(kAgainNs, kLongestNs) {
  const base::Result<uint64_t> bytes = retained_bytes(controller.image());
  if (bytes.ok()) expect_bytes(*bytes);
}

RetainKeeper::~RetainKeeper() {
  {
    std::lock_guard lock(ending_mutex_);
    ending_ = true;
  }
  ending_changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void RetainKeeper::start() {
  thread_ = std::thread([this] { run(); });
}

void RetainKeeper::expect_bytes(uint64_t bytes) {
  if (bytes > bytes_.load()) bytes_.store(bytes);
}

void RetainKeeper::take(Snapshot& out) {
  out.number = ++taken_;
  out.image = controller_.verified().digest();
  out.cycle = controller_.cycles();
  copy_retained(controller_.image(), controller_.memory().data(), out.values);
  controller_.worked(copy_ns());
}

int64_t RetainKeeper::copy_ns() const {
  return kCopyNs + static_cast<int64_t>(bytes_.load(std::memory_order_relaxed)) / kCopyBytesPerNs;
}

void RetainKeeper::serve(int64_t free_ns) {
  const uint32_t state = state_.load(std::memory_order_acquire);
  if (state != kWanted && state != kUrgent) return;
  if (state == kWanted && free_ns < copy_ns()) return;
  take(snapshot_);
  state_.store(kTaken, std::memory_order_release);
}

base::Status RetainKeeper::save(const Snapshot& snapshot) {
  std::lock_guard lock(saving_);
  return save_held(snapshot);
}

base::Status RetainKeeper::save_held(const Snapshot& snapshot) {
  if (snapshot.number < saved_.number) return base::Ok{};
  base::Status saved = store_.save_retained(snapshot.image, snapshot.cycle, snapshot.values);
  if (saved.ok()) saved_ = snapshot;
  saved_or_not(saved);
  return saved;
}

std::optional<RetainKeeper::Unsaved> RetainKeeper::unsaved() const {
  std::lock_guard lock(unsaved_mutex_);
  return unsaved_;
}

void RetainKeeper::saved_or_not(const base::Status& saved) {
  const bool was = unsaved().has_value();
  {
    std::lock_guard lock(unsaved_mutex_);
    if (saved.ok()) unsaved_.reset();
    if (!saved.ok() && !was) unsaved_ = {wall_time_(), saved.error().text};
  }
  if (saved.ok() && was) note(Event::kCleared, "retained values are saved again");
  if (!saved.ok() && !was) {
    note(Event::kAlarm, "retained values are not being saved: " + saved.error().text);
  }
}

void RetainKeeper::note(Event event, const std::string& text) {
  JournalEntry entry;
  entry.time_ns = wall_time_();
  entry.event = event;
  entry.text = text;
  store_.note(std::move(entry));
}

bool RetainKeeper::wait(int64_t ns) {
  std::unique_lock lock(ending_mutex_);
  return !ending_changed_.wait_for(lock, std::chrono::nanoseconds(ns), [&] { return ending_; });
}

void RetainKeeper::run() {
  const auto now_ns = [] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  while (wait(step(now_ns()))) continue;
}

// A scan that does not end keeps the last boundary's values: there are no newer ones.
int64_t RetainKeeper::step(int64_t now_ns) {
  uint32_t state = state_.load(std::memory_order_acquire);
  if (state == kTaken) {
    keep(now_ns);
    next_ns_ = now_ns + kPeriodNs;
    state_.store(state = kIdle, std::memory_order_release);
  }
  if (state != kIdle) {
    uint32_t wanted = kWanted;
    if (now_ns - asked_ns_ >= kPatienceNs) state_.compare_exchange_strong(wanted, kUrgent);
    return kPollNs;
  }
  if (now_ns < next_ns_) return next_ns_ - now_ns;
  renew(now_ns);
  snapshot_.values.reserve(bytes_.load());
  asked_ns_ = now_ns;
  state_.store(kWanted, std::memory_order_release);
  return kPollNs;
}

void RetainKeeper::keep(int64_t now_ns) {
  std::lock_guard lock(saving_);
  const bool same = snapshot_.image == saved_.image && snapshot_.values == saved_.values;
  const bool known = same && store_.keeps_retained();
  const bool wanted = !known && store_.names(snapshot_.image) && save_again_.due(now_ns);
  if (wanted && !save_held(snapshot_).ok()) save_again_.failed(now_ns);
}

// What is said once is not said again as long as something is wrong.
void RetainKeeper::renew(int64_t now_ns) {
  store_.look();
  for (const std::string& text : store_.complaints()) {
    if (std::find(said_.begin(), said_.end(), text) != said_.end()) continue;
    note(Event::kAlarm, text);
    said_.push_back(text);
  }
  if (renew_again_.due(now_ns) && !store_.renew().ok()) renew_again_.failed(now_ns);
  if (said_.empty() || !store_.complaints().empty()) return;
  note(Event::kCleared, "storage is well again");
  said_.clear();
}

}  // namespace online_change
