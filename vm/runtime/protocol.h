// The control channel's messages: binary, little endian, each of one
// version byte, one command or result byte, and a body. Framing: frames.h. Both directions are
// decoded by the bounded reader, and neither side believes the other.
//
// Sides of neighbouring releases understand each other: from version 13 on messages only grow at
// their ends (fields.h). An answer may have more fields than its reader knows, or fewer. A request
// may have more only where they say nothing (zeros), since whoever asks for more would not get it;
// flags that the controller does not know are refused as well. The layout of an error is the same
// in all versions, so that a client of an older one can say what is wrong.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"
#include "base/result.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/memory_report.h"
#include "vm/runtime/protocol_version.h"

namespace vm {

// Those that are understood, up to any later one. Recordings hold requests.
inline constexpr uint8_t kOldestRequest = 12;
inline constexpr uint8_t kOldestAnswer = 13;
inline constexpr uint32_t kMaxMessageBytes = 1u << 20;
inline constexpr uint32_t kMaxNames = 4096;          // in one request
inline constexpr uint32_t kMaxNameBytes = 65536;     // of a path or a value
inline constexpr uint32_t kChunkBytes = 512u << 10;  // of an image, a package, a page of rows

enum class Command : uint8_t {
#define COMMAND(id, name, handler, body, changes_state, meaning) id,
#include "vm/runtime/commands.def"
#undef COMMAND
};
inline constexpr uint8_t kCommandCount = 0
#define COMMAND(id, name, handler, body, changes_state, meaning) +1
#include "vm/runtime/commands.def"
#undef COMMAND
    ;
const char* command_name(Command command);
bool changes_state(Command command);
// Of a request that nobody has looked at yet.
bool changes_state(base::ByteSpan request);

enum SwitchFlags : uint32_t {
  kAllowLoss = 1,
  kPermanent = 2,       // accept at once
  kAllowOverrun = 4,    // even if the predicted pause does not fit the tightest task
  kNoWayBack = 8,       // the controller does not undo it by itself (X7)
  kLastEditBoots = 16,  // after a power loss it runs, on trial, and not what was accepted (D4)
  kMoreToCome = 32,     // the next edit belongs to it: taken back by the controller, both go (E-26)
};
inline constexpr uint32_t kAllSwitchFlags = 63;

enum StageFlags : uint32_t {
  kByStandby = 1,  // the change prepares a second data area (docs/adr/0011-two-strategies.md)
  kRehearsal = 2,  // only to be looked at: not journalled or stored; also beside another change
  kTableAdditions = 4,  // refused when variables that run become others (E-16)
};
inline constexpr uint32_t kAllStageFlags = 7;

// As the name of a request for fates: one line for each variable instead of groups of them.
inline constexpr const char* kEveryVariable = "every";
// As the name of a request for the fates of the way back, and after the edit in one for undo:
// FB_Exit of what goes does not run.
inline constexpr const char* kWithoutExit = "without FB_Exit";
// So does this: values that do not fit their old type again are converted all the same.
inline constexpr const char* kWithLoss = "with loss";

struct Request {
  Command command = Command::kStatus;
  // In commands that change state: what the sender believes to run.
  base::Digest expected{};
  uint64_t edition = 0;
  // Bodies. Assignments: names and values in parallel. Page: offset and names (a pattern).
  std::vector<std::string> names{};
  std::vector<std::string> values{};
  uint64_t offset = 0;
  base::Bytes data{};
  base::Digest digest{};
  uint32_t flags = 0;
};
base::Bytes encode(const Request& request);
base::Result<Request> decode_request(base::ByteSpan bytes);

// An answer is a body or an Error.
base::Bytes encode_answer(base::ByteSpan body);
// For a client of that version.
base::Bytes encode_answer(const base::Error& error, uint8_t version = kProtocolVersion);
// The body; the other side's Error as it was; kProtocol for anything else.
base::Result<base::Bytes> decode_answer(base::ByteSpan bytes);

struct TrapRow {
  uint64_t cycle = 0;
  std::string task;
  TrapText text;
};

struct StatusReport {
  std::string name;
  base::Digest running{};
  uint64_t edition = 0;          // counts switches, undos and accepts
  std::string change;            // state of the change; "idle"
  uint64_t edits = 0;            // on trial, also while another one is prepared
  bool last_edit_boots = false;  // the newest of them, after a power loss too
  std::string changed_by;        // who staged it
  std::string aborted;           // when, and by whom or what, if the last one was, while prepared
  base::Digest previous{};       // during a trial: what undo brings back
  base::Digest boots_next{};
  base::Digest trial_lost{};        // the program that was on trial when the last process ended
  std::vector<std::string> alarms;  // of what is stored
  uint64_t cycles = 0;
  int64_t uptime_ns = 0;
  int64_t base_period_ns = 0;
  bool faulted = false;
  uint64_t forces = 0;
  uint64_t boundary_forces = 0;  // those that hold at the boundaries of cycles only
  MemoryReport memory;
  uint64_t pous = 0;
  uint64_t native_pous = 0;  // that run as machine code; 0: everything is interpreted
  uint64_t native_bytes = 0;
  uint64_t pous_to_make = 0;             // machine code of so many is still being made
  std::vector<std::string> interpreted;  // "POU: why", the first few, where there is machine code
  std::vector<TaskStatus> tasks;
  std::vector<TrapRow> traps;
  std::vector<DeviceStatus> devices;
  std::string watched_by;     // whose roll-out watches the edit on trial; "": none does
  int64_t watch_left_ns = 0;  // until it is taken back, if nobody accepts it
};
inline constexpr size_t kShownInterpreted = 8;

struct ValueRow {
  std::string path;
  std::string type;
  std::string value;  // empty in lists
};
struct Values {
  // The cycle of the boundary at which they were taken; the last one, where they did not fit into
  // one (vm/runtime/live_copy.h).
  uint64_t cycle = 0;
  uint64_t last_cycle = 0;
  uint64_t next = 0;  // of lists: where the next page begins; 0: this was the last
  std::vector<ValueRow> rows;
};

// Forced variables: all of them, or those of the request that forced them.
struct ForceRow {
  std::string path;
  std::string type;
  std::string value;
  std::string reason;  // as that of vm::Force
};
struct ForceRows {
  std::vector<ForceRow> rows;
};

struct ImagePart {
  base::Digest digest{};
  uint64_t total = 0;
  base::Bytes bytes;
};

// A change is prepared: what a switch names.
struct StagedAnswer {
  uint64_t edition = 0;
};

struct AbortAnswer {
  bool done = false;  // there was something to end
  std::string text;   // a line for people
};

base::Bytes encode(const StatusReport& report);
base::Bytes encode(const TaskTimes& times);
base::Bytes encode(const Values& values);
base::Bytes encode(const ForceRows& rows);
base::Bytes encode(const ImagePart& part);
base::Bytes encode(const StagedAnswer& answer);
base::Bytes encode(const AbortAnswer& answer);
base::Result<StatusReport> decode_status(base::ByteSpan body);
base::Result<TaskTimes> decode_task_times(base::ByteSpan body);
base::Result<Values> decode_values(base::ByteSpan body);
base::Result<ForceRows> decode_forces(base::ByteSpan bytes);
base::Result<ImagePart> decode_image_part(base::ByteSpan body);
base::Result<StagedAnswer> decode_staged_answer(base::ByteSpan body);
base::Result<AbortAnswer> decode_abort_answer(base::ByteSpan body);

}  // namespace vm
