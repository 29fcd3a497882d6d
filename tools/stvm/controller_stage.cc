// From an uploaded package to a change that is staged, or only looked at (case 78).
#include <utility>

#include "base/limits.h"
#include "base/memory_limit.h"
#include "online_change/apply/pace.h"
#include "online_change/plan/online_limits.h"
#include "tools/stvm/controller_service.h"

namespace stvm {

using online_change::Event;

static constexpr size_t kMostNote = 160;  // bytes; the journal keeps some more

// One at a time: whoever begins one ends that of another connection, which is told so.
base::Result<base::Bytes> ControllerService::upload(const vm::Request& request) {
  if (request.offset == 0) {
    upload_ = base::Bytes();
    upload_of_ = session_;
    upload_by_ = who_;
    if (aborted_of_ == session_) aborted_.clear();
  }
  if (upload_.empty()) {
    base::Status goes_on = check_not_aborted();
    if (!goes_on.ok()) return goes_on.error();
  }
  if (upload_of_ != session_ && !upload_.empty()) return others_upload();
  if (upload_of_ != session_ || request.offset != upload_.size()) {
    return base::Error{base::Refusal::kProtocol, "parts of the package are missing"};
  }
  if (upload_.size() + request.data.size() > start_.most_upload) {
    return base::Error{base::Refusal::kTooLarge, "the package is longer than the limit"};
  }
  upload_.insert(upload_.end(), request.data.begin(), request.data.end());
  return base::Bytes{};
}

base::Error ControllerService::others_upload() const {
  if (upload_by_.empty()) return {base::Refusal::kProtocol, "no package has been uploaded"};
  return {base::Refusal::kChangePending, upload_by_ + " is bringing another change now"};
}

base::Status ControllerService::check_upload(const vm::Request& request,
                                             base::ByteSpan package) const {
  // What never ran has no values that a change could carry over.
  if (!start_.fault.empty() && !has_no_program()) {
    return base::Error{base::Refusal::kFault, start_.fault};
  }
  if (base::sha256(package) == request.digest) return base::Ok{};
  return base::Error{base::Refusal::kBadHash, "the package arrived damaged"};
}

// E-16, E-22: what its sender wants refused, and what this version of stvm does not take.
static base::Status check_edit_steps(const ir::Image& running, const ir::Image& next,
                                     uint32_t flags) {
  if ((flags & vm::kTableAdditions) != 0) {
    base::Status kept = online_change::check_table(
        online_change::table_edits(running, next, online_change::TableSide::kBefore),
        "the table that runs");
    if (!kept.ok()) return kept;
  }
  return online_change::check_own_limits(running, next);
}

static base::Status check_edit(const ir::Image& running, const ir::Image& next, uint32_t flags) {
  return base::within_memory([&] { return check_edit_steps(running, next, flags); },
                             [] {
                               return base::Status(base::Error{base::Refusal::kNoMemory, {}});
                             });
}

// Checks and builds beside the running program; touches nothing of it, so it needs no boundary. A
// change that somebody staged and did not switch gives way, and the new edition, which is the
// answer, makes sure that nobody switches what he did not stage. A rehearsal never takes its place.
base::Result<base::Bytes> ControllerService::stage(const vm::Request& request) {
  if (upload_of_ != session_) return others_upload();
  if (upload_.empty()) {
    base::Status goes_on = check_not_aborted();
    if (!goes_on.ok()) return goes_on.error();
  }
  base::Bytes package = std::exchange(upload_, {});
  if (base::Status good = check_upload(request, package); !good.ok()) return good.error();
  if (auto revoked = admission_.revoke(package, wall_time_())) {
    if (!revoked->ok()) note_done(Event::kRefused, who_, base::to_string(revoked->error()));
    if (!revoked->ok()) return revoked->error();
    note_done(Event::kRevoked, who_, **revoked);
    return vm::encode(vm::StagedAnswer{edition_});
  }
  const base::Result<Signer> signer = admission_.open(package, local_, wall_time_());
  if (!signer.ok()) {
    note_done(Event::kRefused, who_, base::to_string(signer.error()));
    return signer.error();
  }
  const std::string unless = request.names.empty() ? std::string() : request.names.front();
  base::Result<base::Bytes> staged =
      stage_package(std::move(package), request.flags, unless, {},
                    request.names.size() > 2 ? request.names[2] : "", *signer);
  if (!staged.ok()) return staged;
  staged_digest_ = request.digest;
  const bool rehearsal = (request.flags & vm::kRehearsal) != 0;
  if (!rehearsal && request.names.size() > 1) {
    note_ = request.names[1].substr(0, kMostNote);
  }
  return staged;
}

base::Result<base::Bytes> ControllerService::stage_package(base::Bytes package, uint32_t flags,
                                                           const std::string& unless,
                                                           const std::string& redone,
                                                           const std::string& taken_out,
                                                           const Signer& signer) {
  const bool standby = (flags & vm::kByStandby) != 0;
  const auto strategy =
      standby ? online_change::Strategy::kStandby : online_change::Strategy::kInPlace;
  const bool rehearsal = (flags & vm::kRehearsal) != 0;
  if (guard_.is_on()) {
    return base::Error{base::Refusal::kChangePending,
                       "the edit on trial belongs to a roll-out (" + guard_.note() +
                           "); it must be accepted or taken back first"};
  }
  const bool own = only_looked_at_ && looked_at_by_ == session_;
  const bool taken = change_.state() != online_change::State::kIdle && !own;
  if (rehearsal && taken) {
    if (base::Status room = change_.room(); !room.ok()) return room.error();
    base::Status may_begin = check_unless(unless);
    return may_begin.ok() ? stage_rehearsal(package, strategy, flags, taken_out)
                          : may_begin.error();
  }
  change_.cancel();
  forget_staged();
  gone_.erase(session_);
  only_looked_at_ = rehearsal;
  looked_at_by_ = session_;
  staged_of_ = session_;
  base::Result<uint32_t> condition = find_unless(unless);
  if (!condition.ok()) return refused(condition.error());
  unless_ = {unless, *condition, false};
  preparing_ = true;
  taken_out_ = taken_out;
  base::Status staged = stage_unless_aborted(package, strategy);
  preparing_ = false;
  if (staged.ok()) {
    staged = check_edit(controller_.image(), change_.next()->image(), flags);
    if (!staged.ok()) change_.cancel();
  }
  if (!staged.ok()) {
    change_.collect();  // devices that it opened
    if (!abort_why_.empty()) return give_up();
    const base::Error error = refused(staged.error());
    forget_staged();
    return error;
  }
  aborted_.clear();
  staged_ = *change_.next();
  staged_package_ = std::move(package);
  staged_flags_ = flags;
  redone_ = redone;
  signer_ = signer;
  if (!rehearsal) {
    online_change::JournalEntry done = entry(online_change::Event::kStaged);
    done.counts = change_.plan().counts;
    done.predicted_ns = change_.predicted_pause_ns();
    done.text = signer_text(signer_);
    store_.note(std::move(done));
    changed_by_ = who_;
    ++edition_;
  }
  return vm::encode(vm::StagedAnswer{edition_});
}

// Once, so that a dry run says the same as the change (case 78).
double ControllerService::pace() {
  if (pace_ == 0) pace_ = online_change::measured_pace(clock_);
  return pace_;
}

// Verifying and planning take their time; between their steps somebody may end it.
base::Status ControllerService::stage_unless_aborted(base::ByteSpan package,
                                                     online_change::Strategy strategy) {
  const auto job_at_boundary = [this](const std::function<void()>& job) {
    return aborted() ? base::Status(abort_error()) : at_boundary(job);
  };
  change_.set_pace(pace());
  change_.set_interruption([this] {
    if (unless_.data == 0) return aborted();
    base::Status looked = look_at_boundary([&] { unless_holds(); });
    return aborted() || !looked.ok();
  });
  base::Status staged =
      change_.stage(package, strategy, job_at_boundary, trial_taken_out(taken_out_));
  change_.set_interruption(nullptr);
  return staged;
}

base::Result<base::Bytes> ControllerService::stage_rehearsal(base::ByteSpan package,
                                                             online_change::Strategy strategy,
                                                             uint32_t flags,
                                                             const std::string& taken_out) {
  if (rehearsal_ && rehearsal_of_ != session_) {
    return base::Error{base::Refusal::kChangePending, "somebody else is looking at a change now"};
  }
  gone_.erase(session_);
  forget_report();
  rehearsal_.reset();
  auto staged = Rehearsal::stage(controller_, package, strategy, trial_taken_out(taken_out),
                                 [this](auto ranges) { return copy_of(std::move(ranges)); });
  if (!staged.ok()) return staged.error();
  base::Status taken = check_edit(controller_.image(), (*staged)->next().image(), flags);
  if (!taken.ok()) return taken.error();
  rehearsal_ = std::move(*staged);
  rehearsal_->change().set_pace(pace());
  rehearsal_of_ = session_;
  return vm::encode(vm::StagedAnswer{edition_});
}

const online_change::Change& ControllerService::looked_at() const {
  return rehearses() ? rehearsal_->change() : change_;
}

// A dry run whose change another one has replaced, or that was of another version.
base::Status ControllerService::check_not_gone() const {
  if (!gone_.contains(session_)) return base::Ok{};
  return base::Error{base::Refusal::kChangePending,
                     "another change took the place of the one that was looked at; try again"};
}

void ControllerService::forget_rehearsal() {
  if (!rehearsal_) return;
  gone_.insert(rehearsal_of_);
  forget_report();
  rehearsal_.reset();
}

// The edition says so too, but it counts from 0 again when the controller is started anew.
base::Status ControllerService::check_staged(const vm::Request& request) const {
  if (!staged_) return base::Error{base::Refusal::kBusy, "no change is staged"};
  if (request.names.size() < 2 || request.names[1] == base::to_hex(staged_digest_)) {
    return base::Ok{};
  }
  return base::Error{base::Refusal::kStaleBase,
                     "another change is staged than the one that was checked" +
                         (changed_by_.empty() ? "" : ", by " + changed_by_)};
}

// What the switch looks at before it begins. At the boundary only active steps and the time of
// tasks are looked at; the values are those of the report, which is of a copy.
base::Result<base::Bytes> ControllerService::rehearse(const vm::Request& request) {
  if (base::Status there = check_not_gone(); !there.ok()) return there.error();
  const online_change::Change& change = looked_at();
  if (change.next() == nullptr) return base::Error{base::Refusal::kBusy, "no change is staged"};
  if (base::Status kept = check_not_aborted(); !kept.ok()) return kept.error();
  const std::string health = request.names.empty() ? std::string() : request.names.front();
  base::Status refused_by = check_health(health, change.next()->image());
  if (!refused_by.ok()) return refused_by.error();
  if (!live_ || live_of_ != session_) {
    base::Status looked = look(&change.next()->image(), false);
    if (!looked.ok()) return looked.error();
  }
  const bool allow_overrun = (request.flags & vm::kAllowOverrun) != 0;
  const int64_t pause_ns = change.predicted_pause_ns();
  base::Status taken = look_at_boundary([&] {
    if (!rehearses()) unless_holds();
    const bool on_time = !allow_overrun && !controller_.faulted();
    if (on_time) refused_by = online_change::fits_free_time(pause_ns, controller_.tasks());
    if (refused_by.ok()) refused_by = change.refused_by_values(true);
  });
  if (!taken.ok()) return taken.error();
  if (!rehearses() && aborted()) return give_up();
  if (!refused_by.ok()) return refused_by.error();
  const bool allow_loss = (request.flags & vm::kAllowLoss) != 0;
  if (allow_loss || live_->loss_count() == 0) return base::Bytes{};
  return base::Error{base::Refusal::kWouldLose,
                     std::to_string(live_->loss_count()) + " live value(s) would be lost"};
}

void ControllerService::forget_staged() {
  aside_.wait();
  store_.forget_aside();
  staged_.reset();
  staged_package_ = base::Bytes();
  staged_digest_ = {};
  redone_.clear();
  signer_.reset();
  taken_out_.clear();
  unless_ = {};
  note_.clear();
  guard_.forget();
  forget_report();
  if (std::exchange(only_looked_at_, false)) gone_.insert(looked_at_by_);
}

base::Result<base::Bytes> ControllerService::cancel(const vm::Request&) {
  if (gone_.erase(session_) != 0) return base::Bytes{};
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
  gone_.erase(session_);
  return base::Bytes{};
}

}  // namespace stvm
