// The commands of an online change, as the serving controller carries them out.
#include <algorithm>

#include "base/limits.h"
#include "online_change/apply/deadline.h"
#include "online_change/plan/pause.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/shown_edits.h"

namespace stvm {

using online_change::Change;
using online_change::Exits;
using online_change::Losses;

namespace {

// A switch that finds too little time before the next cycle is tried again after it.
constexpr int kSwitchAttempts = 200;
// So many times in turn without any idle time, and a change that needs some is given up.
constexpr int kIdleAttempts = 200;
// By standby, so often in all, when the program writes more than it did before.
constexpr int kMostTries = 8;

}  // namespace

// Undo too takes its time from the next cycle.
bool ControllerService::time_for_switch() const {
  int64_t left = controller_.next_cycle_ns() - clock_.now_ns();
  const int64_t needs = online_change::with_reserve(change_.predicted_pause_ns());
  return left > needs + 2 * keeper_.copy_ns();  // before and after
}

// A pass begins in another cycle than the one before it, however long that takes; what counts are
// cycles without any idle time.
base::Result<bool> ControllerService::work_in_idle_time(base::Result<bool> (Change::*work)()) {
  base::Result<bool> done = false;
  uint64_t cycle = UINT64_MAX;
  bool stands = false;
  for (int idle_less = 0; idle_less < kIdleAttempts;) {
    if (aborted()) return abort_error();
    const uint64_t left = change_.units_left();
    bool other_cycle = false;
    base::Status taken = at_boundary([&] {
      if (unless_holds()) return;
      done = (change_.*work)();
      other_cycle = std::exchange(cycle, controller_.cycles()) != cycle;
      stands = controller_.faulted() || stands_;
    });
    if (!taken.ok()) return taken.error();
    if (!done.ok() || *done || stands) return done;
    if (change_.units_left() != left) {
      idle_less = 0;
    } else if (other_cycle) {
      ++idle_less;
    } else {
      boundary_.pause(kBetweenAttemptsNs);
    }
  }
  return false;
}

base::Status ControllerService::configure(bool allow_overrun) {
  base::Result<bool> done = work_in_idle_time(&Change::configure);
  if (!done.ok()) return done.error();
  if (allow_overrun) return base::Ok{};  // arm() does the rest
  if (*done) return catch_up();
  change_.cancel();
  return base::Error{base::Refusal::kDeadline,
                     "the tasks leave no idle time to prepare the change in; the old program "
                     "runs on"};
}

// Whether what it leaves fits is said by admit().
base::Status ControllerService::catch_up() {
  base::Result<bool> done = work_in_idle_time(&Change::catch_up);
  return done.ok() ? base::Status(base::Ok{}) : done.error();
}

base::Status ControllerService::arm_in_time(bool allow_loss, bool allow_overrun,
                                            base::Status& armed) {
  bool tried = false;
  for (int attempt = 1; !tried; ++attempt) {
    if (attempt != 1) boundary_.pause(kBetweenAttemptsNs);
    if (aborted()) return abort_error();
    base::Status taken = at_boundary([&] {
      if (unless_holds()) return;
      armed = change_.admit(allow_overrun);
      const bool now = allow_overrun || time_for_switch() || attempt == kSwitchAttempts;
      if (armed.ok() && !now) return;
      if (armed.ok()) armed = change_.arm(allow_loss, allow_overrun);
      tried = true;
    });
    if (!taken.ok()) return taken;
  }
  return base::Ok{};
}

base::Result<online_change::SwitchReport> ControllerService::switch_in_time(
    bool allow_overrun, online_change::Snapshot& before, uint64_t& missed_before,
    int64_t& done_ns) {
  std::optional<base::Result<online_change::SwitchReport>> report;
  before = empty_snapshot();
  online_change::Snapshot after = empty_snapshot();
  const auto nobody_else_saves = keeper_.hold();
  std::optional<online_change::Deadline> deadline;
  int tries = 0;
  auto job = [&] {
    if (unless_holds()) return;
    if (!allow_overrun && !time_for_switch()) return;
    if (controller_.start_pending() && !controller_.faulted() && !stands_) return;
    keeper_.take(before);
    if (!allow_overrun) {
      deadline.emplace(clock_, controller_.next_cycle_ns());
      change_.set_interruption(std::ref(*deadline));  // as a copy it would be allocated here
    }
    missed_before = controller_.missed_releases();
    report.emplace(change_.switch_now(++tries < kMostTries));
    if (report->ok() && controller_.faulted()) go_on_hot();
    done_ns = clock_.now_ns();
    change_.set_interruption(nullptr);
    if (!report->ok()) return;
    keeper_.take(after);
    guard_.begin();
  };
  const auto is_armed = [&] { return change_.state() == online_change::State::kArmed; };
  for (int attempt = 0; attempt < kSwitchAttempts && !report; ++attempt) {
    if (attempt != 0) boundary_.pause(kBetweenAttemptsNs);
    if (aborted()) return abort_error();
    base::Status taken = at_boundary(job);
    if (!taken.ok()) return taken.error();
    if (!report || report->ok() || !is_armed()) continue;
    report.reset();  // more had been written than the last pass found
    if (base::Status caught_up = catch_up(); !caught_up.ok()) return caught_up.error();
  }
  if (report) {
    if (report->ok()) {
      complain(keeper_.save_held(before));
      complain(keeper_.save_held(after));
    }
    return std::move(*report);
  }
  const std::string expected = std::to_string(change_.predicted_pause_ns());
  change_.cancel();
  return base::Error{base::Refusal::kDeadline,
                     "no cycle left time enough for the switch, which is expected to take " +
                         expected + " ns; the old program runs on"};
}

// Releases that the switch made late are known only when the next cycles have been. The switch has
// been made: when no boundary comes any more, what is known is the answer.
online_change::SwitchReport ControllerService::finish_report(online_change::SwitchReport report,
                                                             uint64_t missed_before,
                                                             int64_t done_ns) {
  for (int attempt = 0; attempt < kSwitchAttempts; ++attempt) {
    uint64_t cycles = 0;
    base::Status taken = at_boundary([&] {
      cycles = controller_.cycles();
      report.missed = controller_.missed_releases() - missed_before;
    });
    if (!taken.ok()) break;
    if (cycles > report.cycle_after || controller_.faulted()) break;
    boundary_.pause(kBetweenAttemptsNs);
  }
  report.ago_ns = clock_.now_ns() - done_ns;
  return report;
}

// What is staged stays so where only this attempt has failed.
base::Error ControllerService::not_switched(const base::Error& why) {
  preparing_ = false;
  if (!abort_why_.empty()) return give_up();
  base::Error error = refused(why);
  if (!change_.prepares()) forget_staged();
  return error;
}

base::Status ControllerService::prepare_switch(const vm::Request& request, Trial& next,
                                               bool faulted, bool allow_overrun) {
  const std::string health = request.names.empty() ? std::string() : request.names.front();
  base::Status ready = check_health(health, staged_->image());
  if (ready.ok() && !faulted) ready = configure(allow_overrun);
  if (!ready.ok()) return not_switched(ready.error());
  const bool allow_loss = (request.flags & vm::kAllowLoss) != 0;
  base::Status taken = arm_in_time(allow_loss, allow_overrun, ready);
  if (!taken.ok()) return not_switched(taken.error());
  if (!ready.ok()) return not_switched(ready.error());
  base::Status stored = admission_.take(signer_, wall_time_());
  if (stored.ok()) stored = store_trial(next);
  if (!stored.ok()) {
    change_.cancel();
    return not_switched(stored.error());
  }
  // Storing takes its time, and the program writes on.
  if (!allow_overrun) ready = catch_up();
  if (ready.ok()) return ready;
  change_.cancel();
  let_store_follow();
  return not_switched(ready.error());
}

base::Result<base::Bytes> ControllerService::make_switch(const vm::Request& request) {
  if (only_looked_at_) {
    return base::Error{base::Refusal::kBusy, "what is staged is a dry run; stage the change anew"};
  }
  if (base::Status kept = check_not_aborted(); !kept.ok()) return kept.error();
  if (base::Status same = check_staged(request); !same.ok()) return same.error();
  if (has_no_program()) return switch_to_first();
  preparing_ = true;
  bool faulted = false;
  base::Status taken = look_at_boundary([&] { faulted = controller_.faulted(); });
  if (!taken.ok()) return not_switched(taken.error());
  // Nothing runs that could be delayed.
  const bool allow_overrun = faulted || (request.flags & vm::kAllowOverrun) != 0;
  Trial trial{describe_staged(), controller_.verified(), staged_package_,
              staged_flags_,     request.flags,          {}};
  // Whoever brings an edit again has no project that says so.
  if (!redone_.empty()) trial.switch_flags |= undone_.back().switch_flags & vm::kLastEditBoots;
  if (guard_.is_staged()) trial.switch_flags &= ~vm::kLastEditBoots;  // X6-08
  trial.taken_out = taken_out_;
  trial.signer = signer_;
  trial.edit.name = redone_.empty() ? "E" + std::to_string(edits_made_ + 1) : redone_;
  base::Status ready = prepare_switch(request, trial, faulted, allow_overrun);
  if (!ready.ok()) return ready.error();
  const int64_t predicted_ns = change_.predicted_pause_ns();
  uint64_t missed_before = 0;
  int64_t done_ns = 0;
  auto report = switch_in_time(allow_overrun, trial.retained, missed_before, done_ns);
  change_.collect();
  if (!report.ok()) {
    change_.cancel();
    let_store_follow();
    return not_switched(report.error());
  }
  preparing_ = false;
  begin_or_end_chain(trial);
  ++edition_;
  note_edit(std::move(trial), *report, predicted_ns);
  forget_staged();
  forget_rehearsal();
  begin_probation(request);
  if ((request.flags & vm::kPermanent) != 0) {
    base::Status permanent = make_permanent();
    if (!permanent.ok()) return permanent.error();
  }
  return encode(finish_report(*report, missed_before, done_ns));
}

// Done first and then recorded: after a power cut in between it boots the same program. Where no
// cycle leaves time enough it is done all the same: it is what people ask for when something is
// wrong.
base::Result<base::Bytes> ControllerService::undo(const vm::Request& request) {
  base::Status newest = check_newest(request);
  if (!newest.ok()) return newest.error();
  Exits exits = Exits::kRun;
  Losses losses = Losses::kRefused;
  for (size_t i = 1; i < request.names.size(); ++i) {
    if (request.names[i] == vm::kWithoutExit) {
      exits = Exits::kSkip;
    } else if (request.names[i] == vm::kWithLoss) {
      losses = Losses::kAllowed;
    } else {
      return base::Error{base::Refusal::kProtocol, "an undo in a way that is not known here"};
    }
  }
  return undo_now({}, exits, losses);
}

base::Result<base::Bytes> ControllerService::undo_now(const std::string& why, Exits exits,
                                                      Losses losses) {
  if (change_.prepares() && !trials_.empty()) {  // an edit on top of the one that goes
    abort_why_ = "because the edit below it was undone";
    (void)give_up();
  }
  if (base::Status primed = change_.prime(); !primed.ok()) return refused(primed.error());
  std::optional<base::Result<online_change::SwitchReport>> report;
  uint64_t missed_before = 0;
  int64_t done_ns = 0;
  const int64_t predicted_ns = change_.predicted_pause_ns();
  const base::Digest undone = controller_.verified().digest();
  std::string left_out;
  if (exits == Exits::kSkip) left_out = instances_text(controller_.image(), change_.leaving());
  online_change::Snapshot after = empty_snapshot();
  for (int attempt = 1; !report; ++attempt) {
    if (attempt != 1) boundary_.pause(kBetweenAttemptsNs);
    base::Status taken = at_boundary([&] {
      const bool stopped = controller_.faulted() || stopping_trap(UINT64_MAX) != nullptr;
      if (!stopped && !time_for_switch() && attempt != kSwitchAttempts) return;
      missed_before = controller_.missed_releases();
      report.emplace(change_.undo(exits, losses));
      if (report->ok() && stopped) go_on_hot();
      done_ns = clock_.now_ns();
      if (!report->ok()) return;
      keeper_.take(after);
      guard_.end();
    });
    if (!taken.ok()) return taken.error();
  }
  if (!report->ok()) return refused(report->error());
  change_.collect();
  undone_.push_back(std::move(trials_.back()));
  trials_.pop_back();
  let_store_follow();
  complain(keeper_.save(after));
  note_units("undone", (*report)->cycle_after);
  note_switch(online_change::Event::kUndone, undone, **report, predicted_ns,
              undone_text(undone_.back().edit.name, left_out, why));
  not_undone_.clear();
  given_back_.clear();
  forget_rehearsal();
  probation_.reset();
  ++edition_;
  changed_by_ = who_;
  return encode(finish_report(**report, missed_before, done_ns));
}

// From what is prepared to an edit on trial, under the name that it had before it was undone.
void ControllerService::note_edit(Trial trial, const online_change::SwitchReport& report,
                                  int64_t predicted_ns) {
  if (redone_.empty()) {
    ++edits_made_;
    undone_.clear();  // of them none can be brought again
  } else {
    undone_.pop_back();
  }
  given_back_.clear();
  trial.edit.cycle = report.cycle_after;
  trials_.push_back(std::move(trial));
  changed_by_ = who_;
  switched_cycle_ = report.cycle_before;
  note_units("switched", report.cycle_after);
  note_switch(online_change::Event::kSwitched, previous()->digest(), report, predicted_ns,
              "edit " + trials_.back().edit.name + (note_.empty() ? "" : ", " + note_) +
                  (trials_.back().signer ? ", signed by " + trials_.back().signer->by : ""));
  if (last_edit_boots() || trials_.size() > 1)
    complain(keep_edits());  // with the values of the boundary
}

}  // namespace stvm
