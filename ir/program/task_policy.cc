#include "ir/program/task_policy.h"

#include <iterator>

#include "base/name_case.h"

namespace ir {
namespace {

#define CHOICE(attribute, member, value, text, meaning)                          \
  {                                                                              \
    attribute, text, meaning, [](TaskPolicy& policy) { policy.member = value; }, \
        [](const TaskPolicy& policy) { return policy.member == value; }          \
  }

constexpr TaskChoice kChoices[] = {
    CHOICE("io", io, TaskIo::kNewest, "newest",
           "inputs as at the start of the scan; outputs are sent when it is done"),
    CHOICE("io", io, TaskIo::kSynchronous, "synchronous",
           "inputs of the first cycle of the period; outputs are sent in the first of the next"),
    CHOICE("input_buffer", input_buffer, IoBuffer::kCopied, "copied",
           "two buffers: what is received is copied to the other one when a scan starts"),
    CHOICE("input_buffer", input_buffer, IoBuffer::kLocked, "locked",
           "one buffer, which takes nothing new while a scan lasts"),
    CHOICE("input_buffer", input_buffer, IoBuffer::kSwapped, "swapped",
           "two buffers that change places when a scan starts"),
    CHOICE("input_buffer", input_buffer, IoBuffer::kSwappedWithFlag, "swapped_with_flag",
           "the same; a flag says whether there is anything new to change places for"),
    CHOICE("input_buffer", input_buffer, IoBuffer::kThree, "three",
           "three buffers: one is received into, one waits, one is read"),
    CHOICE("input_buffer", input_buffer, IoBuffer::kFirstUnseen, "first_unseen",
           "two buffers; inputs that no scan has seen stay until one has, whatever comes later"),
    CHOICE("output_buffer", output_buffer, IoBuffer::kCopied, "copied",
           "what a scan has written is copied to what is sent next when it ends"),
    CHOICE("output_buffer", output_buffer, IoBuffer::kLocked, "locked",
           "one buffer; what it has goes to what is sent next before a scan locks it"),
    CHOICE("output_buffer", output_buffer, IoBuffer::kSwapped, "swapped",
           "two buffers that change places when a scan ends"),
    CHOICE("output_buffer", output_buffer, IoBuffer::kSwappedWithFlag, "swapped_with_flag",
           "two; they change places when outputs are sent, if a flag says that a scan has ended"),
    CHOICE("output_buffer", output_buffer, IoBuffer::kThree, "three",
           "three buffers: one is written, one waits, one is sent"),
    CHOICE("output_buffer", output_buffer, IoBuffer::kFirstUnseen, "first_unseen",
           "two buffers; changed outputs that were not sent stay until they are, then the newest"),
    CHOICE("exchange", exchange, TaskExchange::kOfCycle, "cycle",
           "inputs are received and outputs sent with the control cycle alone"),
    CHOICE("exchange", exchange, TaskExchange::kOwn, "own",
           "also for this task: received when its scan starts, sent when it ends"),
    CHOICE("overrun", overrun, Overrun::kSkip, "skip",
           "it is left out and counted; the next one is on time"),
    CHOICE("overrun", overrun, Overrun::kStretch, "stretch",
           "it waits for the end of the scan, and the period counts from there"),
    CHOICE("overrun", overrun, Overrun::kFault, "fault", "it ends the scan as a trap does"),
    CHOICE("overrun", overrun, Overrun::kAtOnce, "at_once",
           "it begins as soon as the scan has ended, with the newest inputs"),
    CHOICE("overrun", overrun, Overrun::kLengthen, "lengthen",
           "the control cycle lasts until the scan has ended: inputs and outputs wait"),
    CHOICE("on_trap", on_trap, OnTrap::kStopAll, "stop_all",
           "all tasks stop; all outputs take their safe values"),
    CHOICE("on_trap", on_trap, OnTrap::kStopTask, "stop_task",
           "this task stops; its outputs take their safe values"),
    CHOICE("on_trap", on_trap, OnTrap::kGoOn, "go_on",
           "the scan is given up, its outputs stay as they were; the next release runs"),
    CHOICE(kFreewheeling, freewheeling, true, "",
           "released again in the first cycle after its scan, without a period"),
};

#undef CHOICE

constexpr PolicyConflict kNotSynchronous = {
    "no period that its inputs and outputs could be synchronous with",
    "give it an INTERVAL alone, or leave the attribute `io` out"};
constexpr PolicyConflict kOwnIsNotSynchronous = {
    "an exchange of its own with each scan, so its inputs and outputs cannot be synchronous",
    "leave one of the attributes `io` and `exchange` out"};
constexpr PolicyConflict kNothingStaysUnseen = {
    "an exchange of its own with each scan, so `first_unseen` has nothing to keep",
    "leave the attribute `exchange` out, or give it another buffer"};
constexpr PolicyConflict kNothingToLengthenFor = {
    "no period at whose end the control cycle could be lengthened",
    "give it an INTERVAL alone, or another `overrun`"};
constexpr PolicyConflict kNeverLate = {
    "no releases that could find its scan running",
    "leave the attribute `overrun` out: a freewheeling task is released when its scan has ended"};
constexpr PolicyConflict kOldInputs = {
    "inputs that are synchronous with its period, so it cannot start at once with the newest",
    "leave the attribute `io` out, or give it another `overrun`"};

}  // namespace

const PolicyConflict* policy_conflict(const TaskPolicy& policy, bool periodic) {
  const bool synchronous = policy.io == TaskIo::kSynchronous;
  if (synchronous && !periodic) return &kNotSynchronous;
  if (policy.exchange == TaskExchange::kOwn) {
    if (synchronous) return &kOwnIsNotSynchronous;
    const bool keeps_first = policy.input_buffer == IoBuffer::kFirstUnseen ||
                             policy.output_buffer == IoBuffer::kFirstUnseen;
    if (keeps_first) return &kNothingStaysUnseen;
  }
  if (policy.overrun == Overrun::kLengthen && !periodic) return &kNothingToLengthenFor;
  if (policy.overrun != Overrun::kAtOnce) return nullptr;
  if (policy.freewheeling) return &kNeverLate;
  return synchronous ? &kOldInputs : nullptr;
}

TaskChoices task_choices() { return {std::begin(kChoices), std::end(kChoices)}; }

const TaskChoice* find_task_choice(std::string_view attribute, std::string_view value) {
  for (const TaskChoice& choice : kChoices) {
    if (base::same_name(choice.attribute, attribute) && base::same_name(choice.text, value))
      return &choice;
  }
  return nullptr;
}

namespace {
constexpr std::string_view kSchedules[kScheduleCount] = {"send_first", "run_first"};
}  // namespace

std::string_view schedule_text(Schedule schedule) {
  return kSchedules[static_cast<size_t>(schedule)];
}

std::optional<Schedule> schedule_of(std::string_view text) {
  for (uint32_t i = 0; i < kScheduleCount; ++i) {
    if (base::same_name(kSchedules[i], text)) return static_cast<Schedule>(i);
  }
  return std::nullopt;
}

bool apply_policy(TaskPolicy& policy, std::string_view attribute, std::string_view value) {
  const TaskChoice* choice = find_task_choice(attribute, value);
  if (choice != nullptr) choice->apply(policy);
  return choice != nullptr;
}

std::string policy_text(const TaskPolicy& policy) {
  std::string text;
  for (const TaskChoice& choice : kChoices) {
    if (!choice.holds(policy) || choice.holds(TaskPolicy{})) continue;
    text += " " + std::string(choice.attribute);
    if (!choice.text.empty()) text += " " + std::string(choice.text);
  }
  return text;
}

}  // namespace ir
