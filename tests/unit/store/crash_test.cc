// X5, A17, cases 54 to 56: power cuts at every boundary between two calls to the disk, with every
// choice of what was in flight, torn sectors, processes killed before the cut, and cuts during the
// recovery. Behind each there is exactly one program, which was promised, and its retained values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/unit/sanitized.h"
#include "tests/unit/store/history.h"

namespace history {
namespace {

constexpr uint64_t kStates = kOneOf == 1 ? 1'000'000 : 10'000;

class Cuts {
 public:
  // Looks at all states of this life. Level 0: those of the life; 1: those of what follows a cut.
  void live_through(History& history, sim::SimStorage& disk, uint64_t seed, uint32_t operations,
                    bool faults) {
    disk.before_call = [&] { look(history, disk, 0); };
    live(history, seed, operations, faults);
    disk.before_call = nullptr;
  }
  uint64_t tried() const { return tried_; }
  uint64_t failed() const { return failed_; }

 private:
  static constexpr size_t kChoices = 24;  // at one boundary; above it, a sample

  // All choices when there are few of them.
  void choices_of(const std::vector<sim::SimStorage::Dirty>& dirty) {
    choices_.clear();
    sim::SimStorage::Choice choice(dirty.size(), 0);
    uint64_t all = 1;
    for (const auto& row : dirty) all = std::min<uint64_t>(all * (row.contents.size() + 1), 1000);
    for (uint64_t n = 0; n < std::min<uint64_t>(all, kChoices); ++n) {
      uint64_t rest = all <= kChoices ? n : random_();
      for (size_t i = 0; i < dirty.size(); ++i) {
        choice[i] = static_cast<uint8_t>(rest % (dirty[i].contents.size() + 1));
        rest /= dirty[i].contents.size() + 1;
      }
      choices_.push_back(choice);
    }
  }

  void look(const History& history, const sim::SimStorage& disk, int level) {
    if (++boundaries_ % kOneOf != 0) return;
    choices_of(disk.dirty());
    const std::vector<sim::SimStorage::Choice> choices = choices_;
    for (const auto& choice : choices) try_one(history, disk.after_cut(choice), level);
    for (size_t i = 0; i < disk.dirty().size(); ++i) {
      const auto& choice = choices[random_() % choices.size()];
      for (uint32_t bytes : {1u, 20u, 60u, 256u, 509u, static_cast<uint32_t>(random_() % 512)}) {
        try_one(history, disk.after_cut(choice, {i, bytes}), level);
      }
    }
    if (!disk.dirty().empty()) try_one(history, disk.after_kill(), level);
  }

  void try_one(const History& history, sim::SimStorage disk, int level) {
    ++tried_;
    History next(disk, history.promises());
    std::string wrong = next.open();
    if (!wrong.empty()) {
      report(wrong, level);
      return;
    }
    if (level == 0 && tried_ % 7 == 0) recover_through(history.promises(), std::move(disk));
  }

  // The recovery and what comes behind it is cut, too.
  void recover_through(const Promises& promises, sim::SimStorage disk) {
    History next(disk, promises);
    disk.before_call = [&] { look(next, disk, 1); };
    std::string wrong = next.open();
    if (!wrong.empty()) report(wrong, 1);
    next.believe();
    if (next.settle()) live(next, tried_, 5);
    disk.before_call = nullptr;
  }

  void report(const std::string& wrong, int level) {
    if (++failed_ <= 5) std::printf("level %d: %s\n", level, wrong.c_str());
  }

  std::mt19937_64 random_{1};
  std::vector<sim::SimStorage::Choice> choices_;
  uint64_t boundaries_ = 0;
  uint64_t tried_ = 0;
  uint64_t failed_ = 0;
};

void cut_lives(bool faults) {
  Cuts cuts;
  for (uint64_t seed = 1; cuts.tried() < kStates && cuts.failed() == 0; ++seed) {
    sim::SimStorage disk;
    History history(disk);
    ASSERT_EQ(history.open(), "");
    cuts.live_through(history, disk, seed, 30, faults);
  }
  std::printf("%llu tried, %llu failed\n", static_cast<unsigned long long>(cuts.tried()),
              static_cast<unsigned long long>(cuts.failed()));
  EXPECT_EQ(cuts.failed(), 0u);
}

TEST(Crash, X5_case54_APowerCutAtAnyInstantLeavesOneVersionWithItsValues) { cut_lives(false); }

// The same while the disk fails now and then and what has failed is renewed.
TEST(Crash, case56_APowerCutAroundFaultsOfTheDiskLeavesOneVersionWithItsValues) {
  cut_lives(true);
}

}  // namespace
}  // namespace history
