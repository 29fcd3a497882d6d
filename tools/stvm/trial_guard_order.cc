#include "tools/stvm/trial_guard_order.h"

#include <algorithm>

#include "vm/runtime/fields.h"

namespace stvm {
namespace {

constexpr uint64_t kMostLoad = 1'000'000;  // percent

constexpr auto guard_step_fields = [](auto& a, auto& step) {
  a.enumerator(step.op, kLastConditionOp);
  a(step.operand);
};

constexpr auto condition_fields = [](auto& a, auto& condition) {
  a(condition.text);
  a.list(condition.steps, 9, [&](auto& step) { guard_step_fields(a, step); });
};

constexpr auto guard_fields = [](auto& a, auto& order) {
  a(order.note);
  a(order.deadline_ns);
  a(order.grace_ns);
  a(order.hold_ns);
  a(order.traps);
  a(order.devices);
  a(order.alarms);
  a(order.stop_safe);
  a(order.most_missed);
  a(order.most_load);
  a.texts(order.names);
  a.rows(order.conditions, 8, condition_fields);
  a.added(order.window_ns);
};

}  // namespace

base::Bytes encode(const GuardOrder& order) { return vm::write_fields(order, guard_fields); }

// As a request: what is not known is not left out, since whoever sends it relies on it.
base::Result<GuardOrder> decode_guard_order(base::ByteSpan bytes) {
  vm::FieldReader reader(bytes);
  GuardOrder order;
  guard_fields(reader, order);
  if (reader.failed()) return vm::not_understood("conditions of a trial");
  const base::ByteSpan more = reader.rest();
  if (std::any_of(more.begin(), more.end(), [](uint8_t byte) { return byte != 0; })) {
    return vm::not_understood("the trial has conditions that only a newer controller knows");
  }
  const bool timed =
      order.deadline_ns > 0 && order.grace_ns >= 0 && order.hold_ns >= 0 && order.window_ns >= 0;
  const bool bounded =
      order.names.size() <= kMostConditionNames && order.conditions.size() <= kMostConditions;
  if (timed && bounded) return order;
  return vm::not_understood("conditions of a trial");
}

}  // namespace stvm
