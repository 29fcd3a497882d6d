#include "online_change/store/control_record.h"

#include <algorithm>

namespace online_change {

base::Bytes encode(const ControlRecord& record) {
  base::ByteWriter out;
  out.raw(record.boots);
  out.u8(record.slot);
  out.boolean(record.trial);
  out.u8(record.tries_left);
  out.raw(record.trial_digest);
  return out.take();
}

std::optional<ControlRecord> decode_control(base::ByteSpan payload) {
  base::ByteReader in(payload);
  ControlRecord record;
  auto digest = [&](base::Digest& out) {
    base::ByteSpan bytes = in.raw(out.size());
    std::copy(bytes.begin(), bytes.end(), out.begin());
  };
  digest(record.boots);
  record.slot = in.u8();
  record.trial = in.boolean();
  record.tries_left = in.u8();
  digest(record.trial_digest);
  if (!in.done() || record.slot > 1) return std::nullopt;
  return record;
}

}  // namespace online_change
