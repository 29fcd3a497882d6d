// Disks that fail: at every call, in every way; full, read-only, damaged. The store says so, and
// what was durable before is still there when the disk works again.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/unit/sanitized.h"
#include "tests/unit/store/history.h"

namespace history {
namespace {

using sim::Failure;

// A disk with version 1 on it, saved values, and one note.
sim::SimStorage lived_on() {
  sim::SimStorage disk;
  History history(disk);
  EXPECT_EQ(history.open(), "");
  EXPECT_TRUE(history.install(1));
  EXPECT_TRUE(history.save());
  EXPECT_TRUE(history.note());
  return disk;
}

// What is promised there.
Promises promised() {
  Promises out;
  out.boots = 1;
  out.count = out.count_begun = out.count_accepted = 1;
  out.notes = out.notes_begun = 1;
  return out;
}

// One call fails, in one of the ways; the process goes on, ends, and the disk works again.
void fail_once(std::string_view call, uint64_t number, Failure how, bool& reached, uint64_t seed) {
  sim::SimStorage disk = lived_on();
  uint64_t calls = 0;
  reached = false;
  disk.fails = [&](std::string_view name) {
    if (name != call || ++calls != number) return Failure::kNone;
    reached = true;
    return how;
  };
  History history(disk, promised());
  const std::string wrong = history.open();
  if (!reached) {
    EXPECT_EQ(wrong, "");
  }
  // What cannot be read is not found; nothing that is found may be wrong.
  if (!wrong.empty()) return;
  live(history, seed, 12);
  sim::SimStorage later = disk.after_cut(sim::SimStorage::Choice(disk.dirty().size(), 0));
  History again(later, history.promises());
  EXPECT_EQ(again.open(), "") << call << " " << number;
}

TEST(Faults, case56_OneFailureAnywhereLosesNothingThatWasDurable) {
  uint64_t tried = 0;
  for (const char* call : {"open", "read", "write", "sync", "check"}) {
    for (Failure how : {Failure::kError, Failure::kShort}) {
      for (uint64_t seed = 1; seed <= 20; seed += kOneOf) {
        bool reached = true;
        for (uint64_t number = 1; reached; ++number, ++tried) {
          fail_once(call, number, how, reached, seed);
        }
      }
    }
  }
  std::printf("%llu tried\n", static_cast<unsigned long long>(tried));
  EXPECT_GT(tried, 3000u / kOneOf);
}

// A read fails while the controller starts, and the disk is well again.
TEST(Faults, case56_RenewalKeepsWhatCouldOnlyNotBeRead) {
  for (int number = 1;; ++number) {
    sim::SimStorage disk = lived_on();
    int reads = 0;
    disk.fails = [&](std::string_view call) {
      return call == "read" && ++reads == number ? Failure::kError : Failure::kNone;
    };
    online_change::Store store(disk, small());
    disk.fails = nullptr;
    if (reads < number) break;
    store.look();
    (void)store.renew().ok();
    History again(disk, promised());
    EXPECT_EQ(again.open(), "") << "read " << number;
  }
}

TEST(Faults, case56_AFullDiskRefusesTheChangeAndKeepsTheRest) {
  sim::SimStorage disk = lived_on();
  disk.full_at = 0;
  History history(disk, promised());
  ASSERT_EQ(history.open(), "");
  EXPECT_TRUE(history.save()) << "what has room needs none";
  EXPECT_FALSE(history.begin_trial(30)) << "a longer program does not fit";
  EXPECT_TRUE(history.undo());
  EXPECT_TRUE(history.save());
  disk.full_at = ~uint64_t{0};
  EXPECT_TRUE(history.begin_trial(30)) << "no room is not the end of a copy";
  EXPECT_TRUE(history.accept());
  History again(disk, history.promises());
  EXPECT_EQ(again.open(), "");
}

TEST(Faults, case56_AReadOnlyDiskStillBoots) {
  sim::SimStorage disk = lived_on();
  disk.fails = [](std::string_view call) {
    return call == "write" ? Failure::kError : Failure::kNone;
  };
  History history(disk, promised());
  ASSERT_EQ(history.open(), "");
  EXPECT_FALSE(history.save());
  EXPECT_FALSE(history.begin_trial(2));
  ASSERT_TRUE(history.found().boots);
}

TEST(Faults, ADiskWithoutRoomAtTheStartGivesNothingAndSaysSo) {
  sim::SimStorage disk;
  disk.full_at = 0;
  History history(disk);
  EXPECT_EQ(history.open(), "");
  EXPECT_FALSE(history.install(1));
  EXPECT_FALSE(history.found().boots);
}

// --- damage -------------------------------------------------------------------------

// Whatever is in the files: the same programs and values, or none and a reason, never a mixture.
void expect_sound(sim::SimStorage disk, const std::string& what) {
  History history(disk, promised());
  const std::string wrong = history.open();
  const online_change::Recovered& found = history.found();
  if (wrong.empty()) return;
  const bool said = !found.nothing.empty() || !found.alarms.empty() ||
                    !found.no_newest.empty() || wrong.starts_with("entry");
  EXPECT_TRUE(said) << what << ": " << wrong;
  EXPECT_EQ(wrong.find("mixture"), std::string::npos) << what;
}

TEST(Damage, case56_AFlippedBitAnywhereIsSeen) {
  const sim::SimStorage good = lived_on();
  const size_t files = good.names().size();
  uint64_t tried = 0;
  for (size_t file = 0; file < files; ++file) {
    sim::SimStorage disk = good;
    for (size_t bit = 0; bit < disk.content(file).size() * 8; bit += (bit < 8192 ? 1 : 7) * kOneOf) {
      disk.content(file)[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
      disk.settle(file);
      expect_sound(disk, good.names()[file] + " bit " + std::to_string(bit));
      disk.content(file)[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
      ++tried;
    }
  }
  std::printf("%llu tried\n", static_cast<unsigned long long>(tried));
}

TEST(Damage, ATruncatedFileIsSeen) {
  const sim::SimStorage good = lived_on();
  for (size_t file = 0; file < good.names().size(); ++file) {
    sim::SimStorage disk = good;
    while (!disk.content(file).empty()) {
      disk.content(file).pop_back();
      disk.settle(file);
      sim::SimStorage one = disk;
      expect_sound(one, good.names()[file]);
    }
  }
}

TEST(Damage, case56_BothSlotsOrBothControlRecordsGiveAReasonAndTakeANewProgram) {
  for (const std::string which : {"slot", "control"}) {
    sim::SimStorage disk = lived_on();
    const std::vector<std::string> names = disk.names();
    for (size_t file = 0; file < names.size(); ++file) {
      if (!names[file].starts_with(which)) continue;
      disk.content(file)[100] ^= 1;
      disk.settle(file);
    }
    History history(disk, promised());
    EXPECT_NE(history.open(), "");
    EXPECT_FALSE(history.found().boots);
    EXPECT_FALSE(history.found().virgin);
    EXPECT_NE(history.found().nothing, "");
    history.believe();
    EXPECT_TRUE(history.install(2));
    EXPECT_TRUE(history.save());
    History again(disk, history.promises());
    EXPECT_EQ(again.open(), "");
  }
}

TEST(Damage, OneControlRecordIsMadeWholeFromTheOther) {
  for (const char* which : {"control_0", "control_1"}) {
    sim::SimStorage disk = lived_on();
    const std::vector<std::string> names = disk.names();
    for (int round = 0; round < 2; ++round) {
      for (size_t file = 0; file < names.size(); ++file) {
        const bool damaged = (names[file] == which) == (round == 0);
        if (!names[file].starts_with("control") || !damaged) continue;
        disk.content(file)[5] ^= 1;
        disk.settle(file);
      }
      History history(disk, promised());
      ASSERT_EQ(history.open(), "");
      ASSERT_TRUE(history.settle());
    }
  }
}

TEST(Damage, case57_TheLayoutOfTheRetainedValuesStaysUntilNewOnesAreDurable) {
  sim::SimStorage disk = lived_on();
  auto store = std::make_unique<online_change::Store>(disk, small());
  ASSERT_TRUE(store->settle().ok());
  ASSERT_TRUE(store->begin_trial(program(2), 10).ok());
  ASSERT_TRUE(store->accept().ok());
  EXPECT_FALSE(store->retained_fits());
  EXPECT_EQ(store->begin_trial(program(3), 10).error().refusal, base::Refusal::kStorageFailed);
  EXPECT_EQ(store->install(program(3), 10).error().refusal, base::Refusal::kStorageFailed);
  EXPECT_FALSE(store->save_retained(program(1).digest, 5, base::Bytes(3)).ok());
  ASSERT_TRUE(store->save_retained(program(2).digest, 5, base::Bytes(3)).ok());
  EXPECT_TRUE(store->begin_trial(program(3), 10).ok());
}

}  // namespace
}  // namespace history
