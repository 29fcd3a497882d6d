#include "online_change/store/retain_record.h"

#include <algorithm>

#include "base/check.h"
#include "base/digest_reader.h"

namespace online_change {

base::Bytes encode(const RetainRecord& record) {
  base::ByteWriter out;
  out.raw(record.image);
  out.boolean(record.trial);
  out.u64(record.cycle);
  out.blob(record.values);
  base::Bytes bytes = out.take();
  base::dcheck(
      [&] {
        const auto read = decode_retain(bytes);
        return read && read->image == record.image && read->values == record.values;
      },
      "retained values are read as they were written");
  return bytes;
}

uint64_t retain_record_bytes(uint64_t values) { return encode(RetainRecord{}).size() + values; }

std::optional<RetainRecord> decode_retain(base::ByteSpan payload) {
  base::ByteReader in(payload);
  RetainRecord record;
  record.image = base::read_digest(in);
  record.trial = in.boolean();
  record.cycle = in.u64();
  base::ByteSpan values = in.blob();
  record.values.assign(values.begin(), values.end());
  if (!in.done()) return std::nullopt;
  return record;
}

}  // namespace online_change
