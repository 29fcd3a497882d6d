#include "vm/runtime/protocol.h"

#include <algorithm>

#include "vm/runtime/fields.h"

namespace vm {
namespace {

enum class RequestBody : uint8_t {
  kNone,
  kNames,
  kAssignments,
  kPage,
  kData,
  kStage,
  kFlags,
  kSwitch
};

struct CommandRow {
  const char* name;
  RequestBody body;
  bool changes_state;
};
constexpr CommandRow kCommands[] = {
#define COMMAND(id, name, handler, body, changes_state, meaning) \
  {name, RequestBody::body, changes_state},
#include "vm/runtime/commands.def"
#undef COMMAND
};

const CommandRow& row(Command command) { return kCommands[static_cast<size_t>(command)]; }

constexpr uint32_t kTextBytes = 4;  // of an empty one

base::Error other_version(uint8_t controller, uint8_t client) {
  return {base::Refusal::kProtocol,
          "the controller speaks version " + std::to_string(controller) +
              " of the protocol, the client version " + std::to_string(client) +
              "; use the stvm that the controller was started with, or start the controller again "
              "with this one"};
}

bool says_nothing(base::ByteSpan bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](uint8_t byte) { return byte == 0; });
}

bool has_unknown_flags(const Request& request) {
  switch (row(request.command).body) {
    case RequestBody::kStage:
      return (request.flags & ~kAllStageFlags) != 0;
    case RequestBody::kSwitch:
      return (request.flags & ~kAllSwitchFlags) != 0;
    case RequestBody::kNone:
    case RequestBody::kNames:
    case RequestBody::kAssignments:
    case RequestBody::kPage:
    case RequestBody::kData:
    case RequestBody::kFlags:  // a number, which the command checks
      break;
  }
  return false;
}

// `R` is a Request for reading, a const one for writing.
template <class A, class R>
void request_fields(A& a, R& request) {
  if (row(request.command).changes_state) {
    a(request.expected);
    a(request.edition);
  }
  switch (row(request.command).body) {
    case RequestBody::kNone:
      break;
    case RequestBody::kNames:
      a.list(request.names, kTextBytes);
      break;
    case RequestBody::kAssignments:
      a.list(request.names, kTextBytes);
      a.list(request.values, kTextBytes);
      break;
    case RequestBody::kPage:
      a(request.offset);
      a.list(request.names, kTextBytes);
      break;
    case RequestBody::kData:
      a(request.offset);
      a(request.data);
      break;
    case RequestBody::kStage:
      a(request.digest);
      a(request.flags);
      a.list(request.names, kTextBytes);
      break;
    case RequestBody::kFlags:
      a(request.flags);
      break;
    case RequestBody::kSwitch:
      a(request.flags);
      a.list(request.names, kTextBytes);
      break;
  }
}

template <class A, class T>
void summary_fields(A& a, T& times) {
  a(times.min);
  a(times.average);
  a(times.p99);
  a(times.max);
  a(times.total);
}

template <class A, class T>
void class_fields(A& a, T& row) {
  a(row.end_ns);
  a(row.count);
}

template <class A, class T>
void times_fields(A& a, T& task) {
  a(task.name);
  a.list(task.run, 16);
  a.list(task.delay, 16);
}

void activity_fields(FieldWriter& a, const TaskActivity& activity) { a(packed(activity)); }

void activity_fields(FieldReader& a, TaskActivity& activity) {
  uint32_t bits = 0;
  a(bits);
  activity = unpacked(bits);
  if (packed(activity) != bits) a.fail();  // a state or kind that there is not
}

template <class A, class T>
void task_fields(A& a, T& task) {
  a(task.name);
  a(task.period_ns);
  a(task.priority);
  a(task.scans);
  a(task.overruns);
  a(task.missed);
  a(task.last_ns);
  summary_fields(a, task.run);
  summary_fields(a, task.delay);
  a(task.stopped);
  a(task.freewheeling);
  a(task.once);
  a(task.recent_ns);
  activity_fields(a, task.activity);
}

template <class A, class T>
void trap_fields(A& a, T& trap) {
  a(trap.cycle);
  a(trap.task);
  a(trap.text.pou);
  a(trap.text.file);
  a(trap.text.line);
  a(trap.text.text);
}

template <class A, class T>
void device_fields(A& a, T& device) {
  a(device.name);
  a(device.driver);
  a(device.state);
  a(device.exchanges);
  a(device.errors);
  a(device.age_ns);
  a(device.error);
  a(device.writes);
  a(device.last_writer);
  a(device.error_age_ns);
}

template <class A, class T>
void value_fields(A& a, T& value) {
  a(value.path);
  a(value.type);
  a(value.value);
}

template <class A, class T>
void room_fields(A& a, T& room) {
  a(room.areas);
  a(room.used);
  a(room.slack);
}

template <class A, class T>
void memory_fields(A& a, T& memory) {
  a(memory.capacity);
  a(memory.free);
  a(memory.largest_free);
  room_fields(a, memory.globals);
  room_fields(a, memory.programs);
  room_fields(a, memory.instances);
}

template <class A, class T>
void status_fields(A& a, T& report) {
  a(report.name);
  a(report.running);
  a(report.edition);
  a(report.change);
  a(report.edits);
  a(report.last_edit_boots);
  a(report.changed_by);
  a(report.aborted);
  a(report.previous);
  a(report.boots_next);
  a(report.trial_lost);
  a.list(report.alarms, kTextBytes);
  a(report.cycles);
  a(report.uptime_ns);
  a(report.base_period_ns);
  a(report.faulted);
  a(report.forces);
  a(report.boundary_forces);
  memory_fields(a, report.memory);
  a(report.pous);
  a(report.native_pous);
  a(report.native_bytes);
  a(report.pous_to_make);
  a.list(report.interpreted, kTextBytes);
  a.list(report.tasks, 134);
  a.list(report.traps, 28);
  a.list(report.devices, 40);
}

template <class A, class T>
void values_fields(A& a, T& values) {
  a(values.cycle);
  a(values.last_cycle);
  a(values.next);
  a.list(values.rows, 3 * kTextBytes);
}

template <class A, class T>
void force_fields(A& a, T& row) {
  a(row.path);
  a(row.type);
  a(row.value);
  a(row.reason);
}

template <class A, class T>
void forces_fields(A& a, T& forces) {
  a.list(forces.rows, 4 * kTextBytes);
}

template <class A, class T>
void image_fields(A& a, T& part) {
  a(part.digest);
  a(part.total);
  a(part.bytes);
}

template <class A, class T>
void staged_fields(A& a, T& answer) {
  a(answer.edition);
}

template <class A, class T>
void abort_fields(A& a, T& answer) {
  a(answer.done);
  a(answer.text);
}

}  // namespace

#define FIELDS(type, list)                                          \
  static void fields(FieldWriter& a, const type& v) { list(a, v); } \
  static void fields(FieldReader& a, type& v) { list(a, v); }
FIELDS(TaskStatus, task_fields)
FIELDS(TimeClass, class_fields)
FIELDS(TaskTimes, times_fields)
FIELDS(TrapRow, trap_fields)
FIELDS(DeviceStatus, device_fields)
FIELDS(ValueRow, value_fields)
FIELDS(StatusReport, status_fields)
FIELDS(Values, values_fields)
FIELDS(ForceRow, force_fields)
FIELDS(ForceRows, forces_fields)
FIELDS(ImagePart, image_fields)
FIELDS(StagedAnswer, staged_fields)
FIELDS(AbortAnswer, abort_fields)
#undef FIELDS

base::Error not_understood(const char* what) {
  return {base::Refusal::kProtocol, std::string("message not understood: ") + what};
}

const char* command_name(Command command) { return row(command).name; }
bool changes_state(Command command) { return row(command).changes_state; }

base::Bytes encode(const Request& request) {
  FieldWriter writer;
  writer(kProtocolVersion);
  writer(static_cast<uint8_t>(request.command));
  request_fields(writer, request);
  return writer.take();
}

base::Result<Request> decode_request(base::ByteSpan bytes) {
  FieldReader reader(bytes, Texts::kAsSent);
  uint8_t version = 0;
  uint8_t command = 0;
  reader(version);
  if (!bytes.empty() && version < kOldestRequest) return other_version(kProtocolVersion, version);
  reader(command);
  if (command >= std::size(kCommands)) {
    return not_understood("unknown command; is the client newer than the controller?");
  }
  Request request;
  request.command = static_cast<Command>(command);
  request_fields(reader, request);
  if (reader.failed() || (version <= kProtocolVersion && !reader.rest().empty())) {
    return not_understood("damaged request");
  }
  if (!says_nothing(reader.rest()) || has_unknown_flags(request)) {
    return not_understood("the client asks for something that only a newer controller can do");
  }
  if (request.names.size() > kMaxNames) return not_understood("too many names");
  if (row(request.command).body == RequestBody::kAssignments &&
      request.names.size() != request.values.size()) {
    return not_understood("names without values");
  }
  return request;
}

base::Bytes encode_answer(base::ByteSpan body) {
  FieldWriter writer;
  writer(kProtocolVersion);
  writer(true);
  base::Bytes answer = writer.take();
  answer.insert(answer.end(), body.begin(), body.end());
  return answer;
}

base::Bytes encode_answer(const base::Error& error, uint8_t version) {
  FieldWriter writer;
  writer(version);
  writer(false);
  writer(std::string(base::refusal_code(error.refusal)));
  writer(error.text.substr(0, kMaxNameBytes));
  return writer.take();
}

base::Result<base::Bytes> decode_answer(base::ByteSpan bytes) {
  if (bytes.size() < 2 || bytes[1] > 1) return not_understood("damaged answer");
  base::ByteSpan rest = bytes.subspan(2);
  if (bytes[1] == 1) {
    if (bytes[0] < kOldestAnswer) return other_version(bytes[0], kProtocolVersion);
    return base::Bytes(rest.begin(), rest.end());
  }
  FieldReader reader(rest);
  std::string code;
  std::string text;
  reader(code);
  reader(text);
  auto refusal = base::refusal_from_code(code);
  if (reader.failed()) return not_understood("damaged answer");
  if (!refusal) return base::Error{base::Refusal::kProtocol, code + ": " + text};
  return base::Error{*refusal, text};
}

base::Bytes encode(const StatusReport& report) { return write_fields(report); }
base::Bytes encode(const TaskTimes& times) { return write_fields(times); }
base::Bytes encode(const Values& values) { return write_fields(values); }
base::Bytes encode(const ForceRows& rows) { return write_fields(rows); }
base::Bytes encode(const ImagePart& part) { return write_fields(part); }
base::Bytes encode(const StagedAnswer& answer) { return write_fields(answer); }
base::Bytes encode(const AbortAnswer& answer) { return write_fields(answer); }

base::Result<StatusReport> decode_status(base::ByteSpan body) {
  return read_fields<StatusReport>(body, "status");
}
base::Result<TaskTimes> decode_task_times(base::ByteSpan body) {
  return read_fields<TaskTimes>(body, "times");
}
base::Result<Values> decode_values(base::ByteSpan body) {
  return read_fields<Values>(body, "values");
}
base::Result<ForceRows> decode_forces(base::ByteSpan body) {
  return read_fields<ForceRows>(body, "forces");
}
base::Result<ImagePart> decode_image_part(base::ByteSpan body) {
  return read_fields<ImagePart>(body, "image");
}
base::Result<StagedAnswer> decode_staged_answer(base::ByteSpan body) {
  return read_fields<StagedAnswer>(body, "staged");
}
base::Result<AbortAnswer> decode_abort_answer(base::ByteSpan body) {
  return read_fields<AbortAnswer>(body, "abort");
}

}  // namespace vm
