#include "tests/golden/runner/machine_engine.h"

#include <cstring>
#include <utility>

#include "ir/bytecode/symbols.h"
#include "online_change/apply/change.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"

namespace golden {
namespace {

class NoDevices : public vm::IoPort {
 public:
  void receive(std::span<uint8_t>) override {}
  void send(std::span<const uint8_t>) override {}
};

std::string count_text(const online_change::FateCounts& counts) {
  return "kept " + std::to_string(counts.kept) + ", moved " + std::to_string(counts.moved) +
         ", converted " + std::to_string(counts.converted) + ", initialised " +
         std::to_string(counts.initialised) + ", dropped " + std::to_string(counts.dropped);
}

// "Main.x: converted INT -> DINT (retyped)"
std::string fate_text(const online_change::FateRow& row) {
  std::string text = row.path + ": " + online_change::fate_name(row.fate);
  if (row.count > 1) text += " x" + std::to_string(row.count);
  if (row.old_type.empty() || row.new_type.empty() || row.old_type == row.new_type) {
    text += " " + (row.new_type.empty() ? row.old_type : row.new_type);
  } else {
    text += " " + row.old_type + " -> " + row.new_type;
  }
  return row.reason.empty() ? text : text + " (" + row.reason + ")";
}

// The tiers of changes run native code on both sides, but one.
vm::TierOptions tier_options(Tier tier) {
  vm::TierOptions out;
  switch (tier) {
    case Tier::kEvaluator:
    case Tier::kInterpreter:
    case Tier::kIdentity:
      out.tier = vm::Tier::kInterpreter;
      break;
    case Tier::kUnfused:
      out.tier = vm::Tier::kInterpreter;
      out.fusing = vm::Fusing::kNever;
      break;
    case Tier::kFuelOne:  // resumes in the middle of what is fused elsewhere
      out.fusing_seed = 7;
      out.logic_line = 1;
      out.tier = vm::Tier::kInterpreter;
      break;
    case Tier::kMoveAll:
    case Tier::kStandby:
    case Tier::kNative:
    case Tier::kNativeFuelOne:
      break;
    case Tier::kFewRegisters:
      out.integer_registers = 5;
      out.plain = true;
      out.table_ways = 2;
      out.float_registers = 3;
      break;
    case Tier::kSpills:
      out.spill_seed = 12345;
      out.pou_seed = 99;
      out.logic_line = 1;
      out.fusing = vm::Fusing::kAlways;
      break;
    case Tier::kAlternating:
      out.alternates = true;
      out.fusing = vm::Fusing::kAlways;
      out.fusing_seed = 11;
      out.logic_line = 1;
      break;
    case Tier::kBeside:
      out.making = vm::Making::kBeside;
      out.take_at = 2;
      break;
  }
  return out;
}

std::vector<std::string> loss_texts(const std::vector<online_change::LiveLoss>& losses) {
  std::vector<std::string> lines;
  for (const online_change::LiveLoss& loss : losses) {
    std::string becomes = loss.new_value.empty() ? "" : " -> " + loss.new_value;
    lines.push_back("loss " + loss.path + ": " + loss.old_value + becomes + " " + loss.what);
  }
  return lines;
}

class MachineEngine : public Engine {
 public:
  MachineEngine(Tier tier, const Program& program) : tier_(tier), program_(&program) {}

  base::Status start() {
    base::Result<ir::VerifiedImage> image = link(*program_, nullptr, false);
    if (!image.ok()) return image.error();
    vm::ControllerOptions options;
    options.fuel_budget = 20'000'000;
    // As in the evaluator: a trap ends the scan of its task, and nothing else.
    options.on_trap = ir::OnTrap::kGoOn;
    if (tier_ == Tier::kFuelOne || tier_ == Tier::kNativeFuelOne || tier_ == Tier::kBeside) {
      options.fuel_slice = 1;
    }
    // In the middle of turns that are done together.
    if (tier_ == Tier::kFewRegisters) options.fuel_slice = 7;
    if (tier_ == Tier::kSpills) options.fuel_slice = 23;
    options.tier = tier_options(tier_);
    auto controller = vm::Controller::start(*image, options, clock_, devices_);
    if (!controller.ok()) return controller.error();
    controller_ = std::move(*controller);
    change_ = std::make_unique<online_change::Change>(*controller_);
    return base::Ok{};
  }

  base::Result<std::string> scan() override {
    // Those of FB_Init at the start belong to the first scan.
    size_t traps_before = scans_++ == 0 ? 0 : controller_->traps().size();
    controller_->cycle();
    const vm::Traps& traps = controller_->traps();
    if (traps.size() > traps_before) {
      const vm::TrapRecord& first = *traps[traps_before];
      return std::string(ir::trap_name(first.trap.kind)) + " " + first.text.pou + ":" +
             std::to_string(first.text.line);
    }
    if (!hard_change_is_due()) return std::string();
    base::Status switched = tier_ == Tier::kStandby ? late_change() : hard_change();
    if (!switched.ok()) return switched.error();
    return std::string();
  }

  std::string state() const override {
    return program_->states.text(controller_->verified(), controller_->memory().view());
  }
  base::Status set(const std::string& path, const std::string& value) override {
    return controller_->set(path, value);
  }
  base::Status force(const std::string& path, const std::string& value) override {
    return controller_->force(path, value);
  }
  base::Status unforce(const std::string& path) override { return controller_->unforce(path); }

  std::vector<std::string> forces() const override {
    std::vector<std::string> lines;
    for (const vm::Force& force : controller_->forces()) {
      lines.push_back(force.path + " " + vm::hold_text(force.reason));
    }
    return lines;
  }

  base::Status restart(Restart kind) override {
    constexpr int64_t kExitLimitNs = 1'000'000'000;
    constexpr vm::Restart kKinds[] = {vm::Restart::kCold, vm::Restart::kWarm, vm::Restart::kHot};
    // What FB_Exit trapped is on record; the evaluator does not report it either.
    (void)controller_->restart(kKinds[static_cast<size_t>(kind)], kExitLimitNs);
    return base::Ok{};
  }

  base::Result<std::vector<std::string>> change(const Program& next, bool allow_loss) override {
    change_->cancel();  // of late_change()
    base::Status staged = stage(next, false);
    if (!staged.ok()) return staged.error();
    std::vector<std::string> lines = {count_text(change_->plan().counts)};
    for (const online_change::FateRow& row : change_->plan().fates) {
      lines.push_back(fate_text(row));
    }
    for (std::string& line : loss_texts(change_->live_losses())) lines.push_back(std::move(line));
    base::Status armed = arm(allow_loss);
    if (!armed.ok()) {
      change_->cancel();
      return armed.error();
    }
    base::Result<online_change::SwitchReport> report = watched(change_->switch_now());
    if (!report.ok()) return report.error();
    previous_.push_back(program_);
    program_ = &next;
    hard_packages_.clear();
    return lines;
  }
  // With the losses of its report.
  base::Result<std::vector<std::string>> undo(bool allow_loss) override {
    if (base::Status primed = change_->prime(); !primed.ok()) return primed.error();
    std::vector<std::string> lines;
    if (change_->on_trial() != 0) {
      base::Result<vm::Memory> copy = vm::Memory::reserve();
      if (!copy.ok()) return copy.error();
      std::memcpy(copy->data(), controller_->memory().data(), controller_->image().data_capacity);
      lines = loss_texts(change_->imagine_undo(0, copy->data()).losses);
    }
    const auto losses =
        allow_loss ? online_change::Losses::kAllowed : online_change::Losses::kRefused;
    base::Result<online_change::SwitchReport> report =
        watched(change_->undo(online_change::Exits::kRun, losses));
    if (!report.ok()) return report.error();
    if (!previous_.empty()) {
      program_ = previous_.back();
      previous_.pop_back();
    }
    hard_packages_.clear();
    return lines;
  }
  base::Status accept() override { return change_->accept(); }
  uint64_t missed() const override { return controller_->missed_releases() + delayed_; }

 private:
  online_change::Strategy strategy() const {
    return tier_ == Tier::kStandby ? online_change::Strategy::kStandby
                                   : online_change::Strategy::kInPlace;
  }

  base::Status stage(const Program& next, bool move_all) {
    base::Result<ir::VerifiedImage> image = link(next, &controller_->image(), move_all);
    if (!image.ok()) return image.error();
    auto package = online_change::make_package(controller_->verified().encoded(), image->encoded());
    if (!package.ok()) return package.error();
    return change_->stage(online_change::encode(*package), strategy());
  }

  base::Result<online_change::SwitchReport> watched(
      base::Result<online_change::SwitchReport> report) {
    if (clock_.now_ns() > controller_->next_cycle_ns()) ++delayed_;
    return report;
  }

  // What can be done in idle time takes none of the scans'.
  base::Status arm(bool allow_loss) {
    base::Result<bool> done = change_->configure();
    return done.ok() ? change_->arm(allow_loss) : base::Status(done.error());
  }

  // After every scan; in a long run after each of the first, and after some of the others, which
  // meet every phase of what repeats. One that is armed is switched to at the next scan.
  bool hard_change_is_due() const {
    constexpr uint64_t kEach = 256;
    constexpr uint64_t kThen = 7;
    const bool hard = tier_ == Tier::kIdentity || tier_ == Tier::kAlternating ||
                      tier_ == Tier::kMoveAll || tier_ == Tier::kStandby;
    const online_change::State state = change_->state();
    if (!hard || state == online_change::State::kTrial) return false;
    return scans_ <= kEach || scans_ % kThen == 0 || state == online_change::State::kArmed;
  }

  // The same program under another name: without that, a change to itself would be none.
  base::Result<base::Bytes> hard_image() const {
    if (tier_ != Tier::kMoveAll) {
      ir::Image image = controller_->image();
      image.name = image.name.ends_with('\'') ? image.name.substr(0, image.name.size() - 1)
                                              : image.name + '\'';
      return ir::encode(image);
    }
    base::Result<ir::VerifiedImage> image = link(*program_, &controller_->image(), true);
    if (!image.ok()) return image.error();
    return image->encoded();
  }

  // The package that leads from the running image to the same program. Images alternate between a
  // few layouts, and linking is a pure function: each is linked once.
  base::Status stage_hard() {
    auto known = hard_packages_.find(controller_->verified().digest());
    if (known != hard_packages_.end()) return change_->stage(known->second, strategy());
    base::Result<base::Bytes> next = hard_image();
    if (!next.ok()) return next.error();
    auto package = online_change::make_package(controller_->verified().encoded(), *next);
    if (!package.ok()) return package.error();
    base::Bytes& bytes = hard_packages_[controller_->verified().digest()];
    bytes = online_change::encode(*package);
    return change_->stage(bytes, strategy());
  }

  // An identity change whose second area is a scan old when it is switched to.
  base::Status late_change() {
    if (change_->state() == online_change::State::kArmed) {
      base::Result<online_change::SwitchReport> report = watched(change_->switch_now());
      if (!report.ok()) return report.error();
      base::Status accepted = change_->accept();
      if (!accepted.ok()) return accepted;
    }
    base::Status staged = stage_hard();
    if (!staged.ok()) return staged;
    return arm(false);
  }

  // An identity change, with or without moving everything; nothing may differ after it.
  base::Status hard_change() {
    base::Status staged = stage_hard();
    // Relinked against itself, a program without instances to move is the same image.
    if (!staged.ok()) {
      return staged.error().refusal == base::Refusal::kNoChange ? base::Status(base::Ok{}) : staged;
    }
    base::Status armed = arm(false);
    if (!armed.ok()) return armed;
    base::Result<online_change::SwitchReport> report = watched(change_->switch_now());
    if (!report.ok()) return report.error();
    return change_->accept();
  }

  Tier tier_;
  const Program* program_;
  std::vector<const Program*> previous_;  // of each edit on trial
  vm::VirtualClock clock_;
  NoDevices devices_;
  uint64_t scans_ = 0;
  uint64_t delayed_ = 0;
  std::unique_ptr<vm::Controller> controller_;
  std::unique_ptr<online_change::Change> change_;
  std::map<base::Digest, base::Bytes> hard_packages_;
};

}  // namespace

base::Result<std::unique_ptr<Engine>> make_machine_engine(Tier tier, const Program& program) {
  auto engine = std::make_unique<MachineEngine>(tier, program);
  base::Status started = engine->start();
  if (!started.ok()) return started.error();
  return std::unique_ptr<Engine>(std::move(engine));
}

}  // namespace golden
