#include "online_change/store/copies.h"

#include <algorithm>

namespace online_change {

Copies::Copies(vm::Storage& storage, RecordKind kind, std::vector<std::string> names)
    : storage_(storage), kind_(kind) {
  for (std::string& name : names) copies_.push_back({std::move(name), {}, false});
}

base::Status Copies::bury(Copy& copy, const base::Error& error) {
  copy.dead = true;
  if (complaint_.empty()) complaint_ = error.text;
  return base::Error{base::Refusal::kStorageFailed, error.text};
}

void Copies::recover(uint64_t payload_bytes) {
  for (Copy& copy : copies_) {
    base::Status opened = storage_.open(copy.name, record_bytes(payload_bytes));
    if (opened.ok()) opened = storage_.sync(copy.name);
    if (!opened.ok()) (void)bury(copy, opened.error()).ok();
    copy.record = read_record(storage_, copy.name, kind_);
    if (copy.record.state == RecordState::kUnreadable && !copy.dead) {
      (void)bury(copy, {base::Refusal::kFileUnreadable, copy.name + " cannot be read"}).ok();
    }
    last_sequence_ = std::max(last_sequence_, copy.record.sequence);
  }
}

base::Status Copies::reserve(size_t number, uint64_t payload_bytes, uint64_t spare) {
  Copy& copy = copies_[number];
  if (copy.dead) return base::Error{base::Refusal::kStorageFailed, complaint_};
  const base::Result<uint64_t> size = storage_.size(copy.name);
  const uint64_t wanted = record_bytes(payload_bytes);
  const bool fits = size.ok() && *size >= wanted;
  base::Status opened = storage_.open(copy.name, fits ? wanted : wanted + spare);
  if (!opened.ok() && !fits && spare != 0) opened = storage_.open(copy.name, wanted);
  // The copy holds what it held: no room is not the end of it.
  if (!opened.ok()) return base::Error{base::Refusal::kStorageFailed, opened.error().text};
  return opened;
}

base::Status Copies::write(size_t number, const Payload& payload) {
  Copy& copy = copies_[number];
  if (copy.dead) return base::Error{base::Refusal::kStorageFailed, complaint_};
  if (last_sequence_ >= kLastSequence) {
    return bury(copy, {base::Refusal::kStorageFailed, copy.name + ": no sequence number is left"});
  }
  copy.record = {RecordState::kDamaged, 0, {}};
  const uint64_t sequence = ++last_sequence_;
  base::Status written = write_record(storage_, copy.name, kind_, sequence, payload);
  if (!written.ok()) return bury(copy, written.error());
  copy.record = {RecordState::kValid, sequence, {}};
  return written;
}

}  // namespace online_change
