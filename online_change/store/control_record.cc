#include "online_change/store/control_record.h"

#include <algorithm>

#include "base/check.h"
#include "base/digest_reader.h"

namespace online_change {
namespace {

// Where there were two slots only, what was on trial lay in the other one, and nothing said so.
constexpr uint8_t other_of_two(uint8_t slot) { return slot == 0 ? 1 : 0; }

}  // namespace

base::Bytes encode(const ControlRecord& record) {
  base::dcheck(record.slot < kImageSlots, "the slot of what boots is one of three");
  base::ByteWriter out;
  out.raw(record.boots);
  out.u8(record.slot);
  out.boolean(record.trial);
  out.u8(record.tries_left);
  out.raw(record.trial_digest);
  const bool as_of_two = record.slot < 2 && record.trial_slot == other_of_two(record.slot);
  const bool resumes = record.trial && record.resumes;
  if (resumes || (record.trial && !as_of_two)) out.u8(record.trial_slot);
  if (resumes) out.boolean(true);
  base::Bytes bytes = out.take();
  base::dcheck(bytes.size() <= kMostControlBytes, "a control record has room in its file");
  return bytes;
}

std::optional<ControlRecord> decode_control(base::ByteSpan payload) {
  base::ByteReader in(payload);
  ControlRecord record;
  record.boots = base::read_digest(in);
  record.slot = in.u8();
  record.trial = in.boolean();
  record.tries_left = in.u8();
  record.trial_digest = base::read_digest(in);
  record.trial_slot = other_of_two(record.slot);
  if (in.left() != 0) record.trial_slot = in.u8();
  if (in.left() != 0) record.resumes = in.boolean();
  const bool sound = record.slot < kImageSlots && record.trial_slot < kImageSlots;
  if (!in.done() || !sound || record.slot == record.trial_slot) return std::nullopt;
  if (!record.trial && record.tries_left != 0) return std::nullopt;
  const base::Bytes written = encode(record);
  const bool same = std::equal(written.begin(), written.end(), payload.begin(), payload.end());
  return same ? std::optional(record) : std::nullopt;
}

}  // namespace online_change
