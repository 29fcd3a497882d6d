// How the channel's side gets work done at a boundary of the running program: between threads
// (mailbox.h), or in a simulation that runs both sides in one (tests/sim).
#pragma once

#include <cstdint>
#include <functional>

namespace vm {

class Boundary {
 public:
  enum class Outcome : uint8_t { kDone, kTimeout, kClosed };

  virtual ~Boundary() = default;
  // Runs `job` at a boundary and waits for its end. After kTimeout and kClosed it has not run and
  // will not.
  virtual Outcome run(const std::function<void()>& job, int64_t timeout_ns) = 0;
  // Lets about so much time pass while the program goes on.
  virtual void pause(int64_t ns) = 0;

  // Asked now and then while run() waits for a boundary, by the thread that waits; the job cannot
  // begin meanwhile. True: it waits no longer, which is a kTimeout.
  std::function<bool()> give_up;
};

}  // namespace vm
