// The commands of a package in stored order, once for both directions (base/archive.h).
#pragma once

#include "base/archive.h"
#include "online_change/package/package.h"
#include "online_change/package/stored_step.h"

namespace online_change {

template <class Archive, class T>
void fate_fields(Archive& a, T& row) {
  a.enumerator(row.fate, Fate::kDropped);
  a(row.path);
  a(row.old_type);
  a(row.new_type);
  a(row.may_lose);
  a(row.reason);
  a(row.count);
  a(row.old_path);
}

template <class Archive, class T>
void call_fields(Archive& a, T& call) {
  a(call.row);
  a(call.instance);
  a(call.place);
  a(call.type);
  a.list(call.inputs, 3 * 4, [&](auto& input) {
    a(input.from);
    a(input.type);
    a(input.slot);
  });
}

template <class Archive, class T>
void gather_fields(Archive& a, T& gather) {
  a.list(gather, 3 * 4 + 2, [&](auto& part) {
    a(part.from);
    a(part.within);
    a(part.size);
    a(part.from_mask);
    a(part.to_mask);
  });
}

// `gathers`: of a version that has them.
template <class Archive, class T>
void plan_fields(Archive& a, T& plan, bool gathers) {
  a.list(plan.fates, 1 + 3 * 4 + 1 + 4 + 8 + 4, [&](auto& row) { fate_fields(a, row); });
  a(plan.counts.kept);
  a(plan.counts.moved);
  a(plan.counts.converted);
  a(plan.counts.initialised);
  a(plan.counts.dropped);
  a.list(plan.steps, 2 + 9 * 4 + 4, [&](auto& step) { step_fields(a, step); });
  a.list(plan.calls, 5 * 4, [&](auto& call) { call_fields(a, call); });
  if (gathers) a.list(plan.gathers, 4, [&](auto& gather) { gather_fields(a, gather); });
  a(plan.boundary_bytes);
  a(plan.predicted_pause_ns);
}

template <class Archive, class T>
void command_fields(Archive& a, T& package, bool gathers) {
  a(package.base);
  plan_fields(a, package.forward, gathers);
  plan_fields(a, package.inverse, gathers);
}

}  // namespace online_change
