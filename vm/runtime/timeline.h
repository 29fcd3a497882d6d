// What happens in control cycles, told while it happens: for timing charts (B11).
#pragma once

#include <cstdint>
#include <string_view>

namespace vm {

enum class Moment : uint8_t {
  kCycle,      // a control cycle begins
  kReceived,   // inputs of all devices; for one task alone where it has a name (B12)
  kSent,       // outputs to all devices; likewise
  kReleased,   // the task is due since then
  kMissed,     // it was due, and no scan of its own will come of it
  kBegun,      // its scan
  kSuspended,
  kResumed,
  kEnded,
  kTrapped,    // the scan ends so
  kInputsOf,   // when what its scan works with was received; told when it begins
  kOutputsOf,  // what its scan has written is sent
};

class Timeline {
 public:
  virtual ~Timeline() = default;
  // On the control thread, inside of cycles: quick. `task`: name, "" where it is of no task.
  virtual void note(Moment moment, std::string_view task, int64_t at_ns) = 0;
};

}  // namespace vm
