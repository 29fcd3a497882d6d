#include "online_change/store/copies.h"

#include <algorithm>

#include "base/check.h"

namespace online_change {
namespace {

// A copy that could not be read may have a higher sequence number than those that could. The next
// write skips so many numbers, so that it is the newest all the same.
constexpr uint64_t kUnreadSequences = uint64_t{1} << 32;

}  // namespace

Copies::Copies(vm::Storage& storage, RecordKind kind, std::vector<std::string> names)
    : storage_(storage), kind_(kind) {
  for (std::string& name : names) copies_.push_back({std::move(name), {}, false});
}

base::Status Copies::bury(Copy& copy, const base::Error& error) {
  if (!copy.dead) copy.why = error.text;
  copy.dead = true;
  return base::Error{base::Refusal::kStorageFailed, error.text};
}

void Copies::recover(uint64_t payload_bytes) {
  bool unread = false;
  for (Copy& copy : copies_) {
    copy.room = record_bytes(payload_bytes);
    base::Status opened = storage_.open(copy.name, copy.room);
    if (opened.ok()) opened = storage_.sync(copy.name);
    if (!opened.ok()) (void)bury(copy, opened.error()).ok();
    copy.record = read_record(storage_, copy.name, kind_);
    const bool unreadable = copy.record.state == RecordState::kUnreadable;
    unread |= unreadable;
    if (unreadable && !copy.dead) {
      (void)bury(copy, {base::Refusal::kFileUnreadable, copy.name + " cannot be read"}).ok();
    }
    last_sequence_ = std::max(last_sequence_, copy.record.sequence);
    base::dcheck(copy.record.state == RecordState::kValid || copy.record.payload.empty(),
                 "only a valid copy has content");
  }
  // A later process may be able to read it.
  if (unread) last_sequence_ = std::min(last_sequence_ + kUnreadSequences, kLastSequence);
}

base::Status Copies::reserve(size_t number, uint64_t payload_bytes, uint64_t spare) {
  Copy& copy = copies_[number];
  const uint64_t wanted = record_bytes(payload_bytes);
  if (copy.dead) {
    if (copy.room < wanted) copy.room = wanted + spare;
    return base::Ok{};
  }
  const base::Result<uint64_t> size = storage_.size(copy.name);
  if (size.ok() && *size >= wanted) return base::Ok{};
  base::Status opened = storage_.open(copy.name, wanted + spare);
  if (!opened.ok() && spare != 0) opened = storage_.open(copy.name, wanted);
  // The copy holds what it held: no room is not the end of it.
  if (!opened.ok()) return base::Error{base::Refusal::kStorageFailed, opened.error().text};
  copy.room = std::max(copy.room, wanted);
  return opened;
}

base::Status Copies::write(size_t number, const Payload& payload) {
  Copy& copy = copies_[number];
  if (last_sequence_ >= kLastSequence) {
    return bury(copy, {base::Refusal::kStorageFailed, copy.name + ": no sequence number is left"});
  }
  base::Status written = write_as(++last_sequence_, copy, payload);
  base::dcheck(!written.ok() || newest([](size_t) { return true; }) == number,
               "what was written last is the newest copy");
  return written;
}

base::Status Copies::write_older(size_t number, const Payload& payload) {
  const std::optional<size_t> first = newest([](size_t) { return true; });
  if (!first || *first == number) return write(number, payload);
  base::dcheck(copies_[*first].record.sequence != 0, "there is a number below that of the newest");
  base::Status written = write_as(copies_[*first].record.sequence - 1, copies_[number], payload);
  base::dcheck(newest([](size_t) { return true; }) == first, "the newest copy stays the newest");
  return written;
}

base::Status Copies::write_as(uint64_t sequence, Copy& copy, const Payload& payload) {
  base::dcheck(copy.dead || copy.record.state != RecordState::kUnreadable,
               "nothing is written over what could not be read");
  if (!copy.dead) copy.record = {RecordState::kDamaged, 0, {}};
  base::Status written =
      copy.dead ? replace_record(storage_, copy.name, kind_, sequence, payload, copy.room)
                : write_record(storage_, copy.name, kind_, sequence, payload);
  if (!written.ok()) return bury(copy, written.error());
  copy.record = {RecordState::kValid, sequence, {}};
  copy.dead = false;
  return written;
}

base::Status Copies::renew(size_t number) {
  Copy& copy = copies_[number];
  if (!copy.dead || valid(number) || unread(number)) return base::Ok{};
  base::Status made = storage_.replace(copy.name, copy.room, {});
  if (!made.ok()) return bury(copy, made.error());
  copy.record = {};
  copy.dead = false;
  base::dcheck(whole(number) == false, "a copy that was renewed holds nothing");
  return made;
}

void Copies::check() {
  doubt_.clear();
  for (size_t i = 0; i < copies_.size(); ++i) {
    Copy& copy = copies_[i];
    if (copy.dead && !valid(i) && !unread(i)) continue;
    base::Status there = storage_.check(copy.name);
    if (there.ok()) continue;
    if (there.error().refusal == base::Refusal::kFileNotFound) {
      (void)bury(copy, there.error()).ok();
      reject(i);
    } else if (doubt_.empty()) {
      doubt_ = there.error().text;
    }
  }
}

std::string Copies::complaint() const {
  for (const Copy& copy : copies_) {
    if (copy.dead) return copy.why;
  }
  return doubt_;
}

}  // namespace online_change
