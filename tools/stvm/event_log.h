// The events of one resource: takes what its store and its threads note, and what the control
// thread puts into a ring; leaves out what comes too often, with a count; writes a line for each;
// and keeps the newest ones in memory for those who ask. In the order in which they happened here,
// whatever the clock does meanwhile. Those of before, as far as they are durable, come first.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "online_change/store/store.h"
#include "tools/stvm/event_limits.h"
#include "tools/stvm/log_output.h"
#include "vm/io/device_events.h"
#include "vm/runtime/event_ring.h"
#include "vm/runtime/recorder.h"

namespace stvm {

class EventLog {
 public:
  static constexpr size_t kMostKept = 2048;
  // The clocks of the machine; a test has others.
  class Clocks {
   public:
    virtual ~Clocks() = default;
    virtual int64_t wall_ns() const;    // since 1970
    virtual int64_t steady_ns() const;  // that of ScanEvent
  };
  static const Clocks& real_clocks();

  static online_change::Event event_of(vm::DeviceEvent event);

  // `store` is told to tell this, and outlives it; `resource`: "" where there is no other. Lines go
  // to `output`, if any.
  EventLog(online_change::Store& store, std::string resource, std::shared_ptr<LogOutput> output,
           const Clocks& clocks = real_clocks());
  ~EventLog();  // close()

  // For the control thread.
  vm::EventRing& ring() { return ring_; }
  // Watches the recorder for its end; null: no more.
  void watch(const vm::Recorder* recorder) { recorder_ = recorder; }
  // A thread looks from now on.
  void start();
  // What the thread does, 20 times a second: the ring, and counts of what was left out. Any other
  // thread may, too.
  void look();
  // The thread ends, and all counts are told.
  void close();

  // Any other thread. False: there were too many like it, and it only counts.
  bool take(const online_change::JournalEntry& entry);
  // Takes an event of a device, by its thread, perhaps after the end of the store.
  void take_device(vm::DeviceEvent event, const std::string& device, const std::string& text);
  // Events from number `first` on, as sectors of a journal, at most so many bytes; their `sequence`
  // is that number, from 1.
  base::Bytes page(uint64_t first, size_t most_bytes) const;

 private:
  void remember(online_change::JournalEntry entry);
  void show(const online_change::JournalEntry& entry);
  void tell_left_out(int64_t now_ns, bool all);
  void look_at_recorder();

  online_change::Store& store_;
  const std::string prefix_;
  const std::shared_ptr<LogOutput> output_;
  const Clocks& clocks_;
  vm::EventRing ring_;
  const vm::Recorder* recorder_ = nullptr;

  std::mutex looking_;        // the ring is for one thread at a time
  mutable std::mutex mutex_;  // of what follows; never taken by the control thread
  EventLimits limits_;
  base::Bytes kept_;  // a ring of sectors: event number N at N % kMostKept
  uint64_t next_ = 1;

  std::mutex ending_mutex_;
  std::condition_variable ending_changed_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace stvm
