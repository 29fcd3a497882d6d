// The commands of an online change, as the serving controller carries them out.
#include <algorithm>

#include "base/limits.h"
#include "online_change/diff/initial_data.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/shown_edits.h"

namespace stvm {
namespace {

using online_change::Fate;
using online_change::FateRow;

constexpr uint64_t kLinesPerPage = 1000;
constexpr size_t kShownLosses = 500;
// A switch that finds too little time before the next cycle is tried again after it.
constexpr int kSwitchAttempts = 200;
// So many times in turn without any idle time, and a change that needs some is given up.
constexpr int kIdleAttempts = 200;

// Initial value of a scalar or string of the new version; "" for anything else.
std::string initial_text(const ir::Image& image, const std::string& path) {
  base::Result<ir::Symbol> symbol = ir::find_symbol(image, path);
  if (!symbol.ok()) return {};
  ir::Kind kind = image.types[symbol->type].kind;
  bool leaf = image.types.is_scalar(symbol->type) || kind == ir::Kind::kString ||
              kind == ir::Kind::kWstring;
  if (!leaf) return {};
  base::Bytes value(image.layouts[symbol->type].size);
  online_change::InitialData(image).read(symbol->data, value);
  ir::Symbol alone = *symbol;
  alone.data = 0;
  return ir::format_value(image, alone, value);
}

// The text of the old value as a value of the new type; "" where it is none.
std::string converted_text(const ir::Image& image, const std::string& path,
                           const std::string& now) {
  base::Result<ir::Symbol> symbol = ir::find_symbol(image, path);
  if (!symbol.ok()) return {};
  base::Result<base::Bytes> value = ir::parse_value(image, symbol->type, now);
  if (!value.ok()) return {};
  ir::Symbol alone = *symbol;
  alone.data = 0;
  return ir::format_value(image, alone, *value);
}

uint64_t line_bytes(const FateLine& line) {
  return line.row.path.size() + line.row.old_type.size() + line.row.new_type.size() +
         line.row.reason.size() + line.live.now.size() + line.live.after.size() +
         line.live.loss.size() + 64;
}

}  // namespace

// One at a time: whoever begins one ends that of another connection, which is told so.
base::Result<base::Bytes> ControllerService::upload(const vm::Request& request) {
  if (request.offset == 0) {
    upload_ = base::Bytes();
    upload_of_ = session_;
  }
  if (request.offset != upload_.size() || upload_of_ != session_) {
    return base::Error{base::Refusal::kProtocol, "parts of the package are missing"};
  }
  if (upload_.size() + request.data.size() > base::kMaxImageBytes) {
    return base::Error{base::Refusal::kTooLarge, "the package is longer than the limit"};
  }
  upload_.insert(upload_.end(), request.data.begin(), request.data.end());
  return base::Bytes{};
}

// Checks and builds beside the running program; touches nothing of it, so it needs no boundary. A
// change that somebody staged and did not switch gives way, and the new edition, which is the
// answer, makes sure that nobody switches what he did not stage.
base::Result<base::Bytes> ControllerService::stage(const vm::Request& request) {
  base::Bytes package = std::move(upload_);
  upload_ = {};
  bool faulted = false;
  base::Status taken = at_boundary([&] { faulted = controller_.faulted(); });
  if (!taken.ok()) return taken.error();
  if (faulted) return base::Error{base::Refusal::kFault, "the controller is stopped by a fault"};
  if (base::sha256(package) != request.digest) {
    return base::Error{base::Refusal::kBadHash, "the package arrived damaged"};
  }
  change_.cancel();
  forget_staged();
  const bool standby = (request.flags & vm::kByStandby) != 0;
  base::Status staged = change_.stage(
      package, standby ? online_change::Strategy::kStandby : online_change::Strategy::kInPlace,
      [this](const auto& job) { return at_boundary(job); });
  if (!staged.ok()) {
    change_.collect();  // devices that it opened
    forget_staged();
    return refused(staged.error());
  }
  staged_ = *change_.next();
  online_change::JournalEntry done = entry(online_change::Event::kStaged);
  done.counts = change_.plan().counts;
  done.predicted_ns = change_.plan().predicted_pause_ns;
  store_.note(std::move(done));
  base::ByteWriter answer;
  answer.u64(++edition_);
  return answer.take();
}

// The first page takes the live values; the others show the same ones.
base::Result<base::Bytes> ControllerService::fates(const vm::Request& request) {
  const bool back = change_.state() == online_change::State::kTrial && previous_;
  if (!back && (change_.state() == online_change::State::kIdle || !staged_)) {
    return base::Error{base::Refusal::kBusy, "no change is staged, and none is on trial"};
  }
  const ir::VerifiedImage& next_version = back ? *previous_ : *staged_;
  const ir::Image& next_image = next_version.image();
  if (request.offset == 0 || !live_) {
    live_.reset();
    auto taken = LiveReport::take(controller_, change_, back ? nullptr : &next_image,
                                  [this](auto ranges) { return copy_of(std::move(ranges)); });
    if (!taken.ok()) return taken.error();
    live_.emplace(std::move(*taken));
    live_of_ = session_;
  }
  const online_change::Plan& plan = back ? change_.undo_plan() : change_.plan();
  FatePage page{plan.counts,
                change_.predicted_pause_ns(),
                plan.boundary_bytes,
                0,
                {},
                live_->loss_count(),
                {},
                {},
                {}};
  uint64_t bytes = 0;
  uint64_t next = request.offset;
  const uint64_t end = std::min<uint64_t>(plan.fates.size(), request.offset + kLinesPerPage);
  for (; next < end && bytes <= vm::kChunkBytes; ++next) {
    page.lines.push_back(live_line(plan.fates[next], next_image, back));
    bytes += line_bytes(page.lines.back());
  }
  page.next = next < plan.fates.size() ? next : 0;
  if (request.offset == 0) {
    for (size_t i = 0; i < std::min(live_->losses().size(), kShownLosses); ++i) {
      page.losses.push_back({live_->losses()[i]});
    }
    page.edits = shown_edits(controller_.verified(), next_version);
    page.system = shown_system(controller_.image(), next_image);
  }
  return encode(page);
}

// With the resulting value, and its loss when there is one.
FateLine ControllerService::live_line(const FateRow& row, const ir::Image& next, bool back) const {
  FateLine line{row, {}};
  if (row.count == 1 && !row.old_type.empty()) line.live.now = live_->value(row);
  if (row.fate == Fate::kMoved || row.fate == Fate::kKept) {
    line.live.after = line.live.now;
  } else if (back && row.fate == Fate::kInitialised) {
    line.row.reason = "as it was before the change";
  } else if (back && row.fate == Fate::kConverted) {
    line.row.reason = "as it was before the change, unless written since";
  } else if (row.fate == Fate::kInitialised && row.count == 1) {
    line.live.after = initial_text(next, row.path);
  } else if (row.fate == Fate::kConverted && !line.live.now.empty()) {
    line.live.after = converted_text(next, row.path, line.live.now);
  }
  // The value of one of several says nothing of the others: they are told one by one.
  if (online_change::stands_for_several(row)) {
    line.live = {};
  } else if (const online_change::LiveLoss* loss = live_->loss(row.path)) {
    line.live = {loss->old_value, loss->new_value, loss->what};
  }
  return line;
}

void ControllerService::forget_staged() {
  aside_.wait();
  store_.forget_aside();
  staged_.reset();
  live_.reset();
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
    int64_t deadline_ns = controller_.next_cycle_ns();
    if (!allow_overrun) {
      change_.set_interruption([=, this] { return clock_.now_ns() > deadline_ns; });
    }
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
  bool allow_overrun = (request.flags & vm::kAllowOverrun) != 0;
  ir::VerifiedImage running = controller_.verified();
  base::Status armed = configure(allow_overrun);
  if (!armed.ok()) return not_switched(armed.error());
  base::Status taken = arm_in_time((request.flags & vm::kAllowLoss) != 0, allow_overrun, armed);
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
  note_switch(online_change::Event::kSwitched, previous_->digest(), *report, predicted_ns);
  forget_staged();
  if ((request.flags & vm::kPermanent) != 0) {
    base::Status permanent = make_permanent();
    if (!permanent.ok()) return permanent.error();
  }
  return encode(finish_report(*report, missed_before, done_ns));
}

// Done first and then recorded: after a power cut in between it boots the same program. Where no
// cycle leaves time enough it is done all the same: it is what people ask for when something is
// wrong.
base::Result<base::Bytes> ControllerService::undo(const vm::Request&) {
  std::optional<base::Result<online_change::SwitchReport>> report;
  uint64_t missed_before = 0;
  int64_t done_ns = 0;
  const int64_t predicted_ns = change_.predicted_pause_ns();
  const base::Digest undone = controller_.verified().digest();
  online_change::Snapshot after = empty_snapshot();
  for (int attempt = 1; !report; ++attempt) {
    if (attempt != 1) boundary_.pause(kBetweenAttemptsNs);
    base::Status taken = at_boundary([&] {
      if (!time_for_switch() && attempt != kSwitchAttempts) return;
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
  note_switch(online_change::Event::kUndone, undone, **report, predicted_ns);
  previous_.reset();
  ++edition_;
  return encode(finish_report(**report, missed_before, done_ns));
}

// Durable first: after a power cut in between, the accepted version boots, as it was asked for.
base::Status ControllerService::make_permanent() {
  if (change_.state() != online_change::State::kTrial) return change_.accept();
  base::Status stored = keep_programs();
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
  ++edition_;
  return accepted;
}

base::Result<base::Bytes> ControllerService::accept(const vm::Request&) {
  base::Status permanent = make_permanent();
  if (!permanent.ok()) return permanent.error();
  return base::Bytes{};
}

base::Result<base::Bytes> ControllerService::cancel(const vm::Request&) {
  if (staged_ && change_.state() != online_change::State::kTrial) {
    store_.note(entry(online_change::Event::kCancelled));
  }
  change_.cancel();
  forget_staged();
  return base::Bytes{};
}

}  // namespace stvm
