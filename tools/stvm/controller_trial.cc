// What the controller does by itself in the first cycles of a version on trial (X7): when a trap
// stops it, or its health condition fails, the version before comes back.
#include "ir/bytecode/symbols.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/trap_text.h"

namespace stvm {

// A BOOL of the staged version.
base::Status ControllerService::check_health(const std::string& name) const {
  if (name.empty() || !staged_) return base::Ok{};
  const ir::Image& next = staged_->image();
  base::Result<ir::Symbol> symbol = ir::find_symbol(next, name);
  if (!symbol.ok()) return symbol.error();
  if (next.types[symbol->type].kind == ir::Kind::kBool) return base::Ok{};
  return base::Error{base::Refusal::kBadValue,
                     "the health condition `" + name + "` is " + next.types.text(symbol->type) +
                         "; name a BOOL that stays TRUE while all is well"};
}

uint64_t ControllerService::stopped_tasks() const {
  uint64_t stopped = 0;
  for (const vm::TaskStatus& task : controller_.tasks()) stopped += task.stopped ? 1 : 0;
  return stopped;
}

void ControllerService::begin_probation(const vm::Request& request) {
  probation_.reset();
  if ((request.flags & (vm::kNoWayBack | vm::kPermanent)) != 0) return;
  Probation next{0, request.names.empty() ? std::string() : request.names.front(), edition_};
  base::Status taken =
      look_at_boundary([&] { next.ends = controller_.cycles() + kProbationCycles; });
  if (taken.ok()) probation_ = std::move(next);
}

std::string ControllerService::look_at_trial() {
  std::string why;
  bool over = false;
  base::Status taken = look_at_boundary([&] {
    const bool trapped = controller_.faulted() || stopped_tasks() > stopped_before_;
    over = controller_.cycles() >= probation_->ends;
    if (trapped && !controller_.traps().empty()) {
      why = "a trap on trial: " + trap_text(*controller_.traps().back());
    } else if (!probation_->health.empty()) {
      const base::Result<std::string> healthy = controller_.get(probation_->health);
      if (healthy.ok() && *healthy == "FALSE") {
        why = "the health condition `" + probation_->health + "` is FALSE on trial";
      }
    }
  });
  if (taken.ok() && over && why.empty()) probation_.reset();
  return why;
}

void ControllerService::watch_trial() {
  if (!probation_) return;
  if (change_.state() != online_change::State::kTrial || probation_->edition != edition_) {
    probation_.reset();
    return;
  }
  const std::string why = look_at_trial();
  if (!why.empty()) give_back(why);
}

// Once: what cannot be undone stays as it is, for people to look at.
void ControllerService::give_back(const std::string& why) {
  who_ = "controller";
  probation_.reset();
  vm::Request request{.command = vm::Command::kUndo};
  request.expected = controller_.verified().digest();
  request.edition = edition_;
  const Answer undone = undo_now(why);
  if (recorder_ != nullptr) {
    undone.ok() ? recorder_->note(vm::encode(request)) : recorder_->forget_jobs();
  }
  if (undone.ok()) return;
  start_.alarms.push_back("the version on trial was not undone after " + why + ": " +
                          base::to_string(undone.error()));
}

// After a fault, or when the version on trial has stopped a task: tasks run again with the values
// that they have, and what is new begins.
void ControllerService::go_on_hot() {
  complain(at_boundary([&] {
    if (!controller_.faulted() && stopped_tasks() <= stopped_before_) return;
    (void)controller_.restart(vm::Restart::kHot, kExitLimitNs).ok();  // nothing leaves
    controller_.construct();
  }));
}

}  // namespace stvm
