#include "frontend/sema/configuration/task_attributes.h"

#include <numeric>
#include <optional>

#include "base/limits.h"
#include "frontend/lex/literals.h"
#include "frontend/sema/quoted.h"

namespace frontend {
namespace {

using Code = base::DiagnosticCode;

void apply_watchdog(const Phase& phase, const TaskDecl& decl, const Attribute& attribute,
                    ir::Task& task) {
  const DecodedTime time = decode_duration(attribute.value);
  if (!time.problem && !time.negative && time.ns > 0 && time.ns <= INT64_MAX) {
    task.watchdog_ns = static_cast<int64_t>(time.ns);
    return;
  }
  phase.error(Code::kBadTaskPolicy, attribute.name.span,
              "the watchdog of task " + quoted(decl.name.text) + " is no duration above zero",
              "write it as in {attribute 'watchdog' := 'T#50ms'}");
}

void apply_choice(const Phase& phase, const TaskDecl& decl, const Attribute& attribute,
                  ir::Task& task) {
  if (ir::apply_policy(task.policy, attribute.name.text, attribute.value)) return;
  std::string known;
  bool is_policy = false;
  for (const ir::TaskChoice& choice : ir::task_choices()) {
    if (!ir::same_name(choice.attribute, attribute.name.text)) continue;
    is_policy = true;
    known += (known.empty() ? "" : ", ") + std::string(choice.text);
  }
  if (!is_policy) return;
  phase.error(Code::kBadTaskPolicy, attribute.name.span,
              "the attribute " + quoted(attribute.name.text) + " of task " +
                  quoted(decl.name.text) + " cannot be " + quoted(attribute.value),
              known.empty() ? "it takes no value" : "write one of " + known);
}

// Has a freewheeling task an `overrun`? It is not refused by ir::policy_conflict, because images
// may have it: it does nothing.
bool has_idle_overrun(const ir::TaskPolicy& policy) {
  return policy.overrun == ir::Overrun::kStretch || policy.overrun == ir::Overrun::kFault;
}

}  // namespace

void apply_task_attributes(const Phase& phase, const TaskDecl& decl, ir::Task& task) {
  for (uint32_t i = 0; i < decl.attributes.count; ++i) {
    const Attribute& attribute = phase.sema().tree.attributes[decl.attributes.first + i];
    if (ir::same_name(attribute.name.text, "watchdog")) {
      apply_watchdog(phase, decl, attribute, task);
    } else {
      apply_choice(phase, decl, attribute, task);
    }
  }
  if (task.policy.freewheeling && has_idle_overrun(task.policy)) {
    phase.error(
        Code::kBadTaskPolicy, decl.span,
        "task " + quoted(decl.name.text) + " is freewheeling: no release finds its scan running",
        "leave the attribute `overrun` out");
  }
  const bool periodic = !decl.single.valid() && !task.policy.freewheeling;
  if (const ir::PolicyConflict* conflict = ir::policy_conflict(task.policy, periodic)) {
    phase.error(Code::kBadTaskPolicy, decl.span,
                "task " + quoted(decl.name.text) + " has " + std::string(conflict->text),
                std::string(conflict->way_out));
    task.policy.io = ir::TaskIo::kNewest;
    task.policy.overrun = ir::Overrun::kSkip;
    task.policy.exchange = ir::TaskExchange::kOfCycle;
  }
  if (!task.policy.freewheeling) return;
  if (decl.interval.valid() || decl.single.valid()) {
    phase.error(Code::kBadTaskPolicy, decl.span,
                "task " + quoted(decl.name.text) + " is freewheeling and has INTERVAL or SINGLE",
                "leave one of them out");
  }
  task.period_ns = 0;
  task.event = ir::kNoEvent;
}

void apply_schedule(const Phase& phase, const Name& owner, Range32 attributes) {
  for (uint32_t i = 0; i < attributes.count; ++i) {
    const Attribute& attribute = phase.sema().tree.attributes[attributes.first + i];
    if (!ir::same_name(attribute.name.text, ir::kScheduleAttribute)) continue;
    const std::optional<ir::Schedule> schedule = ir::schedule_of(attribute.value);
    if (schedule) {
      phase.sema().program.schedule = *schedule;
      continue;
    }
    phase.error(Code::kBadTaskPolicy, attribute.name.span,
                "the attribute `schedule` of " + quoted(owner.text) + " cannot be " +
                    quoted(attribute.value),
                "write one of send_first, run_first");
  }
}

void check_base_cycle(const Phase& phase, const std::vector<TaskDecl>& decls) {
  constexpr auto kLeast = static_cast<int64_t>(base::kMinBaseCycleNs);
  const size_t first = phase.sema().program.tasks.size() - decls.size();
  int64_t base = 0;
  for (size_t i = 0; i < decls.size(); ++i) {
    const ir::Task& task = phase.sema().program.tasks[first + i];
    if (task.period_ns <= 0) continue;
    base = std::gcd(base, task.period_ns);
    if (base >= kLeast) continue;
    phase.error(Code::kBadInterval, decls[i].span,
                "with the interval of task " + quoted(task.name) + " the control cycle has " +
                    std::to_string(base) + " ns",
                "let all intervals be multiples of one that is at least " +
                    std::to_string(kLeast / 1000) + " us");
    return;
  }
}

}  // namespace frontend
