#include "tools/stvm/trial_guard.h"

#include <algorithm>
#include <cmath>

#include "base/joined.h"
#include "base/visible_text.h"
#include "tools/stvm/trap_text.h"

namespace stvm {
namespace {

constexpr size_t kShownText = 80;  // of a condition, in the journal
constexpr size_t kShownValues = 4;

base::Result<std::vector<ConditionVariable>> variables_of(const GuardOrder& order,
                                                          const ir::Image& next) {
  std::vector<ConditionVariable> variables;
  for (const std::string& name : order.names) {
    base::Result<ConditionVariable> variable = condition_variable(next, name);
    if (!variable.ok()) return variable.error();
    variables.push_back(*variable);
  }
  for (const Condition& condition : order.conditions) {
    base::Status fits = check_condition(condition, variables);
    if (fits.ok()) continue;
    return base::Error{fits.error().refusal,
                       base::joined({"`", condition.text, "`: ", fits.error().text})};
  }
  return variables;
}

}  // namespace

base::Status TrialGuard::check(const GuardOrder& order, const ir::Image& next) {
  const auto variables = variables_of(order, next);
  return variables.ok() ? base::Status(base::Ok{}) : base::Status(variables.error());
}

base::Status TrialGuard::stage(GuardOrder order, const ir::Image& running, const ir::Image& next) {
  if (is_on()) return base::Error{base::Refusal::kChangePending, "a trial is watched already"};
  auto variables = variables_of(order, next);
  if (!variables.ok()) return variables.error();
  variables_ = std::move(*variables);
  baseline_.resize(variables_.size());
  now_.resize(variables_.size());
  false_since_.assign(order.conditions.size(), -1);
  means_.clear();
  for (size_t i = 0; order.window_ns != 0 && i < variables_.size(); ++i) {
    const auto before = condition_variable(running, order.names[i]);
    const ConditionType type = condition_type(variables_[i]);
    if (!before.ok() || condition_type(*before) != type || type == ConditionType::kBool) continue;
    means_.push_back({i, *before});
  }
  order_ = std::move(order);
  online_before_ = order_.devices ? devices_online() : 0;
  trap_.reset();
  state_.store(State::kStaged, std::memory_order_release);
  return base::Ok{};
}

void TrialGuard::forget() {
  if (is_staged()) state_.store(State::kOff, std::memory_order_release);
}

bool TrialGuard::read(std::vector<ConditionValue>& values) const {
  bool all = true;
  for (size_t i = 0; i < variables_.size(); ++i) {
    all = read_variable(variables_[i], controller_.memory().data(), values[i]) && all;
  }
  return all;
}

uint64_t TrialGuard::devices_online() const {
  const std::vector<vm::DeviceStatus> devices = controller_.devices();
  return static_cast<uint64_t>(std::count_if(
      devices.begin(), devices.end(), [](const auto& one) { return one.state == "online"; }));
}

void TrialGuard::begin() {
  if (!is_staged()) return;
  began_ns_ = clock_.now_ns();
  traps_before_ = controller_.trap_count();
  missed_before_ = controller_.missed_releases();
  take_baseline();
  state_.store(State::kOn, std::memory_order_release);
  controller_.watch(this);
}

void TrialGuard::collect() {
  if (is_staged() && order_.window_ns != 0) controller_.watch(this);
}

void TrialGuard::collect_means() {
  for (Mean& mean : means_) {
    ConditionValue now;
    if (!read_variable(mean.before, controller_.memory().data(), now)) continue;
    const double value =
        now.type == ConditionType::kReal ? now.real : static_cast<double>(now.integer);
    if (!std::isfinite(value)) continue;
    mean.value += (value - mean.value) / static_cast<double>(++mean.count);
  }
}

// The first values of the version on trial, or the means of what they were before.
void TrialGuard::take_baseline() {
  (void)read(baseline_);
  for (const Mean& mean : means_) {
    ConditionValue& value = baseline_[mean.variable];
    if (mean.count == 0) continue;
    if (value.type == ConditionType::kReal) {
      value.real = mean.value;
    } else if (std::abs(mean.value) < 0x1p62) {
      value.integer = std::llround(mean.value);
    }
  }
}

void TrialGuard::end() {
  if (!is_on()) return;
  controller_.watch(nullptr);
  state_.store(State::kOff, std::memory_order_release);
}

void TrialGuard::fail(Cause cause) {
  if (state() != State::kOn) return;
  cause_ = cause;
  cycle_ = controller_.cycles();
  state_.store(State::kFailed, std::memory_order_release);
  if (failed) failed();
}

// What is computed is kept with the values that it was computed of.
void TrialGuard::look_at_conditions(int64_t now) {
  const bool fits = read(now_);
  for (size_t i = 0; i < order_.conditions.size(); ++i) {
    const Computed computed =
        fits ? compute(order_.conditions[i], now_, baseline_) : Computed::kOverflow;
    if (computed == Computed::kTrue) {
      false_since_[i] = -1;
      continue;
    }
    if (false_since_[i] < 0) false_since_[i] = now;
    if (now - false_since_[i] < order_.hold_ns) continue;
    condition_ = i;
    computed_ = computed;
    return fail(Cause::kCondition);
  }
}

void TrialGuard::at_boundary() {
  if (is_staged()) return collect_means();
  if (state() != State::kOn) return;
  const int64_t now = clock_.now_ns();
  const bool traps =
      controller_.faulted() || (order_.traps && controller_.trap_count() != traps_before_);
  if (traps) {
    if (!controller_.traps().empty()) trap_ = controller_.traps().back();
    return fail(Cause::kTrap);
  }
  if (now - began_ns_ >= order_.deadline_ns) return fail(Cause::kDeadline);
  if (now - began_ns_ < order_.grace_ns) {
    missed_before_ = controller_.missed_releases();
    return;
  }
  count_ = controller_.missed_releases() - missed_before_;
  if (count_ > order_.most_missed) return fail(Cause::kMissed);
  count_ = order_.most_load == 0 ? 0 : controller_.load();
  if (count_ > order_.most_load * 10) return fail(Cause::kLoad);
  look_at_conditions(now);
}

std::optional<TrialGuard::Cause> TrialGuard::look_aside(bool alarm) const {
  if (state() != State::kOn || clock_.now_ns() - began_ns_ < order_.grace_ns) return std::nullopt;
  if (order_.alarms && alarm) return Cause::kAlarm;
  if (order_.devices && devices_online() < online_before_) return Cause::kDevice;
  return std::nullopt;
}

// "Main.n = 5, baseline(Main.n) = 2"
std::string TrialGuard::values_text(const Condition& condition) const {
  std::string text;
  std::vector<std::string> said;
  for (const ConditionStep& step : condition.steps) {
    if (step.op > ConditionOp::kBaseline || said.size() == kShownValues) continue;
    const std::string& name = order_.names[step.operand];
    const bool before = step.op == ConditionOp::kBaseline;
    const ConditionValue& value = (before ? baseline_ : now_)[step.operand];
    std::string one = base::joined(
        {before ? "baseline(" : "", name, before ? ") = " : " = ", condition_text(value)});
    if (std::find(said.begin(), said.end(), one) != said.end()) continue;
    text += (text.empty() ? "" : ", ") + one;
    said.push_back(std::move(one));
  }
  return text;
}

std::string TrialGuard::why() const {
  const std::string at = " in cycle " + std::to_string(cycle_);
  std::string text;
  switch (cause_) {
    case Cause::kCondition: {
      const Condition& condition = order_.conditions[condition_];
      const char* const is = computed_ == Computed::kFalse    ? "` is FALSE"
                             : computed_ == Computed::kByZero ? "` divides by zero"
                                                              : "` has no room in 64 bits";
      text = base::joined({"`", base::whole_characters(condition.text, kShownText), is, at, ": ",
                           values_text(condition)});
      break;
    }
    case Cause::kDeadline:
      text = "nobody has accepted it by its deadline" + at;
      break;
    case Cause::kTrap:
      text = "a trap on trial" + at + (trap_ == nullptr ? "" : ": " + trap_text(*trap_));
      break;
    case Cause::kMissed:
      text = std::to_string(count_) + " release(s) were missed" + at;
      break;
    case Cause::kLoad:
      text = "the tasks took " + std::to_string(count_ / 10) + " % of their time" + at;
      break;
    case Cause::kDevice:
      text = "a device is no longer online" + at;
      break;
    case Cause::kAlarm:
      text = "an alarm of the storage" + at;
      break;
  }
  return base::joined({order_.note, ": ", text});
}

}  // namespace stvm
