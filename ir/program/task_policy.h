// How the controller treats a task beyond its period and priority: attributes in front of TASK
// (B4 to B7, B12; docs/TASKS.md). The first value of each holds without one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ir {

// Which inputs a scan works with, and when its outputs are sent (B6).
enum class TaskIo : uint8_t { kNewest, kSynchronous };
// How the inputs of a task are kept apart from what is received meanwhile (B4), and what it has
// written from what is sent (B5). All kinds but kFirstUnseen show the newest: inputs that had
// arrived when the scan starts, outputs of the last scan that has ended. Images store the numbers,
// so more are appended only.
enum class IoBuffer : uint8_t {
  kCopied,
  kLocked,
  kSwapped,
  kSwappedWithFlag,
  kThree,
  kFirstUnseen,
};
inline constexpr uint32_t kIoBufferCount = 6;
// Further exchanges inside a control cycle (B12). With kOwn the task receives when its scan starts,
// into its own buffer, and what it has written is sent when its scan has ended.
enum class TaskExchange : uint8_t { kOfCycle, kOwn };
inline constexpr uint32_t kTaskExchangeCount = 2;
// What a release does that finds the scan of the last one still running (B7). Append only.
enum class Overrun : uint8_t { kSkip, kStretch, kFault, kAtOnce, kLengthen };
// What a trap in a scan of the task does; unstated: what the controller's options say.
enum class OnTrap : uint8_t { kUnstated, kStopAll, kStopTask, kGoOn };

inline constexpr std::string_view kFreewheeling = "freewheeling";

struct TaskPolicy {
  TaskIo io = TaskIo::kNewest;
  TaskExchange exchange = TaskExchange::kOfCycle;
  IoBuffer input_buffer = IoBuffer::kCopied;
  IoBuffer output_buffer = IoBuffer::kCopied;
  Overrun overrun = Overrun::kSkip;
  OnTrap on_trap = OnTrap::kUnstated;
  bool freewheeling = false;  // released again in the first cycle after its scan; it has no period
  friend bool operator==(const TaskPolicy&, const TaskPolicy&) = default;
};

// One value that an attribute can have: {attribute 'overrun' := 'stretch'}.
struct TaskChoice {
  std::string_view attribute;
  std::string_view text;
  std::string_view meaning;
  void (*apply)(TaskPolicy&);
  bool (*holds)(const TaskPolicy&);
};
struct TaskChoices {
  const TaskChoice* first;
  const TaskChoice* last;
  const TaskChoice* begin() const { return first; }
  const TaskChoice* end() const { return last; }
};
TaskChoices task_choices();

// nullptr: there is no such attribute, or it does not have this value. Case does not matter.
const TaskChoice* find_task_choice(std::string_view attribute, std::string_view value);
bool apply_policy(TaskPolicy& policy, std::string_view attribute, std::string_view value);

// What a policy asks for that the task cannot have: "task t has TEXT", and the way out. `periodic`:
// it is released by its period alone. nullptr: nothing.
struct PolicyConflict {
  std::string_view text;
  std::string_view way_out;
};
const PolicyConflict* policy_conflict(const TaskPolicy& policy, bool periodic);

// What a control cycle of a resource begins with (B2): {attribute 'schedule' := 'run_first'} in
// front of RESOURCE. With kRunFirst the tasks work with the inputs that were received at the end of
// the cycle before, and what they have written is sent in their own cycle. Append only.
enum class Schedule : uint8_t { kSendFirst, kRunFirst };
inline constexpr uint32_t kScheduleCount = 2;
inline constexpr std::string_view kScheduleAttribute = "schedule";
std::string_view schedule_text(Schedule schedule);
// nullopt: there is none of this name. Case does not matter.
std::optional<Schedule> schedule_of(std::string_view text);

// What differs from the default, as " attribute value" each.
std::string policy_text(const TaskPolicy& policy);

}  // namespace ir
