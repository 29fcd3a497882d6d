// TASK: when the programs run.
#include "frontend/sema/configuration/configuration.h"
#include "frontend/sema/configuration/task_attributes.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"
#include "ir/types/longest_time.h"

namespace frontend {
namespace {

constexpr int64_t kMaxPriority = 65535;

}  // namespace

void Configuration::add_task(const TaskDecl& decl, const ResourceDecl& resource) {
  for (const TaskDecl& other : resource.tasks) {
    if (&other == &decl) break;
    check_once(decl.name, other.name);
  }
  ir::Task task;
  task.name = decl.name.text;
  task.period_ns = decl.single.valid() ? 0 : kDefaultPeriodNs;
  if (decl.single.valid()) task.event = event_of(decl.single);
  if (decl.interval.valid()) {
    auto period =
        ask<Constants>().fold_bits(decl.interval, sema_.program.types.elementary(ir::Kind::kTime));
    task.period_ns = period ? static_cast<int64_t>(*period) : kDefaultPeriodNs;
    // With SINGLE, an interval of 0 means that edges alone release the task.
    const bool too_long = task.period_ns > ir::kLongestTimeNs;
    if (too_long || task.period_ns < 0 || (task.period_ns == 0 && task.event == ir::kNoEvent)) {
      error(DiagnosticCode::kBadInterval, decl.span,
            "task " + quoted(decl.name) + " has the interval " + std::to_string(task.period_ns) +
                " ns");
      task.period_ns = kDefaultPeriodNs;
    }
  }
  if (decl.priority.valid()) {
    int64_t priority = ask<Constants>().fold_integer(decl.priority).value_or(0);
    if (priority < 0 || priority > kMaxPriority) {
      error(DiagnosticCode::kBadPriority, decl.span,
            "task " + quoted(decl.name) + " has the priority " + std::to_string(priority),
            "use 0 (highest) to " + std::to_string(kMaxPriority));
      priority = 0;
    }
    task.priority = static_cast<uint32_t>(priority);
  }
  apply_task_attributes(*this, decl, task);
  sema_.program.tasks.push_back(std::move(task));
}

// SINGLE := variable: a BOOL among the globals.
uint32_t Configuration::event_of(ExprId id) {
  const Expr& expr = sema_.tree[id];
  const Note note = infer(id);
  if (!note.type.valid()) return ir::kNoEvent;
  bool boolean = sema_.program.types.root_kind(note.type) == ir::Kind::kBool;
  if (note.view) {
    error(DiagnosticCode::kBadEvent, expr.span, "SINGLE needs a BOOL that shares no bytes",
          "copy the bit to a global variable of its own");
    return ir::kNoEvent;
  }
  if (boolean && expr.kind == ExprKind::kDirect) return ask<Variables>().direct_member(expr);
  if (boolean && note.variable.valid()) {
    const Variable& variable = resolve(note.variable);
    if (variable.storage == Storage::kGlobal && !variable.constant) return variable.index;
  }
  error(DiagnosticCode::kBadEvent, expr.span, "SINGLE needs a global variable of type BOOL",
        "declare it in VAR_GLOBAL; the task runs at each of its rising edges");
  return ir::kNoEvent;
}

}  // namespace frontend
