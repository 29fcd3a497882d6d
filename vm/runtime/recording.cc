#include "vm/runtime/recording.h"

#include <algorithm>
#include <span>

#include "base/crc32c.h"

namespace vm {
namespace {

constexpr char kMagic[] = {'S', 'T', 'C', 'R', 'E', 'C', '0', '3'};
// A cycle of several receptions has a tag of its own: a program that does not know it replays up to
// there, as where a file is cut off.
enum class Tag : uint8_t { kStart = 1, kCycle = 2, kRequest = 3, kEnd = 4, kLongCycle = 5 };
constexpr size_t kFrameBytes = 9;                  // tag, length, checksum
constexpr uint64_t kMaxClock = uint64_t{1} << 62;  // ns: 146 years
constexpr uint32_t kMaxImageBytes = uint32_t{1} << 24;

void varint(base::ByteWriter& out, uint64_t value) {
  for (; value >= 0x80; value >>= 7) out.u8(static_cast<uint8_t>(value | 0x80));
  out.u8(static_cast<uint8_t>(value));
}

uint64_t varint(base::ByteReader& in) {
  uint64_t value = 0;
  for (uint32_t shift = 0; shift < 64; shift += 7) {
    const uint8_t byte = in.u8();
    value |= static_cast<uint64_t>(byte & 0x7f) << shift;
    if ((byte & 0x80) == 0) return value;
  }
  in.fail();
  return 0;
}

// Differences between neighbours: a clock never goes back.
void write_clock(base::ByteWriter& out, const std::vector<int64_t>& reads) {
  varint(out, reads.size());
  uint64_t before = 0;
  for (int64_t read : reads) {
    varint(out, static_cast<uint64_t>(read) - before);
    before = static_cast<uint64_t>(read);
  }
}

void read_clock(base::ByteReader& in, std::vector<int64_t>& reads) {
  const uint64_t count = varint(in);
  uint64_t now = 0;
  for (uint64_t i = 0; i < count && !in.failed(); ++i) {
    const uint64_t more = varint(in);
    if (more > kMaxClock - now) return in.fail();
    now += more;
    reads.push_back(static_cast<int64_t>(now));
  }
}

void write_changes(base::ByteWriter& out, std::span<const ByteChange> changes) {
  varint(out, changes.size());
  uint32_t before = 0;
  for (const auto& [offset, value] : changes) {
    varint(out, offset - before);
    out.u8(value);
    before = offset;
  }
}

void read_changes(base::ByteReader& in, ByteChanges& changes) {
  const uint64_t count = varint(in);
  uint32_t offset = 0;
  for (uint64_t i = 0; i < count && !in.failed(); ++i) {
    const uint64_t gap = varint(in);
    if (gap >= kMaxImageBytes - offset) return in.fail();
    offset += static_cast<uint32_t>(gap);
    changes.push_back({offset, in.u8()});
  }
}

base::Bytes framed(Tag tag, base::ByteWriter& payload) {
  base::ByteWriter out;
  out.u8(static_cast<uint8_t>(tag));
  out.blob(payload.bytes());
  out.u32(base::crc32c(out.bytes()));
  return out.take();
}

void read_start(base::ByteReader& in, RecordedStart& start) {
  const auto copy = [](base::ByteSpan bytes) { return base::Bytes(bytes.begin(), bytes.end()); };
  start.image = copy(in.blob());
  start.retained = copy(in.blob());
  start.fuel_slice = in.u64();
  start.fuel_budget = in.u64();
  start.code_limit = in.u64();
  start.data_limit = in.u64();
  start.on_trap = in.enumerator<ir::OnTrap>(4);
  if (!in.done()) start.trial = copy(in.blob());
}

// Each `changed` and `lost` of its own.
void write_receptions(base::ByteWriter& out, const Observed& observed) {
  const std::span<const ByteChange> changed = observed.changed;
  const std::span<const ByteChange> lost = observed.lost;
  varint(out, observed.receptions.size());
  RecordedReception begin;
  for (const RecordedReception& end : observed.receptions) {
    write_changes(out, changed.subspan(begin.changed, end.changed - begin.changed));
    write_changes(out, lost.subspan(begin.lost, end.lost - begin.lost));
    begin = end;
  }
}

void read_receptions(base::ByteReader& in, Observed& observed) {
  const uint64_t count = varint(in);
  if (count < 2) return in.fail();  // one cycle has one stored form
  for (uint64_t i = 0; i < count && !in.failed(); ++i) {
    read_changes(in, observed.changed);
    read_changes(in, observed.lost);
    observed.receptions.push_back({static_cast<uint32_t>(observed.changed.size()),
                                   static_cast<uint32_t>(observed.lost.size())});
  }
}

RecordedCycle read_cycle(base::ByteReader& in, bool is_long) {
  RecordedCycle cycle;
  Observed& observed = cycle.observed;
  cycle.number = varint(in);
  read_clock(in, observed.clock);
  is_long ? read_receptions(in, observed) : read_changes(in, observed.changed);
  read_changes(in, observed.outputs);
  read_changes(in, observed.markers);
  read_changes(in, observed.globals);
  if (!is_long) {
    read_changes(in, observed.lost);
    observed.receptions = {{static_cast<uint32_t>(observed.changed.size()),
                            static_cast<uint32_t>(observed.lost.size())}};
  }
  cycle.state = in.u32();
  return cycle;
}

RecordedRequest read_request(base::ByteReader& in) {
  RecordedRequest request;
  request.cycle = varint(in);
  read_clock(in, request.clock);
  const base::ByteSpan bytes = in.blob();
  request.bytes.assign(bytes.begin(), bytes.end());
  return request;
}

// One record from the front of `rest`, which is shortened by it; false: it is not whole, or it is
// the end.
bool read_record(base::ByteSpan& rest, Recording& recording) {
  if (rest.size() < kFrameBytes) return false;
  base::ByteReader frame(rest);
  const uint8_t tag = frame.u8();
  const base::ByteSpan payload = frame.blob();
  const size_t size = payload.size() + kFrameBytes;
  const uint32_t checksum = frame.u32();
  if (frame.failed() || checksum != base::crc32c(rest.first(size - 4))) return false;
  rest = rest.subspan(size);
  base::ByteReader in(payload);
  if (tag == static_cast<uint8_t>(Tag::kStart)) {
    if (!recording.start.image.empty()) return false;  // the first record, and only that
    read_start(in, recording.start);
  } else if (const bool is_long = tag == static_cast<uint8_t>(Tag::kLongCycle);
             is_long || tag == static_cast<uint8_t>(Tag::kCycle)) {
    RecordedCycle cycle = read_cycle(in, is_long);
    if (in.done()) recording.cycles.push_back(std::move(cycle));
  } else if (tag == static_cast<uint8_t>(Tag::kRequest)) {
    RecordedRequest request = read_request(in);
    if (in.done()) recording.requests.push_back(std::move(request));
  } else {
    recording.cut_off = tag != static_cast<uint8_t>(Tag::kEnd) || !in.done() || !rest.empty();
    return false;
  }
  return in.done();
}

}  // namespace

base::Bytes encode_record(const RecordedStart& start) {
  base::ByteWriter payload;
  payload.blob(start.image);
  payload.blob(start.retained);
  payload.u64(start.fuel_slice);
  payload.u64(start.fuel_budget);
  payload.u64(start.code_limit);
  payload.u64(start.data_limit);
  payload.u8(static_cast<uint8_t>(start.on_trap));
  if (!start.trial.empty()) payload.blob(start.trial);
  base::ByteWriter out;
  out.raw(base::as_bytes({kMagic, sizeof kMagic}));
  out.raw(framed(Tag::kStart, payload));
  return out.take();
}

base::Bytes encode_record(const RecordedCycle& cycle) {
  base::ByteWriter payload;
  const Observed& observed = cycle.observed;
  const bool is_long = observed.receptions.size() > 1;
  varint(payload, cycle.number);
  write_clock(payload, observed.clock);
  is_long ? write_receptions(payload, observed) : write_changes(payload, observed.changed);
  write_changes(payload, observed.outputs);
  write_changes(payload, observed.markers);
  write_changes(payload, observed.globals);
  if (!is_long) write_changes(payload, observed.lost);
  payload.u32(cycle.state);
  return framed(is_long ? Tag::kLongCycle : Tag::kCycle, payload);
}

base::Bytes encode_record(const RecordedRequest& request) {
  base::ByteWriter payload;
  varint(payload, request.cycle);
  write_clock(payload, request.clock);
  payload.blob(request.bytes);
  return framed(Tag::kRequest, payload);
}

base::Bytes encode_end() {
  base::ByteWriter nothing;
  return framed(Tag::kEnd, nothing);
}

base::Result<Recording> decode_recording(base::ByteSpan bytes) {
  Recording recording;
  const bool magic = bytes.size() >= sizeof kMagic &&
                     std::equal(std::begin(kMagic), std::end(kMagic), bytes.begin());
  base::ByteSpan rest = magic ? bytes.subspan(sizeof kMagic) : base::ByteSpan();
  if (!read_record(rest, recording) || recording.start.image.empty()) {
    return base::Error{base::Refusal::kBadRecording, "it does not begin as a recording does"};
  }
  recording.cut_off = true;  // until the end is seen
  while (read_record(rest, recording)) {
  }
  std::stable_sort(
      recording.requests.begin(), recording.requests.end(),
      [](const RecordedRequest& a, const RecordedRequest& b) { return a.cycle < b.cycle; });
  return recording;
}

}  // namespace vm
