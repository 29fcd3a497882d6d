// Hand-over of commands from one channel thread to the control thread. The control thread runs a
// waiting job at a boundary and never waits for one but in its idle time: without a job, serve() is
// one load.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "vm/runtime/boundary.h"

namespace vm {

class Mailbox : public Boundary {
 public:
  // Channel thread.
  Outcome run(const std::function<void()>& job, int64_t timeout_ns) override;
  void pause(int64_t ns) override;

  // Control thread, at a boundary.
  void serve();
  // Control thread, in its idle time: at most so long, until a job is there.
  void wait(int64_t ns);
  // Control thread, when it ends: no job is taken any more.
  void close();

 private:
  bool post();       // false: closed
  bool take_back();  // false: it runs, or has run
  enum State : uint32_t { kEmpty, kPosted, kRunning, kDone, kClosed };

  std::atomic<uint32_t> state_{kEmpty};
  const std::function<void()>* job_ = nullptr;  // belongs to whoever the state says
};

}  // namespace vm
