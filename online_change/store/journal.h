// What happens to a controller (Event), and the part of it that is durable: rings of entries, each
// in a sector of its own with a checksum and a sequence number, so a cut costs the entry that was
// being written and no other. Who changed what, when, from which version to which, with which fates
// and which pause.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/hash.h"
#include "online_change/diff/fates.h"
#include "vm/runtime/ports.h"

namespace online_change {

enum class Event : uint8_t {
#define EVENT(id, name, level, kept, limit, meaning) id,
#include "online_change/store/events.def"
#undef EVENT
};
inline constexpr size_t kEventKinds = 0
#define EVENT(id, name, level, kept, limit, meaning) +1
#include "online_change/store/events.def"
#undef EVENT
    ;

// Numbers of syslog and of journald's prefix.
enum class Level : uint8_t { kError = 3, kWarning = 4, kNotice = 5, kInfo = 6 };
// What outlives the controller: nothing; the ring of what decides which program runs, for years;
// that of what can come so often that it would push the former out.
enum class Kept : uint8_t { kMemory, kJournal, kOften };
// How many of one kind, of one task, device or command, are told in a row. By a plant: few, since
// it never tires. By people: more.
enum class Limit : uint8_t { kNone, kPlant, kPeople };

struct EventRow {
  const char* name;
  Level level;
  Kept kept;
  Limit limit;
};
const EventRow& event_row(Event event);
inline const char* event_name(Event event) { return event_row(event).name; }

struct JournalEntry {
  uint64_t sequence = 0;  // given by the ring
  int64_t time_ns = 0;    // wall clock, since 1970; handed in
  Event event = Event::kStarted;
  std::string who;      // the user; cut at kMaxWho bytes
  base::Digest from{};  // zeros: none
  base::Digest to{};
  FateCounts counts;
  int64_t predicted_ns = 0;  // pause
  int64_t measured_ns = 0;
  uint64_t cycle = 0;
  std::string text;         // the reason, or the trap; cut at kMaxText bytes
  std::string source = {};  // "task Fast", "device press"; "": the controller; cut at kMaxSource
};

inline constexpr size_t kMaxWho = 32;
inline constexpr size_t kMaxText = 240;
inline constexpr size_t kMaxSource = 64;

// One sector.
base::Bytes encode(const JournalEntry& entry);
std::optional<JournalEntry> decode_entry(base::ByteSpan sector);

// Entries of a file, oldest first. What is damaged is left out; a part that cannot be read is an
// error, and so is a file that is not there.
base::Result<std::vector<JournalEntry>> read_journal(vm::Storage& storage, const std::string& name);

// The entries of two lists, both oldest first, by time; what has the same time stays in its own
// order.
std::vector<JournalEntry> by_time(std::vector<JournalEntry> entries,
                                  std::vector<JournalEntry> traps);

// The journal, whose entries are in memory too, so that they can be shown while the disk fails, and
// are written when it is well again.
class Journal {
 public:
  Journal(vm::Storage& storage, std::string name, uint32_t entries)
      : storage_(storage), name_(std::move(name)), entries_(entries) {}
  void recover();
  // Durable when it returns without an error. After one nothing more is written before renew().
  base::Status add(JournalEntry entry);
  // A file that was removed has failed.
  void check();
  // Where something has failed: a new file with all entries. One that could not be read is left
  // alone, since it holds entries that are nowhere else.
  base::Status renew();
  const std::vector<JournalEntry>& entries() const { return ring_; }
  const std::string& complaint() const { return complaint_; }

 private:
  base::Status fail(const base::Error& error);
  void forget_oldest();

  vm::Storage& storage_;
  std::string name_;
  uint32_t entries_;
  std::vector<JournalEntry> ring_;  // oldest first
  uint64_t next_ = 1;
  bool unread_ = false;
  std::string complaint_;  // not empty: dead
};

}  // namespace online_change
