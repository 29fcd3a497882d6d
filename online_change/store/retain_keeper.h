// Keeps the retained values durable while a program runs. The control thread copies them at a
// boundary when it is asked to; a thread of the keeper asks, and waits for the disk. What did not
// change is not written again. It also has what failed in the store renewed, and notes when
// something is not stored and when it is again.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "online_change/store/back_off.h"
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
  struct Unsaved {
    int64_t since_ns = 0;  // wall time
    std::string why;
  };

  // Without start() there is no thread: only save() writes, or step().
  RetainKeeper(vm::Controller& controller, Store& store, WallTime wall_time);
  ~RetainKeeper();
  void start();
  // What the thread does at `now_ns`, of any clock that never goes back; returns after which time
  // it does the next.
  int64_t step(int64_t now_ns);
  // Set while the retained values cannot be saved. Waits for no disk.
  std::optional<Unsaved> unsaved() const;

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
  void keep(int64_t now_ns);
  void renew(int64_t now_ns);
  void note(Event event, const std::string& text);
  void saved_or_not(const base::Status& saved);

  vm::Controller& controller_;
  Store& store_;
  WallTime wall_time_;
  uint64_t taken_ = 0;  // control thread
  std::atomic<uint64_t> bytes_{0};

  // Belong to the control thread in kWanted and kUrgent, to the keeper's otherwise.
  std::atomic<uint32_t> state_{kIdle};
  Snapshot snapshot_;

  std::mutex saving_;  // guards saved_
  Snapshot saved_;

  // The keeper's thread.
  int64_t next_ns_ = 0;   // the next request
  int64_t asked_ns_ = 0;  // this one
  BackOff save_again_;
  BackOff renew_again_;
  std::vector<std::string> said_;  // complaints of the store

  mutable std::mutex unsaved_mutex_;
  std::optional<Unsaved> unsaved_;

  std::mutex ending_mutex_;
  std::condition_variable ending_changed_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace online_change
