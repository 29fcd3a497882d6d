#include "tools/stvm/activity_text.h"

#include "tools/common/table.h"

namespace stvm {
namespace {

std::string_view kind_text(ir::IoBuffer kind) {
  ir::TaskPolicy policy;
  policy.input_buffer = kind;
  for (const ir::TaskChoice& choice : ir::task_choices()) {
    if (choice.attribute == "input_buffer" && choice.holds(policy)) return choice.text;
  }
  return "unknown";
}

std::string number_text(uint8_t buffer) {
  return buffer == vm::BufferState::kNone ? "-" : std::to_string(buffer);
}

std::string state_of(const vm::TaskActivity& activity) {
  const bool scan = activity.state == vm::TaskState::kRunning ||
                    activity.state == vm::TaskState::kSuspended ||
                    activity.state == vm::TaskState::kDue;
  return std::string(vm::state_text(activity.state)) + (activity.late && scan ? ", late" : "");
}

void row(tools::Table& table, std::string task, std::string state, const char* of,
         const vm::BufferState& buffer) {
  table.row({std::move(task), std::move(state), of, std::string(kind_text(buffer.kind)),
             number_text(buffer.writer), number_text(buffer.waiting), number_text(buffer.reader),
             buffer.fresh ? "yes" : "no", buffer.locked ? "yes" : "no"});
}

void buffer_json(tools::JsonWriter& json, const char* name, const vm::BufferState& buffer) {
  json.key(name).begin_object().field("kind", kind_text(buffer.kind));
  json.field("writer", uint32_t{buffer.writer});
  if (buffer.waiting != vm::BufferState::kNone) json.field("waiting", uint32_t{buffer.waiting});
  json.field("reader", uint32_t{buffer.reader});
  json.field("fresh", buffer.fresh).field("locked", buffer.locked).end_object();
}

}  // namespace

std::string activity_text(const std::vector<vm::TaskStatus>& tasks) {
  tools::Table table(
      {"task", "state", "of", "buffers", "> writer", "> waits", "> reader", "new", "in scan"});
  for (const vm::TaskStatus& task : tasks) {
    row(table, task.name, state_of(task.activity), "inputs", task.activity.inputs);
    row(table, "", "", "outputs", task.activity.outputs);
  }
  return table.text();
}

void activity_json(tools::JsonWriter& json, const vm::TaskActivity& activity) {
  json.field("execution", vm::state_text(activity.state)).field("late", activity.late);
  buffer_json(json, "inputs", activity.inputs);
  buffer_json(json, "outputs", activity.outputs);
}

}  // namespace stvm
