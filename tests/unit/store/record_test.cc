// Records, copies and entries: every damage is seen, and nothing takes more than it should.
#include "online_change/store/record.h"

#include <gtest/gtest.h>

#include "base/hash.h"
#include "online_change/store/control_record.h"
#include "online_change/store/copies.h"
#include "online_change/store/journal.h"
#include "online_change/store/retain_record.h"
#include "tests/unit/store/sim_storage.h"

namespace online_change {
namespace {

constexpr RecordKind kKind = RecordKind::kControl;

TEST(Record, IsWhatWasWritten) {
  sim::SimStorage disk;
  ASSERT_TRUE(disk.open("r", record_bytes(700)).ok());
  EXPECT_EQ(read_record(disk, "r", kKind).state, RecordState::kEmpty);
  ASSERT_TRUE(write_record(disk, "r", kKind, 7, base::Bytes(700, 3)).ok());
  Record record = read_record(disk, "r", kKind);
  EXPECT_EQ(record.state, RecordState::kValid);
  EXPECT_EQ(record.sequence, 7u);
  EXPECT_EQ(record.payload, base::Bytes(700, 3));
  EXPECT_EQ(read_record(disk, "r", RecordKind::kImage).state, RecordState::kDamaged);
  EXPECT_EQ(read_record(disk, "other", kKind).state, RecordState::kEmpty) << "never written";
}

TEST(Record, OfTwoPartsIsWhatWasWritten) {
  const base::Bytes first(80, 4);
  const base::Bytes second(620, 5);
  sim::SimStorage disk;
  ASSERT_TRUE(disk.open("r", record_bytes(700)).ok());
  ASSERT_TRUE(write_record(disk, "r", kKind, 7, {first, second, base::sha256(second)}).ok());
  const Record record = read_record(disk, "r", kKind);
  EXPECT_EQ(record.state, RecordState::kValid);
  base::Bytes both = first;
  both.insert(both.end(), second.begin(), second.end());
  EXPECT_EQ(record.payload, both);
}

// Whoever says what the sum is says which bytes are sound.
TEST(Record, ASumOfOtherBytesIsDamage) {
  const base::Bytes first(80, 4);
  base::Bytes second(620, 5);
  const base::Digest sum = base::sha256(second);
  second.back() ^= 1;
  sim::SimStorage disk;
  ASSERT_TRUE(disk.open("r", record_bytes(700)).ok());
  ASSERT_TRUE(write_record(disk, "r", kKind, 7, {first, second, sum}).ok());
  EXPECT_EQ(read_record(disk, "r", kKind).state, RecordState::kDamaged);
}

TEST(Record, EveryFlippedBitOfTwoPartsIsSeen) {
  const base::Bytes first(40, 9);
  const base::Bytes second(60, 8);
  sim::SimStorage disk;
  ASSERT_TRUE(disk.open("r", record_bytes(100)).ok());
  ASSERT_TRUE(write_record(disk, "r", kKind, 1, {first, second, base::sha256(second)}).ok());
  base::Bytes& content = disk.content(0);
  for (size_t bit = 0; bit < (kSectorBytes + 100) * 8; ++bit) {
    content[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
    EXPECT_EQ(read_record(disk, "r", kKind).state, RecordState::kDamaged) << "bit " << bit;
    content[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
  }
  EXPECT_EQ(read_record(disk, "r", kKind).state, RecordState::kValid);
}

TEST(Record, EveryFlippedBitIsSeen) {
  sim::SimStorage disk;
  ASSERT_TRUE(disk.open("r", record_bytes(100)).ok());
  ASSERT_TRUE(write_record(disk, "r", kKind, 1, base::Bytes(100, 9)).ok());
  base::Bytes& content = disk.content(0);
  for (size_t bit = 0; bit < (kSectorBytes + 100) * 8; ++bit) {
    content[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
    EXPECT_EQ(read_record(disk, "r", kKind).state, RecordState::kDamaged) << "bit " << bit;
    content[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
  }
  EXPECT_EQ(read_record(disk, "r", kKind).state, RecordState::kValid);
}

TEST(Record, EveryTruncationIsSeen) {
  sim::SimStorage disk;
  ASSERT_TRUE(disk.open("r", record_bytes(100)).ok());
  ASSERT_TRUE(write_record(disk, "r", kKind, 1, base::Bytes(100, 9)).ok());
  base::Bytes& content = disk.content(0);
  content.resize(record_bytes(100));
  while (!content.empty()) {
    content.pop_back();
    EXPECT_NE(read_record(disk, "r", kKind).state, RecordState::kValid) << content.size();
  }
}

// A length that no file has, with a checksum that is right.
TEST(Record, ALengthBeyondTheFileIsDamage) {
  sim::SimStorage disk;
  ASSERT_TRUE(disk.open("r", record_bytes(100)).ok());
  base::Bytes header = record_header(kKind, 1, base::Bytes(5000));
  ASSERT_TRUE(disk.write("r", 0, header).ok());
  EXPECT_EQ(read_record(disk, "r", kKind).state, RecordState::kDamaged);
}

TEST(Copies, TheNewestIsNeverWrittenOver) {
  sim::SimStorage disk;
  Copies copies(disk, kKind, {"a", "b"});
  copies.recover(10);
  auto any = [](size_t) { return false; };
  for (uint8_t i = 1; i < 6; ++i) {
    std::optional<size_t> next = copies.victim(any);
    ASSERT_TRUE(next);
    EXPECT_NE(next, copies.newest([](size_t) { return true; }));
    ASSERT_TRUE(copies.write(*next, base::Bytes{i}).ok());
  }
  Copies again(disk, kKind, {"a", "b"});
  again.recover(10);
  EXPECT_EQ(again.take_payload(*again.newest([](size_t) { return true; })), base::Bytes{5});
}

// Counts the calls of that name, and lets those fail.
void fail_calls(sim::SimStorage& disk, std::string_view name, int& calls) {
  disk.fails = [name, &calls](std::string_view call) {
    if (call != name) return sim::Failure::kNone;
    ++calls;
    return sim::Failure::kError;
  };
}

// A sync that has failed once says "done" the next time, for a file that does not hold what was
// written: so the same file is not written, not even when the disk is well.
TEST(Copies, ADeadCopyIsWrittenInANewFileOnly) {
  sim::SimStorage disk;
  Copies copies(disk, kKind, {"a", "b"});
  copies.recover(10);
  ASSERT_TRUE(copies.write(0, base::Bytes{1}).ok());
  int syncs = 0;
  fail_calls(disk, "sync", syncs);
  EXPECT_EQ(copies.write(1, base::Bytes{2}).error().refusal, base::Refusal::kStorageFailed);
  EXPECT_EQ(syncs, 1);
  int renames = 0;
  fail_calls(disk, "rename", renames);
  EXPECT_EQ(copies.write(1, base::Bytes{3}).error().refusal, base::Refusal::kStorageFailed);
  EXPECT_EQ(renames, 1) << "it was written in place";
  EXPECT_NE(copies.complaint(), "");
  EXPECT_EQ(copies.victim([](size_t) { return false; }), 1u);
  disk.fails = nullptr;
  ASSERT_TRUE(copies.write(1, base::Bytes{4}).ok());
  EXPECT_EQ(copies.complaint(), "");
  Copies again(disk, kKind, {"a", "b"});
  again.recover(10);
  EXPECT_EQ(again.newest([](size_t) { return true; }), 1u);
  EXPECT_EQ(again.take_payload(1), base::Bytes{4});
}

// What reads see behind a sync that has failed is not what the disk holds: nor for the process that
// comes next.
TEST(Copies, WhatASyncHasLostIsNotFoundByTheNextProcess) {
  sim::SimStorage disk;
  Copies copies(disk, kKind, {"a", "b"});
  copies.recover(10);
  ASSERT_TRUE(copies.write(0, base::Bytes{1}).ok());
  int syncs = 0;
  fail_calls(disk, "sync", syncs);
  ASSERT_FALSE(copies.write(1, base::Bytes{2}).ok());
  EXPECT_EQ(read_record(disk, "b", kKind).state, RecordState::kValid) << "as a system shows it";
  sim::SimStorage later = disk.after_kill();
  Copies next(later, kKind, {"a", "b"});
  next.recover(10);
  EXPECT_EQ(next.newest([](size_t) { return true; }), 0u);
}

// Its number may be higher than those that can be read; it must not come back as the newest.
TEST(Copies, WhatIsWrittenBesideOneThatCannotBeReadIsNewer) {
  sim::SimStorage disk;
  Copies copies(disk, kKind, {"a", "b", "c"});
  copies.recover(10);
  for (uint8_t i = 0; i < 6; ++i) ASSERT_TRUE(copies.write(i < 2 ? i : 2u, base::Bytes{i}).ok());
  int reads = 0;  // of each copy its header and its payload, in their order
  disk.fails = [&](std::string_view call) {
    reads += call == "read" ? 1 : 0;
    return call == "read" && reads == 5 ? sim::Failure::kError : sim::Failure::kNone;
  };
  Copies half(disk, kKind, {"a", "b", "c"});
  half.recover(10);
  disk.fails = nullptr;
  ASSERT_EQ(half[2].record.state, RecordState::kUnreadable);
  ASSERT_TRUE(half.write(0, base::Bytes{9}).ok());
  Copies whole(disk, kKind, {"a", "b", "c"});
  whole.recover(10);
  EXPECT_EQ(whole.newest([](size_t) { return true; }), 0u);
}

TEST(Copies, ACopyWhoseFileIsGoneIsDeadAndComesBack) {
  sim::SimStorage disk;
  Copies copies(disk, kKind, {"a", "b"});
  copies.recover(10);
  ASSERT_TRUE(copies.write(0, base::Bytes{1}).ok());
  disk.remove("a");
  copies.check();
  EXPECT_FALSE(copies.valid(0));
  EXPECT_NE(copies.complaint().find("removed"), std::string::npos);
  ASSERT_TRUE(copies.renew(0).ok());
  EXPECT_EQ(copies.complaint(), "");
  disk.remove("a");
  EXPECT_FALSE(copies.write(0, base::Bytes{2}).ok()) << "durable, where nobody finds it";
}

// It may be the newest; only new content takes its place, or an empty file when it is gone.
TEST(Copies, case56_WhatCouldNotBeReadIsNotRenewed) {
  sim::SimStorage disk;
  Copies written(disk, kKind, {"a"});
  written.recover(10);
  ASSERT_TRUE(written.write(0, base::Bytes{1}).ok());
  disk.fails = [&](std::string_view call) {
    return call == "read" ? sim::Failure::kError : sim::Failure::kNone;
  };
  Copies copies(disk, kKind, {"a"});
  copies.recover(10);
  disk.fails = nullptr;
  ASSERT_TRUE(copies.unread(0));
  copies.check();
  EXPECT_TRUE(copies.renew(0).ok());
  EXPECT_NE(copies.complaint(), "") << "until it is read or written";
  EXPECT_EQ(read_record(disk, "a", kKind).payload, base::Bytes{1});
  disk.remove("a");
  copies.check();
  ASSERT_TRUE(copies.renew(0).ok());
  EXPECT_EQ(copies.complaint(), "");
}

TEST(Copies, case56_WhenNobodyCanTellItIsSaidAndNothingIsLost) {
  sim::SimStorage disk;
  Copies copies(disk, kKind, {"a", "b"});
  copies.recover(10);
  ASSERT_TRUE(copies.write(0, base::Bytes{1}).ok());
  disk.fails = [&](std::string_view call) {
    return call == "check" ? sim::Failure::kError : sim::Failure::kNone;
  };
  copies.check();
  EXPECT_TRUE(copies.whole(0));
  EXPECT_NE(copies.complaint(), "");
  disk.fails = nullptr;
  copies.check();
  EXPECT_EQ(copies.complaint(), "");
  ASSERT_TRUE(copies.renew(0).ok());
  EXPECT_EQ(read_record(disk, "a", kKind).payload, base::Bytes{1});
}

TEST(Journal, EntriesComeBackOldestFirstAndTheRingGoesRound) {
  sim::SimStorage disk;
  Journal journal(disk, "j", 4);
  journal.recover();
  for (int i = 1; i <= 10; ++i) {
    JournalEntry entry;
    entry.event = Event::kSwitched;
    entry.who = "operator";
    entry.time_ns = i;
    entry.counts.dropped = static_cast<uint64_t>(i);
    entry.measured_ns = 100 + i;
    entry.text = std::string(1000, 'x');
    ASSERT_TRUE(journal.add(entry).ok());
  }
  std::vector<JournalEntry> entries = *read_journal(disk, "j");
  ASSERT_EQ(entries.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(entries[i].sequence, 7 + i);
    EXPECT_EQ(entries[i].counts.dropped, 7 + i);
    EXPECT_EQ(entries[i].measured_ns, static_cast<int64_t>(107 + i));
    EXPECT_EQ(entries[i].who, "operator");
    EXPECT_EQ(entries[i].text, std::string(kMaxText, 'x'));
  }
  Journal again(disk, "j", 4);
  again.recover();
  ASSERT_TRUE(again.add({}).ok());
  EXPECT_EQ(read_journal(disk, "j")->back().sequence, 11u);
}

TEST(Journal, X5_AnEntryIsDurableWhenItIsNoted) {
  sim::SimStorage disk;
  Journal journal(disk, "j", 4);
  journal.recover();
  for (uint64_t count = 1; count <= 3; ++count) {
    ASSERT_TRUE(journal.add({}).ok());
    sim::SimStorage left = disk.after_cut(sim::SimStorage::Choice(disk.dirty().size(), 0));
    EXPECT_EQ(read_journal(left, "j")->size(), count);
  }
}

TEST(Journal, ADamagedEntryCostsNoOther) {
  sim::SimStorage disk;
  Journal journal(disk, "j", 4);
  journal.recover();
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(journal.add({}).ok());
  const base::Bytes good = disk.content(0);
  for (size_t bit = 0; bit < kSectorBytes * 8; ++bit) {
    disk.content(0) = good;
    disk.content(0)[2 * kSectorBytes + bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
    EXPECT_EQ(read_journal(disk, "j")->size(), 3u) << "bit " << bit;
  }
}

// It would begin again with the first number, over entries that are newer.
TEST(Journal, OneThatCannotBeReadIsNotWritten) {
  sim::SimStorage disk;
  Journal first(disk, "j", 4);
  first.recover();
  ASSERT_TRUE(first.add({}).ok());
  int reads = 0;
  fail_calls(disk, "read", reads);
  Journal journal(disk, "j", 4);
  journal.recover();
  disk.fails = nullptr;
  EXPECT_NE(journal.complaint(), "");
  EXPECT_FALSE(journal.add({}).ok());
  EXPECT_FALSE(journal.renew().ok());
  EXPECT_EQ(read_journal(disk, "j")->size(), 1u);
  disk.remove("j");
  journal.check();
  EXPECT_TRUE(journal.renew().ok()) << "there is nothing left to lose";
}

TEST(Journal, WhatCouldNotBeWrittenIsThereWhenTheDiskIsWell) {
  sim::SimStorage disk;
  Journal journal(disk, "j", 4);
  journal.recover();
  JournalEntry entry;
  for (entry.cycle = 1; entry.cycle <= 3; ++entry.cycle) ASSERT_TRUE(journal.add(entry).ok());
  int syncs = 0;
  fail_calls(disk, "sync", syncs);
  for (; entry.cycle <= 6; ++entry.cycle) EXPECT_FALSE(journal.add(entry).ok());
  EXPECT_FALSE(journal.renew().ok());
  EXPECT_EQ(journal.entries().back().cycle, 6u) << "shown meanwhile";
  disk.fails = nullptr;
  EXPECT_TRUE(journal.renew().ok());
  EXPECT_EQ(journal.complaint(), "");
  EXPECT_TRUE(journal.add(entry).ok());
  const std::vector<JournalEntry> entries = *read_journal(disk, "j");
  ASSERT_EQ(entries.size(), 4u);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(entries[i].cycle, 4 + i);
}

TEST(Journal, CutsTextsBetweenCharacters) {
  JournalEntry entry;
  entry.who.assign(kMaxWho - 1, 'a');
  entry.who += "\xc3\xa4";
  std::optional<JournalEntry> back = decode_entry(encode(entry));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->who, std::string(kMaxWho - 1, 'a'));
}

// A sector has room for the longest texts, and one of an older release has no source.
TEST(Journal, R10_AnEventHasASource) {
  JournalEntry entry;
  entry.who.assign(2 * kMaxWho, 'w');
  entry.text.assign(2 * kMaxText, 't');
  entry.source.assign(2 * kMaxSource, 's');
  std::optional<JournalEntry> back = decode_entry(encode(entry));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->who.size() + back->text.size() + back->source.size(),
            kMaxWho + kMaxText + kMaxSource);
  entry.source = "task Fast";
  EXPECT_EQ(decode_entry(encode(entry))->source, "task Fast");
}

TEST(Decoders, TakeWhatTheyWroteAndNothingElse) {
  ControlRecord control;
  control.boots[3] = 7;
  control.slot = 1;
  control.trial = true;
  control.tries_left = 1;
  control.trial_digest[5] = 9;
  control.trial_slot = 0;
  base::Bytes bytes = encode(control);
  std::optional<ControlRecord> back = decode_control(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(encode(*back), bytes);
  EXPECT_TRUE(back->is_trial(control.trial_digest));
  bytes.push_back(0);
  EXPECT_FALSE(decode_control(bytes));
  bytes.pop_back();
  bytes[32] = 3;  // there are three slots
  EXPECT_FALSE(decode_control(bytes));
  control.trial_slot = 2;  // D3: several edits on trial
  bytes = encode(control);
  back = decode_control(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->trial_slot, 2);
  control.resumes = true;  // D4
  EXPECT_EQ(encode(control).size(), kMostControlBytes);
  EXPECT_TRUE(decode_control(encode(control))->resumes);
  bytes[32] = 2;  // it cannot hold both
  EXPECT_FALSE(decode_control(bytes));
  ControlRecord idle = control;
  idle.trial = idle.resumes = false;  // nothing is on trial, so nothing is tried
  EXPECT_FALSE(decode_control(encode(idle)));
  idle.tries_left = 0;
  EXPECT_TRUE(decode_control(encode(idle)));

  RetainRecord retain;
  retain.image[0] = 1;
  retain.trial = true;
  retain.cycle = 12;
  retain.values = {1, 2, 3};
  bytes = encode(retain);
  std::optional<RetainRecord> values = decode_retain(bytes);
  ASSERT_TRUE(values);
  EXPECT_EQ(encode(*values), bytes);
  for (size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_FALSE(decode_retain(base::ByteSpan(bytes).first(n))) << n;
  }
}

}  // namespace
}  // namespace online_change
