// Hand-over of commands from one channel thread to the control thread. The control thread runs a
// waiting job at a boundary and never waits for one but in its idle time: without a job, serve() is
// one load.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "vm/runtime/boundary.h"
#include "vm/runtime/clocks.h"

namespace vm {

class Mailbox : public Boundary {
 public:
  // Channel thread.
  Outcome run(const std::function<void()>& job, int64_t timeout_ns) override;
  void pause(int64_t ns) override;

  // Control thread, at a boundary.
  void serve();
  // Control thread, in its idle time: sleeps until a job is there, or until that time, or so long.
  // The time is absolute: what delays the call itself does not move the end.
  void wait_until(const RealClock& clock, int64_t at_ns);
  void wait(int64_t ns);
  // Control thread, when it ends: no job is taken any more.
  void close();

 private:
  void sleep_until(int64_t monotonic_ns);
  bool post();       // false: closed
  bool take_back();  // false: it runs, or has run
  enum State : uint32_t { kEmpty, kPosted, kRunning, kDone, kClosed };

  std::atomic<uint32_t> state_{kEmpty};
  const std::function<void()>* job_ = nullptr;  // belongs to whoever the state says
};

}  // namespace vm
