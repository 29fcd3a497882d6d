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
      a.texts(request.names);
      break;
    case RequestBody::kAssignments:
      a.texts(request.names);
      a.texts(request.values);
      break;
    case RequestBody::kPage:
      a(request.offset);
      a.texts(request.names);
      break;
    case RequestBody::kData:
      a(request.offset);
      a(request.data);
      break;
    case RequestBody::kStage:
      a(request.digest);
      a(request.flags);
      a.texts(request.names);
      break;
    case RequestBody::kFlags:
      a(request.flags);
      break;
    case RequestBody::kSwitch:
      a(request.flags);
      a.texts(request.names);
      break;
  }
}

constexpr auto summary_fields = [](auto& a, auto& times) {
  a(times.min);
  a(times.average);
  a(times.p99);
  a(times.max);
  a(times.total);
};

constexpr auto class_fields = [](auto& a, auto& row) {
  a(row.end_ns);
  a(row.count);
};

constexpr auto times_fields = [](auto& a, auto& task) {
  a(task.name);
  a.rows(task.run, 16, class_fields);
  a.rows(task.delay, 16, class_fields);
};

void activity_fields(FieldWriter& a, const TaskActivity& activity) { a(packed(activity)); }

void activity_fields(FieldReader& a, TaskActivity& activity) {
  uint32_t bits = 0;
  a(bits);
  activity = unpacked(bits);
  if (packed(activity) != bits) a.fail();  // a state or kind that there is not
}

constexpr auto task_fields = [](auto& a, auto& task) {
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
};

constexpr auto trap_fields = [](auto& a, auto& trap) {
  a(trap.cycle);
  a(trap.task);
  a(trap.text.pou);
  a(trap.text.file);
  a(trap.text.line);
  a(trap.text.text);
};

constexpr auto device_fields = [](auto& a, auto& device) {
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
};

constexpr auto value_fields = [](auto& a, auto& value) {
  a(value.path);
  a(value.type);
  a(value.value);
};

constexpr auto room_fields = [](auto& a, auto& room) {
  a(room.areas);
  a(room.used);
  a(room.slack);
};

constexpr auto memory_fields = [](auto& a, auto& memory) {
  a(memory.capacity);
  a(memory.free);
  a(memory.largest_free);
  room_fields(a, memory.globals);
  room_fields(a, memory.programs);
  room_fields(a, memory.instances);
};

constexpr auto status_fields = [](auto& a, auto& report) {
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
  a.texts(report.alarms);
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
  a.texts(report.interpreted);
  a.rows(report.tasks, 134, task_fields);
  a.rows(report.traps, 28, trap_fields);
  a.rows(report.devices, 40, device_fields);
  a.added(report.watched_by);
  a.added(report.watch_left_ns);
};

constexpr auto values_fields = [](auto& a, auto& values) {
  a(values.cycle);
  a(values.last_cycle);
  a(values.next);
  a.rows(values.rows, 3 * kTextBytes, value_fields);
};

constexpr auto force_fields = [](auto& a, auto& row) {
  a(row.path);
  a(row.type);
  a(row.value);
  a(row.reason);
};

constexpr auto forces_fields = [](auto& a, auto& forces) {
  a.rows(forces.rows, 4 * kTextBytes, force_fields);
};

constexpr auto image_fields = [](auto& a, auto& part) {
  a(part.digest);
  a(part.total);
  a(part.bytes);
};

constexpr auto staged_fields = [](auto& a, auto& answer) {
  a(answer.edition);
};

constexpr auto abort_fields = [](auto& a, auto& answer) {
  a(answer.done);
  a(answer.text);
};

}  // namespace

base::Error not_understood(const char* what) {
  return {base::Refusal::kProtocol, std::string("message not understood: ") + what};
}

const char* command_name(Command command) { return row(command).name; }
bool changes_state(Command command) { return row(command).changes_state; }
bool changes_state(base::ByteSpan request) {
  return request.size() > 1 && request[1] < std::size(kCommands) &&
         kCommands[request[1]].changes_state;
}

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

base::Bytes encode(const StatusReport& report) { return write_fields(report, status_fields); }
base::Bytes encode(const TaskTimes& times) { return write_fields(times, times_fields); }
base::Bytes encode(const Values& values) { return write_fields(values, values_fields); }
base::Bytes encode(const ForceRows& rows) { return write_fields(rows, forces_fields); }
base::Bytes encode(const ImagePart& part) { return write_fields(part, image_fields); }
base::Bytes encode(const StagedAnswer& answer) { return write_fields(answer, staged_fields); }
base::Bytes encode(const AbortAnswer& answer) { return write_fields(answer, abort_fields); }

base::Result<StatusReport> decode_status(base::ByteSpan body) {
  return read_fields<StatusReport>(body, "status", status_fields);
}
base::Result<TaskTimes> decode_task_times(base::ByteSpan body) {
  return read_fields<TaskTimes>(body, "times", times_fields);
}
base::Result<Values> decode_values(base::ByteSpan body) {
  return read_fields<Values>(body, "values", values_fields);
}
base::Result<ForceRows> decode_forces(base::ByteSpan body) {
  return read_fields<ForceRows>(body, "forces", forces_fields);
}
base::Result<ImagePart> decode_image_part(base::ByteSpan body) {
  return read_fields<ImagePart>(body, "image", image_fields);
}
base::Result<StagedAnswer> decode_staged_answer(base::ByteSpan body) {
  return read_fields<StagedAnswer>(body, "staged", staged_fields);
}
base::Result<AbortAnswer> decode_abort_answer(base::ByteSpan body) {
  return read_fields<AbortAnswer>(body, "abort", abort_fields);
}

}  // namespace vm
