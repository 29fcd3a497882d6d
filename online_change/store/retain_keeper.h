// Keeps the retained values durable while a program runs. The control thread copies them at a
// boundary when it is asked to; a thread of the keeper asks, and waits for the disk. What did not
// change is not written again. It also brings traps to the journal.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "online_change/store/store.h"
#include "vm/runtime/controller.h"

namespace online_change {

// The retained values of one boundary.
struct Snapshot {
  uint64_t number = 0;  // snapshots of one controller in their order
  base::Digest image{};
  uint64_t cycle = 0;
  base::Bytes values;
};

class RetainKeeper {
 public:
  using WallTime = std::function<int64_t()>;  // ns since 1970

  // Without start() there is no thread: only save() writes.
  RetainKeeper(vm::Controller& controller, Store& store, WallTime wall_time);
  ~RetainKeeper();
  void start();

  // Control thread, at a boundary; `free_ns`: until the next cycle. Without a request: one load.
  void serve(int64_t free_ns);
  // Control thread, at a boundary. Takes about copy_ns().
  void take(Snapshot& out);
  int64_t copy_ns() const;

  // Any other thread. The programs that snapshots are taken of have so many bytes at most.
  void expect_bytes(uint64_t bytes);
  // Durable when it returns. One that is older than what has been saved is left out.
  base::Status save(const Snapshot& snapshot);
  // Nobody else saves while it is held.
  std::unique_lock<std::mutex> hold() { return std::unique_lock(saving_); }
  base::Status save_held(const Snapshot& snapshot);

 private:
  enum State : uint32_t { kIdle, kWanted, kUrgent, kTaken };

  void run();
  bool wait(int64_t ns);  // false: ending
  bool request();         // a snapshot and traps; false: none came
  void note_traps();

  vm::Controller& controller_;
  Store& store_;
  WallTime wall_time_;
  uint64_t taken_ = 0;  // control thread
  std::atomic<uint64_t> bytes_{0};

  // Belong to the control thread in kWanted and kUrgent, to the keeper's otherwise.
  std::atomic<uint32_t> state_{kIdle};
  Snapshot snapshot_;
  vm::Traps traps_;
  uint64_t traps_seen_ = 0;

  std::mutex saving_;  // guards saved_
  Snapshot saved_;

  std::mutex ending_mutex_;
  std::condition_variable ending_changed_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace online_change
