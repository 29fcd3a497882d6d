// What a tool tells a controller of the trial of the next edit (X6-03 to X6-05): under what
// conditions it goes on, how long, and whose it is. It travels as the data of vm::Command::kGuard;
// like all messages it grows at its end (docs/adr/0039-messages-that-grow.md).
#pragma once

#include <string>
#include <vector>

#include "base/bytes.h"
#include "tools/stvm/condition.h"

namespace stvm {

struct GuardOrder {
  std::string note;         // "plan 1f2e3d4c wave 1 by ann": the journal says it of the trial's end
  int64_t deadline_ns = 0;  // from the switch on; not accepted by then: taken back
  int64_t grace_ns = 0;     // nothing but traps and the deadline counts for so long
  int64_t hold_ns = 0;      // a condition is FALSE for so long, at each boundary, before it counts
  bool traps = true;        // a trap counts, also one that stops nothing
  bool devices = false;     // so does a device that was online at the switch and is no longer
  bool alarms = false;      // so does an alarm of the storage
  bool stop_safe = false;   // what cannot be taken back ends with safe outputs (X6-06)
  uint64_t most_missed = UINT64_MAX;  // releases
  uint64_t most_load = 0;             // percent of the periods of all tasks; 0: any
  std::vector<std::string> names;     // variables
  std::vector<Condition> conditions;
  // baseline() is the mean over what is seen before the switch, from the order on; whoever sends it
  // waits for so long. 0: it is the first value of the version on trial.
  int64_t window_ns = 0;
};

base::Bytes encode(const GuardOrder& order);
// kProtocol.
base::Result<GuardOrder> decode_guard_order(base::ByteSpan bytes);

}  // namespace stvm
