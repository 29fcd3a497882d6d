// Recordings with any content: read within their bytes, and what is read is written as it was.
//
// An input is the rest of a file behind a good header: records of {tag, length, payload}, whose
// checksums are put right here, so that the decoders behind them are reached.
#include <cstddef>
#include <cstdint>

#include "base/check.h"
#include "base/crc32c.h"
#include "vm/runtime/recording.h"

namespace {

base::Bytes file_of(base::ByteSpan input) {
  vm::RecordedStart start;
  start.image = {1};
  base::Bytes file = vm::encode_record(start);
  while (input.size() >= 2) {
    const size_t length = std::min<size_t>(input[1], input.size() - 2);
    base::ByteWriter record;
    record.u8(input[0] % 5);
    record.blob(input.subspan(2, length));
    record.u32(base::crc32c(record.bytes()));
    file.insert(file.end(), record.bytes().begin(), record.bytes().end());
    input = input.subspan(2 + length);
  }
  return file;
}

void append(base::Bytes& file, const base::Bytes& record) {
  file.insert(file.end(), record.begin(), record.end());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const base::ByteSpan input(data, size);
  if (vm::decode_recording(input).ok()) return 0;  // as it is
  const base::Result<vm::Recording> read = vm::decode_recording(file_of(input));
  base::check(read.ok(), "the header is good");
  base::Bytes again = vm::encode_record(read->start);
  for (const vm::RecordedCycle& cycle : read->cycles) append(again, vm::encode_record(cycle));
  for (const vm::RecordedRequest& row : read->requests) append(again, vm::encode_record(row));
  append(again, vm::encode_end());
  const base::Result<vm::Recording> same = vm::decode_recording(again);
  base::check(same.ok() && !same->cut_off, "what was read is written whole");
  base::check(same->cycles.size() == read->cycles.size(), "no cycle is lost");
  for (size_t i = 0; i < read->cycles.size(); ++i) {
    const vm::Observed& a = read->cycles[i].observed;
    const vm::Observed& b = same->cycles[i].observed;
    const bool devices = a.changed == b.changed && a.lost == b.lost &&
                         a.receptions.size() == b.receptions.size();
    base::check(a.clock == b.clock && devices, "what the cycle saw is the same");
  }
  return 0;
}
