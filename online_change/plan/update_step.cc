#include "online_change/plan/update_step.h"

namespace online_change {

bool UpdateStep::early() const {
  const auto* initial = as<InitialValues>();
  return initial != nullptr && initial->early;
}

std::optional<CopiedValues> UpdateStep::source() const {
  if (const auto* copied = as<CopiedValues>()) return *copied;
  if (const auto* converted = as<ConvertedValues>()) {
    return CopiedValues{converted->from, converted->from_stride};
  }
  if (const auto* entered = as<EnteredStep>()) return CopiedValues{entered->from, 0};
  return std::nullopt;
}

const base::Bytes* UpdateStep::bytes() const {
  if (const auto* initial = as<InitialValues>()) return &initial->bytes;
  if (const auto* migrated = as<GivenValue>()) return &migrated->made;
  const auto* gathered = as<GatheredBits>();
  return gathered == nullptr ? nullptr : &gathered->rest;
}

}  // namespace online_change
