// The commands of an online change, as the serving controller carries them out.
#include <algorithm>

#include "base/limits.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/deadline.h"

namespace stvm {
namespace {

// A switch that finds too little time before the next cycle is tried again after it.
constexpr int kSwitchAttempts = 200;
// So many times in turn without any idle time, and a change that needs some is given up.
constexpr int kIdleAttempts = 200;

}  // namespace

// One at a time: whoever begins one ends that of another connection, which is told so.
base::Result<base::Bytes> ControllerService::upload(const vm::Request& request) {
  if (request.offset == 0) {
    upload_ = base::Bytes();
    upload_of_ = session_;
    upload_by_ = who_;
  }
  if (upload_of_ != session_ && !upload_.empty()) return others_upload();
  if (upload_of_ != session_ || request.offset != upload_.size()) {
    return base::Error{base::Refusal::kProtocol, "parts of the package are missing"};
  }
  if (upload_.size() + request.data.size() > base::kMaxImageBytes) {
    return base::Error{base::Refusal::kTooLarge, "the package is longer than the limit"};
  }
  upload_.insert(upload_.end(), request.data.begin(), request.data.end());
  return base::Bytes{};
}

base::Error ControllerService::others_upload() const {
  return {base::Refusal::kChangePending, upload_by_ + " brings another change just now"};
}

base::Status ControllerService::check_upload(const vm::Request& request,
                                             base::ByteSpan package) const {
  // What never ran has no values that a change could carry over.
  if (!start_.fault.empty()) return base::Error{base::Refusal::kFault, start_.fault};
  if (base::sha256(package) == request.digest) return base::Ok{};
  return base::Error{base::Refusal::kBadHash, "the package arrived damaged"};
}

// Checks and builds beside the running program; touches nothing of it, so it needs no boundary. A
// change that somebody staged and did not switch gives way, and the new edition, which is the
// answer, makes sure that nobody switches what he did not stage. A rehearsal never takes its place.
base::Result<base::Bytes> ControllerService::stage(const vm::Request& request) {
  if (upload_of_ != session_) return others_upload();
  const base::Bytes package = std::exchange(upload_, {});
  if (base::Status good = check_upload(request, package); !good.ok()) return good.error();
  const bool standby = (request.flags & vm::kByStandby) != 0;
  const auto strategy =
      standby ? online_change::Strategy::kStandby : online_change::Strategy::kInPlace;
  const bool rehearsal = (request.flags & vm::kRehearsal) != 0;
  const bool taken = change_.state() != online_change::State::kIdle && !only_looked_at_;
  if (rehearsal && taken) return stage_rehearsal(package, strategy);
  change_.cancel();
  forget_staged();
  only_looked_at_ = rehearsal;
  base::Status staged =
      change_.stage(package, strategy, [this](const auto& job) { return at_boundary(job); });
  if (!staged.ok()) {
    change_.collect();  // devices that it opened
    const base::Error error = refused(staged.error());
    forget_staged();
    return error;
  }
  staged_ = *change_.next();
  if (!rehearsal) {
    online_change::JournalEntry done = entry(online_change::Event::kStaged);
    done.counts = change_.plan().counts;
    done.predicted_ns = change_.plan().predicted_pause_ns;
    store_.note(std::move(done));
  }
  changed_by_ = who_;
  base::ByteWriter answer;
  answer.u64(++edition_);
  return answer.take();
}

base::Result<base::Bytes> ControllerService::stage_rehearsal(base::ByteSpan package,
                                                             online_change::Strategy strategy) {
  rehearsal_.reset();
  forget_report();
  auto staged = Rehearsal::stage(controller_, package, strategy,
                                 [this](auto ranges) { return copy_of(std::move(ranges)); });
  if (!staged.ok()) return staged.error();
  rehearsal_ = std::move(*staged);
  rehearsal_of_ = session_;
  base::ByteWriter answer;
  answer.u64(edition_);
  return answer.take();
}

const online_change::Change& ControllerService::looked_at() const {
  return rehearses() ? rehearsal_->change() : change_;
}

// What the switch looks at before it begins, in the same order. Values of a rehearsal are those of
// its copy.
base::Result<base::Bytes> ControllerService::rehearse(const vm::Request& request) {
  const bool allow_overrun = (request.flags & vm::kAllowOverrun) != 0;
  const bool allow_loss = (request.flags & vm::kAllowLoss) != 0;
  base::Status refused_by = base::Ok{};
  base::Status taken = look_at_boundary([&] {
    const int64_t pause_ns = looked_at().predicted_pause_ns();
    const bool on_time = !allow_overrun && !controller_.faulted();
    if (on_time) refused_by = online_change::fits_free_time(pause_ns, controller_.tasks());
    if (refused_by.ok()) refused_by = looked_at().refused_by_values(allow_loss);
  });
  if (!taken.ok()) return taken.error();
  if (!refused_by.ok()) return refused_by.error();
  return base::Bytes{};
}

void ControllerService::forget_staged() {
  aside_.wait();
  store_.forget_aside();
  staged_.reset();
  forget_report();
  only_looked_at_ = false;
}

// Undo too takes its time from the next cycle.
bool ControllerService::time_for_switch() const {
  int64_t left = controller_.next_cycle_ns() - clock_.now_ns();
  return left > change_.predicted_pause_ns() + 2 * keeper_.copy_ns();  // before and behind
}

base::Status ControllerService::configure(bool allow_overrun) {
  base::Result<bool> done = false;
  uint64_t left = change_.units_left();
  for (int idle_less = 0; done.ok() && !*done;) {
    base::Status taken = at_boundary([&] { done = change_.configure(); });
    if (!taken.ok()) return taken;
    const bool progress = change_.units_left() != left;
    left = change_.units_left();
    idle_less = progress ? 0 : idle_less + 1;
    if (idle_less < kIdleAttempts) continue;
    if (allow_overrun) return base::Ok{};  // arm() does the rest
    change_.cancel();
    return base::Error{base::Refusal::kDeadline,
                       "the tasks leave no idle time to prepare the change in; the old program "
                       "runs on"};
  }
  return done.ok() ? base::Status(base::Ok{}) : done.error();
}

base::Status ControllerService::arm_in_time(bool allow_loss, bool allow_overrun,
                                            base::Status& armed) {
  bool tried = false;
  for (int attempt = 1; !tried; ++attempt) {
    if (attempt != 1) boundary_.pause(kBetweenAttemptsNs);
    base::Status taken = at_boundary([&] {
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

base::Result<online_change::SwitchReport> ControllerService::switch_in_time(bool allow_overrun,
                                                                            uint64_t& missed_before,
                                                                            int64_t& done_ns) {
  std::optional<base::Result<online_change::SwitchReport>> report;
  online_change::Snapshot before = empty_snapshot();
  online_change::Snapshot after = empty_snapshot();
  const auto nobody_else_saves = keeper_.hold();
  auto job = [&] {
    if (!allow_overrun && !time_for_switch()) return;
    keeper_.take(before);
    if (!allow_overrun) change_.set_interruption(Deadline(clock_, controller_.next_cycle_ns()));
    missed_before = controller_.missed_releases();
    report.emplace(change_.switch_now());
    done_ns = clock_.now_ns();
    change_.set_interruption(nullptr);
    if (report->ok()) keeper_.take(after);
  };
  for (int attempt = 0; attempt < kSwitchAttempts && !report; ++attempt) {
    if (attempt != 0) boundary_.pause(kBetweenAttemptsNs);
    base::Status taken = at_boundary(job);
    if (!taken.ok()) return taken.error();
  }
  if (report) {
    if (report->ok()) {
      complain(keeper_.save_held(before));
      complain(keeper_.save_held(after));
    }
    return std::move(*report);
  }
  change_.cancel();
  return base::Error{base::Refusal::kDeadline,
                     "no cycle left time enough for the switch; the old program runs on"};
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
  base::Error error = refused(why);
  if (change_.state() == online_change::State::kIdle) forget_staged();
  return error;
}

base::Result<base::Bytes> ControllerService::make_switch(const vm::Request& request) {
  if (only_looked_at_) {
    return base::Error{base::Refusal::kBusy, "what is staged is a dry run; stage the change anew"};
  }
  const std::string health = request.names.empty() ? std::string() : request.names.front();
  base::Status armed = check_health(health);
  if (!armed.ok()) return not_switched(armed.error());
  bool faulted = false;
  uint64_t stopped = 0;
  base::Status taken = look_at_boundary([&] {
    faulted = controller_.faulted();
    stopped = stopped_tasks();
  });
  if (!taken.ok()) return not_switched(taken.error());
  // Nothing runs that could be delayed.
  const bool allow_overrun = faulted || (request.flags & vm::kAllowOverrun) != 0;
  ir::VerifiedImage running = controller_.verified();
  if (!faulted) armed = configure(allow_overrun);
  if (!armed.ok()) return not_switched(armed.error());
  taken = arm_in_time((request.flags & vm::kAllowLoss) != 0, allow_overrun, armed);
  if (!taken.ok()) return not_switched(taken.error());
  if (!armed.ok()) return not_switched(armed.error());
  const int64_t predicted_ns = change_.predicted_pause_ns();
  base::Status stored = store_trial();
  if (!stored.ok()) {
    change_.cancel();
    return not_switched(stored.error());
  }
  uint64_t missed_before = 0;
  int64_t done_ns = 0;
  auto report = switch_in_time(allow_overrun, missed_before, done_ns);
  change_.collect();
  if (!report.ok()) {
    change_.cancel();
    complain(store_.end_trial());
    return not_switched(report.error());
  }
  previous_ = std::move(running);
  ++edition_;
  changed_by_ = who_;
  note_switch(online_change::Event::kSwitched, previous_->digest(), *report, predicted_ns);
  forget_staged();
  stopped_before_ = faulted ? 0 : stopped;
  if (faulted) go_on_hot();
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
base::Result<base::Bytes> ControllerService::undo(const vm::Request&) { return undo_now({}); }

base::Result<base::Bytes> ControllerService::undo_now(const std::string& why) {
  bool faulted = false;
  std::optional<base::Result<online_change::SwitchReport>> report;
  uint64_t missed_before = 0;
  int64_t done_ns = 0;
  const int64_t predicted_ns = change_.predicted_pause_ns();
  const base::Digest undone = controller_.verified().digest();
  online_change::Snapshot after = empty_snapshot();
  for (int attempt = 1; !report; ++attempt) {
    if (attempt != 1) boundary_.pause(kBetweenAttemptsNs);
    base::Status taken = at_boundary([&] {
      faulted = controller_.faulted();
      if (!faulted && !time_for_switch() && attempt != kSwitchAttempts) return;
      missed_before = controller_.missed_releases();
      report.emplace(change_.undo());
      done_ns = clock_.now_ns();
      if (report->ok()) keeper_.take(after);
    });
    if (!taken.ok()) return taken.error();
  }
  if (!report->ok()) return refused(report->error());
  change_.collect();
  complain(store_.end_trial());
  complain(keeper_.save(after));
  note_switch(online_change::Event::kUndone, undone, **report, predicted_ns, why);
  go_on_hot();
  previous_.reset();
  probation_.reset();
  ++edition_;
  changed_by_ = who_;
  return encode(finish_report(**report, missed_before, done_ns));
}

// Durable first: after a power cut in between, the accepted version boots, as it was asked for.
base::Status ControllerService::make_permanent() {
  if (change_.state() != online_change::State::kTrial) return change_.accept();
  base::Status stored = keep_programs();
  if (stored.ok() && previous_) {
    complain(store_.keep_before({previous_->digest(), previous_->encoded()}));
  }
  if (stored.ok()) stored = store_.accept();
  if (!stored.ok()) {
    return refused(
        {stored.error().refusal, stored.error().text + "; the change runs, but is still on trial"});
  }
  base::Status accepted = change_.accept();  // nothing that runs depends on it
  online_change::Snapshot after = empty_snapshot();
  base::Status taken = at_boundary([&] { keeper_.take(after); });
  change_.collect();
  complain(taken.ok() ? keeper_.save(after) : taken);
  online_change::JournalEntry done = entry(online_change::Event::kAccepted);
  if (previous_) done.from = previous_->digest();
  done.to = controller_.verified().digest();
  store_.note(std::move(done));
  previous_.reset();
  probation_.reset();
  ++edition_;
  changed_by_ = who_;
  return accepted;
}

base::Result<base::Bytes> ControllerService::accept(const vm::Request&) {
  base::Status permanent = make_permanent();
  if (!permanent.ok()) return permanent.error();
  return base::Bytes{};
}

base::Result<base::Bytes> ControllerService::cancel(const vm::Request&) {
  if (rehearses()) {
    rehearsal_.reset();
    forget_report();
    return base::Bytes{};
  }
  if (staged_ && !only_looked_at_ && change_.state() != online_change::State::kTrial) {
    store_.note(entry(online_change::Event::kCancelled));
  }
  change_.cancel();
  forget_staged();
  return base::Bytes{};
}

}  // namespace stvm
