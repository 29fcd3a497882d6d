// The page of a controller at the broker, for people and programs that watch a fleet. Counters that
// change with each cycle are not in it: it is published when it is another than before.
#include "tools/common/json.h"
#include "tools/stvm/agent.h"

namespace stvm {
namespace {

void health_json(tools::JsonWriter& json, const vm::StatusReport& status) {
  json.field("faulted", status.faulted).field("edits_on_trial", status.edits);
  json.field("forces", status.forces).field("watched_by", status.watched_by);
  json.key("alarms").begin_array();
  for (const std::string& alarm : status.alarms) json.value(alarm);
  json.end_array().key("stopped_tasks").begin_array();
  for (const vm::TaskStatus& task : status.tasks) {
    if (task.stopped) json.value(task.name);
  }
  json.end_array().key("devices").begin_array();
  for (const vm::DeviceStatus& device : status.devices) {
    json.begin_object().field("name", device.name).field("state", device.state).end_object();
  }
  json.end_array().field("traps", uint64_t{status.traps.size()});
}

}  // namespace

std::string agent_status_json(const std::string& name, const AgentAbout& about,
                              const vm::StatusReport* status,
                              const std::map<std::string, std::string>& facts) {
  tools::JsonWriter json;
  json.begin_object().field("version", 1).field("name", name);
  json.field("answers", status != nullptr).field("program", about.program);
  json.field("running", base::to_hex(about.running));
  if (status != nullptr) health_json(json, *status);
  json.key("characteristics").begin_object();
  for (const auto& [key, value] : facts) json.field(key, value);
  json.end_object().key("parts").begin_array();
  for (const ir::Part& part : about.parts) {
    json.begin_object().field("kind", ir::part_kind_name(part.kind)).field("name", part.name);
    json.field("identity", base::to_hex(part.identity)).end_object();
  }
  json.end_array().end_object();
  return json.finish();
}

}  // namespace stvm
