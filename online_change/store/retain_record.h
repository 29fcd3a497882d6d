// The retained values of one boundary, as bytes of the ranges of Image::retain one after the
// other, and the image whose layout that is.
#pragma once

#include <optional>

#include "base/bytes.h"
#include "base/hash.h"

namespace online_change {

struct RetainRecord {
  base::Digest image{};
  bool trial = false;  // taken while that image was on trial
  uint64_t cycle = 0;  // after which
  base::Bytes values;
};

base::Bytes encode(const RetainRecord& record);
// Encoded, with so many bytes of values.
uint64_t retain_record_bytes(uint64_t values);
std::optional<RetainRecord> decode_retain(base::ByteSpan payload);

}  // namespace online_change
