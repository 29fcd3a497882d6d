// How the controller treats a task beyond its period and priority: attributes in front of TASK
// (systems.md B4, B6, B7; reliability.md, traps). The first value of each holds without one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ir {

// Which inputs a scan works with, and when its outputs are sent (B6).
enum class TaskIo : uint8_t { kNewest, kSynchronous };
// How the inputs of a task are kept apart from what is received meanwhile (B4). All kinds but
// kFirstUnseen show the newest that had arrived when the scan starts. Images store the numbers, so
// more are appended only.
enum class InputBuffer : uint8_t {
  kCopied,
  kLocked,
  kSwapped,
  kSwappedWithFlag,
  kThree,
  kFirstUnseen,
};
// What a release does that finds the scan of the last one still running (B7).
enum class Overrun : uint8_t { kSkip, kStretch, kFault };
// What a trap in a scan of the task does; unstated: what the controller's options say.
enum class OnTrap : uint8_t { kUnstated, kStopAll, kStopTask, kGoOn };

inline constexpr std::string_view kFreewheeling = "freewheeling";

struct TaskPolicy {
  TaskIo io = TaskIo::kNewest;
  InputBuffer input_buffer = InputBuffer::kCopied;
  Overrun overrun = Overrun::kSkip;
  OnTrap on_trap = OnTrap::kUnstated;
  bool freewheeling = false;  // released again in the first cycle behind its scan; it has no period
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

// What differs from the default, as " attribute value" each.
std::string policy_text(const TaskPolicy& policy);

}  // namespace ir
