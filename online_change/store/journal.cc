#include "online_change/store/journal.h"

#include <algorithm>
#include <iterator>

#include "base/check.h"
#include "base/crc32c.h"
#include "base/digest_reader.h"
#include "base/visible_text.h"
#include "online_change/store/record.h"

namespace online_change {
namespace {

constexpr uint32_t kJournalMagic = 0x314e524a;  // "JRN1"
constexpr size_t kChecksumAt = kSectorBytes - 4;

constexpr EventRow kRows[] = {
#define EVENT(id, name, level, kept, limit, meaning) {name, Level::level, Kept::kept, Limit::limit},
#include "online_change/store/events.def"
#undef EVENT
};

void put_counts(base::ByteWriter& out, const FateCounts& counts) {
  for (uint64_t count :
       {counts.kept, counts.moved, counts.converted, counts.initialised, counts.dropped}) {
    out.u64(count);
  }
}

void get_counts(base::ByteReader& in, FateCounts& counts) {
  for (uint64_t* count :
       {&counts.kept, &counts.moved, &counts.converted, &counts.initialised, &counts.dropped}) {
    *count = in.u64();
  }
}

}  // namespace

const EventRow& event_row(Event event) { return kRows[static_cast<size_t>(event)]; }

base::Bytes encode(const JournalEntry& entry) {
  base::ByteWriter out;
  out.u32(kJournalMagic);
  out.u64(entry.sequence);
  out.i64(entry.time_ns);
  out.u8(static_cast<uint8_t>(entry.event));
  out.raw(entry.from);
  out.raw(entry.to);
  put_counts(out, entry.counts);
  out.i64(entry.predicted_ns);
  out.i64(entry.measured_ns);
  out.u64(entry.cycle);
  out.text(base::whole_characters(entry.who, kMaxWho));
  out.text(base::whole_characters(entry.text, kMaxText));
  out.text(base::whole_characters(entry.source, kMaxSource));
  base::Bytes sector = out.take();
  base::check(sector.size() <= kChecksumAt, "an entry of the journal fits into its sector");
  sector.resize(kSectorBytes);
  const uint32_t checksum = base::crc32c(base::ByteSpan(sector).first(kChecksumAt));
  std::memcpy(sector.data() + kChecksumAt, &checksum, sizeof checksum);
  base::dcheck([&] { return entry.sequence > kLastSequence || decode_entry(sector).has_value(); },
               "an entry of the journal is read as it was written");
  return sector;
}

std::optional<JournalEntry> decode_entry(base::ByteSpan sector) {
  if (sector.size() != kSectorBytes) return std::nullopt;
  base::ByteReader tail(sector.subspan(kChecksumAt));
  if (base::crc32c(sector.first(kChecksumAt)) != tail.u32()) return std::nullopt;
  base::ByteReader in(sector.first(kChecksumAt));
  if (in.u32() != kJournalMagic) return std::nullopt;
  JournalEntry entry;
  entry.sequence = in.u64();
  entry.time_ns = in.i64();
  entry.event = in.enumerator<Event>(kEventKinds);
  entry.from = base::read_digest(in);
  entry.to = base::read_digest(in);
  get_counts(in, entry.counts);
  entry.predicted_ns = in.i64();
  entry.measured_ns = in.i64();
  entry.cycle = in.u64();
  entry.who = in.text();
  entry.text = in.text();
  entry.source = in.text();  // zeros after what older releases have written: ""
  if (in.failed() || entry.sequence > kLastSequence || entry.who.size() > kMaxWho ||
      entry.text.size() > kMaxText || entry.source.size() > kMaxSource) {
    return std::nullopt;
  }
  return entry;
}

namespace {

// Equal ones stay as they were. Numbers are sorted instead of entries: that is less code.
void sort_by_sequence(std::vector<JournalEntry>& entries) {
  std::vector<std::pair<uint64_t, uint32_t>> order;
  for (const JournalEntry& entry : entries) {
    order.emplace_back(entry.sequence, static_cast<uint32_t>(order.size()));
  }
  std::sort(order.begin(), order.end());
  std::vector<JournalEntry> sorted;
  sorted.reserve(entries.size());
  for (const auto& [sequence, at] : order) sorted.push_back(std::move(entries[at]));
  entries = std::move(sorted);
}

// Adds what can be read; the error of what cannot.
base::Status read_into(vm::Storage& storage, const std::string& name,
                       std::vector<JournalEntry>& entries) {
  constexpr uint64_t kPiece = 256 * kSectorBytes;
  constexpr uint64_t kMost = 1u << 26;  // a longer file is not one of ours
  base::Result<uint64_t> size = storage.size(name);
  if (!size.ok()) return size.error();
  base::Status all = base::Ok{};
  for (uint64_t at = 0; at < std::min(*size, kMost); at += kPiece) {
    base::Result<base::Bytes> piece = storage.read(name, at, kPiece);
    if (!piece.ok()) all = piece.error();
    for (size_t i = 0; piece.ok() && i + kSectorBytes <= piece->size(); i += kSectorBytes) {
      std::optional<JournalEntry> entry =
          decode_entry(base::ByteSpan(*piece).subspan(i, kSectorBytes));
      if (entry) entries.push_back(std::move(*entry));
    }
  }
  sort_by_sequence(entries);
  return all;
}

}  // namespace

base::Result<std::vector<JournalEntry>> read_journal(vm::Storage& storage,
                                                     const std::string& name) {
  std::vector<JournalEntry> entries;
  base::Status all = read_into(storage, name, entries);
  if (!all.ok()) return all.error();
  return entries;
}

std::vector<JournalEntry> by_time(std::vector<JournalEntry> entries,
                                  std::vector<JournalEntry> traps) {
  std::vector<JournalEntry> all;
  auto trap = traps.begin();
  for (JournalEntry& entry : entries) {
    while (trap != traps.end() && trap->time_ns <= entry.time_ns) {
      all.push_back(std::move(*trap++));
    }
    all.push_back(std::move(entry));
  }
  all.insert(all.end(), std::make_move_iterator(trap), std::make_move_iterator(traps.end()));
  return all;
}

base::Status Journal::fail(const base::Error& error) {
  complaint_ = error.text;
  return error;
}

// Entries move, which takes less time than the disk does.
void Journal::forget_oldest() {
  if (ring_.size() <= entries_) return;
  ring_.erase(ring_.begin(), ring_.end() - static_cast<std::ptrdiff_t>(entries_));
}

void Journal::recover() {
  base::Status opened = storage_.open(name_, uint64_t{entries_} * kSectorBytes);
  if (opened.ok()) opened = storage_.sync(name_);
  if (!opened.ok()) (void)fail(opened.error()).ok();
  base::Status read = read_into(storage_, name_, ring_);
  unread_ = !read.ok() && read.error().refusal != base::Refusal::kFileNotFound;
  if (unread_) (void)fail(read.error()).ok();
  forget_oldest();
  if (!ring_.empty()) next_ = ring_.back().sequence + 1;
}

base::Status Journal::add(JournalEntry entry) {
  entry.sequence = next_++;
  const uint64_t at = entry.sequence % entries_ * kSectorBytes;
  const base::Bytes sector = encode(entry);
  if (std::optional<JournalEntry> kept = decode_entry(sector)) ring_.push_back(std::move(*kept));
  forget_oldest();
  if (!complaint_.empty()) return base::Error{base::Refusal::kStorageFailed, complaint_};
  base::Status written = storage_.write(name_, at, sector);
  if (written.ok()) written = storage_.sync(name_);
  if (!written.ok()) return fail(written.error());
  return written;
}

void Journal::check() {
  if (!complaint_.empty() && !unread_) return;
  base::Status there = storage_.check(name_);
  if (there.ok()) return;
  if (there.error().refusal == base::Refusal::kFileNotFound) unread_ = false;
  (void)fail(there.error()).ok();
}

base::Status Journal::renew() {
  if (complaint_.empty()) return base::Ok{};
  if (unread_) return base::Error{base::Refusal::kStorageFailed, complaint_};
  base::Bytes content(uint64_t{entries_} * kSectorBytes, 0);
  for (const JournalEntry& entry : ring_) {
    const base::Bytes sector = encode(entry);
    std::copy(sector.begin(), sector.end(),
              content.begin() +
                  static_cast<std::ptrdiff_t>(entry.sequence % entries_ * kSectorBytes));
  }
  const vm::Storage::Piece piece{0, content};
  base::Status made = storage_.replace(name_, content.size(), {&piece, 1});
  if (!made.ok()) return fail(made.error());
  complaint_.clear();
  return made;
}

}  // namespace online_change
