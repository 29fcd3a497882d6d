// Between the control thread and one device (B8, B9): a thread of its own exchanges with the driver
// once in each period, through triple buffers both ways. The control side never waits, locks,
// allocates or calls the system; a driver that hangs or dies delays nothing but itself.
//
// A set is what the device exchanges for one version of the program. At most one is in use: its
// outputs are written. The others are read only, so that a version which is about to run, or to
// come back, finds inputs at once. When a set is used no more, the points that only it wrote
// become what LeftOutputs says, in one exchange.
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "vm/io/driver.h"
#include "vm/io/triple_buffer.h"
#include "vm/runtime/ports.h"

namespace vm {

// What outputs become when no version writes them any more, in the bytes of its points: bits of
// `held` stay as they are, the others become those of `value`.
struct LeftOutputs {
  base::Bytes value;
  base::Bytes held;
  friend bool operator==(const LeftOutputs&, const LeftOutputs&) = default;
};

class ExchangeSet {
 public:
  ExchangeSet(DevicePoints what, LeftOutputs behind);

  const DevicePoints points;
  const LeftOutputs left;
  TripleBuffer inputs;                 // written by the exchange
  TripleBuffer outputs;                // written by the control thread
  std::unique_ptr<WriteQueue> writes;  // by the exchange; null: no output is writable
  // Control thread: the inputs have been received, the outputs sent, at least once.
  bool received = false;
  // Exchange: the same of the other side.
  bool has_outputs = false;
};

class ExchangePort {
 public:
  // Without a thread (`own_thread` false), exchange_now() does what it would.
  ExchangePort(ir::Device device, std::unique_ptr<IoDriver> driver, bool own_thread,
               DeviceLog log = {}, bool confined = false);
  // The outputs that were sent last go out, if that takes no longer than the timeout and a second;
  // a driver that hangs is left behind.
  ~ExchangePort();

  const ir::Device& device() const;

  // --- off the control thread
  std::shared_ptr<ExchangeSet> add(DevicePoints points, LeftOutputs left);
  void drop(const std::shared_ptr<ExchangeSet>& set);  // not the one in use
  DeviceStatus status() const;

  // --- control thread
  void use(ExchangeSet* set);  // one that was added; null: none
  // When the newest inputs came, on the clock of now_ns(); INT64_MIN: never.
  int64_t received_ns() const;
  // Are they valid and new enough?
  bool fresh(int64_t now_ns) const;
  // Has the last exchange failed? One that does not end has not.
  bool failed() const;
  void exchange_now(int64_t now_ns);
  // The clock of a port with a thread: the time since some instant, without a system call.
  static int64_t now_ns();

 private:
  struct Core;
  std::shared_ptr<Core> core_;
  std::thread thread_;
};

}  // namespace vm
