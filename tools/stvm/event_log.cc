#include "tools/stvm/event_log.h"

#include <algorithm>
#include <chrono>
#include <iterator>

#include "online_change/store/record.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/event_text.h"

namespace stvm {
namespace {

using online_change::Event;
using online_change::JournalEntry;
using online_change::kSectorBytes;

constexpr std::chrono::milliseconds kEventLook{50};

constexpr Event kOfScans[vm::kScanEventKinds] = {Event::kTrap, Event::kWatchdog, Event::kOverrun,
                                                 Event::kDeviceLost, Event::kDeviceBack};
constexpr Event kOfDevices[] = {Event::kDeviceLost, Event::kDeviceBack, Event::kPeerWrote,
                                Event::kPeerRefused};

JournalEntry entry_of(const vm::ScanEvent& event, int64_t time_ns) {
  JournalEntry entry;
  entry.time_ns = time_ns;
  entry.event = kOfScans[static_cast<size_t>(event.kind)];
  entry.to = event.version;
  entry.cycle = event.cycle;
  entry.source = event.source.view();
  entry.text = event.text.view();
  return entry;
}

}  // namespace

int64_t EventLog::Clocks::wall_ns() const { return wall_time_ns(); }

int64_t EventLog::Clocks::steady_ns() const {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

const EventLog::Clocks& EventLog::real_clocks() {
  static const Clocks clocks;
  return clocks;
}

Event EventLog::event_of(vm::DeviceEvent event) { return kOfDevices[static_cast<size_t>(event)]; }

EventLog::EventLog(online_change::Store& store, std::string resource,
                   std::shared_ptr<LogOutput> output, const Clocks& clocks)
    : store_(store),
      prefix_(resource.empty() ? std::string() : resource + ": "),
      output_(std::move(output)),
      clocks_(clocks) {
  for (JournalEntry& entry : store.history()) remember(std::move(entry));
  store.tell([this](const JournalEntry& entry) { return take(entry); });
}

EventLog::~EventLog() { close(); }

void EventLog::start() {
  thread_ = std::thread([this] {
    std::unique_lock lock(ending_mutex_);
    while (!ending_changed_.wait_for(lock, kEventLook, [this] { return ending_; })) {
      lock.unlock();
      look();
      lock.lock();
    }
  });
}

void EventLog::close() {
  {
    const std::lock_guard lock(ending_mutex_);
    ending_ = true;
  }
  ending_changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  look();
  tell_left_out(clocks_.steady_ns(), true);
  recorder_ = nullptr;  // it may end before this
}

// Not more than the ring has at a time: whoever fills it faster than it is emptied is counted
// there.
void EventLog::look() {
  const std::lock_guard looking(looking_);
  const int64_t behind_ns = clocks_.wall_ns() - clocks_.steady_ns();
  vm::ScanEvent event;
  for (uint64_t i = 0; i < vm::EventRing::kRecords && ring_.take(event); ++i) {
    store_.note(entry_of(event, event.steady_ns + behind_ns));
  }
  look_at_recorder();
  tell_left_out(clocks_.steady_ns(), false);
}

void EventLog::look_at_recorder() {
  const char* const why = recorder_ != nullptr ? recorder_->ended_early() : nullptr;
  if (why == nullptr) return;
  recorder_ = nullptr;
  JournalEntry entry;
  entry.time_ns = clocks_.wall_ns();
  entry.event = Event::kRecordingEnded;
  entry.text = why;
  store_.note(std::move(entry));
}

void EventLog::tell_left_out(int64_t now_ns, bool all) {
  std::unique_lock lock(mutex_);
  for (size_t kind = 0; kind < vm::kScanEventKinds; ++kind) {
    const uint64_t lost = ring_.take_lost(static_cast<vm::ScanEventKind>(kind));
    limits_.count(kOfScans[kind], lost, now_ns);
  }
  std::vector<JournalEntry> entries;
  for (const EventLimits::LeftOut& row : limits_.take_left_out(now_ns, all)) {
    JournalEntry entry;
    entry.time_ns = clocks_.wall_ns();
    entry.event = row.event;
    entry.source = row.source;
    entry.text = more_text(row.count, row.span_ns);
    show(entry);
    entries.push_back(std::move(entry));
  }
  lock.unlock();
  for (JournalEntry& entry : entries) store_.keep(std::move(entry));
}

bool EventLog::take(const JournalEntry& entry) {
  const std::lock_guard lock(mutex_);
  if (!limits_.pass(entry.event, entry.source, clocks_.steady_ns())) return false;
  show(entry);
  return true;
}

void EventLog::take_device(vm::DeviceEvent event, const std::string& device,
                           const std::string& text) {
  JournalEntry entry;
  entry.time_ns = clocks_.wall_ns();
  entry.event = event_of(event);
  entry.source = "device " + device;
  entry.text = text;
  take(entry);
}

void EventLog::show(const JournalEntry& entry) {
  remember(entry);
  if (output_ == nullptr) return;
  output_->add(event_row(entry.event).level, entry.time_ns, prefix_ + event_text(entry));
}

void EventLog::remember(JournalEntry entry) {
  entry.sequence = next_++;
  const base::Bytes sector = online_change::encode(entry);
  const size_t at = entry.sequence % kMostKept * kSectorBytes;
  if (kept_.size() < at + kSectorBytes) kept_.resize(at + kSectorBytes);
  std::copy(sector.begin(), sector.end(), kept_.begin() + static_cast<std::ptrdiff_t>(at));
}

base::Bytes EventLog::page(uint64_t first, size_t most_bytes) const {
  const std::lock_guard lock(mutex_);
  base::Bytes out;
  const uint64_t oldest = next_ > kMostKept ? next_ - kMostKept : 1;
  for (uint64_t i = std::max(first, oldest); i < next_ && out.size() < most_bytes; ++i) {
    const auto at = kept_.begin() + static_cast<std::ptrdiff_t>(i % kMostKept * kSectorBytes);
    out.insert(out.end(), at, at + kSectorBytes);
  }
  return out;
}

}  // namespace stvm
