#include "online_change/package/stored_step.h"

#include <utility>

namespace online_change {
namespace {

template <class Archive>
void fields(Archive& a, StoredStep& step) {
  a.enumerator(step.kind, StepKind::kGather);
  a(step.early);
  a(step.from);
  a(step.to);
  a(step.size);
  a(step.count);
  a(step.from_stride);
  a(step.to_stride);
  a(step.old_type);
  a(step.new_type);
  a(step.fate);
}

void set_how(const StoredStep& stored, base::Bytes bytes, UpdateStep& step) {
  switch (stored.kind) {
    case StepKind::kInitialise:
      step.how = InitialValues{std::move(bytes), stored.early};
      return;
    case StepKind::kCopy:
      step.how = CopiedValues{stored.from, stored.from_stride};
      return;
    case StepKind::kConvert:
      step.how =
          ConvertedValues{stored.from, stored.from_stride, stored.old_type, stored.new_type, {}};
      return;
    case StepKind::kEnter:
      step.how = EnteredStep{stored.from, stored.from_stride};
      return;
    case StepKind::kMigrate:
      step.how = GivenValue{stored.from, stored.from_stride, stored.new_type, {}};
      return;
    case StepKind::kGather:
      step.how = GatheredBits{stored.from, std::move(bytes)};
      return;
  }
}

}  // namespace

StoredStep stored(const UpdateStep& step) {
  StoredStep out;
  out.kind = step.kind();
  out.early = step.early();
  out.to = step.to;
  out.size = step.size;
  out.count = step.count;
  out.to_stride = step.to_stride;
  out.fate = step.fate;
  if (const auto source = step.source()) {
    out.from = source->from;
    out.from_stride = source->from_stride;
  }
  if (const auto* converted = step.as<ConvertedValues>()) {
    out.old_type = converted->old_type;
    out.new_type = converted->new_type;
  } else if (const auto* entered = step.as<EnteredStep>()) {
    out.from_stride = entered->active;
  } else if (const auto* given = step.as<GivenValue>()) {
    out.from = given->call;
    out.from_stride = given->slot;
    out.new_type = given->type;
  } else if (const auto* gathered = step.as<GatheredBits>()) {
    out.from = gathered->row;
  }
  return out;
}

std::optional<UpdateStep> from_stored(const StoredStep& stored, base::Bytes bytes) {
  const bool initial = stored.kind == StepKind::kInitialise;
  const bool may_have_bytes = initial || stored.kind == StepKind::kGather;
  if ((stored.early && !initial) || (!bytes.empty() && !may_have_bytes)) return std::nullopt;
  UpdateStep step;
  step.to = stored.to;
  step.size = stored.size;
  step.count = stored.count;
  step.to_stride = stored.to_stride;
  step.fate = stored.fate;
  set_how(stored, std::move(bytes), step);
  return step;
}

void step_fields(base::WriteArchive& a, const UpdateStep& step) {
  StoredStep fixed = stored(step);
  fields(a, fixed);
  const base::Bytes* const bytes = step.bytes();
  static const base::Bytes kNone;
  a(bytes == nullptr ? kNone : *bytes);
}

void step_fields(base::ReadArchive& a, UpdateStep& step) {
  StoredStep fixed;
  base::Bytes bytes;
  fields(a, fixed);
  a(bytes);
  std::optional<UpdateStep> read = from_stored(fixed, std::move(bytes));
  if (!read) return a.fail();
  step = std::move(*read);
}

}  // namespace online_change
