#include "tools/stvm/controller_service.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "base/limits.h"
#include "base/memory_limit.h"
#include "base/tool_limits.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/names.h"
#include "tools/stvm/stop_signal.h"
#include "vm/native/program.h"

namespace stvm {
namespace {

// A long scan of a slow task postpones the boundary; longer than this is an answer of its own.
constexpr int64_t kKeepUpPatienceNs = 200'000'000;
constexpr int64_t kBoundaryPatienceNs = 5'000'000'000;

}  // namespace

ControllerService::ControllerService(vm::Controller& controller, vm::Clock& clock,
                                     online_change::Store& store, vm::Boundary& boundary,
                                     StartReport start,
                                     online_change::RetainKeeper::WallTime wall_time)
    : controller_(controller),
      clock_(clock),
      store_(store),
      boundary_(boundary),
      start_(std::move(start)),
      wall_time_(std::move(wall_time)),
      keeper_(controller, store, wall_time_),
      admission_(start_.trust),
      change_(controller),
      units_(controller, {controller.cycles(), wall_time_(), start_.who, "started"}),
      guard_(controller, clock),
      aside_(store),
      keep_again_(1'000'000'000, 8'000'000'000) {
  trials_.reserve(base::kMostEditsOnTrial);  // after a switch nothing may fail
  undone_.reserve(base::kMostEditsOnTrial);
  guard_.failed = [this] {
    if (wake) wake();
  };
  boundary_.give_up = [this] { return preparing_ && aborted(); };
}

void ControllerService::ended(uint64_t session) {
  // Not `= {}`, which keeps the room.
  if (session == upload_of_) upload_ = base::Bytes();
  if (session == live_of_) forget_report();
  if (session == before_of_) before_ = {};
  if (session == rehearsal_of_) rehearsal_.reset();
  if (only_looked_at_ && session == looked_at_by_) {
    change_.cancel();
    forget_staged();
  }
  if (staged_ && !only_looked_at_ && session == staged_of_) {
    who_ = changed_by_;
    abort_why_ = "because the connection of " + who_ + " has ended";
    (void)give_up();
  }
  if (more_of_ != 0 && session == more_of_ && is_incomplete()) {
    give_back("because the connection of " + changed_by_ + " ended before the rest of it came");
  }
  gone_.erase(session);
  if (session == history_of_) history_ = std::vector<online_change::JournalEntry>();
}

// When memory runs out, so that the answer needs none: it was made before.
base::Bytes ControllerService::answer(base::ByteSpan bytes, bool& keep_open) {
  if (no_memory_.empty()) no_memory_ = vm::encode_answer({base::Refusal::kNoMemory, {}});
  return base::within_memory([&] { return answer_within_memory(bytes, keep_open); },
                             [&] {
                               if (recorder_ != nullptr) recorder_->forget_jobs();
                               return std::exchange(no_memory_, {});
                             });
}

base::Bytes ControllerService::answer_within_memory(base::ByteSpan bytes, bool& keep_open) {
  base::Result<vm::Request> request = vm::decode_request(bytes);
  if (!request.ok()) {
    keep_open = false;
    const uint8_t version = bytes.empty() ? vm::kProtocolVersion : bytes.front();
    return vm::encode_answer(request.error(), version);
  }
  base::Status expected = check_expected(*request);
  if (!expected.ok()) return vm::encode_answer(expected.error());
  Answer body = dispatch(*request);
  if (recorder_ != nullptr) {
    const bool done = vm::changes_state(request->command) && (body.ok() || recorder_->switched());
    done ? recorder_->note(bytes) : recorder_->forget_jobs();
  }
  if (!body.ok()) return vm::encode_answer(body.error());
  if (body->size() + 16 > vm::kMaxMessageBytes) {
    return vm::encode_answer(too_long());
  }
  return vm::encode_answer(*body);
}

base::Result<base::Bytes> ControllerService::dispatch(const vm::Request& request) {
  preparing_ = false;
  abort_why_.clear();
  switch (request.command) {
#define COMMAND(id, name, handler, body, changes_state, meaning) \
  case vm::Command::id:                                          \
    return handler(request);
#include "vm/runtime/commands.def"
#undef COMMAND
  }
  return base::Error{base::Refusal::kProtocol, "unknown command"};
}

base::Status ControllerService::check_expected(const vm::Request& request) const {
  if (!vm::changes_state(request.command)) return base::Ok{};
  const base::Digest& running = controller_.verified().digest();
  if (request.expected == running && request.edition == edition_) return base::Ok{};
  return base::Error{base::Refusal::kStaleBase,
                     "the request is for version " + base::short_hex(request.expected) +
                         " edition " + std::to_string(request.edition) + ", but " +
                         base::short_hex(running) + " edition " + std::to_string(edition_) +
                         " is running" + (changed_by_.empty() ? "" : ", made by " + changed_by_)};
}

base::Status ControllerService::at_boundary(const std::function<void()>& job) {
  if (recorder_ == nullptr) return look_at_boundary(job);
  return look_at_boundary([&] {
    const vm::RecordedJob recorded(*recorder_, controller_);
    job();
  });
}

base::Status ControllerService::look_at_boundary(const std::function<void()>& job) {
  bool had_memory = true;
  const auto guarded = [&] {
    had_memory = base::within_memory([&] { return job(), true; }, [] { return false; });
  };
  switch (boundary_.run(guarded, kBoundaryPatienceNs)) {
    case vm::Boundary::Outcome::kDone:
      if (!had_memory) return base::Error{base::Refusal::kNoMemory, {}};
      return base::Ok{};
    case vm::Boundary::Outcome::kClosed:
      return base::Error{base::Refusal::kNotRunning, "the controller is stopping"};
    case vm::Boundary::Outcome::kTimeout:
      break;
  }
  return base::Error{base::Refusal::kBusy, "no boundary came within 5 s: a task does not end"};
}

void report_tier(const ir::Image& image, const vm::CodeTable& code, vm::StatusReport& report) {
  report.pous = code.pous.size();
  const vm::native::Program* const native = code.native.get();
  if (native == nullptr) return;
  report.native_pous = native->native_pous();
  report.native_bytes = native->code_bytes();
  for (uint32_t pou = 0; pou < report.pous; ++pou) {
    if (native->reason(pou).empty() || report.interpreted.size() == vm::kShownInterpreted) continue;
    report.interpreted.push_back(image.pous[pou].name + ": " + native->reason(pou));
  }
}

// Before waiting for a boundary, at which no task is inside a scan.
std::vector<vm::TaskActivity> ControllerService::activities() const {
  std::vector<vm::TaskActivity> rows(controller_.image().tasks.size());
  const uint32_t generation = controller_.generation().number();
  for (size_t task = 0; task < rows.size(); ++task) {
    rows[task] = controller_.activity(task, generation).value_or(vm::TaskActivity{});
  }
  return rows;
}

base::Result<base::Bytes> ControllerService::status(const vm::Request&) {
  vm::StatusReport report;
  const std::vector<vm::TaskActivity> doing = activities();
  report.pous_to_make = controller_.pous_to_make();
  if (report.pous_to_make == 0) keep_up();
  const vm::CodeTable* code = nullptr;
  vm::TaskCopy tasks(controller_, "");
  vm::Traps traps;
  traps.reserve(vm::kKeptTraps);
  base::Status taken = copy_at_boundaries([&](int64_t free_ns) {
    report.cycles = controller_.cycles();
    code = &controller_.code();
    report.faulted = controller_.faulted();
    report.uptime_ns = clock_.now_ns();
    if (traps.empty()) traps = controller_.traps();  // later it could free one there
    return tasks.take(controller_, free_ns);
  });
  if (!taken.ok()) return taken.error();
  for (const vm::TaskSample& task : tasks.samples()) {
    report.tasks.push_back(vm::status_of(task));
    if (report.tasks.size() <= doing.size()) {
      report.tasks.back().activity = doing[report.tasks.size() - 1];
    }
  }
  for (const auto& trap : traps) report.traps.push_back({trap->cycle, trap->task, trap->text});
  report.name = controller_.image().name;
  report.running = controller_.verified().digest();
  report.edition = edition_;
  report.change = online_change::state_name(change_.state());
  report.changed_by = changed_by_;
  report.aborted = aborted_;
  report.edits = trials_.size();
  report.last_edit_boots = last_edit_boots();
  if (guard_.is_on()) {
    report.watched_by = guard_.note();
    report.watch_left_ns = guard_.left_ns();
  }
  if (previous() != nullptr) report.previous = previous()->digest();
  report.boots_next = store_.boots();
  report.trial_lost = start_.trial_lost.value_or(base::Digest{});
  report.alarms = start_.alarms;
  if (!start_.fault.empty()) report.alarms.push_back(start_.fault);
  if (!not_undone_.empty()) report.alarms.push_back(not_undone_);
  if (!given_back_.empty()) report.alarms.push_back(given_back_);
  if (const auto unsaved = keeper_.unsaved()) {
    report.alarms.push_back("retained values are not being saved since " +
                            time_text(unsaved->since_ns) + ": " + unsaved->why);
  }
  for (std::string& text : store_.complaints()) report.alarms.push_back(std::move(text));
  report.base_period_ns = controller_.base_period_ns();
  report.forces = controller_.forces().size();
  for (const vm::Force& force : controller_.forces()) {
    report.boundary_forces += force.reason.empty() ? 0 : 1;
  }
  report.devices = controller_.devices();
  report.memory = vm::memory_report(controller_.image());
  report_tier(controller_.image(), *code, report);
  return vm::encode(report);
}

base::Result<base::Bytes> ControllerService::times(const vm::Request& request) {
  const std::string name = request.names.empty() ? "" : request.names.front();
  vm::TaskCopy task(controller_, name);
  if (name.empty() || task.samples().empty()) {
    return no_such_task(controller_.image(), name);
  }
  base::Status taken =
      copy_at_boundaries([&](int64_t free_ns) { return task.take(controller_, free_ns); });
  if (!taken.ok()) return taken.error();
  return vm::encode(vm::times_of(task.samples().front()));
}

base::Result<base::Bytes> ControllerService::reset_times(const vm::Request&) {
  base::Status taken = look_at_boundary([&] { controller_.reset_times(); });
  if (!taken.ok()) return taken.error();
  return base::Bytes();
}

// Nothing of it is to be seen, so a recording need not have it; and what fails is tried again.
void ControllerService::keep_up() {
  if (StopSignal::take_hangup()) {
    note_done(online_change::Event::kHangup, {},
              "SIGHUP: there is no log file to open anew; the controller runs on");
  }
  const auto renew = [&] {
    if (auto change = controller_.renew_forces()) {
      boundary_.run([&] { controller_.use(*change); }, kKeepUpPatienceNs);
    }
    return true;
  };
  base::within_memory(renew, [] { return false; });
  base::within_memory([&] { return watch_unless(), true; }, [] { return false; });
  base::within_memory([&] { return watch_trial(), true; },
                      [&] {
                        if (recorder_ != nullptr) recorder_->forget_jobs();
                        return false;
                      });
  base::within_memory([&] { return keep_programs_now_and_then(), true; }, [] { return false; });
}

base::Result<base::Bytes> ControllerService::image(const vm::Request& request) {
  const ir::VerifiedImage& running = controller_.verified();
  return image_part(running.digest(), running.encoded(), request.offset);
}

base::Result<base::Bytes> ControllerService::before_edit(const vm::Request& request) {
  const std::string& name = request.names.front();
  for (const Trial& trial : trials_) {
    if (trial.edit.name != name) continue;
    return image_part(trial.before.digest(), trial.before.encoded(), request.offset);
  }
  return base::Error{base::Refusal::kNothingToUndo,
                     "no edit `" + name + "` is on trial; `stvm edits` shows them"};
}

// The first page reads it from the disk, and the others of the same connection are of that reading.
base::Result<base::Bytes> ControllerService::before(const vm::Request& request) {
  if (!request.names.empty()) return before_edit(request);
  if (request.offset == 0 || before_of_ != session_) {
    base::Result<online_change::StoredImage> stored = store_.before();
    if (!stored.ok()) return stored.error();
    before_ = std::move(*stored);
    before_of_ = session_;
  }
  Answer part = image_part(before_.digest, before_.bytes, request.offset);
  if (request.offset + vm::kChunkBytes >= before_.bytes.size()) before_ = {};
  return part;
}

base::Result<base::Bytes> ControllerService::image_part(const base::Digest& digest,
                                                        const base::Bytes& encoded,
                                                        uint64_t offset) {
  if (offset > encoded.size()) {
    return base::Error{base::Refusal::kProtocol, "the image is not that long"};
  }
  vm::ImagePart part{digest, encoded.size(), {}};
  auto begin = encoded.begin() + static_cast<std::ptrdiff_t>(offset);
  auto size = std::min<uint64_t>(vm::kChunkBytes, encoded.size() - offset);
  part.bytes.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
  return vm::encode(part);
}

base::Result<base::Bytes> ControllerService::stop(const vm::Request&) {
  if (stop_wanted()) return base::Bytes();
  stopped_by_ = who_;
  stop_wanted_.store(true, std::memory_order_release);
  return base::Bytes();
}

// The answer is what FB_Exit had to say, mostly nothing.
base::Result<base::Bytes> ControllerService::restart(const vm::Request& request) {
  if (request.flags > static_cast<uint32_t>(vm::Restart::kHot)) {
    return base::Error{base::Refusal::kProtocol, "a restart is cold, warm or hot"};
  }
  // What never ran has nothing that a hot restart could go on with.
  if (has_no_program()) return base::Error{base::Refusal::kNothingBoots, start_.fault};
  const bool held = !start_.fault.empty();
  const auto kind = held && request.flags == static_cast<uint32_t>(vm::Restart::kHot)
                        ? vm::Restart::kWarm
                        : static_cast<vm::Restart>(request.flags);
  if (base::Status installed = install_held(); !installed.ok()) return installed.error();
  base::Status left = base::Ok{};
  base::Status taken = at_boundary([&] { left = controller_.restart(kind, kExitLimitNs); });
  if (!taken.ok()) return taken.error();
  online_change::JournalEntry made = entry(online_change::Event::kRestarted);
  constexpr const char* kKinds[] = {"cold", "warm", "hot"};
  made.text = kKinds[request.flags];
  store_.note(std::move(made));
  if (kind == vm::Restart::kCold) complain(save_retained_now());
  const std::string text = left.ok() ? std::string() : base::to_string(left.error());
  return base::Bytes(text.begin(), text.end());
}

}  // namespace stvm
