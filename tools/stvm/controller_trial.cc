// What the controller does by itself in the first cycles of a version on trial (X7): when a trap
// stops it, or its health condition fails, the version before comes back.
#include "ir/bytecode/variable_names.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/trap_text.h"

namespace stvm {

// A BOOL of the next version.
base::Status ControllerService::check_health(const std::string& name, const ir::Image& next) {
  if (name.empty()) return base::Ok{};
  base::Result<ir::Symbol> symbol = ir::named_symbol(next, name);
  if (!symbol.ok()) return symbol.error();
  if (next.types[symbol->type].kind == ir::Kind::kBool) return base::Ok{};
  return base::Error{base::Refusal::kBadValue,
                     "the health condition `" + name + "` is " + next.types.text(symbol->type) +
                         "; name a BOOL that stays TRUE while all is well"};
}

const vm::TrapRecord* ControllerService::stopping_trap(uint64_t end) const {
  const vm::Traps& traps = controller_.traps();
  for (auto trap = traps.rbegin(); trap != traps.rend(); ++trap) {
    if ((*trap)->cycle < switched_cycle_) break;
    if ((*trap)->cycle >= end) continue;
    if (controller_.faulted()) return trap->get();
    for (const ir::ImageTask& task : controller_.image().tasks) {
      const bool stops = task.policy.on_trap == ir::OnTrap::kStopTask;
      if (stops && ir::same_name(task.name, (*trap)->task)) return trap->get();
    }
  }
  return nullptr;
}

void ControllerService::begin_probation(const vm::Request& request) {
  probation_.reset();
  if ((request.flags & (vm::kNoWayBack | vm::kPermanent)) != 0) return;
  Probation next;
  next.edit = trials_.back().edit.name;
  if (!request.names.empty()) next.health = request.names.front();
  if (!next.health.empty()) {
    base::Result<ir::Symbol> symbol = ir::named_symbol(controller_.image(), next.health);
    if (symbol.ok()) next.health_data = symbol->data;
  }
  next.ends = switched_cycle_ + kProbationCycles;
  probation_ = std::move(next);
}

std::string ControllerService::look_at_trial() {
  std::string trap;
  bool sick = false;
  bool over = false;
  base::Status taken = look_at_boundary([&] {
    over = controller_.cycles() >= probation_->ends;
    const vm::TrapRecord* const stopping = stopping_trap(probation_->ends);
    if (stopping != nullptr) trap = trap_text(*stopping);
    const uint32_t health = probation_->health_data;
    sick = health != 0 && controller_.memory().data()[health] == 0;
  });
  if (!taken.ok()) return {};
  if (!trap.empty()) return "a trap on trial: " + trap;
  if (sick) return "the health condition `" + probation_->health + "` is FALSE on trial";
  if (over) probation_.reset();
  return {};
}

// Conditions of the trial of the staged change; of a dry run they are checked only.
base::Result<base::Bytes> ControllerService::guard(const vm::Request& request) {
  base::Result<GuardOrder> order = decode_guard_order(request.data);
  if (!order.ok()) return order.error();
  if (base::Status there = check_not_gone(); !there.ok()) return there.error();
  const online_change::Change& change = looked_at();
  if (change.next() == nullptr) return base::Error{base::Refusal::kBusy, "no change is staged"};
  if (has_no_program()) {
    return base::Error{base::Refusal::kNothingToUndo, "a first program is not on trial"};
  }
  // Else the trial of somebody else would end with it.
  if (!trials_.empty()) {
    return base::Error{base::Refusal::kChangePending,
                       "an edit is on trial here; accept or undo it before the roll-out"};
  }
  const bool only_checked = rehearses() || only_looked_at_;
  const ir::Image& next = change.next()->image();
  if (only_checked) {
    base::Status sound = TrialGuard::check(*order, next);
    return sound.ok() ? base::Result<base::Bytes>(base::Bytes{}) : sound.error();
  }
  // The control thread may look at what an order before this one asked for: first it stops.
  base::Status taken = look_at_boundary([&] { guard_.forget(); });
  if (taken.ok()) taken = guard_.stage(std::move(*order), controller_.image(), next);
  if (taken.ok()) taken = look_at_boundary([&] { guard_.collect(); });
  if (taken.ok()) return base::Bytes{};
  return only_checked ? taken.error() : refused(taken.error());
}

void ControllerService::watch_trial() {
  if (guard_.looks_aside()) {
    if (const auto cause = guard_.look_aside(!store_.complaints().empty())) {
      base::Status failed = look_at_boundary([&] { guard_.fail(*cause); });
      if (!failed.ok()) return;
    }
  }
  if (guard_.has_failed()) return give_back(guard_.why());
  if (!probation_) return;
  if (trials_.empty() || trials_.back().edit.name != probation_->edit) {
    probation_.reset();
    return;
  }
  const std::string why = look_at_trial();
  if (!why.empty()) give_back(why);
}

bool ControllerService::is_incomplete() const {
  return !trials_.empty() && (trials_.back().switch_flags & vm::kMoreToCome) != 0;
}

void ControllerService::begin_or_end_chain(Trial& trial) {
  const bool goes_on = more_of_ != 0 && more_of_ == session_ && is_incomplete();
  const bool more = (trial.switch_flags & vm::kMoreToCome) != 0;
  if (goes_on) trial.chain = trials_.back().chain;
  if (more && !goes_on) trial.chain = ++chains_;
  if (more || goes_on) more_of_ = more ? session_ : 0;
}

// With all that came before it as parts of the same (E-26). An FB_Exit that traps is left out then:
// it is one of the version that must go. Once: what cannot be undone stays as it is, for people to
// look at.
void ControllerService::give_back(const std::string& why) {
  who_ = "controller";
  probation_.reset();
  const uint64_t chain = trials_.back().chain;
  std::string edits;
  Answer undone = base::Bytes();
  do {
    edits += (edits.empty() ? "" : ", ") + trials_.back().edit.name;
    vm::Request request{.command = vm::Command::kUndo};
    request.expected = controller_.verified().digest();
    request.edition = edition_;
    request.names = {trials_.back().edit.name, vm::kWithLoss};
    undone = undo_now(why, online_change::Exits::kRun, online_change::Losses::kAllowed);
    if (!undone.ok() && undone.error().refusal == base::Refusal::kExitFailed) {
      request.names.push_back(vm::kWithoutExit);
      undone = undo_now(why, online_change::Exits::kSkip, online_change::Losses::kAllowed);
    }
    if (recorder_ != nullptr) {
      undone.ok() ? recorder_->note(vm::encode(request)) : recorder_->forget_jobs();
    }
  } while (undone.ok() && chain != 0 && !trials_.empty() && trials_.back().chain == chain);
  if (undone.ok()) {
    given_back_ = edits + kGivenBackMark + time_text(wall_time_()) + ": " + why;
    return;
  }
  not_undone_ = "the version on trial was not undone after " + why + ": " +
                base::to_string(undone.error()) + "; `stvm undo` tries again";
  // No boundary came: it is tried again.
  if (!guard_.has_failed() || undone.error().refusal == base::Refusal::kBusy) return;
  guard_.give_up();
  if (!guard_.stops_safe()) return;
  stopped_by_ = "controller";
  stop_wanted_.store(true, std::memory_order_release);
}

// At a boundary, after a switch or an undo, when a trap had stopped something: tasks run again
// with the values that they have, and what is new begins.
void ControllerService::go_on_hot() {
  (void)controller_.restart(vm::Restart::kHot, kExitLimitNs).ok();  // nothing leaves
  controller_.construct();
}

}  // namespace stvm
