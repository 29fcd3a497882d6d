#include "tools/stvm/player.h"

#include <string>

#include "online_change/store/boot.h"

namespace stvm {
namespace {

base::Error unusable(const std::string& why) { return {base::Refusal::kBadRecording, why}; }

}  // namespace

base::Status Player::start() {
  const vm::RecordedStart& start = recording_.start;
  base::Result<ir::VerifiedImage> image = ir::verify(start.image);
  if (!image.ok()) return unusable(image.error().text);
  uint64_t retained = 0;
  for (const ir::RetainRange& range : image->image().retain) retained += range.size;
  if (!start.retained.empty() && start.retained.size() != retained) {
    return unusable("its retained values are of another program");
  }
  // Else a loop in the program could be one without an end.
  if (start.fuel_budget > vm::ControllerOptions().fuel_budget) {
    return unusable("its scans have more fuel than a controller gives them");
  }
  if (recording_.cycles.empty()) return unusable("it ends before the program had started");
  base::Status started = start_controller(*image);
  if (started.ok()) started = start_service(*image, retained);
  return started.ok() ? compare_and_ask(recording_.cycles.front()) : started;
}

base::Status Player::start_controller(const ir::VerifiedImage& image) {
  const vm::RecordedStart& start = recording_.start;
  vm::ControllerOptions options;
  options.fuel_slice = start.fuel_slice;
  options.fuel_budget = start.fuel_budget;
  options.code_limit = start.code_limit;
  options.code_slack_percent = 0;  // what found room then finds it here
  options.data_limit = start.data_limit;
  options.on_trap = start.on_trap;
  replay_.see(recording_.cycles.front().observed);
  auto controller = vm::Controller::start(image, options, replay_, replay_, start.retained);
  if (!controller.ok()) return controller.error();
  controller_ = std::move(*controller);
  return base::Ok{};
}

base::Status Player::start_service(const ir::VerifiedImage& image, uint64_t retained) {
  const base::Bytes& trial = recording_.start.trial;
  auto edits = std::make_optional<std::vector<online_change::ResumedEdit>>();
  if (!trial.empty()) edits = online_change::decode_trial(trial, image.digest());
  if (!edits) return unusable("its edits on trial do not lead to its program");
  // The store is as it was: what undo can come to is what was accepted.
  const ir::VerifiedImage& accepted = edits->empty() ? image : edits->front().before;
  base::Result<online_change::Boot> boot = online_change::boot(store_, accepted, "replay", 0);
  if (!boot.ok()) return boot.error();
  base::Status stored = base::Ok{};
  if (!edits->empty()) {
    stored = store_.begin_trial({image.digest(), image.encoded()}, retained, false);
  }
  if (!stored.ok()) return stored;
  service_.emplace(*controller_, idle_clock_, store_, boundary_);
  service_->stand_between_cycles();
  if (!edits->empty()) service_->resume(*edits);
  return base::Ok{};
}

base::Status Player::cycle() {
  const vm::RecordedCycle& cycle = recording_.cycles[next_++];
  replay_.see(cycle.observed);
  controller_->cycle();
  return compare_and_ask(cycle);
}

base::Status Player::compare_and_ask(const vm::RecordedCycle& cycle) {
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

base::Status Player::ask(const vm::RecordedRequest& recorded) {
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

}  // namespace stvm
