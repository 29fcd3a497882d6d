// The file of a recorded run: everything from outside that its state depends on, so that a replay
// comes to the same bytes in every cycle (invariant 5). A header, then records in the order in
// which they happened; each has a checksum, so that a file whose end is lost can still be replayed
// up to there. A request stands before the first cycle that saw what it did, so a cut loses no
// request that a cycle before it needs; a record of its own says that the end is there.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "vm/runtime/controller.h"

namespace vm {

// A recording that reaches this size ends; 1 ms cycles fill it in about half a day.
inline constexpr uint64_t kMaxRecordingBytes = (uint64_t{1} << 30) - (1u << 20);

struct RecordedStart {
  base::Bytes image;     // encoded
  base::Bytes retained;  // as given to Controller::start()
  uint64_t fuel_slice = 0;
  uint64_t fuel_budget = 0;
  uint64_t code_limit = 0;
  uint64_t data_limit = 0;
  ir::OnTrap on_trap = ir::OnTrap::kStopAll;
  // Edits that were on trial when it started, as whoever plays it understands them; mostly none.
  base::Bytes trial = {};
};

using ByteChange = std::pair<uint32_t, uint8_t>;  // offset, new byte
using ByteChanges = std::vector<ByteChange>;     // offsets in order

// Where the rows of one reception end, in Observed::changed and Observed::lost.
struct RecordedReception {
  uint32_t changed = 0;
  uint32_t lost = 0;
};
// What the controller saw of the clock and of its devices.
struct Observed {
  std::vector<int64_t> clock;  // results of Clock::now_ns(), in order
  ByteChanges changed;  // input bytes that differ from before, one reception after the other
  ByteChanges outputs;  // %Q and %M that others wrote at the boundary
  ByteChanges markers;
  ByteChanges globals;  // that other resources write, in the order of SharedGlobals::gather_read
  ByteChanges lost;     // tasks whose device was lost (IoPort::lost_tasks); as `changed`
  // Calls of IoPort::receive(), in order. A cycle has one at most, and one more for each scan of a
  // task that exchanges by itself (B12).
  std::vector<RecordedReception> receptions = {};
};
// Number 0 is the start; then one for each call of Controller::cycle().
struct RecordedCycle {
  uint64_t number = 0;
  Observed observed;
  uint32_t state = 0;  // StateSum after it
};
// A request of the control channel that changed something, after that cycle.
struct RecordedRequest {
  uint64_t cycle = 0;
  std::vector<int64_t> clock;
  base::Bytes bytes;
};

base::Bytes encode_record(const RecordedStart& start);
base::Bytes encode_record(const RecordedCycle& cycle);
base::Bytes encode_record(const RecordedRequest& request);
base::Bytes encode_end();

struct Recording {
  RecordedStart start;
  std::vector<RecordedCycle> cycles;
  std::vector<RecordedRequest> requests;  // by the number of the cycle
  bool cut_off = false;                   // the end of the file was lost
};
// kBadRecording when the header is none.
base::Result<Recording> decode_recording(base::ByteSpan bytes);

}  // namespace vm
