// One durable record in a file of its own: a header in the first sector, the payload after it. A
// record is valid when its checksums are right, and by nothing else: a cut leaves the record as it
// was, or as it shall be, or one that is seen not to be valid, in whatever order the disk has
// written it. docs/adr/0013-durable-storage.md has the format.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "vm/runtime/ports.h"

namespace online_change {

inline constexpr uint32_t kSectorBytes = 512;  // what a disk writes at once, and a header takes

// Nothing writes so often; a record beyond it is not one of ours.
inline constexpr uint64_t kLastSequence = uint64_t{1} << 62;

enum class RecordKind : uint32_t { kControl = 1, kImage = 2, kRetain = 3, kEdits = 4, kTrust = 5 };

enum class RecordState : uint8_t {
  kEmpty,       // never written
  kValid,       //
  kDamaged,     // cut off while it was written, or changed since
  kUnreadable,  // the storage says so; nothing may be written over it
};

struct Record {
  RecordState state = RecordState::kEmpty;
  uint64_t sequence = 0;  // of kValid
  base::Bytes payload;    // of kValid
};

// One after the other; borrowed.
struct Payload {
  Payload(base::ByteSpan all) : first(all) {}      // NOLINT: most are in one piece
  Payload(const base::Bytes& all) : first(all) {}  // NOLINT
  // `sum`: the SHA-256 of the second one, which is known already.
  Payload(base::ByteSpan a, base::ByteSpan b, const base::Digest& sum)
      : first(a), second(b), second_sum(sum) {}
  base::ByteSpan first;
  base::ByteSpan second;
  std::optional<base::Digest> second_sum;
};

constexpr uint64_t record_bytes(uint64_t payload) { return kSectorBytes + payload; }

base::Bytes record_header(RecordKind kind, uint64_t sequence, const Payload& payload);
// Any content of the file, of any length. Takes no more memory than the file has bytes.
Record read_record(vm::Storage& storage, const std::string& name, RecordKind kind);
// Durable when it returns. After an error the file holds anything.
base::Status write_record(vm::Storage& storage, const std::string& name, RecordKind kind,
                          uint64_t sequence, const Payload& payload);
// Writes the record into a new file of `size` bytes at least. After an error the file holds what it
// held, or the record.
base::Status replace_record(vm::Storage& storage, const std::string& name, RecordKind kind,
                            uint64_t sequence, const Payload& payload, uint64_t size);

}  // namespace online_change
