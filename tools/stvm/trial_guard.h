// The watch over an edit on trial that a roll-out has brought (X6-04, X6-05): it computes the
// conditions at each boundary from the switch on, on the control thread, and says when one of them,
// a trap or the deadline speaks against the edit. Who takes it back is the service, which is told.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "tools/stvm/trial_guard_order.h"
#include "vm/runtime/boundary_watch.h"
#include "vm/runtime/controller.h"

namespace stvm {

class TrialGuard : public vm::BoundaryWatch {
 public:
  enum class Cause : uint8_t { kCondition, kDeadline, kTrap, kMissed, kLoad, kDevice, kAlarm };

  TrialGuard(vm::Controller& controller, vm::Clock& clock)
      : controller_(controller), clock_(clock) {}

  // --- the channel's thread ---
  // Is every condition a BOOL over variables of `next`, and none too long?
  static base::Status check(const GuardOrder& order, const ir::Image& next);
  // Checked; the next switch from `running` to `next` begins it. Not while collect() is at work.
  base::Status stage(GuardOrder order, const ir::Image& running, const ir::Image& next);
  void forget();  // what is staged
  bool is_staged() const { return state() == State::kStaged; }
  // An edit is on trial under it. While it is, nothing is made on top of that.
  bool is_on() const { return state() >= State::kOn; }
  bool has_failed() const { return state() == State::kFailed; }
  // Devices and alarms can be looked at now and then only: does one speak against it?
  bool looks_aside() const { return is_on() && (order_.devices || order_.alarms); }
  std::optional<Cause> look_aside(bool alarm) const;
  // Why it has failed, with values and cycle.
  std::string why() const;
  const std::string& note() const { return order_.note; }
  int64_t left_ns() const { return order_.deadline_ns - (clock_.now_ns() - began_ns_); }
  bool stops_safe() const { return order_.stop_safe; }
  // After a failure that nothing can be done about.
  void give_up() { state_.store(State::kOff, std::memory_order_release); }
  // Called once, on the control thread, when it fails.
  std::function<void()> failed;

  // --- at a boundary ---
  // From here to the switch, the values for the baseline are looked at.
  void collect();
  // After the switch: the variables have their first values of the version on trial.
  void begin();
  // The trial is over: accepted or taken back.
  void end();
  void at_boundary() override;
  // It has failed, if it had not already.
  void fail(Cause cause);

 private:
  enum class State : uint8_t { kOff, kStaged, kOn, kFailed };

  State state() const { return state_.load(std::memory_order_acquire); }
  // False: one of the values has no room in 64 bits.
  bool read(std::vector<ConditionValue>& values) const;
  void look_at_conditions(int64_t now);
  void collect_means();
  void take_baseline();
  std::string values_text(const Condition& condition) const;
  uint64_t devices_online() const;

  vm::Controller& controller_;
  vm::Clock& clock_;
  std::atomic<State> state_{State::kOff};
  GuardOrder order_;
  std::vector<ConditionVariable> variables_;
  std::vector<ConditionValue> baseline_;
  struct Mean {  // of a number that the running version has, too
    size_t variable = 0;
    ConditionVariable before;  // there
    double value = 0;
    uint64_t count = 0;  // of what was seen
  };
  std::vector<Mean> means_;
  std::vector<ConditionValue> now_;
  std::vector<int64_t> false_since_;  // of each condition; -1: it is TRUE
  std::atomic<int64_t> began_ns_{0};
  uint64_t traps_before_ = 0;
  uint64_t missed_before_ = 0;
  uint64_t online_before_ = 0;

  Cause cause_ = Cause::kCondition;
  size_t condition_ = 0;
  Computed computed_ = Computed::kTrue;
  uint64_t cycle_ = 0;
  uint64_t count_ = 0;  // of what has failed: releases, per mille
  std::shared_ptr<const vm::TrapRecord> trap_;
};

}  // namespace stvm
