#include "online_change/store/record.h"

#include <algorithm>

#include "base/check.h"
#include "base/crc32c.h"
#include "base/digest_reader.h"
#include "base/sha256.h"

namespace online_change {
namespace {

constexpr uint64_t kRecordMagic = 0x44524f4345524353;  // "SCRECORD"
constexpr uint32_t kRecordVersion = 1;
// The payload is of two parts, and the hash one of their hashes: the second one's is often known.
constexpr uint32_t kInParts = 2;
constexpr size_t kRecordChecksumAt = kSectorBytes - 4;  // of all bytes before it

struct Header {
  RecordKind kind{};
  uint64_t sequence = 0;
  uint64_t length = 0;
  base::Digest hash{};                   // of the payload
  std::optional<uint64_t> first_length;  // kInParts
};

base::Digest sum_of_parts(base::ByteSpan first, const base::Digest& second) {
  return base::sha256(base::sha256(first), second);
}

bool is_intact(const Header& header, base::ByteSpan payload) {
  if (payload.size() != header.length) return false;
  if (!header.first_length) return base::sha256(payload) == header.hash;
  if (*header.first_length > payload.size()) return false;
  const base::ByteSpan first = payload.first(*header.first_length);
  return sum_of_parts(first, base::sha256(payload.subspan(first.size()))) == header.hash;
}

bool decode(base::ByteSpan sector, Header& out) {
  if (sector.size() != kSectorBytes) return false;
  base::ByteReader tail(sector.subspan(kRecordChecksumAt));
  if (base::crc32c(sector.first(kRecordChecksumAt)) != tail.u32()) return false;
  base::ByteReader in(sector);
  if (in.u64() != kRecordMagic) return false;
  const uint32_t version = in.u32();
  if (version != kRecordVersion && version != kInParts) return false;
  out.kind = static_cast<RecordKind>(in.u32());
  out.sequence = in.u64();
  out.length = in.u64();
  out.hash = base::read_digest(in);
  if (version == kInParts) out.first_length = in.u64();
  return true;
}

// Does read_record() take what is about to be written? A sum that is known is the caller's.
bool is_readable(base::ByteSpan sector, RecordKind kind, uint64_t sequence,
                 const Payload& payload) {
  Header header;
  if (!decode(sector, header) || header.kind != kind || header.sequence != sequence) return false;
  if (header.length != payload.first.size() + payload.second.size()) return false;
  return payload.second_sum || is_intact(header, payload.first);
}

bool all_zero(base::ByteSpan bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](uint8_t byte) { return byte == 0; });
}

}  // namespace

base::Bytes record_header(RecordKind kind, uint64_t sequence, const Payload& payload) {
  base::dcheck(sequence <= kLastSequence, "a record has a sequence number that is read again");
  base::ByteWriter out;
  out.u64(kRecordMagic);
  out.u32(payload.second_sum ? kInParts : kRecordVersion);
  out.u32(static_cast<uint32_t>(kind));
  out.u64(sequence);
  out.u64(payload.first.size() + payload.second.size());
  if (payload.second_sum) {
    out.raw(sum_of_parts(payload.first, *payload.second_sum));
    out.u64(payload.first.size());
  } else {
    out.raw(base::sha256(payload.first));
  }
  base::Bytes sector = out.take();
  sector.resize(kSectorBytes);
  const uint32_t checksum = base::crc32c(base::ByteSpan(sector).first(kRecordChecksumAt));
  std::memcpy(sector.data() + kRecordChecksumAt, &checksum, sizeof checksum);
  base::dcheck([&] { return is_readable(sector, kind, sequence, payload); },
               "a record is read as it was written");
  return sector;
}

Record read_record(vm::Storage& storage, const std::string& name, RecordKind kind) {
  base::Result<uint64_t> size = storage.size(name);
  base::Result<base::Bytes> sector = storage.read(name, 0, kSectorBytes);
  if (!size.ok() && size.error().refusal == base::Refusal::kFileNotFound) return {};
  if (!size.ok() || !sector.ok()) return {RecordState::kUnreadable, 0, {}};
  if (all_zero(*sector)) return {};
  Header header;
  const bool fits = decode(*sector, header) && header.kind == kind &&
                    header.sequence <= kLastSequence && header.length <= *size - kSectorBytes;
  if (!fits) return {RecordState::kDamaged, 0, {}};
  base::Result<base::Bytes> payload = storage.read(name, kSectorBytes, header.length);
  if (!payload.ok()) return {RecordState::kUnreadable, 0, {}};
  if (!is_intact(header, *payload)) return {RecordState::kDamaged, 0, {}};
  base::dcheck(payload->size() == header.length, "a valid record has the length that it says");
  return {RecordState::kValid, header.sequence, std::move(*payload)};
}

base::Status write_record(vm::Storage& storage, const std::string& name, RecordKind kind,
                          uint64_t sequence, const Payload& payload) {
  base::Status done = storage.write(name, kSectorBytes, payload.first);
  if (done.ok() && !payload.second.empty()) {
    done = storage.write(name, kSectorBytes + payload.first.size(), payload.second);
  }
  if (done.ok()) done = storage.write(name, 0, record_header(kind, sequence, payload));
  if (done.ok()) done = storage.sync(name);
  return done;
}

base::Status replace_record(vm::Storage& storage, const std::string& name, RecordKind kind,
                            uint64_t sequence, const Payload& payload, uint64_t size) {
  const base::Bytes header = record_header(kind, sequence, payload);
  const vm::Storage::Piece pieces[] = {
      {0, header},
      {kSectorBytes, payload.first},
      {kSectorBytes + payload.first.size(), payload.second},
  };
  const uint64_t needed = record_bytes(payload.first.size() + payload.second.size());
  return storage.replace(name, std::max(size, needed), pieces);
}

}  // namespace online_change
