// Several copies of one kind of record, each in a file: the newest valid one counts. A copy on
// which an operation has failed is dead, since nobody knows what its file holds: it is never
// written in place again, and lives again when a new file has taken the place of that one. A file
// that could not be read may hold what nothing else does: only new content takes its place.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "online_change/store/record.h"

namespace online_change {

class Copies {
 public:
  struct Copy {
    std::string name;
    Record record;
    bool dead = false;
    std::string why = {};  // it is dead
    uint64_t room = 0;     // bytes of a file that replaces it
  };

  Copies(vm::Storage& storage, RecordKind kind, std::vector<std::string> names);

  // Makes room for a payload of that size in each file and reads what is there. What was in flight
  // when the last process ended is made durable first: nothing is built on what a power cut could
  // still take away.
  void recover(uint64_t payload_bytes);
  // Room for a longer payload in one copy; where it must become longer, for so many bytes more, if
  // the storage has them: a longer file costs a flush of the disk.
  base::Status reserve(size_t number, uint64_t payload_bytes, uint64_t spare = 0);
  // Writes over whatever the copy holds, with the next sequence number; a dead copy gets a new
  // file.
  base::Status write(size_t number, const Payload& payload);
  // Writes a copy that counts as older than the newest, which stays the newest one.
  base::Status write_older(size_t number, const Payload& payload);
  // A dead copy that holds nothing gets a new file that is empty.
  base::Status renew(size_t number);
  // A copy whose file has been removed is dead, and holds nothing. When nobody can tell, that is a
  // complaint until the next check.
  void check();

  size_t count() const { return copies_.size(); }
  const Copy& operator[](size_t number) const { return copies_[number]; }
  bool valid(size_t number) const { return copies_[number].record.state == RecordState::kValid; }
  // Valid and of the highest sequence number among those whose number `fits` takes.
  template <class Fits>
  std::optional<size_t> newest(Fits fits) const {
    std::optional<size_t> best;
    for (size_t i = 0; i < copies_.size(); ++i) {
      if (!valid(i) || !fits(i)) continue;
      if (!best || copies_[i].record.sequence > copies_[*best].record.sequence) best = i;
    }
    return best;
  }
  // The one to be written next; the newest is never written in place, and what `needed` takes is
  // not written at all. A dead one only when there is no other.
  template <class Needed>
  std::optional<size_t> victim(Needed needed) const {
    const std::optional<size_t> first = newest([](size_t) { return true; });
    const std::optional<size_t> sure = newest([&](size_t i) { return !copies_[i].dead; });
    std::optional<size_t> best;
    for (size_t i = 0; i < copies_.size(); ++i) {
      if (copies_[i].dead || first == i || sure == i || (valid(i) && needed(i))) continue;
      if (!best || copies_[i].record.sequence < copies_[*best].record.sequence) best = i;
    }
    for (size_t i = 0; i < copies_.size() && !best; ++i) {
      if (copies_[i].dead && !(valid(i) && needed(i))) best = i;
    }
    return best;
  }
  bool whole(size_t number) const { return valid(number) && !copies_[number].dead; }
  // Nobody knows what it holds.
  bool unread(size_t number) const {
    return copies_[number].record.state == RecordState::kUnreadable;
  }
  // What recover() read; kept until then.
  base::Bytes take_payload(size_t number) { return std::move(copies_[number].record.payload); }
  // The owner has found that the payload is not what it should be.
  void reject(size_t number) { copies_[number].record = {RecordState::kDamaged, 0, {}}; }
  // Why the first of the dead ones is dead, or what check() could not tell; else empty.
  std::string complaint() const;

 private:
  base::Status bury(Copy& copy, const base::Error& error);
  base::Status write_as(uint64_t sequence, Copy& copy, const Payload& payload);

  vm::Storage& storage_;
  RecordKind kind_;
  std::vector<Copy> copies_;
  uint64_t last_sequence_ = 0;
  std::string doubt_;  // of the last check()
};

}  // namespace online_change
