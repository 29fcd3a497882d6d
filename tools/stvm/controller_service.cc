#include "tools/stvm/controller_service.h"

#include <algorithm>
#include <utility>

#include "base/limits.h"
#include "base/memory_limit.h"
#include "tools/stvm/commands.h"
#include "vm/native/program.h"

namespace stvm {
namespace {

// A long scan of a slow task postpones the boundary; longer than this is an answer of its own.
constexpr int64_t kKeepUpPatienceNs = 200'000'000;
constexpr int64_t kBoundaryPatienceNs = 5'000'000'000;

base::Bytes nothing() { return {}; }

vm::ValueRow value_row(const ir::Image& image, const std::string& path, const ir::Symbol& symbol) {
  return {path, image.types.text(symbol.type), {}};
}

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
      change_(controller),
      aside_(store) {}

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
    return vm::encode_answer({base::Refusal::kTooMany, "the answer is too long; ask for less"});
  }
  return vm::encode_answer(*body);
}

base::Result<base::Bytes> ControllerService::dispatch(const vm::Request& request) {
  switch (request.command) {
    case vm::Command::kStatus:
      return status(request);
    case vm::Command::kTimes:
      return times(request);
    case vm::Command::kGet:
      return get(request);
    case vm::Command::kSet:
      return set(request);
    case vm::Command::kForce:
      return force(request);
    case vm::Command::kUnforce:
      return unforce(request);
    case vm::Command::kForces:
      return forces(request);
    case vm::Command::kList:
      return list(request);
    case vm::Command::kImage:
      return image(request);
    case vm::Command::kUpload:
      return upload(request);
    case vm::Command::kStage:
      return stage(request);
    case vm::Command::kFates:
      return fates(request);
    case vm::Command::kSwitch:
      return make_switch(request);
    case vm::Command::kUndo:
      return undo(request);
    case vm::Command::kAccept:
      return accept(request);
    case vm::Command::kCancel:
      return cancel(request);
    case vm::Command::kStop:
      return stop(request);
    case vm::Command::kRestart:
      return restart(request);
    case vm::Command::kJournal:
      return journal(request);
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
                         " is running"};
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

base::Result<base::Bytes> ControllerService::status(const vm::Request&) {
  vm::StatusReport report;
  report.pous_to_make = controller_.pous_to_make();
  if (report.pous_to_make == 0) keep_up();
  const vm::CodeTable* code = nullptr;
  base::Status taken = at_boundary([&] {
    report.cycles = controller_.cycles();
    code = &controller_.code();
    report.faulted = controller_.faulted();
    report.tasks = controller_.tasks();
    report.uptime_ns = clock_.now_ns();
    for (const vm::TrapRecord& trap : controller_.traps()) {
      report.traps.push_back({trap.cycle, trap.task, trap.text});
    }
  });
  if (!taken.ok()) return taken.error();
  report.name = controller_.image().name;
  report.running = controller_.verified().digest();
  report.edition = edition_;
  report.change = online_change::state_name(change_.state());
  if (previous_) report.previous = previous_->digest();
  report.boots_next = store_.boots();
  report.trial_lost = start_.trial_lost.value_or(base::Digest{});
  report.alarms = start_.alarms;
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
  std::optional<vm::TaskTimes> times;
  base::Status taken = at_boundary([&] { times = controller_.task_times(name); });
  if (!taken.ok()) return taken.error();
  if (!times) return base::Error{base::Refusal::kNoSuchTask, "`" + name + "`"};
  return vm::encode(*times);
}

base::Result<base::Bytes> ControllerService::get(const vm::Request& request) {
  const ir::Image& image = controller_.image();
  vm::Values values;
  std::vector<ir::Symbol> symbols;
  for (const std::string& name : request.names) {
    base::Result<ir::Symbol> symbol = ir::find_symbol(image, name);
    if (!symbol.ok()) return symbol.error();
    symbols.push_back(*symbol);
    values.rows.push_back(value_row(image, name, *symbol));
  }
  base::Status taken = at_boundary([&] {
    values.cycle = controller_.cycles();
    auto memory = controller_.memory().view();
    for (size_t i = 0; i < symbols.size(); ++i) {
      values.rows[i].value = ir::format_value(image, symbols[i], memory);
    }
  });
  if (!taken.ok()) return taken.error();
  return vm::encode(values);
}

// All or none: a mistake in the last of several is found before the first is written.
base::Status ControllerService::check_assignments(const vm::Request& request,
                                                  bool inputs_too) const {
  for (size_t i = 0; i < request.names.size(); ++i) {
    const std::string& name = request.names[i];
    base::Result<ir::Symbol> symbol = ir::find_symbol(controller_.image(), name);
    if (!symbol.ok()) return symbol.error();
    if (symbol->constant) {
      return base::Error{base::Refusal::kReadOnly, "`" + name + "` is a constant"};
    }
    if (symbol->input && !inputs_too) {
      return base::Error{base::Refusal::kReadOnly, "`" + name + "` is an input; force it instead"};
    }
    base::Result<base::Bytes> value =
        ir::parse_value(controller_.image(), symbol->type, request.values[i]);
    if (!value.ok()) return base::Error{value.error().refusal, name + ": " + value.error().text};
  }
  return base::Ok{};
}

base::Result<base::Bytes> ControllerService::set(const vm::Request& request) {
  base::Status checked = check_assignments(request, false);
  if (!checked.ok()) return checked.error();
  base::Status done = base::Ok{};
  base::Status taken = at_boundary([&] {
    for (size_t i = 0; i < request.names.size() && done.ok(); ++i) {
      done = controller_.set(request.names[i], request.values[i]);
    }
  });
  if (!taken.ok()) return taken.error();
  if (!done.ok()) return done.error();
  return nothing();
}

// The code for it is made here, beside the running program; the boundary only exchanges it.
base::Result<base::Bytes> ControllerService::force(const vm::Request& request) {
  base::Status checked = check_assignments(request, true);
  if (!checked.ok()) return checked.error();
  std::vector<vm::NamedValue> values;
  for (size_t i = 0; i < request.names.size(); ++i) {
    values.push_back({request.names[i], request.values[i]});
  }
  auto change = controller_.prepare_force(values);
  if (!change.ok()) return change.error();
  base::Status taken = at_boundary([&] { controller_.use(**change); });
  if (!taken.ok()) return taken.error();
  return force_rows(request.names);
}

base::Result<base::Bytes> ControllerService::unforce(const vm::Request& request) {
  std::vector<std::string> names = request.names;
  if (names.empty()) {
    for (const vm::Force& force : controller_.forces()) names.push_back(force.path);
  }
  auto change = controller_.prepare_unforce(names);
  if (!change.ok()) return change.error();
  base::Status taken = at_boundary([&] { controller_.use(**change); });
  if (!taken.ok()) return taken.error();
  return nothing();
}

// Nothing of it is to be seen, so a recording need not have it; and what fails is tried again.
void ControllerService::keep_up() {
  const auto renew = [&] {
    if (auto change = controller_.renew_forces()) {
      boundary_.run([&] { controller_.use(*change); }, kKeepUpPatienceNs);
    }
    return true;
  };
  base::within_memory(renew, [] { return false; });
}

base::Result<base::Bytes> ControllerService::forces(const vm::Request&) { return force_rows({}); }

// Of the variables with these names, or all. Only this thread's commands change forces, so they can
// be read here.
base::Bytes ControllerService::force_rows(const std::vector<std::string>& names) const {
  vm::ForceRows forces;
  const ir::Image& image = controller_.image();
  for (const vm::Force& force : controller_.forces()) {
    const bool wanted =
        names.empty() || std::find(names.begin(), names.end(), force.path) != names.end();
    if (!wanted) continue;
    ir::Symbol alone = force.symbol;
    alone.data = 0;
    forces.rows.push_back({force.path, image.types.text(force.symbol.type),
                           ir::format_value(image, alone, force.value), force.reason});
  }
  return vm::encode(forces);
}

base::Result<base::Bytes> ControllerService::image(const vm::Request& request) {
  const base::Bytes& encoded = controller_.verified().encoded();
  if (request.offset > encoded.size()) {
    return base::Error{base::Refusal::kProtocol, "the image is not that long"};
  }
  vm::ImagePart part{controller_.verified().digest(), encoded.size(), {}};
  auto begin = encoded.begin() + static_cast<std::ptrdiff_t>(request.offset);
  auto size = std::min<uint64_t>(vm::kChunkBytes, encoded.size() - request.offset);
  part.bytes.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
  return vm::encode(part);
}

base::Result<base::Bytes> ControllerService::stop(const vm::Request&) {
  stop_wanted_.store(true, std::memory_order_relaxed);
  return nothing();
}

// The answer is what FB_Exit had to say, mostly nothing.
base::Result<base::Bytes> ControllerService::restart(const vm::Request& request) {
  if (request.flags > static_cast<uint32_t>(vm::Restart::kHot)) {
    return base::Error{base::Refusal::kProtocol, "a restart is cold, warm or hot"};
  }
  const auto kind = static_cast<vm::Restart>(request.flags);
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
