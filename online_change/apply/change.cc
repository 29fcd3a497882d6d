#include "online_change/apply/change.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "base/check.h"
#include "base/memory_limit.h"
#include "base/tool_limits.h"
#include "online_change/apply/losses.h"
#include "online_change/apply/pending.h"
#include "online_change/plan/pause.h"

namespace online_change {
namespace {

const Plan kNothing;

}  // namespace

const char* state_name(State state) {
  constexpr const char* kNames[] = {"idle",     "staged", "verified", "planned",
                                    "prepared", "armed",  "trial"};
  return kNames[static_cast<size_t>(state)];
}

Change::Change(vm::Controller& controller) : controller_(controller) {
  below_.reserve(base::kMostEditsOnTrial);  // what rests needs no memory for that
}
Change::~Change() = default;

template <class Step>
auto Change::guarded(Step step) -> decltype(step()) {
  return base::within_memory(step, [this]() -> decltype(step()) {
    if (pending_) put_back_kept();  // what FB_Exit has written already
    abandon();
    return base::Error{base::Refusal::kNoMemory, {}};
  });
}

base::Error Change::not_in(const char* wanted) const {
  return {base::Refusal::kBusy,
          std::string("the change is ") + state_name(state_) + ", not " + wanted};
}

base::Error Change::no_boundary() {
  return {base::Refusal::kBusy, "a task is inside a scan; the switch waits for a boundary"};
}

// Its start code would run as the new version's, and when that traps, what it writes would stay.
base::Error Change::starts_anew() {
  return {base::Refusal::kBusy, "the program is started anew; the switch waits for its next cycle"};
}

base::Error Change::abandoned(const char* where) const {
  return {base::Refusal::kDeadline,
          std::string("the change was abandoned ") + where + "; the old program runs on"};
}

base::Status Change::stage(base::ByteSpan package, Strategy strategy, const AtBoundary& at_boundary,
                           TakenOut taken_out) {
  if (prepares()) {
    return base::Error{
        base::Refusal::kChangePending,
        std::string("another change is ") + state_name(state_) + "; switch or cancel it first"};
  }
  if (base::Status free = room(); !free.ok()) return free;
  collect();
  if (state_ == State::kTrial) rest();
  base::Status status =
      guarded([&] { return stage_steps(package, strategy, at_boundary, taken_out); });
  if (!status.ok()) cancel();
  return status;
}

base::Status Change::stage_steps(base::ByteSpan bytes, Strategy strategy,
                                 const AtBoundary& at_boundary, TakenOut taken_out) {
  const ir::VerifiedImage& before = controller_.verified();
  base::Result<Package> package = decode(bytes, before.encoded());
  if (!package.ok()) return package.error();
  const base::Digest& running = before.digest();
  if (ir::digest(package->image) == running && package->image == before.encoded()) {
    return base::Error{base::Refusal::kNoChange,
                       "version " + base::short_hex(running) + " is running already"};
  }
  if (package->base != running) return stale_base(package->base, running);
  state_ = State::kStaged;
  if (interrupted()) return abandoned("when it was received");
  auto received = std::make_shared<const base::Bytes>(std::move(package->image));
  if (received_) received_(received);
  base::Result<ir::VerifiedImage> image = ir::verify(std::move(received));
  if (!image.ok()) return image.error();
  state_ = State::kVerified;
  if (interrupted()) return abandoned("when it was verified");
  const bool same =
      same_data({before.image(), before.encoded()}, {image->image(), image->encoded()});
  if (!same || !leaves_all(*package)) {
    base::Status sound = check_package(*package, before.image(), image->image());
    if (!sound.ok()) return sound;
  }
  if (taken_out.change != nullptr) give_back(package->forward, image->image(), taken_out);
  pending_ = std::make_unique<Pending>(std::move(*package), before, *image, strategy, same);
  state_ = State::kPlanned;
  if (interrupted()) return abandoned("when its plan was checked");
  // The code slots of the change below are written now (prime()).
  if (!below_.empty() && below_.back()->waiting) retired_ = std::move(below_.back()->waiting);
  base::Result<std::unique_ptr<vm::Generation>> next = controller_.prepare(*image);
  if (!next.ok()) return next.error();
  pending_->waiting = std::move(*next);
  retired_.reset();  // prepare() has just forgotten it
  if (base::Status tried = try_migrations(at_boundary); !tried.ok()) return tried;
  const uint64_t limit = controller_.data_limit();
  if (pending_->in_place() && limit != 0 && image->image().data_capacity > limit &&
      image->image().data_capacity > before.image().data_capacity) {
    return base::Error{base::Refusal::kTooLarge,
                       "data memory grows to " + std::to_string(image->image().data_capacity) +
                           " bytes; data_limit of this controller is " + std::to_string(limit)};
  }
  if (!pending_->in_place()) {
    base::Result<std::unique_ptr<Standby>> area = Standby::make(
        controller_.generation(), *pending_->waiting, pending_->forward, controller_.data_limit());
    if (!area.ok()) return area.error();
    pending_->area = std::move(*area);
  }
  pending_->count_work(controller_.generation().bools());
  state_ = State::kPrepared;
  if (interrupted()) return abandoned("when it was prepared");
  return base::Ok{};
}

base::Status Change::migrate() {
  if (!pending_->migrate) return base::Ok{};
  return pending_->migrate->run(controller_.memory().data());
}

const Plan& Change::plan() const { return pending_ ? pending_->package.forward : kNothing; }

const ir::VerifiedImage* Change::next() const {
  return pending_ && state_ != State::kTrial ? &pending_->new_image : nullptr;
}

bool Change::keeps_all() const { return pending_ && pending_->keeps_all; }

Strategy Change::strategy() const { return pending_ ? pending_->strategy : Strategy::kInPlace; }

base::Status Change::arm(bool allow_loss, bool allow_overrun) {
  return guarded([&] { return arm_steps(allow_loss, allow_overrun); });
}

base::Status Change::arm_steps(bool allow_loss, bool allow_overrun) {
  if (state_ != State::kPrepared) return not_in("prepared");
  base::Status fits = admit(allow_overrun);
  if (!fits.ok()) return fits;
  base::Status lossless = refused_by_values(allow_loss);
  if (!lossless.ok()) return lossless;
  do {
    if (!interrupted()) continue;
    abandon();
    return abandoned("while it was armed");
  } while (late_unit());
  if (pending_->in_place()) pending_->forward.touch(controller_.memory().data());
  pending_->allow_loss = allow_loss;
  state_ = State::kArmed;
  return base::Ok{};
}

SwitchReport Change::report_begin() const {
  SwitchReport report;
  report.cycle_before = controller_.cycles();
  report.cycle_after = report.cycle_before + 1;
  return report;
}

bool Change::carry_in_place(const OnLoss& on_loss) {
  uint8_t* memory = controller_.memory().data();
  std::optional<KeptData>& kept = pending_->kept;
  return pending_->forward.read(memory, on_loss, interrupted_) &&
         pending_->forward.save(memory, interrupted_) &&
         pending_->backward.remember(memory, interrupted_) &&
         (!kept || kept->holds() || kept->keep(memory, interrupted_)) &&
         pending_->forward.write(memory, interrupted_);
}

// Nothing is visible before the last line of it, and a failure leaves version 1's state.
base::Status Change::carry_over() {
  const uint8_t* source = controller_.memory().data();
  const bool apart = pending_->area != nullptr;
  uint8_t* target = apart ? pending_->area->data().data() : controller_.memory().data();
  Transfer& transfer = pending_->forward;
  Loss lost;
  auto on_loss = [&](const Loss& loss) {
    lost = loss;
    return pending_->may_lose(loss);
  };
  const bool carried =
      apart ? pending_->area->close(source, on_loss, interrupted_) : carry_in_place(on_loss);
  if (!carried) {
    if (lost.what == nullptr || pending_->may_lose(lost)) return abandoned("at the boundary");
    Areas areas(pending_->new_image.image());
    return would_lose(describe(lost, transfer, areas, source), 0);
  }
  std::optional<uint32_t> broken =
      pending_->handles.forward(target, pending_->allow_loss, interrupted_);
  if (broken) {
    if (!apart) transfer.restore(target);
    return *broken == HandleTransfer::kInterrupted
               ? abandoned("at the boundary")
               : would_lose(broken_at(Areas(pending_->new_image.image()), *broken), 0);
  }
  if (interrupted()) {
    if (!apart) pending_->handles.restore_forward(target);
    if (!apart) transfer.restore(target);
    return abandoned("before its last step");
  }
  return base::Ok{};
}

// FB_Exit runs while the old program still does: what it writes is carried over. When the old
// program goes on, all is put back that it wrote, and nothing has left (put_back_kept()).
base::Status Change::leave(const std::vector<uint32_t>& ids) {
  if (ids.empty()) return base::Ok{};
  std::optional<KeptData>& kept = pending_->kept_at(state_);
  base::check(kept.has_value(), "FB_Exit runs, and nothing was taken to keep values in");
  if (!kept->keep(controller_.memory().data(), interrupted_)) return abandoned("at the boundary");
  return controller_.leave(ids, controller_.base_period_ns());
}

void Change::put_back_kept() {
  std::optional<KeptData>& kept = pending_->kept_at(state_);
  if (!kept || !kept->holds()) return;
  kept->put_back(controller_.memory().data());
  controller_.values_put_back();
}

// Memory can run out when the text of a trap in FB_Init is made: version 2 is published then, and
// goes without needing any.
base::Result<SwitchReport> Change::switch_now(bool again) {
  const size_t before = on_trial();
  base::Result<SwitchReport> report = guarded([&] { return switch_steps(again); });
  if (!report.ok() && on_trial() > before) take_back();
  return report;
}

base::Result<SwitchReport> Change::switch_steps(bool again) {
  if (state_ != State::kArmed) return not_in("armed");
  if (!controller_.at_boundary()) return no_boundary();
  if (controller_.starts_anew() && !controller_.faulted()) return starts_anew();
  SwitchReport report = report_begin();
  int64_t begin_ns = measured_ns();
  const bool leaves = !pending_->leaving.at_switch.empty();
  base::Status carried = leaves ? check_losses(pending_->allow_loss) : base::Status(base::Ok{});
  if (carried.ok()) {
    carried = leave(pending_->leaving.at_switch);
    if (carried.ok()) carried = check_charts();
    if (carried.ok()) carried = migrate();
    if (carried.ok()) pending_->charts.note(controller_.memory().data());
    if (carried.ok()) carried = carry_over();
    if (!carried.ok() && leaves) put_back_kept();
    count_switch();
  }
  if (!carried.ok()) {
    const bool late = pending_->area && pending_->area->behind();
    if (!again || leaves || !late) abandon();
    return carried.error();
  }
  vm::Memory& data = pending_->area ? pending_->area->data() : controller_.memory();
  if (pending_->migrate_back) pending_->migrate_back->note(data.data());
  vm::Memory* const area = pending_->area ? &pending_->area->data() : nullptr;
  pending_->waiting = controller_.publish(std::move(pending_->waiting), area);
  moved_forces_ = controller_.take_moved_forces();
  pending_->ended_forces = moved_forces_.ended;
  state_ = State::kTrial;
  if (base::Status entered = enter(); !entered.ok()) return entered.error();
  report.pause_ns = measured_ns() - begin_ns;
  report.counts = plan().counts;
  return report;
}

// Nothing of version 2 has run but its FB_Init, so nothing can keep version 1 from coming back.
base::Status Change::enter() {
  if (!does_anything(plan())) return base::Ok{};
  base::Status entered = controller_.enter();
  if (!entered.ok()) take_back();
  return entered;
}

void Change::take_back() {
  const auto interrupted = std::exchange(interrupted_, nullptr);
  const bool undone = undo_steps(Exits::kSkip, Losses::kAllowed, true).ok();
  interrupted_ = interrupted;
  base::check(undone, "a switch whose FB_Init trapped cannot be undone");
  // What FB_Exit and start code wrote to other variables goes with it.
  uint8_t* memory = controller_.memory().data();
  if (retired_pending_->kept) {
    retired_pending_->kept->put_back(memory);
  } else if (retired_area_) {
    retired_area_->put_back(memory);
  }
}

void Change::cancel() {
  abandon();
  collect();
}

void Change::collect() {
  retired_area_.reset();
  retired_pending_.reset();
  if (state_ == State::kTrial) pending_->kept.reset();
  // After a switch, which nothing takes back: without memory for it the program is interpreted.
  base::within_memory([&] { return controller_.make_native(), true; }, [] { return false; });
  (void)prime().ok();  // undo asks again
  if (state_ != State::kIdle) return;
  controller_.settle_devices();
  retired_.reset();
}

// At a boundary too: what was taken is freed later.
void Change::abandon() {
  if (state_ == State::kTrial) return;
  if (pending_ && pending_->waiting) retired_ = std::move(pending_->waiting);
  if (pending_) retired_area_ = std::move(pending_->area);
  if (pending_) retired_pending_ = std::move(pending_);
  state_ = State::kIdle;
  resume();
}

}  // namespace online_change
