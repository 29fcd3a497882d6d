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
constexpr int64_t kCopyNs = 1'000;  // and one for every kCopyBytesPerNs bytes
constexpr int64_t kCopyBytesPerNs = 2;

}  // namespace

RetainKeeper::RetainKeeper(vm::Controller& controller, Store& store, WallTime wall_time)
    : controller_(controller), store_(store), wall_time_(std::move(wall_time)) {
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
  const uint64_t count = controller_.trap_count();
  if (count != traps_seen_) {
    const vm::Traps& all = controller_.traps();
    const uint64_t added = std::min<uint64_t>(count - traps_seen_, all.size());
    traps_.assign(all.end() - static_cast<std::ptrdiff_t>(added), all.end());
    traps_seen_ = count;
  }
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
  return saved;
}

bool RetainKeeper::wait(int64_t ns) {
  std::unique_lock lock(ending_mutex_);
  return !ending_changed_.wait_for(lock, std::chrono::nanoseconds(ns), [&] { return ending_; });
}

bool RetainKeeper::request() {
  snapshot_.values.reserve(bytes_.load());
  state_.store(kWanted, std::memory_order_release);
  for (int64_t waited = 0; state_.load(std::memory_order_acquire) != kTaken; waited += kPollNs) {
    uint32_t wanted = kWanted;
    if (waited >= kPatienceNs) state_.compare_exchange_strong(wanted, kUrgent);
    if (!wait(kPollNs)) return false;
  }
  return true;
}

// A scan that does not end keeps the last boundary's values: there are no newer ones.
void RetainKeeper::run() {
  do {
    if (!request()) return;
    {
      std::lock_guard lock(saving_);
      const bool known = snapshot_.image == saved_.image && snapshot_.values == saved_.values;
      // What fails is among the complaints of the store.
      if (!known) (void)save_held(snapshot_).ok();
    }
    note_traps();
    state_.store(kIdle, std::memory_order_release);
  } while (wait(kPeriodNs));
}

void RetainKeeper::note_traps() {
  for (const auto& trap : traps_) {
    JournalEntry entry;
    entry.time_ns = wall_time_();
    entry.event = Event::kTrap;
    entry.to = snapshot_.image;
    entry.cycle = trap->cycle;
    const vm::TrapText& text = trap->text;
    entry.text = "task " + trap->task + ": " + text.file + ":" + std::to_string(text.line) + " (" +
                 text.pou + "): " + text.text;
    store_.note_trap(std::move(entry));
  }
  traps_.clear();
}

}  // namespace online_change
