// stvm replay: a recorded run again, cycle by cycle, compared with what it was.
#include <cstdio>
#include <optional>

#include "ir/bytecode/variable_names.h"
#include "online_change/store/boot.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/memory_storage.h"
#include "tools/stvm/names.h"
#include "tools/stvm/plot.h"
#include "tools/stvm/run_resources.h"
#include "tools/stvm/trace.h"
#include "tools/stvm/trap_text.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/replay.h"
#include "vm/runtime/state_sum.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kReplayOptions[] = {
    tools::kScansOption, tools::kPrintOption, tools::kPlotOption,
    tools::kTraceOption, STVM_FORMAT_OPTION,
};
constexpr tools::Command kReplayCommand{
    "replay",       "RECORDING", "Runs a recorded run again and compares every cycle.",
    kReplayOptions, 1,           1};

// Every job is done at once: between two cycles of a replay there is nobody else.
class AtOnce : public vm::Boundary {
 public:
  Outcome run(const std::function<void()>& job, int64_t) override {
    job();
    return Outcome::kDone;
  }
  void pause(int64_t) override {}
};

class Player {
 public:
  explicit Player(vm::Recording recording) : recording_(std::move(recording)), store_(storage_) {}

  base::Status start() {
    const vm::RecordedStart& start = recording_.start;
    base::Result<ir::VerifiedImage> image = ir::verify(start.image);
    if (!image.ok()) return unusable(image.error().text);
    vm::ControllerOptions options;
    options.fuel_slice = start.fuel_slice;
    options.fuel_budget = start.fuel_budget;
    options.code_limit = start.code_limit;
    options.code_slack_percent = 0;  // what found room then finds it here
    options.data_limit = start.data_limit;
    options.on_trap = start.on_trap;
    uint64_t retained = 0;
    for (const ir::RetainRange& range : image->image().retain) retained += range.size;
    if (!start.retained.empty() && start.retained.size() != retained) {
      return unusable("its retained values are of another program");
    }
    if (recording_.cycles.empty()) return unusable("it ends before the program had started");
    replay_.see(recording_.cycles.front().observed);
    auto controller = vm::Controller::start(*image, options, replay_, replay_, start.retained);
    if (!controller.ok()) return controller.error();
    controller_ = std::move(*controller);
    auto edits = std::make_optional<std::vector<online_change::ResumedEdit>>();
    if (!start.trial.empty()) edits = online_change::decode_trial(start.trial, image->digest());
    if (!edits) return unusable("its edits on trial do not lead to its program");
    // The store is as it was: what undo can come to is what was accepted.
    const ir::VerifiedImage& accepted = edits->empty() ? *image : edits->front().before;
    base::Result<online_change::Boot> boot = online_change::boot(store_, accepted, "replay", 0);
    if (!boot.ok()) return boot.error();
    base::Status stored = base::Ok{};
    if (!edits->empty()) {
      stored = store_.begin_trial({image->digest(), image->encoded()}, retained, false);
    }
    if (!stored.ok()) return stored;
    service_.emplace(*controller_, idle_clock_, store_, boundary_);
    service_->stand_between_cycles();
    if (!edits->empty()) service_->resume(*edits);
    return compare_and_ask(recording_.cycles.front());
  }

  bool at_end() const { return next_ == recording_.cycles.size(); }

  base::Status cycle() {
    const vm::RecordedCycle& cycle = recording_.cycles[next_++];
    replay_.see(cycle.observed);
    controller_->cycle();
    return compare_and_ask(cycle);
  }

  vm::Controller& controller() { return *controller_; }
  const vm::Recording& recording() const { return recording_; }

 private:
  static base::Error unusable(const std::string& why) {
    return {base::Refusal::kBadRecording, why};
  }

  // The cycle came out as it was, and after it is done what was asked for then.
  base::Status compare_and_ask(const vm::RecordedCycle& cycle) {
    if (sum_.of(*controller_) != cycle.state || !replay_.exact()) {
      return base::Error{base::Refusal::kReplayDiffers,
                         "after cycle " + std::to_string(cycle.number)};
    }
    for (; request_ < recording_.requests.size(); ++request_) {
      const vm::RecordedRequest& request = recording_.requests[request_];
      if (request.cycle > cycle.number) break;
      if (base::Status done = ask(request); !done.ok()) return done;
    }
    return base::Ok{};
  }

  // The request was carried out then, whatever time was left; so it is now.
  base::Status ask(const vm::RecordedRequest& recorded) {
    base::Result<vm::Request> request = vm::decode_request(recorded.bytes);
    if (!request.ok()) return unusable(request.error().text);
    if (request->command == vm::Command::kSwitch) request->flags |= vm::kAllowOverrun;
    replay_.see(recorded.clock);
    bool keep_open = true;
    base::Result<base::Bytes> answer =
        vm::decode_answer(service_->answer(vm::encode(*request), keep_open));
    if (answer.ok()) return base::Ok{};
    // A list of revoked keys: here there are none (Admission::open), and nothing of it runs.
    if (answer.error().refusal == base::Refusal::kBadKeys) return base::Ok{};
    return base::Error{
        base::Refusal::kReplayDiffers,
        std::string(vm::command_name(request->command)) + " after cycle " +
            std::to_string(recorded.cycle) +
            " was carried out then, and is refused: " + base::to_string(answer.error())};
  }

  vm::Recording recording_;
  vm::Replay replay_;
  vm::StateSum sum_;
  vm::VirtualClock idle_clock_;
  MemoryStorage storage_;
  online_change::Store store_;
  AtOnce boundary_;
  std::unique_ptr<vm::Controller> controller_;
  std::optional<ControllerService> service_;
  size_t next_ = 1;
  size_t request_ = 0;
};

void print_result(const Player& player, vm::Controller& controller,
                  const std::vector<std::string>& names, bool json) {
  const bool whole = player.at_end() && !player.recording().cut_off;
  if (json) {
    tools::JsonWriter out;
    out.begin_object().field("cycles", controller.cycles()).field("identical", true);
    out.field("requests", player.recording().requests.size()).field("whole", whole);
    out.key("values").begin_object();
    for (const std::string& name : names) {
      out.key(name);
      typed_value_of(out, controller, name);
    }
    out.end_object().end_object();
    std::fputs(out.finish().c_str(), stdout);
    return;
  }
  for (const std::string& name : names) {
    base::Result<std::string> value = controller.get(name);
    std::printf("%s=%s\n", name.c_str(), value.ok() ? value->c_str() : "?");
  }
  std::printf("%llu cycles replayed, the state is identical after each of them\n",
              static_cast<unsigned long long>(controller.cycles()));
  if (player.recording().cut_off) std::printf("the end of the recording is lost\n");
}

base::Status replay(const tools::Options& options) {
  const bool json = wants_json(options);
  base::Result<uint64_t> scans = options.number("--scans", UINT64_MAX);
  if (!scans.ok()) return scans.error();
  const std::string& file = options.arguments().front();
  base::Result<base::Bytes> bytes = tools::read_bytes(file);
  if (!bytes.ok()) return bytes.error();
  base::Result<vm::Recording> recording = vm::decode_recording(*bytes);
  if (!recording.ok()) {
    return base::Error{recording.error().refusal, file + ": " + recording.error().text};
  }
  Player player(std::move(*recording));
  if (base::Status started = player.start(); !started.ok()) return started;
  Names names;
  for (const std::string& name : split_names(options.all("--print"))) {
    base::Result<Names> now = matching(player.controller().image(), {name});
    if (!now.ok() && is_pattern(name)) return now.error();
    if (!now.ok()) now = Names{name};  // a change can bring it
    names.insert(names.end(), now->begin(), now->end());
  }
  std::optional<Trace> trace;
  if (options.has("--trace")) {
    base::Result<Trace> opened =
        Trace::open(options.text("--trace"), player.controller().image(), names);
    if (!opened.ok()) return opened.error();
    trace.emplace(std::move(*opened));
  }
  std::optional<Plot> plot;
  if (options.has("--plot")) {
    base::Result<Plot> begun = Plot::of(player.controller(), names);
    if (!begun.ok()) return begun.error();
    plot.emplace(std::move(*begun));
  }
  while (!player.at_end() && player.controller().cycles() < *scans) {
    if (base::Status same = player.cycle(); !same.ok()) return same;
    if (!player.controller().at_boundary()) continue;
    if (plot) plot->sample(player.controller());
    if (!trace) continue;
    if (base::Status written = trace->write(player.controller()); !written.ok()) return written;
  }
  if (trace) {
    if (base::Status closed = trace->close(); !closed.ok()) return closed;
  }
  // Only now: a change can have brought them.
  for (const std::string& name : names) {
    base::Result<ir::Symbol> symbol = ir::named_symbol(player.controller().image(), name);
    if (!symbol.ok()) return symbol.error();
  }
  if (plot) {
    const std::string picture = plot->svg(player.controller().image().name);
    base::Status drawn = tools::write_file(options.text("--plot"), base::as_bytes(picture));
    if (!drawn.ok()) return drawn;
  }
  print_result(player, player.controller(), names, json);
  return base::Ok{};
}

int run_replay(const tools::Options& options) {
  base::Status done = replay(options);
  if (done.ok()) return tools::kOk;
  const int code = refuse(done.error());
  return done.error().refusal == base::Refusal::kReplayDiffers ? tools::kFindings : code;
}

}  // namespace

const Entry kReplay{&kReplayCommand, run_replay};

}  // namespace stvm
