// What the serving controller stores around a change, and what it writes into its journal.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>

#include "online_change/store/retained_values.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/event_text.h"

namespace stvm {

using online_change::Event;
using online_change::JournalEntry;

int64_t wall_time_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string time_text(int64_t time_ns) {
  const auto seconds = static_cast<std::time_t>(time_ns / 1'000'000'000);
  std::tm parts{};
  char text[64];
  if (time_ns < 0 || ::gmtime_r(&seconds, &parts) == nullptr) return std::to_string(time_ns);
  size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
  std::snprintf(text + length, sizeof text - length, ".%03dZ",
                static_cast<int>(time_ns / 1'000'000 % 1000));
  return text;
}

// From what runs to what is staged.
JournalEntry ControllerService::entry(Event event) const {
  JournalEntry entry;
  entry.time_ns = wall_time_();
  entry.event = event;
  entry.who = who_;
  entry.from = controller_.verified().digest();
  if (staged_) entry.to = staged_->digest();
  return entry;
}

void ControllerService::note_done(Event event, const std::string& who, std::string text) {
  JournalEntry done;
  done.time_ns = wall_time_();
  done.event = event;
  done.who = who;
  done.text = std::move(text);
  store_.note(std::move(done));
}

base::Error ControllerService::refused(const base::Error& error) {
  if (only_looked_at_) return error;
  JournalEntry refusal = entry(Event::kRefused);
  refusal.text = base::to_string(error);
  store_.note(std::move(refusal));
  return error;
}

void ControllerService::note_switch(Event event, const base::Digest& from,
                                    const online_change::SwitchReport& report, int64_t predicted_ns,
                                    const std::string& why) {
  JournalEntry done = entry(event);
  done.text = why;
  done.from = from;
  done.to = controller_.verified().digest();
  done.counts = report.counts;
  done.predicted_ns = predicted_ns;
  done.measured_ns = report.pause_ns;
  done.cycle = report.cycle_after;
  store_.note(std::move(done));
  const vm::MovedForces forces = change_.take_moved_forces();
  if (forces.ended) {
    note_done(Event::kUnforced, who_,
              "without a place in the program that runs now: " + list_text(*forces.ended));
  }
  if (!forces.back) return;
  std::vector<std::string> again;  // what another force keeps out has not come back
  for (const vm::Force& force : controller_.forces()) {
    const auto is_it = [&](const vm::Force& one) {
      return one.path == force.path && one.value == force.value;
    };
    if (std::ranges::none_of(*forces.back, is_it)) continue;
    again.push_back(force.path + "=" + vm::value_text(controller_.image(), force));
  }
  if (again.empty()) return;
  note_done(Event::kForced, who_, "again, as before the edit that was undone: " + list_text(again));
}

// A snapshot with room for the running program or the staged one.
online_change::Snapshot ControllerService::empty_snapshot() const {
  online_change::Snapshot out;
  uint64_t most = 0;
  for (const ir::Image* image : {&controller_.image(), staged_ ? &staged_->image() : nullptr,
                                 previous() != nullptr ? &previous()->image() : nullptr}) {
    if (image == nullptr) continue;
    const base::Result<uint64_t> bytes = online_change::retained_bytes(*image);
    if (bytes.ok()) most = std::max(most, *bytes);
  }
  out.values.reserve(most);
  return out;
}

base::Status ControllerService::save_retained_now() {
  online_change::Snapshot now = empty_snapshot();
  base::Status taken = look_at_boundary([&] { keeper_.take(now); });
  return taken.ok() ? keeper_.save(now) : taken;
}

base::Status ControllerService::install_held() {
  if (start_.fault.empty()) return base::Ok{};
  const ir::VerifiedImage& image = controller_.verified();
  const base::Result<uint64_t> bytes = online_change::retained_bytes(image.image());
  if (!bytes.ok()) return bytes.error();
  base::Status installed = store_.install({image.digest(), image.encoded()}, *bytes);
  if (!installed.ok()) return installed;
  store_.note(entry(Event::kInstalled));
  start_.fault.clear();
  return installed;
}

void ControllerService::store_beside() {
  change_.set_received([this](const std::shared_ptr<const base::Bytes>& image) {
    if (!only_looked_at_) aside_.start(image);
  });
}

base::Status ControllerService::store_trial(Trial& next) {
  if (!staged_) return base::Error{base::Refusal::kBusy, "no change is staged"};
  const base::Result<uint64_t> bytes = online_change::retained_bytes(staged_->image());
  if (!bytes.ok()) return bytes.error();
  keeper_.expect_bytes(*bytes);
  aside_.wait();
  if (base::Status kept = keep_programs(); !kept.ok()) return kept;
  // One that undo could not end, because the disk failed.
  base::Status follows = store_follows();
  if (follows.ok() && !store_.retained_fits()) follows = save_retained_now();
  if (!follows.ok()) return follows;
  // One that is accepted at once is on trial until that is stored: a power cut in between loses no
  // edit below it that boots.
  const bool permanent = (next.switch_flags & vm::kPermanent) != 0;
  if (permanent && last_edit_boots()) next.switch_flags |= vm::kLastEditBoots;
  const bool resumes = (next.switch_flags & vm::kLastEditBoots) != 0;
  // With edits below it, too: when the trial is lost, their values lead back to what was accepted.
  // Those of the switch come after it; until then these are newer than others.
  if (resumes || !trials_.empty()) {
    next.retained = empty_snapshot();
    base::Status taken = look_at_boundary([&] { keeper_.take(next.retained); });
    if (taken.ok()) taken = keep_edits(&next);
    if (!taken.ok()) return taken;
  }
  return store_.begin_trial({staged_->digest(), staged_->encoded()}, *bytes, resumes);
}

base::Status ControllerService::store_follows() {
  if (trials_.empty()) return store_.end_trial();
  const ir::VerifiedImage& running = controller_.verified();
  if (store_.tries(running.digest())) return base::Ok{};
  const base::Result<uint64_t> bytes = online_change::retained_bytes(running.image());
  if (!bytes.ok()) return bytes.error();
  return store_.begin_trial({running.digest(), running.encoded()}, *bytes, last_edit_boots());
}

// What fails here, of a switch or an undo that has been made, is done when the disk is well: else
// an edit that was undone would boot.
void ControllerService::let_store_follow() {
  const base::Status follows = store_follows();
  store_is_behind_ = !follows.ok();
  complain(follows);
}

// Where nothing is wrong this does nothing.
base::Status ControllerService::keep_programs() {
  const ir::VerifiedImage& running = controller_.verified();
  base::Status kept = store_.restore({running.digest(), running.encoded()});
  if (!kept.ok() || trials_.empty()) return kept;
  const ir::VerifiedImage& accepted = trials_.front().before;
  return store_.restore({accepted.digest(), accepted.encoded()});
}

void ControllerService::keep_programs_now_and_then() {
  const int64_t now = clock_.now_ns();
  if ((store_.complaints().empty() && !store_is_behind_) || !keep_again_.due(now)) return;
  base::Status kept = keep_programs();
  if (kept.ok() && store_is_behind_) kept = store_follows();
  if (!kept.ok()) return keep_again_.failed(now);
  store_is_behind_ = false;
}

// Entries from number `offset` on, as they lie on the disk; none after the last. The first page
// reads it, and the others of the same connection are of that reading.
base::Result<base::Bytes> ControllerService::journal(const vm::Request& request) {
  if (request.offset == 0 || history_of_ != session_) {
    history_ = store_.history();
    history_of_ = session_;
  }
  base::Bytes page;
  for (uint64_t i = request.offset; i < history_.size() && page.size() < vm::kChunkBytes; ++i) {
    const base::Bytes entry = online_change::encode(history_[i]);
    page.insert(page.end(), entry.begin(), entry.end());
  }
  if (page.empty()) history_ = std::vector<JournalEntry>();
  return page;
}

// From number `offset` on; none after the last.
base::Result<base::Bytes> ControllerService::events(const vm::Request& request) {
  return events_ == nullptr ? base::Bytes() : events_->page(request.offset, vm::kChunkBytes);
}

// The program runs as it was asked to, only the disk does not follow: status shows that.
void ControllerService::complain(const base::Status& status) {
  if (status.ok()) return;
  JournalEntry alarm = entry(Event::kAlarm);
  alarm.text = status.error().text;
  store_.note(std::move(alarm));
}

}  // namespace stvm
