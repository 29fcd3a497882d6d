// Hours of a plant's time: mostly scans, and a step of somebody every few seconds.
#include <algorithm>
#include <set>

#include "tests/sim/heap_use.h"
#include "tests/sim/world.h"

namespace sim {
namespace {

constexpr int64_t kSecond = 1'000'000'000;
constexpr int64_t kHour = 3600 * kSecond;
constexpr uint64_t kSlack = 1 << 20;  // of the heap; programs of different hours differ
constexpr uint32_t kScansForInputs = 16;
constexpr size_t kGrowth = 3;  // of a program by edits

}  // namespace

// Nothing is saved in here, so a power cut finds none of these boundaries.
void World::scan_for(int64_t ns) {
  const int64_t until_ns = clock_.now_ns() + ns;
  for (uint32_t i = 0; clock_.now_ns() < until_ns; ++i) {
    if (controller_->faulted()) {  // the plant waits for somebody
      clock_.advance(until_ns - clock_.now_ns());
      return;
    }
    if (i % kScansForInputs == 0) {
      for (size_t byte = 0; byte < controller_->image().input_bytes; ++byte) {
        devices_.set_input(byte, static_cast<uint8_t>(random_.next()));
      }
    }
    controller_->cycle();
    ++tally_.boundaries;
  }
}

// All but those that may run once more.
void World::forget_versions() {
  const vm::StatusReport now = settled();
  std::sort(may_boot_.begin(), may_boot_.end());
  may_boot_.erase(std::unique(may_boot_.begin(), may_boot_.end()), may_boot_.end());
  std::set<base::Digest> kept(may_boot_.begin(), may_boot_.end());
  kept.insert({now.running, now.previous, now.boots_next});
  for (const OnTrial& edit : on_trial_) kept.insert(edit.before);  // undo leads there, one by one
  std::erase_if(versions_, [&](const auto& row) { return !kept.contains(row.first); });
}

bool World::endure(int hours, const Hourly& hourly) {
  if (!begin()) return false;
  most_text_ = kGrowth * differential::print(first_->tree).size();
  uint64_t first_hour = 0;
  int64_t ends_ns = clock_.now_ns();
  for (int hour = 1; hour <= hours; ++hour) {
    ends_ns += kHour;
    uint64_t most = 0;
    while (clock_.now_ns() < ends_ns) {
      scan_for((1 + random_.below(9)) * kSecond);
      step();
      forget_versions();
      most = std::max(most, heap_use());
    }
    tally_.plant_ns += static_cast<uint64_t>(kHour);
    hourly(hour, most);
    if (hour == 1) first_hour = most;
    require(most <= first_hour + first_hour / 2 + kSlack, "the memory of every hour is the same");
  }
  return true;
}

}  // namespace sim
